#include <gonio/tools/report/write_page.h>

#include <ostream>
#include <string>

namespace gonio {

// Made by the build from tools/report/page.
extern const char page_head[], page_tail[];

void write_page(std::ostream& out, const nlohmann::json& report) {
  out << page_head;
  // In HTML, `<` could end the script element that holds the JSON. It occurs inside JSON strings only.
  for (const char c : report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) c == '<' ? out << "\\u003c" : out << c;
  out << page_tail;
}

}  // namespace gonio
