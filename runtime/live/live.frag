// Draws the scene by sphere tracing. Before this text come the scene's functions scene_distance and scene_surface, and
// the constants kSteps, kSurfaces, kLights and kInverseLipschitz.
uniform vec2 u_size, u_offset;                    // of the image; from the pixel's middle; pixels
uniform vec3 u_position, u_target, u_right, u_up, u_forward;  // the camera
uniform vec2 u_half;                              // half the image's size, at unit distance for a perspective camera
uniform bool u_orthographic;
uniform vec3 u_lo, u_hi;                          // box around the scene
uniform bool u_bounded;
uniform float u_far;                              // scene units
uniform float u_exposure;                         // factor
uniform vec3 u_bottom, u_top;                     // the background straight down and straight up
uniform vec4 u_color[kSurfaces];                  // base colour, roughness
uniform vec4 u_glow[kSurfaces];                   // emission, metalness
uniform vec4 u_light[kLights];                    // direction to the light (w 0), or its place (w 1)
uniform vec4 u_power[kLights];                    // irradiance, or radiant intensity; radius of the light's body
uniform int u_lights;
out vec4 o_color;

const float kPi = 3.14159265;

vec3 background(vec3 d) { return mix(u_bottom, u_top, clamp(0.5 * d.y + 0.5, 0.0, 1.0)); }

// Returns the part of a ray within the scene's box, empty (x > y) if the ray misses it.
vec2 clip(vec3 o, vec3 d) {
  if (!u_bounded) return vec2(0.0, u_far);
  vec3 a = (u_lo - o) / d, b = (u_hi - o) / d, near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, u_far)));
}

// Returns the distance along the ray to the surface, or -1. `pixel`: width of a pixel at unit distance.
float trace(vec3 o, vec3 d, float pixel, float side) {
  vec2 part = clip(o, d);
  float t = part.x;
  for (int i = 0; i < kSteps && t < part.y; ++i) {
    float f = side * scene_distance(o + t * d);
    float least = max(0.25 * pixel * max(t, u_orthographic ? 1.0 : 0.0), 1e-6 * (1.0 + t));
    if (f < least) return t;
    t += max(f * kInverseLipschitz, least);
  }
  return -1.0;
}

// The gradient by differences over a tetrahedron. The loop keeps the compiler from copying the scene four times.
vec3 normal_at(vec3 p, float h) {
  vec3 n = vec3(0.0);
  for (int i = min(0, u_lights); i < 4; ++i) {
    vec3 e = 2.0 * vec3(float((i + 3) >> 1 & 1), float(i >> 1 & 1), float(i & 1)) - 1.0;
    n += e * scene_distance(p + h * e);
  }
  return dot(n, n) > 0.0 ? normalize(n) : vec3(0.0, 1.0, 0.0);
}

// Returns how much of a light is seen from p: soft, by how near the ray comes to anything between two samples
// (Aaltonen, "GPU-Based Clay Simulation and Ray-Tracing Tech in Claybook", GDC 2018).
float shadow(vec3 p, vec3 d, float far, float from) {
  float seen = 1.0, t = from, last = 1e20;
  for (int i = min(0, u_lights); i < 64 && t < far; ++i) {
    float f = scene_distance(p + t * d);
    float back = min(f * f / (2.0 * last), f), aside = sqrt(max(f * f - back * back, 0.0));
    seen = min(seen, 12.0 * aside / max(t - back, from));
    if (seen < 0.005) return 0.0;
    last = f;
    t += max(f * kInverseLipschitz, 0.5 * from);
  }
  return clamp(seen, 0.0, 1.0);
}

// Returns how open the surroundings are, from 0 to 1, by distances along the normal.
float openness(vec3 p, vec3 n, float reach) {
  float closed = 0.0, all = 0.0, weight = 1.0;
  for (int i = 1 + min(0, u_lights); i <= 5; ++i) {
    float h = reach * float(i) / 5.0;
    closed += weight * clamp(1.0 - scene_distance(p + h * n) / h, 0.0, 1.0);
    all += weight;
    weight *= 0.8;
  }
  return 1.0 - 0.85 * closed / all;
}

// Returns the light that a surface returns: a diffuse base and a GGX reflection, after Walter et al., "Microfacet
// Models for Refraction", 2007, with Schlick's Fresnel term.
vec3 reflected(vec3 n, vec3 v, vec3 l, vec3 color, float roughness, float metalness) {
  float nl = dot(n, l), nv = max(dot(n, v), 1e-3);
  if (nl <= 0.0) return vec3(0.0);
  vec3 h = normalize(l + v);
  float a = max(roughness * roughness, 0.02), a2 = a * a, nh = max(dot(n, h), 0.0);
  float spread = nh * nh * (a2 - 1.0) + 1.0;
  float shape = a2 / (kPi * spread * spread);
  float masking = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
  vec3 f0 = mix(vec3(0.04), color, metalness);
  vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(h, v), 0.0), 5.0);
  return nl * ((1.0 - metalness) * color * (1.0 - fresnel) / kPi + shape * masking * fresnel);
}

vec3 shade(vec3 p, vec3 d, float t, float pixel, float side) {
  float size = max(pixel * (u_orthographic ? 1.0 : t), 1e-5 * (1.0 + t));
  vec3 n = side * normal_at(p, size);
  if (dot(n, d) > 0.0) n = -n;
  int surface = clamp(scene_surface(p), 0, kSurfaces - 1);
  vec4 color = u_color[surface], glow = u_glow[surface];
  vec3 from = p + 2.0 * size * n;
  float open = openness(from, n, 0.1 * length(u_position - u_target));
  vec3 mirrored = reflect(d, n);
  vec3 f0 = mix(vec3(0.04), color.rgb, glow.a);
  vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(-dot(n, d), 0.0), 5.0) * (1.0 - color.a);
  vec3 sum = glow.rgb + open * ((1.0 - glow.a) * color.rgb * background(n) +
                                fresnel * background(mix(mirrored, n, color.a * color.a)));
  for (int i = 0; i < u_lights; ++i) {
    vec3 l = u_light[i].xyz - u_light[i].w * p;
    float far = u_light[i].w > 0.0 ? length(l) - u_power[i].w : u_far;
    vec3 power = u_light[i].w > 0.0 ? u_power[i].rgb / dot(l, l) : u_power[i].rgb;
    l = normalize(l);
    if (dot(n, l) <= 0.0) continue;
    far = min(far, clip(from, l).y);
    sum += power * shadow(from, l, far, 4.0 * size) * reflected(n, -d, l, color.rgb, color.a, glow.a);
  }
  return sum;
}

vec3 srgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  vec2 at = (2.0 * (gl_FragCoord.xy + u_offset) / u_size - 1.0) * u_half;
  vec3 aside = at.x * u_right + at.y * u_up;
  vec3 o = u_position + (u_orthographic ? aside : vec3(0.0));
  vec3 d = u_orthographic ? u_forward : normalize(u_forward + aside);
  float pixel = 2.0 * u_half.x / u_size.x;
  float side = scene_distance(o) < 0.0 ? -1.0 : 1.0;
  float t = trace(o, d, pixel, side);
  vec3 color = t < 0.0 ? background(d) : shade(o + t * d, d, t, pixel, side);
  o_color = vec4(srgb(u_exposure * color), 1.0);
}
