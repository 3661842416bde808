#include "tools/render/scene/json_fields.h"

#include <algorithm>
#include <sstream>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

std::string range_of(double low, double high) {
  std::ostringstream text;
  text << " from " << low << " to " << high;
  return text.str();
}

bool in_range(const nlohmann::json& value, double low, double high) {
  return value.is_number() && value.get<double>() >= low && value.get<double>() <= high;
}

}  // namespace

JsonFields::JsonFields(const nlohmann::json& object, std::string where, std::initializer_list<const char*> known)
    : object_(object), where_(std::move(where)) {
  if (!object.is_object())
    throw Error(where_ + (where_.back() == ':' ? " found " : ": found ") + shown(object) + ", expected an object");
  for (const auto& [key, value] : object.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(key, "an unknown member", one_of({known.begin(), known.end()}, key));
}

void JsonFields::fail(const std::string& key, const std::string& found, const std::string& expected) const {
  throw Error(where(key) + ": found " + found + ", expected " + expected);
}

const nlohmann::json& JsonFields::at(const char* key) const {
  if (!has(key)) fail(key, "none", "one");
  return object_.at(key);
}

std::string JsonFields::text(const char* key) const {
  const nlohmann::json& value = at(key);
  if (!value.is_string()) fail(key, shown(value), "a string");
  return value.get<std::string>();
}

double JsonFields::number(const char* key, double low, double high) const {
  const nlohmann::json& value = at(key);
  if (!in_range(value, low, high)) fail(key, shown(value), "a number" + range_of(low, high));
  return value.get<double>();
}

bool JsonFields::boolean(const char* key) const {
  const nlohmann::json& value = at(key);
  if (!value.is_boolean()) fail(key, shown(value), "true or false");
  return value.get<bool>();
}

glm::vec3 JsonFields::triple(const char* key, double low, double high) const {
  const nlohmann::json& value = at(key);
  bool good = value.is_array() && value.size() == 3;
  for (std::size_t c = 0; good && c < 3; ++c) good = in_range(value[c], low, high);
  if (!good) fail(key, shown(value), "three numbers" + range_of(low, high));
  return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
}

glm::vec3 JsonFields::triple_or_number(const char* key, double low, double high) const {
  const nlohmann::json& value = at(key);
  return value.is_array() ? triple(key, low, high) : glm::vec3(static_cast<float>(number(key, low, high)));
}

}  // namespace gonio
