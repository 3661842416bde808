#include "tools/measure/table_fits.h"

#include <algorithm>
#include <chrono>

namespace gonio {

TableFits fit_table(const BrdfTable& table, const LobeModel& form, const FitOptions& options) {
  const BrdfFunction f = measured_part(table);
  TableFits fits;
  const auto start = std::chrono::steady_clock::now();
  std::vector<Fit> stages = fit_stages(f, form, options);
  fits.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (Fit& fit : stages) {
    fit.model.name = table.info().name;
    const BrdfFunction model = [&](const glm::vec3& wi, const glm::vec3& wo) { return fit.model.eval(wi, wo); };
    const FitErrorReport errors = fit_errors(f, model, options.grazing_cutoff);
    fits.stages.push_back({fit, errors});
  }
  return fits;
}

std::size_t enough_lobes(const TableFits& fits) {
  double best = fits.stages.front().errors.inside.relative_l1;
  for (const StageFit& s : fits.stages) best = std::min(best, s.errors.inside.relative_l1);
  std::size_t k = 0;
  while (fits.stages[k].errors.inside.relative_l1 > enough_factor * best) ++k;
  return k;
}

}  // namespace gonio
