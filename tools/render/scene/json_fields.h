#pragma once

#include <initializer_list>
#include <string>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace gonio {

/// The range of numbers that have no other: the cube of such a length is a float still.
inline constexpr double json_limit = 1e9;

/// Reads the members of a JSON object; every message names the file and the path of the member.
class JsonFields {
 public:
  /// @param where file name and path, such as "a.json: camera"
  /// @param known all members that the object may have
  /// @throws Error if it is no object, or has another member.
  JsonFields(const nlohmann::json& object, std::string where, std::initializer_list<const char*> known);

  bool has(const char* key) const { return object_.contains(key); }
  std::string where(const std::string& key) const { return where_ + (where_.back() == ':' ? " " : ".") + key; }
  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const;

  /// Each throws Error if the member is missing or of another kind.
  const nlohmann::json& at(const char* key) const;
  JsonFields object(const char* key, std::initializer_list<const char*> known) const {
    return JsonFields(at(key), where(key), known);
  }
  std::string text(const char* key) const;
  double number(const char* key, double low = -json_limit, double high = json_limit) const;
  bool boolean(const char* key) const;
  /// An array of three numbers.
  glm::vec3 triple(const char* key, double low = -json_limit, double high = json_limit) const;
  /// A triple, or one number that stands for three.
  glm::vec3 triple_or_number(const char* key, double low = -json_limit, double high = json_limit) const;

 private:
  const nlohmann::json& object_;
  std::string where_;
};

}  // namespace gonio
