#pragma once

#include <string>
#include <vector>

#include "tools/render/scene/scene.h"
#include "tools/render/trace/film.h"

namespace gonio {

struct CompareOptions {
  std::vector<SamplingMethod> methods;
  double seconds = 10;             ///< processor time of each render, all threads together
  double reference_seconds = 160;  ///< the same of the reference
  RenderOptions render;            ///< strategy apart
};

/// The error of a render after some of its samples.
struct ConvergencePoint {
  int samples;
  double seconds;  ///< processor time
  double relmse;
  double standard_error;  ///< of relmse, from its spread over the pixels
};

/// One method with one strategy.
struct CompareRun {
  SamplingMethod method;
  Strategy strategy;
  double build_seconds = 0;                   ///< of the samplers, on the wall
  std::vector<ConvergencePoint> convergence;  ///< at powers of two, and at the end
  RgbImage image;                             ///< at the end
};

struct Comparison {
  std::vector<CompareRun> runs;
  RgbImage reference;
  int reference_samples = 0;
  double reference_relmse = 0;  ///< the reference's own error, known from its two independent halves
  std::size_t pixels = 0;       ///< those whose centre shows a compared material: where errors are measured
  int equal_samples = 0;        ///< the largest power of two that every run has reached
};

/// The indices of the materials that a comparison is about: those with tables; in a scene that has none, those of
/// stack files.
std::vector<std::size_t> compared_materials(const Scene& scene);

/// Whether all of them can be sampled that way: a stack file by its own stack, which is its default, or by the cosine.
bool method_available(const Scene& scene, SamplingMethod method);

/// Renders the scene with every method (in place of what its tables ask for), with multiple
/// importance sampling and with material sampling alone, for equal processor time, and measures the
/// errors against one long render with the default method. Renders take turns, so that whatever else
/// the machine does meets them alike. The reference's own error is subtracted from all.
///
/// Processor time, not that of a clock on the wall: it does not depend on other programs as much.
/// @throws Error if no pixel shows a compared material, or a method is not available for one.
Comparison compare_methods(const Scene& scene, const CompareOptions& options, const Progress& progress = {});

}  // namespace gonio
