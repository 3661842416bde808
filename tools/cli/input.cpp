#include "tools/cli/input.h"

#include <cstdio>

#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/bytes.h>

namespace gonio {
namespace {

void warn_of_transmission(const BrdfTable& table) {
  const auto* grid = std::get_if<MbsdfTable>(&table.data());
  if (grid == nullptr || !grid->has_transmission()) return;
  std::fprintf(stderr, "%s: warning: the file has transmission as well, which is left out\n",
               table.info().source.c_str());
}

}  // namespace

bool is_model_file(const std::filesystem::path& path) {
  const std::string head = read_bytes(path, 64);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string::npos && head[first] == '{';
}

BrdfTable load_input(const std::filesystem::path& path, const CellPolicies& policies) {
  if (!is_model_file(path)) {
    BrdfTable table = load_table(path, policies);
    warn_of_transmission(table);
    return table;
  }
  const LobeModel model = load_model(path);
  MerlTable table(synthesize_merl(model), policies);
  const CellCounts cells = table.cells();
  return BrdfTable(std::move(table),
                   {path.stem().string(), path.string(), "model", describe(model), regular_file_size(path), cells});
}

}  // namespace gonio
