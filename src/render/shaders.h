// GLSL of the painter. Colours are linear; the framebuffer encodes sRGB.
#pragma once

namespace ukemi::shaders {

// Attributes: see Vertex.
inline constexpr const char* kSurfaceVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
uniform mat4 clip_from_world;
uniform mat4 light_from_world;
out vec3 world_position;
out vec3 world_normal;
out vec2 surface_uv;
out vec4 surface_color;
out vec3 light_position;
void main() {
  world_position = position;
  world_normal = normal;
  surface_uv = uv;
  surface_color = color;
  light_position = (light_from_world * vec4(position, 1.0)).xyz * 0.5 + 0.5;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

inline constexpr const char* kSurfaceFragment = R"(#version 330 core
in vec3 world_position;
in vec3 world_normal;
in vec2 surface_uv;
in vec4 surface_color;
in vec3 light_position;
uniform vec3 eye;
uniform vec3 to_key;    // unit, towards the lights
uniform vec3 to_rim;
uniform vec4 base_color;
uniform float alpha_cutoff;  // negative: never cut out
uniform float gloss;
uniform float takes_shadow;  // 0 or 1
uniform sampler2D base_texture;
uniform sampler2DShadow light_map;
out vec4 result;

const vec3 kKey = vec3(1.00, 0.95, 0.87) * 0.92;
const vec3 kSky = vec3(0.86, 0.92, 1.00) * 0.54;
const vec3 kGround = vec3(1.00, 0.93, 0.85) * 0.27;
const vec3 kRim = vec3(0.92, 0.96, 1.00) * 0.35;

float lit() {
  float texel = 1.2 / 1024.0;
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 offset = vec2(i < 2 ? -0.5 : 0.5, (i & 1) == 0 ? -0.5 : 0.5) * texel;
    sum += texture(light_map, vec3(light_position.xy + offset, light_position.z - 0.002));
  }
  return 0.25 * sum;
}

void main() {
  vec4 albedo = base_color * surface_color * texture(base_texture, surface_uv);
  if (albedo.a < alpha_cutoff) discard;
  vec3 face = cross(dFdx(world_position), dFdy(world_position));
  vec3 n = dot(world_normal, world_normal) > 0.0 ? normalize(world_normal) : normalize(face);
  vec3 v = normalize(eye - world_position);
  if (!gl_FrontFacing && dot(world_normal, world_normal) > 0.0) n = -n;
  float shadow = mix(1.0, lit(), takes_shadow);
  float wrapped = max((dot(n, to_key) + 0.15) / 1.15, 0.0);
  vec3 light = mix(kGround, kSky, 0.5 + 0.5 * n.y) + kKey * wrapped * shadow;
  float facing = max(dot(n, v), 0.0);
  light += kRim * pow(1.0 - facing, 3.0) * max(dot(n, to_rim) + 0.2, 0.0);
  float highlight = pow(max(dot(n, normalize(v + to_key)), 0.0), 36.0) * gloss * shadow;
  vec3 color = albedo.rgb * light + kKey * highlight;
  // A soft shoulder above 0.7, so that bright cloth keeps its folds.
  vec3 over = max(color - 0.7, 0.0);
  color = min(color, 0.7) + 0.3 * (1.0 - exp(-over / 0.3));
  result = vec4(color, albedo.a);
}
)";

// Depth as the key light sees it.
inline constexpr const char* kDepthVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 light_from_world;
void main() { gl_Position = light_from_world * vec4(position, 1.0); }
)";

inline constexpr const char* kDepthFragment = R"(#version 330 core
void main() {}
)";

// The figure pressed flat onto the floor along `light`: red where the key light is kept off, green the nearer
// the floor the closer.
inline constexpr const char* kFlatVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform vec3 light;       // towards the light, y = 1
uniform vec3 floor_area;  // centre x, centre z, half side
uniform float floor_y;
out float height;
void main() {
  height = position.y - floor_y;
  vec2 place = position.xz - light.xz * height;
  gl_Position = vec4((place - floor_area.xy) / floor_area.z, 0.0, 1.0);
}
)";

inline constexpr const char* kFlatFragment = R"(#version 330 core
in float height;
uniform vec3 share;  // of red, of green; reach of the green in metres
out vec4 result;
void main() {
  float h = max(height, 0.0);
  result = vec4(share.x * exp(-h / 3.0), share.y * exp(-h / share.z), 0.0, 1.0);
}
)";

inline constexpr const char* kFloorVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
out vec2 place;
void main() {
  place = position.xz;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

inline constexpr const char* kFloorFragment = R"(#version 330 core
in vec2 place;
uniform vec3 floor_area;
uniform vec3 focus;  // x, z, reach
uniform vec4 background;
uniform vec4 ground;
uniform vec4 line;
uniform sampler2D shadow_map;
out vec4 result;

float grid(float step_m, float width_px) {
  vec2 p = place / step_m;
  vec2 pixel = fwidth(p);
  vec2 away = abs(fract(p - 0.5) - 0.5) / pixel;
  vec2 cover = clamp(0.5 * width_px + 0.5 - away, 0.0, 1.0) * (1.0 - smoothstep(0.08, 0.3, pixel));
  return max(cover.x, cover.y);
}

// A small cross where the lines of whole metres meet.
float metre_mark() {
  vec2 away = abs(fract(place - 0.5) - 0.5);
  vec2 pixel = fwidth(place);
  vec2 thin = clamp(0.7 + 0.5 - away / pixel, 0.0, 1.0);
  vec2 near = 1.0 - smoothstep(0.05, 0.06, away);
  return max(thin.x * near.y, thin.y * near.x) * (1.0 - smoothstep(0.008, 0.018, max(pixel.x, pixel.y)));
}

void main() {
  float away = distance(place, focus.xy) / focus.z;
  float near = 1.0 - smoothstep(0.5, 2.6, away);
  vec3 color = mix(background.rgb, ground.rgb, near);
  float lines = max(max(0.8 * grid(1.0, 1.3), 0.30 * grid(0.25, 1.0)), metre_mark());
  color = mix(color, line.rgb, line.a * lines * near);
  vec2 uv = (place - floor_area.xy) / floor_area.z * 0.5 + 0.5;
  vec2 dark = texture(shadow_map, uv).rg;
  color *= (1.0 - 0.40 * dark.r) * (1.0 - 0.55 * dark.g);
  result = vec4(color, 1.0);
}
)";

}  // namespace ukemi::shaders
