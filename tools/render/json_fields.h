#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace gonio {

/// The range of numbers that have no other: the cube of such a length is a float still.
inline constexpr double json_limit = 1e9;

/// Reads the members of a JSON object; every message names the file and the path of the member.
/// Members that nobody asked for are an error in finish().
class JsonFields {
 public:
  /// @param where file name and path, such as "a.json: camera". @throws Error if it is no object.
  JsonFields(const nlohmann::json& object, std::string where);

  bool has(const char* key) const { return object_.contains(key); }
  std::string where(const std::string& key) const { return where_ + (where_.back() == ':' ? " " : ".") + key; }
  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const;

  /// Each throws Error if the member is missing or of another kind.
  const nlohmann::json& at(const char* key);
  JsonFields object(const char* key) { return JsonFields(at(key), where(key)); }
  std::string text(const char* key);
  double number(const char* key, double low = -json_limit, double high = json_limit);
  bool boolean(const char* key);
  /// An array of three numbers.
  glm::vec3 triple(const char* key, double low = -json_limit, double high = json_limit);
  /// A triple, or one number that stands for three.
  glm::vec3 triple_or_number(const char* key, double low = -json_limit, double high = json_limit);

  /// @throws Error if there is a member that none of the above was called for.
  void finish() const;

 private:
  const nlohmann::json& object_;
  std::string where_;
  std::set<std::string> known_;
};

}  // namespace gonio
