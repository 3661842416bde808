#include "tools/stability/summary.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/number.h"

namespace gonio {
nlohmann::json read_stability(const std::filesystem::path& path) {
  nlohmann::json json = parse_json(read_bytes(path), path.string());
  if (!json.is_object() || !json.contains("rows") || !json["rows"].is_array() || json["rows"].empty())
    throw Error(path.string() + ": rows: found none, expected the stability.json of gonio stability");
  const std::vector<std::pair<const char*, nlohmann::json::value_t>> keys = {
      {"variant", nlohmann::json::value_t::string},  {"input", nlohmann::json::value_t::string},
      {"error_of", nlohmann::json::value_t::string}, {"why", nlohmann::json::value_t::string},
      {"fails", nlohmann::json::value_t::boolean},   {"failed", nlohmann::json::value_t::array}};
  for (const nlohmann::json& row : json["rows"]) {
    for (const auto& [key, type] : keys)
      if (!row.is_object() || !row.contains(key) || row[key].type() != type)
        throw Error(path.string() + ": rows: " + key +
                    ": found a row without it, expected the stability.json of gonio stability");
    for (const char* key : {"max_error", "max_error_bound", "bias", "bias_standard_error", "chi2_p"})
      if (!row.contains(key) || !row[key].is_number())
        throw Error(path.string() + ": rows: " + key +
                    ": found a row without this number, expected the stability.json of gonio stability");
  }
  return json;
}

void write_stability_summary(std::ostream& out, const nlohmann::json& stability) {
  out << "| variant | fails on | largest error [ulp] | of | largest bias | smallest chi2 p | why "
         "|\n|---|---|---|---|---|---|---|\n";
  std::vector<std::string> names;
  for (const nlohmann::json& row : stability["rows"])
    if (std::find(names.begin(), names.end(), row["variant"]) == names.end()) names.push_back(row["variant"]);
  for (const std::string& name : names) {
    int count = 0, failures = 0;
    double error = 0, bias = 0, p = 1;
    const nlohmann::json* any = nullptr;
    for (const nlohmann::json& row : stability["rows"]) {
      if (row["variant"] != name) continue;
      any = &row;
      ++count;
      failures += row["fails"].get<bool>();
      error = std::max(error, row["max_error"].get<double>());
      if (std::abs(row["bias"].get<double>()) > std::abs(bias)) bias = row["bias"];
      p = std::min(p, row["chi2_p"].get<double>());
    }
    out << "| " << name << " | " << failures << " of " << count << " | " << number(error, 2) << " | "
        << (*any)["error_of"].get<std::string>() << " | " << number(100 * bias, 2) << " % | " << number(p, 2) << " | "
        << (*any)["why"].get<std::string>() << " |\n";
  }
}

}  // namespace gonio
