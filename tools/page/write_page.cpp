#include "tools/page/write_page.h"

#include <ostream>
#include <string>

namespace gonio {

// Made by the build from tools/report/page and tools/render/page.
extern const char report_page_head[], report_page_tail[], compare_page_head[], compare_page_tail[];

namespace {

void write(std::ostream& out, const char* head, const nlohmann::json& report, const char* tail) {
  out << head;
  // In HTML, `<` could end the script element that holds the JSON. It occurs inside JSON strings only.
  for (const char c : report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    c == '<' ? out << "\\u003c" : out << c;
  out << tail;
}

}  // namespace

void write_page(std::ostream& out, const nlohmann::json& report) {
  write(out, report_page_head, report, report_page_tail);
}

void write_compare_page(std::ostream& out, const nlohmann::json& comparison) {
  write(out, compare_page_head, comparison, compare_page_tail);
}

}  // namespace gonio
