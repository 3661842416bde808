#include "tools/report/merge.h"

#include <algorithm>
#include <cstdio>
#include <ostream>

#include <nlohmann/json.hpp>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_writable.h"
#include "tools/page/write_page.h"

namespace gonio {
namespace {

using Json = nlohmann::json;

/// The member of that name; null if there is none, or if `object` is none.
const Json& member(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

std::string string_of(const Json& value) { return value.is_string() ? value.get<std::string>() : ""; }

Json load_report(const std::filesystem::path& path) {
  Json report = parse_json(read_bytes(path), path.string());
  for (const char* key : {"materials", "lights"}) {
    if (!report.is_object() || !report.contains(key) || !report[key].is_array())
      throw Error(path.string() + ": " + key + ": found none, expected the list of a report.json");
    for (std::size_t k = 0; k < report[key].size(); ++k) {
      const Json& entry = report[key][k];
      if (!entry.is_object())
        throw Error(path.string() + ": " + key + "[" + std::to_string(k) + "]: found " + entry.type_name() +
                    ", expected an object");
    }
  }
  const Json& version = member(report, "gonio_version");
  if (version != GONIO_VERSION)
    throw Error(path.string() + ": gonio_version: found " + shown(version) + ", expected \"" GONIO_VERSION "\"");
  return report;
}

/// Adds to each part of `machine` that is not there yet, as text.
void add_machine(Json& machine, const Json& other) {
  for (const auto& [key, value] : other.items()) {
    const auto text = [](const Json& v) { return v.is_string() ? v.get<std::string>() : v.dump(); };
    if (!machine.contains(key)) machine[key] = value;
    const std::string all = text(machine[key]), added = text(value);
    if (("; " + all + "; ").find("; " + added + "; ") == std::string::npos) machine[key] = all + "; " + added;
  }
}

std::string number(const Json& value, const char* format) {
  if (!value.is_number()) return "";
  char text[32];
  std::snprintf(text, sizeof(text), format, value.get<double>());
  return text;
}

double efficiency_of(const Json& method) {
  const Json& value = member(method, "efficiency");
  return value.is_number() ? value.get<double>() : 0;
}

/// The method of highest efficiency; null if the material has none.
const Json* best(const Json& material) {
  const Json* found = nullptr;
  for (const Json& method : member(material, "methods")) {
    if (found == nullptr || efficiency_of(method) > efficiency_of(*found)) found = &method;
  }
  return found;
}

void write_overview(std::ostream& out, const Json& report, const std::vector<std::string>& pages) {
  const std::size_t materials = report["materials"].size(), lights = report["lights"].size();
  out << "# Sampling quality\n\n"
      << materials << " materials, " << lights
      << " luminaires. Efficiency is 1 / (ns of a sample × (mean relvar from 2° to 70° + 0.001)).\n\n"
      << "| material | format | most efficient | chart | sample ns | mean relvar | efficiency "
         "|\n|---|---|---|---|---|---|---|\n";
  for (std::size_t k = 0; k < materials; ++k) {
    const Json& material = report["materials"][k];
    out << "| [" << string_of(member(material, "name")) << "](" << pages[k] << ") | "
        << string_of(member(material, "format")) << " | ";
    if (const Json* method = best(material)) {
      out << string_of(member(*method, "id")) << " | " << string_of(member(*method, "chart")) << " | "
          << number(member(member(*method, "ns"), "sample"), "%.3g") << " | "
          << number(member(*method, "mean_relvar"), "%.2g") << " | " << number(member(*method, "efficiency"), "%.3g")
          << " |\n";
    } else {
      out << "| | | | |\n";
    }
  }
  for (const Json& light : report["lights"])
    out << "\n- " << string_of(member(light, "name")) << ", " << string_of(member(light, "format")) << '\n';
}

void add_report(Json& merged, Json report) {
  if (merged.is_null()) {
    merged = std::move(report);
    return;
  }
  for (const char* key : {"materials", "lights"})
    for (Json& entry : report[key]) merged[key].push_back(std::move(entry));
  if (member(report, "machine").is_object() && member(merged, "machine").is_object())
    add_machine(merged["machine"], report["machine"]);
  if (report.contains("command"))
    merged["command"] = string_of(member(merged, "command")) + "; " + string_of(report["command"]);
  if (report.contains("stability") && !merged.contains("stability")) merged["stability"] = report["stability"];
}

}  // namespace

void write_merged_report(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& paths,
                         Failures& failures) {
  Json report;
  std::vector<std::string> pages;  // of each material
  for (const auto& path : paths)
    failures.survives([&] {
      add_report(report, load_report(path));
      const std::filesystem::path page = std::filesystem::absolute(path).parent_path() / "report.html";
      const std::string relative =
          page.lexically_relative(std::filesystem::absolute(directory).lexically_normal()).generic_string();
      pages.resize(report["materials"].size(), relative);
    });
  if (report.is_null()) failures.throw_any(paths.size());
  make_folder(directory, "report.json");
  write_stream_atomically(directory / "report.json", [&](std::ostream& out) { out << report.dump(1) << '\n'; });
  write_stream_atomically(directory / "report.html", [&](std::ostream& out) { write_page(out, report); });
  write_stream_atomically(directory / "report.md", [&](std::ostream& out) { write_overview(out, report, pages); });
}

}  // namespace gonio
