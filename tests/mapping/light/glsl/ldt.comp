// The lookup of ldt.glsl on many directions, and the cost of lighting with it.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "ldt.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const int mode = 0;  // 0: lookup, 1: plain point lights, 2: point lights with LDT
layout(constant_id = 1) const int reconstruction = 0;
layout(constant_id = 2) const int lights = 1;

layout(std430, binding = 0) readonly buffer Directions { vec4 direction[]; };
layout(std430, binding = 1) writeonly buffer Results { float result[]; };
layout(std140, binding = 2) uniform Parameters {
  vec4 nadir, c0, c90;
  ivec4 size;  // n_gamma, m_c, number of directions
  vec4 gamma;  // from, step
};
layout(binding = 0) uniform sampler2D texels;

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= uint(size.z)) return;
  Ldt ldt = Ldt(nadir.xyz, c0.xyz, c90.xyz, size.x, size.y, gamma.x, gamma.y, reconstruction);
  vec3 d = direction[k].xyz;
  if (mode == 0) {
    result[k] = ldt_lookup(texels, ldt, d);
    return;
  }
  // The shading of a white diffuse point: what the paper's scenes do besides.
  vec3 normal = vec3(0.0, 0.0, 1.0);
  float sum = 0.0;
  for (int l = 0; l < lights; ++l) {
    vec3 offset = 3.0 * d + vec3(0.1 * float(l), 0.0, -0.2);
    float d2 = dot(offset, offset);
    float light = mode == 1 ? 100.0 / d2 : ldt_point_light(texels, ldt, 100.0, offset);
    sum += light * max(-dot(normal, offset / sqrt(d2)), 0.0) * 0.318309886;
  }
  result[k] = sum;
}
