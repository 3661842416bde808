#pragma once

#include <utility>

#include <gonio/fitting/lobes/beckmann.h>
#include <gonio/fitting/lobes/diffuse.h>
#include <gonio/fitting/lobes/ggx.h>
#include <gonio/fitting/lobes/lafortune.h>
#include <gonio/fitting/lobes/phong.h>
#include <gonio/fitting/lobes/student_t.h>
#include <gonio/fitting/lobes/ward.h>

namespace gonio {

/// Every lobe that can be named; the diffuse ones first.
enum class LobeKind {
  lambert,
  oren_nayar,
  burley,
  ggx,
  beckmann,
  student_t,
  blinn_phong,
  ward,
  ashikhmin_shirley,
  lafortune
};

/// True for the lobes that follow the half vector or the mirror direction.
constexpr bool is_specular(LobeKind kind) noexcept { return kind >= LobeKind::ggx; }

/// The shape parameters of a lobe have at most this many members.
inline constexpr int max_shape = 2;

/// Calls f with the lobe of that kind; `shape` holds its parameters in the order of lobe_info().
template <class T, class F>
auto visit_lobe(LobeKind kind, const T* shape, F&& f) {
  switch (kind) {
    case LobeKind::lambert:
      return f(Lambert<T>{});
    case LobeKind::oren_nayar:
      return f(OrenNayar<T>{shape[0]});
    case LobeKind::burley:
      return f(Burley<T>{shape[0]});
    case LobeKind::ggx:
      return f(Ggx<T>{shape[0]});
    case LobeKind::beckmann:
      return f(Beckmann<T>{shape[0]});
    case LobeKind::student_t:
      return f(StudentT<T>{shape[0], shape[1]});
    case LobeKind::blinn_phong:
      return f(BlinnPhong<T>{shape[0]});
    case LobeKind::ward:
      return f(Ward<T>{shape[0]});
    case LobeKind::ashikhmin_shirley:
      return f(AshikhminShirley<T>{shape[0]});
    case LobeKind::lafortune:
      break;
  }
  return f(Lafortune<T>{shape[0], shape[1]});
}

}  // namespace gonio
