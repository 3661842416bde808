// The include in an older GLSL, as a fragment shader uses it.
#version 330
#include "ldt.glsl"

uniform sampler2D ldt_texels;
uniform Ldt ldt;
uniform vec3 light_position;
uniform float max_cd;
in vec3 position;
in vec3 normal;
out vec4 colour;

void main() {
  vec3 offset = position - light_position;
  float lux = ldt_point_light(ldt_texels, ldt, max_cd, offset);
  colour = vec4(vec3(lux * max(-dot(normalize(normal), normalize(offset)), 0.0)), 1.0);
}
