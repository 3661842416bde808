#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/brdf/formats/sniff.h>
#include <gonio/brdf/table/table.h>
#include <gonio/brdf/value/frame.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

BrdfTable load(const std::filesystem::path& path, const CellPolicies& policies) {
  BrdfTable::Info info;
  info.name = path.stem().string();
  info.source = path.string();
  info.source_bytes = regular_file_size(path);
  const auto finish = [&](auto table, const char* format, std::string description) {
    info.format = format;
    info.description = std::move(description);
    info.cells = table.cells();
    return BrdfTable(std::move(table), std::move(info));
  };
  switch (sniff_format(path)) {
    case TableFormat::merl:
      return finish(MerlTable(read_merl(path), policies), "merl", "");
    case TableFormat::rgl: {
      RglFile file = read_rgl(path);
      std::string description = file.description;
      return finish(RglTable(std::move(file), policies), "rgl", std::move(description));
    }
    case TableFormat::mbsdf: {
      const MbsdfFile file = read_mbsdf(path);
      return finish(MbsdfTable(file, policies), "mbsdf", file.description);
    }
    case TableFormat::unknown:
      break;
  }
  throw Error(path.string() + ": " + to_string(unknown_format(path)));
}

}  // namespace

glm::vec3 BrdfTable::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(is_above(wi) && is_above(wo))) return glm::vec3(0.0f);
  return std::visit([&](const auto& table) { return table.eval(wi, wo); }, data_);
}

void BrdfTable::eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept {
  std::visit(
      [&](const auto& table) {
        eval_many(table, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {f_r.x, f_r.y, f_r.z});
      },
      data_);
}

float BrdfTable::measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(wi.z > 0.0f && wo.z > 0.0f)) return 0.0f;
  return std::visit([&](const auto& table) { return table.measured(wi, wo); }, data_);
}

std::shared_ptr<const BrdfTable> required_table(std::shared_ptr<const BrdfTable> table, const std::string& user) {
  if (!table) throw Error(user + ": table: found none, expected one");
  return table;
}

BrdfTable load_table(const std::filesystem::path& path, const CellPolicies& policies) {
  try {
    return load(path, policies);
  } catch (const Error& error) {
    // Problems with the cells are found where the file's name is not known.
    const std::string text = error.what();
    if (text.compare(0, path.string().size(), path.string()) == 0) throw;
    throw Error(path.string() + ": " + text);
  }
}

}  // namespace gonio
