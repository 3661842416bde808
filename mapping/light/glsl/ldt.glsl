// Lookup of a light distribution texture (Wallner 2008, Listing 1), for GLSL 3.30 and later, also for
// Vulkan. Include it and call ldt_lookup() or ldt_point_light().
//
// The texture is what gonio::LightTexture holds: texels() as R32F (or R16F), width() x m_c(), no mipmaps,
// any filter and wrap mode: texels are fetched and weighted here, since the linear filter of
// graphics hardware has but 8 bits of fraction. The border columns are part of the texels.
//
// Against the listing: intensities lie in texel centres; atan instead of acos, which is accurate next
// to the axis too; C is the periodic coordinate.

#ifndef GONIO_LDT_GLSL
#define GONIO_LDT_GLSL

// Values of gonio::LightFilter.
#define LDT_BILINEAR 0
#define LDT_CATMULL_ROM 1
#define LDT_MITCHELL 2
#define LDT_BSPLINE 3

struct Ldt {
  vec3 nadir, c0, c90;  // LightTexture::frame(), turned as the luminaire is turned in the scene
  int n_gamma, m_c;     // n_gamma(), m_c()
  float gamma_from;     // gamma_from() [rad]
  float gamma_step;     // gamma_step() [rad]
  int reconstruction;   // filter(): one of the above; make it a constant if you can
};

// atan2 to the precision of a float; that of GLSL may be as coarse as 1e-4. 0 for (0, 0).
float ldt_atan(float y, float x) {
  float ax = abs(x), ay = abs(y);
  float small = min(ax, ay), large = max(ax, ay);
  bool upper = small > 0.41421356 * large;  // tan(pi/8)
  float t = upper ? (small - large) / (small + large) : small / max(large, 1e-37);
  float z = t * t;
  // atan on [-tan(pi/8), tan(pi/8)]: relative error 3e-9.
  float angle =
      t + t * z * (-0.333333318 + z * (0.199995405 + z * (-0.142639556 + z * (0.107437315 - z * 0.0645192816))));
  angle += upper ? 0.785398163 : 0.0;
  angle = ay > ax ? 1.570796327 - angle : angle;
  angle = x < 0.0 ? 3.141592654 - angle : angle;
  return y < 0.0 ? -angle : angle;
}

// Weights of four taps at the fraction t between the second and third.
vec4 ldt_weights(int reconstruction, float t) {
  float s = 1.0 - t;
  if (reconstruction == LDT_BILINEAR) return vec4(0.0, s, t, 0.0);
  vec4 cardinal = vec4(-0.5 * t * s * s, 1.0 + t * t * (1.5 * t - 2.5), 1.0 + s * s * (1.5 * s - 2.5),
                       -0.5 * s * t * t);
  if (reconstruction == LDT_CATMULL_ROM) return cardinal;
  vec4 spline = vec4(s * s * s, 4.0 + 3.0 * t * t * (t - 2.0), 4.0 + 3.0 * s * s * (s - 2.0), t * t * t) / 6.0;
  return reconstruction == LDT_BSPLINE ? spline : (spline + 2.0 * cardinal) / 3.0;
}

// One meridian: columns j to j + 3.
float ldt_row(sampler2D texels, int reconstruction, int i, int j, vec4 along) {
  float sum = along.y * texelFetch(texels, ivec2(j + 1, i), 0).r + along.z * texelFetch(texels, ivec2(j + 2, i), 0).r;
  if (reconstruction != LDT_BILINEAR)
    sum += along.x * texelFetch(texels, ivec2(j, i), 0).r + along.w * texelFetch(texels, ivec2(j + 3, i), 0).r;
  return sum;
}

// Intensity over I_max in the direction d, a unit vector from the light; 0 where there are no texels.
float ldt_lookup(sampler2D texels, Ldt ldt, vec3 d) {
  float x = dot(d, ldt.c0), y = dot(d, ldt.c90);
  float s = (ldt_atan(sqrt(x * x + y * y), dot(d, ldt.nadir)) - ldt.gamma_from) / ldt.gamma_step;
  if (s < -1e-4 || s > float(ldt.n_gamma - 1) + 1e-4) return 0.0;
  int j = clamp(int(s), 0, ldt.n_gamma - 2);
  vec4 along = ldt_weights(ldt.reconstruction, clamp(s - float(j), 0.0, 1.0));
  if (ldt.m_c == 1) return max(ldt_row(texels, ldt.reconstruction, 0, j, along), 0.0);

  float turn = ldt_atan(y, x) * 0.159154943;
  float t = (turn < 0.0 ? turn + 1.0 : turn) * float(ldt.m_c);
  int i = min(int(t), ldt.m_c - 1);
  vec4 across = ldt_weights(ldt.reconstruction, t - float(i));
  int next = i + 1 < ldt.m_c ? i + 1 : 0;
  float sum = across.y * ldt_row(texels, ldt.reconstruction, i, j, along) +
              across.z * ldt_row(texels, ldt.reconstruction, next, j, along);
  if (ldt.reconstruction != LDT_BILINEAR) {
    int before = i > 0 ? i - 1 : ldt.m_c - 1, after = next + 1 < ldt.m_c ? next + 1 : 0;
    sum += across.x * ldt_row(texels, ldt.reconstruction, before, j, along) +
           across.w * ldt_row(texels, ldt.reconstruction, after, j, along);
  }
  return max(sum, 0.0);
}

// Illuminance at right angles to the light at the point `offset` from it: I LDT / d^2 (Wallner, eq. 4).
// intensity is I_max [cd], or whatever the light is dimmed to; offset in metres.
float ldt_point_light(sampler2D texels, Ldt ldt, float intensity, vec3 offset) {
  float d2 = dot(offset, offset);
  return intensity * ldt_lookup(texels, ldt, offset / sqrt(d2)) / d2;
}

#endif
