// Draws the scene by sphere tracing. Before this text come the functions scene_distance and scene_surface, the array
// scene_numbers that they read, and the constant kSurfaces. The text depends on the scene's structure alone: its numbers
// are uniforms, so that a change of a number compiles nothing.
const int kMaxLights = 8;
uniform vec2 u_size, u_offset;                    // of the image; from the pixel's middle; pixels
uniform vec3 u_position, u_target, u_right, u_up, u_forward;  // the camera
uniform vec2 u_half;                              // half the image's size, at unit distance for a perspective camera
uniform bool u_orthographic;
uniform float u_far;                              // scene units
uniform float u_exposure;                         // factor
uniform vec3 u_bottom, u_top;                     // the background straight down and straight up
uniform vec4 u_color[kSurfaces];                  // base colour, roughness
uniform vec4 u_glow[kSurfaces];                   // emission, metalness
uniform vec4 u_light[kMaxLights];                 // direction to the light (w 0), or its place (w 1)
// Irradiance, or radiant intensity; radius of the light's body, or of a directional light's disc at unit distance.
uniform vec4 u_power[kMaxLights];
uniform int u_lights;
uniform float u_inverse_lipschitz;                // share of a distance that is surely free
uniform vec3 u_lo, u_hi;                          // the box around the scene
uniform vec3 u_slice_lo, u_slice_hi;              // the box that a slice shows
uniform uint u_exactness[(kSurfaces + 15) / 16];  // of the surfaces, 2 bits each, the first ones lowest
uniform int u_overlay;                            // 0 light, 1 base colour, 2 normal, 3 depth, 4 steps, 5 exactness
uniform int u_slice_axis;                         // that the slice lies across; -1: no slice
uniform float u_slice_at, u_slice_step;           // place on the axis, distance between its lines; scene units
out vec4 o_color;

const float kPi = 3.14159265;
const int kSteps = 256;       // evaluations per camera ray
const float kNear = 0.04;     // distance from a surface that counts as none, pixels
const int kShadowSteps = 64;  // evaluations per ray to a light
const int kProbes = 5;        // evaluations along the normal

vec3 background(vec3 d) { return mix(u_bottom, u_top, clamp(0.5 * d.y + 0.5, 0.0, 1.0)); }

// Returns the part of a ray within the scene's box, empty (x > y) if the ray misses it.
vec2 clip(vec3 o, vec3 d) {
  vec3 a = (u_lo - o) / d, b = (u_hi - o) / d, near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, u_far)));
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

vec3 srgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

// Returns a colour from dark violet over green to yellow (viridis) for a share from 0 to 1.
vec3 heat(float share) {
  const vec3 colors[5] = vec3[5](vec3(0.267, 0.004, 0.329), vec3(0.231, 0.322, 0.545), vec3(0.129, 0.569, 0.549),
                                 vec3(0.369, 0.788, 0.384), vec3(0.992, 0.906, 0.145));
  float at = 4.0 * clamp(share, 0.0, 1.0);
  int i = min(int(at), 3);
  return mix(colors[i], colors[i + 1], at - float(i));
}

struct Ray {
  vec3 o, d;
};

// Returns the ray through a place of the image, in pixels from its lower left corner.
Ray ray_at(vec2 place) {
  vec2 at = (2.0 * place / u_size - 1.0) * u_half;
  vec3 aside = at.x * u_right + at.y * u_up;
  if (u_orthographic) return Ray(u_position + aside, u_forward);
  return Ray(u_position, normalize(u_forward + aside));
}

// Returns the distance along a ray to the slice's plane, negative behind the ray's origin.
float slice_distance(Ray ray) { return (u_slice_at - ray.o[u_slice_axis]) / ray.d[u_slice_axis]; }

// Many compilers copy a function to each of its calls, so scene_distance is called from as few places as possible: in
// trace(), look_around() and shadow(). A single call in a loop over these stages makes a frame ten times as slow in
// SwiftShader, which computes all branches of a loop's body.

// Returns the distance along the ray to the surface, or -1. `pixel`: width of a pixel at unit distance. Counts the
// evaluations of the field. `side` becomes -1 if the ray begins inside a solid.
float trace(Ray ray, float pixel, out float side, out int steps) {
  vec2 part = clip(ray.o, ray.d);
  float t = part.x;
  side = 1.0;
  for (steps = 0; steps < kSteps && t < part.y; ++steps) {
    float f = scene_distance(ray.o + t * ray.d);
    if (steps == 0 && f < 0.0) side = -1.0;
    f *= side;
    float least = max(kNear * pixel * (u_orthographic ? 1.0 : t), 1e-6 * (1.0 + t));
    if (f < least) return t;
    t += max(f * u_inverse_lipschitz, least);
  }
  return -1.0;
}

// A hit, or a ray that meets nothing (t < 0).
struct Hit {
  float t, size;  // along the ray; of the pixel at the surface, scene units
  vec3 p, n;
  float open;     // 0 to 1: how open the surroundings are
  vec3 slice;     // the field on the slice, here and a pixel to the right and above
};

// Corners of a tetrahedron.
vec3 corner(int i) { return 2.0 * vec3(float((i + 3) >> 1 & 1), float(i >> 1 & 1), float(i & 1)) - 1.0; }

// Evaluates the field around a hit, for the normal by differences and the openness by distances along the normal, and
// on the slice. The differences lie within a small part of the pixel, so that edges stay sharp, but not so small
// a part that rounding shows.
void look_around(inout Hit hit, Ray ray, vec2 place, float side) {
  float apart = max(0.03 * hit.size, 5e-5 * length(hit.p - u_position));
  float reach = 0.1 * length(u_position - u_target), closed = 0.0, weights = 0.0;
  vec3 sum = vec3(0.0);
  int first = hit.t < 0.0 ? 4 + kProbes : 0, last = 4 + kProbes + (u_slice_axis < 0 ? 0 : 3);
  for (int i = first; i < last; ++i) {
    int probe = i - 3, sliced = i - 4 - kProbes;
    float h = reach * float(probe) / float(kProbes);
    vec3 at = i < 4 ? hit.p + apart * corner(i) : hit.p + (2.0 * hit.size + h) * hit.n;
    if (sliced >= 0) {
      Ray other = ray_at(place + vec2(float(sliced == 1), float(sliced == 2)));
      at = other.o + slice_distance(other) * other.d;
    }
    float f = scene_distance(at);
    if (sliced >= 0) {
      hit.slice[sliced] = f;
    } else if (i < 4) {
      sum += f * corner(i);
      hit.n = dot(sum, sum) > 0.0 ? side * normalize(sum) : vec3(0.0, 1.0, 0.0);
      if (dot(hit.n, ray.d) > 0.0) hit.n = -hit.n;
    } else {
      float weight = pow(0.8, float(probe));
      closed += weight * clamp(1.0 - f / h, 0.0, 1.0);
      weights += weight;
    }
  }
  hit.open = 1.0 - 0.85 * closed / max(weights, 1e-9);
}

// Returns how much of a light is seen from p: by how near the ray comes to anything between two samples (Aaltonen,
// "GPU-Based Clay Simulation and Ray-Tracing Tech in Claybook", GDC 2018), as a share of the light's width there.
// `sharpness`: the light's distance over its radius.
float shadow(vec3 p, vec3 d, float far, float from, float sharpness) {
  float seen = 1.0, t = from, last = 1e20;
  for (int i = 0; i < kShadowSteps && t < far && seen > 0.005; ++i) {
    float f = scene_distance(p + t * d), back = f * f / (2.0 * last);
    // A ray that leaves a surface was nearest to it before the last sample.
    if (back < last) seen = min(seen, sharpness * sqrt(max(f * f - back * back, 0.0)) / max(t - back, from));
    if (f < 0.0) return 0.0;
    last = max(f, 1e-9);
    t += max(f * u_inverse_lipschitz, 0.5 * from);
  }
  return seen;
}

vec3 shade(Hit hit, vec3 d, int surface) {
  vec4 color = u_color[surface], glow = u_glow[surface];
  vec3 p = hit.p, n = hit.n, from = p + 2.0 * hit.size * n;
  vec3 mirrored = reflect(d, n), f0 = mix(vec3(0.04), color.rgb, glow.a);
  vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(-dot(n, d), 0.0), 5.0) * (1.0 - color.a);
  vec3 sum = glow.rgb + hit.open * ((1.0 - glow.a) * color.rgb * background(n) +
                                    fresnel * background(mix(mirrored, n, color.a * color.a)));
  for (int i = 0; i < u_lights; ++i) {
    vec4 light = u_light[i], power = u_power[i];
    vec3 l = light.xyz - light.w * p;
    float distance = light.w > 0.0 ? length(l) : 1.0, far = light.w > 0.0 ? distance - power.w : u_far;
    l = normalize(l);
    if (dot(n, l) <= 0.0) continue;
    float sharpness = clamp(distance / max(power.w, 1e-3 * distance), 4.0, 200.0);
    float seen = shadow(from, l, min(far, clip(from, l).y), 4.0 * hit.size, sharpness);
    sum += seen * power.rgb / (distance * distance) * reflected(n, -d, l, color.rgb, color.a, glow.a);
  }
  return sum;
}

// Colours of surfaces whose field is a distance, a lower bound of it, and an estimate. All differ in lightness, too.
const vec3 kTrust[3] = vec3[3](vec3(0.36, 0.62, 0.86), vec3(0.99, 0.88, 0.60), vec3(0.72, 0.20, 0.16));

// Returns what an overlay shows, as encoded for the display: colours and normals as the program writes them
// (runtime/image/image.h). The depth is relative to that of the camera's target, which is grey.
vec3 overlay_color(Hit hit, int surface, int steps) {
  if (u_overlay == 4) return heat(log2(float(steps + 1)) / log2(float(kSteps)));
  if (hit.t < 0.0) return vec3(0.0);
  if (u_overlay == 2) return 0.5 + 0.5 * hit.n;
  if (u_overlay == 3) return vec3(1.0 / (1.0 + hit.t / length(u_position - u_target)));
  if (u_overlay == 1) return srgb(u_color[surface].rgb + u_glow[surface].rgb);
  return kTrust[u_exactness[surface >> 4] >> uint(2 * (surface & 15)) & 3u] * (0.75 + 0.25 * hit.n.y);
}

// Returns a colour and an opacity for the field's value on the slice, as runtime/slice/slice.cpp draws it. `slope`:
// the value's change per pixel.
vec4 slice_color(float f, float slope) {
  bool inside = f < 0.0;
  vec3 near = inside ? vec3(0.13, 0.37, 0.70) : vec3(0.95, 0.62, 0.25);
  vec3 far = inside ? vec3(0.66, 0.80, 0.94) : vec3(1.0, 0.94, 0.84);
  vec3 line = inside ? vec3(0.05, 0.19, 0.42) : vec3(0.66, 0.36, 0.05);
  float bands = abs(f) / u_slice_step, share = bands / (bands + 4.0), nearest = floor(bands + 0.5);
  vec4 color = vec4(mix(near, far, share), mix(0.8, 0.4, share));
  // A region that lies entirely at a line's level gets no line.
  if (nearest >= 1.0 && slope > 1e-5 * u_slice_step) {
    float away = abs(bands - nearest) * u_slice_step;
    color = mix(color, vec4(line, 0.9), 0.75 * clamp(1.1 - away / slope, 0.0, 1.0));
  }
  return mix(color, vec4(0.04, 0.04, 0.05, 1.0), slope > 0.0 ? clamp(1.7 - abs(f) / slope, 0.0, 1.0) : 0.0);
}

// Draws the slice over a colour. The surface hides the slice, except where the slice is in the solid: there it shows
// through, because nothing else would show a solid's inside.
vec3 with_slice(vec3 color, Hit hit, Ray ray) {
  if (u_slice_axis < 0) return color;
  float at = slice_distance(ray), f = hit.slice.x;
  vec3 p = ray.o + at * ray.d;
  p[u_slice_axis] = clamp(u_slice_at, u_slice_lo[u_slice_axis], u_slice_hi[u_slice_axis]);
  if (!(at > 0.0) || at > u_far || any(lessThan(p, u_slice_lo)) || any(greaterThan(p, u_slice_hi))) return color;
  vec4 slice = slice_color(f, length(hit.slice.yz - f));
  if (hit.t >= 0.0 && hit.t < at) slice.a *= 0.7 * smoothstep(0.0, -0.02 * u_slice_step, f);
  return mix(color, slice.rgb, slice.a);
}

void main() {
#ifdef COPY_NUMBERS
  scene_numbers = u_numbers;
#endif
  vec2 place = gl_FragCoord.xy + u_offset;
  Ray ray = ray_at(place);
  float pixel = 2.0 * u_half.x / u_size.x, side;
  int steps, surface = 0;
  Hit hit;
  hit.t = trace(ray, pixel, side, steps);
  hit.size = max(pixel * (u_orthographic ? 1.0 : hit.t), 1e-5 * (1.0 + hit.t));
  hit.p = ray.o + hit.t * ray.d, hit.n = vec3(0.0);
  look_around(hit, ray, place, side);
  if (hit.t >= 0.0) surface = clamp(scene_surface(hit.p), 0, kSurfaces - 1);
  vec3 color;
  if (u_overlay != 0) color = overlay_color(hit, surface, steps);
  else color = srgb(u_exposure * (hit.t < 0.0 ? background(ray.d) : shade(hit, ray.d, surface)));
  o_color = vec4(with_slice(color, hit, ray), 1.0);
}
