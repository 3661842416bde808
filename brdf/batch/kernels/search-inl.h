// Searches among the lines of a diagram, one element at a time, once per instruction set: included by the kernels' own
// files alone.
#if defined(GONIO_BATCH_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_SEARCH_INL_H
#undef GONIO_BATCH_SEARCH_INL_H
#else
#define GONIO_BATCH_SEARCH_INL_H
#endif

#include <hwy/cache_control.h>

#include <gonio/brdf/batch/kernels/eight-inl.h>
#include <gonio/mapping/numeric/code16.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

// A search is a pass of vectors that count what is below, one element at a time. Bisection in all lanes at once waits
// for a gather at each of its steps.
using LongPass = hn::ScalableTag<float>;  // among all lines

/// Codes as half floats.
template <class Tag>
HWY_INLINE hn::Vec<Tag> load_codes(Tag d, const std::uint16_t* codes) {
  const hn::Rebind<hwy::float16_t, Tag> half;
  return hn::PromoteTo(d, hn::LoadU(half, reinterpret_cast<const hwy::float16_t*>(codes)));
}

/// A weighted sum of rows of numbers.
template <int count>
struct MixedRow {
  const float* x[count];
  float weight[count];

  HWY_INLINE void prefetch() const {
    for (const float* values : x) hwy::Prefetch(values);
  }
  HWY_INLINE float at(std::ptrdiff_t k) const {
    float sum = weight[0] * x[0][k];
    for (int i = 1; i < count; ++i) sum += weight[i] * x[i][k];
    return sum;
  }
  template <class Tag>
  HWY_INLINE hn::Vec<Tag> mixed(Tag d, std::ptrdiff_t k) const {
    auto sum = hn::Mul(hn::Set(d, weight[0]), hn::LoadU(d, x[0] + k));
    for (int i = 1; i < count; ++i) sum = hn::MulAdd(hn::Set(d, weight[i]), hn::LoadU(d, x[i] + k), sum);
    return sum;
  }
};
struct Row {
  const float* x;
  HWY_INLINE void prefetch() const { hwy::Prefetch(x); }
  HWY_INLINE float at(std::ptrdiff_t k) const { return x[k]; }
  template <class Tag>
  HWY_INLINE hn::Vec<Tag> mixed(Tag d, std::ptrdiff_t k) const {
    return hn::LoadU(d, x + k);
  }
};
/// The densities of a group at a meridian and the next one, whose codes are side by side, in units of half floats:
/// b of the first and a of the second. With two diagrams, w0 of one and w1 of the other.
template <int count>
struct MixedCodes {
  const std::uint16_t* x[count];
  float weight[count], b, a;

  HWY_INLINE void prefetch() const {
    for (const std::uint16_t* codes : x) hwy::Prefetch(codes);
  }
  HWY_INLINE Eight densities() const {
    Eight mixed;
#if HWY_TARGET <= HWY_AVX3
    const hn::FixedTag<float, 16> both;
    auto sum = hn::Mul(hn::Set(both, weight[0]), load_codes(both, x[0]));
    for (int i = 1; i < count; ++i) sum = hn::MulAdd(hn::Set(both, weight[i]), load_codes(both, x[i]), sum);
    const Pass d;
    mixed.x[0] = hn::MulAdd(hn::Set(d, a), hn::UpperHalf(d, sum), hn::Mul(hn::Set(d, b), hn::LowerHalf(d, sum)));
#else
    for (int part = 0; part < Eight::parts; ++part) {
      const Pass d;
      const int k = part * Eight::lanes, next = k + BatchLayout::group_codes;
      auto first = hn::Mul(hn::Set(d, weight[0]), load_codes(d, x[0] + k)),
           second = hn::Mul(hn::Set(d, weight[0]), load_codes(d, x[0] + next));
      for (int i = 1; i < count; ++i) {
        first = hn::MulAdd(hn::Set(d, weight[i]), load_codes(d, x[i] + k), first);
        second = hn::MulAdd(hn::Set(d, weight[i]), load_codes(d, x[i] + next), second);
      }
      mixed.x[part] = hn::MulAdd(hn::Set(d, a), second, hn::Mul(hn::Set(d, b), first));
    }
#endif
    return mixed;
  }
};

/// How many of the values k .. k + count - 1, which ascend, are below the target.
template <class Tag = Pass, class Values>
HWY_INLINE std::ptrdiff_t count_below(const Values& values, std::ptrdiff_t k, std::ptrdiff_t count, float target) {
  const Tag d;
  const auto length = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto t = hn::Set(d, target);
  std::size_t below = 0;
  for (; count > 0; k += length, count -= length) {
    const auto is_below = hn::Lt(values.mixed(d, k), t);
    below += hn::CountTrue(d, hn::And(is_below, hn::FirstN(d, static_cast<std::size_t>(count))));
  }
  return static_cast<std::ptrdiff_t>(below);
}

/// One diagram, the k-th.
struct OneSource {
  const float *floats, *lines;
  const std::uint16_t* codes;

  HWY_INLINE OneSource(const BatchLayout::Diagrams& all, std::ptrdiff_t k)
      : floats(all.floats + k * all.stride),
        lines(all.lines + k * all.lines_stride),
        codes(all.codes + k * all.code_stride) {}

  HWY_INLINE Row row(std::ptrdiff_t start) const { return {floats + start}; }
  /// Between a row and the one that is `next` behind it.
  HWY_INLINE MixedRow<2> row(std::ptrdiff_t start, std::ptrdiff_t next, float b, float a) const {
    return {{floats + start, floats + start + next}, {b, a}};
  }
  /// Of the group of a meridian that begins at `start`, and the next meridian.
  HWY_INLINE MixedCodes<1> group(std::ptrdiff_t start, float b, float a) const {
    return {{codes + start}, {floats[0]}, b, a};
  }
};
/// A blend of the k-th and the next one.
struct TwoSources {
  const float *floats, *lines;
  const std::uint16_t* codes;
  std::ptrdiff_t stride, code_stride;
  float w0, w1;

  HWY_INLINE TwoSources(const BatchLayout::Diagrams& all, std::ptrdiff_t k, float alpha)
      : floats(all.floats + k * all.stride),
        lines(all.lines + k * all.lines_stride),
        codes(all.codes + k * all.code_stride),
        stride(all.stride),
        code_stride(all.code_stride),
        w0(1 - alpha),
        w1(alpha) {}

  HWY_INLINE MixedRow<2> row(std::ptrdiff_t start) const {
    return {{floats + start, floats + stride + start}, {w0, w1}};
  }
  HWY_INLINE MixedRow<4> row(std::ptrdiff_t start, std::ptrdiff_t next, float b, float a) const {
    const float *first = floats + start, *second = first + stride;
    return {{first, first + next, second, second + next}, {w0 * b, w0 * a, w1 * b, w1 * a}};
  }
  HWY_INLINE MixedCodes<2> group(std::ptrdiff_t start, float b, float a) const {
    return {{codes + start, codes + start + code_stride}, {w0 * floats[0], w1 * floats[stride]}, b, a};
  }
};

// The steps of a search. A caller with many elements makes a loop of each.

/// The cell between meridians where the mass before reaches `target`.
template <class Source>
HWY_INLINE std::ptrdiff_t find_meridian(const BatchLayout& layout, const Source& source, float target) {
  return count_below<LongPass>(source.row(layout.before), 1, layout.meridians - 2, target);
}
/// phi of both meridians of a cell, and the mass along each.
template <class Source>
HWY_INLINE void copy_meridians(const BatchLayout& layout, const Source& source, std::ptrdiff_t i, float* to) {
  to[0] = source.lines[i], to[2] = source.lines[i + 1];
  const auto along = source.row(layout.along);
  to[1] = along.at(i), to[3] = along.at(i + 1);
}
/// A group along a meridian, and the mass where it begins.
struct Group {
  std::ptrdiff_t g;
  float start;
};
/// That in which the mass along the meridian at `a` in a cell reaches `target`.
template <class Source>
HWY_INLINE Group find_group(const BatchLayout& layout, const Source& source, std::ptrdiff_t i, float b, float a,
                            float target) {
  const std::ptrdiff_t length = layout.groups - 1;  // the first group begins at 0
  const auto row = source.row(layout.starts + i * length, length, b, a);
  const std::ptrdiff_t g = count_below(row, 0, length, target);
  return {g, g > 0 ? row.at(g - 1) : 0.0f};
}
HWY_INLINE std::ptrdiff_t group_index(const BatchLayout& layout, std::ptrdiff_t g, std::ptrdiff_t i) {
  return (g * layout.meridians + i) * BatchLayout::group_codes;
}
/// The masses of the cells of a group with these densities at its crossings; `r` is the radius of the first one.
HWY_INLINE Eight masses(const Eight& density, const float* r) {
  const Pass d;
  const Eight next = density.next();
  Eight mass;
  for (int part = 0; part < Eight::parts; ++part) {
    const auto r0 = hn::LoadU(d, r + part * Eight::lanes), h = hn::Sub(hn::LoadU(d, r + part * Eight::lanes + 1), r0);
    const auto sum = hn::Add(density.x[part], next.x[part]);
    const auto third = hn::Mul(hn::Mul(h, hn::Set(d, 1.0f / 3)), hn::Add(sum, next.x[part]));
    mass.x[part] = hn::Mul(h, hn::MulAdd(r0, sum, third));
  }
  return mass.first(BatchLayout::group);
}

/// The cell between parallels where the mass along a meridian reaches `target`, in its group: the last one with mass
/// that begins before it. Stores both radii and both densities of the cell, and returns
/// the mass before it.
template <class Source>
HWY_INLINE float find_in_group(const BatchLayout& layout, const Source& source, const Group& group, std::ptrdiff_t i,
                               float b, float a, float target, float* cell) {
  const float* r = source.lines + layout.r + group.g * BatchLayout::group;
  const Eight density = source.group(group_index(layout, group.g, i), b, a).densities();
  const Eight mass = masses(density, r);
  const Eight before = mass.sums_before();
  const int j = before.last_below(target - group.start, mass);
  cell[0] = r[j], cell[1] = r[j + 1];
  density.from(j).template store_first<2>(cell + 2);
  return group.start + hn::GetLane(before.from(j).x[0]);
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
