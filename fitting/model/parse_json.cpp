#include <set>
#include <vector>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using nlohmann::json;

std::string shortened(std::string text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t end = longest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // no half characters
  return text.substr(0, end) + "...";
}

/// Follows the parser through the text and refuses what no file of gonio's has.
class Rules {
 public:
  explicit Rules(const std::string& where) : where_(where) {}

  void operator()(json::parse_event_t event, const json& parsed) {
    switch (event) {
      case json::parse_event_t::object_start:
      case json::parse_event_t::array_start:
        next();
        open_.push_back({event == json::parse_event_t::array_start, 0, {}, {}});
        if (open_.size() > max_json_depth)
          throw Error(where_ + ": found objects or arrays more than " + std::to_string(max_json_depth) +
                      " deep, expected fewer inside each other");
        break;
      case json::parse_event_t::object_end:
      case json::parse_event_t::array_end:
        open_.pop_back();
        break;
      case json::parse_event_t::key:
        open_.back().key = parsed.get<std::string>();
        if (!open_.back().keys.insert(open_.back().key).second)
          throw Error(where_ + ": " + shortened(path(), 200) + ": found twice, expected once");
        break;
      case json::parse_event_t::value:
        next();
        break;
    }
  }

 private:
  struct Open {
    bool array;
    std::size_t count;           // of the elements of an array that have begun
    std::string key;             // of the member that is being read
    std::set<std::string> keys;  // of an object
  };

  void next() {
    if (!open_.empty()) ++open_.back().count;
  }

  std::string path() const {
    std::string text;
    for (const Open& open : open_)
      text += open.array ? "[" + std::to_string(open.count - 1) + "]" : (text.empty() ? "" : ".") + open.key;
    return text;
  }

  const std::string& where_;
  std::vector<Open> open_;
};

}  // namespace

json parse_json(std::string_view text, const std::string& where) {
  if (begins_as_utf16(text))
    throw Error(where + ": found UTF-16, expected JSON in UTF-8 (iconv -f UTF-16 -t UTF-8 FILE > NEW writes it)");
  Rules rules(where);
  try {
    return json::parse(text, [&](int, json::parse_event_t event, const json& parsed) {
      rules(event, parsed);
      return true;
    });
  } catch (const json::exception& error) {  // out_of_range for a number like 1e999
    const std::string what = error.what();  // "[json.exception.parse_error.101] parse error at line 1 ..."
    throw Error(where + ": is not JSON: " + shortened(what.substr(what.find("] ") + 2), 200));
  }
}

std::string shown(const json& value) {
  return shortened(value.dump(-1, ' ', false, json::error_handler_t::replace), 40);
}

}  // namespace gonio
