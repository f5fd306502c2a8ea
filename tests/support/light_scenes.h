// Scenes whose radiance is known in closed form. Each text is the part of the scene file after `"version": 1`. The
// camera sees the same value in all pixels, or the closed form is the mean of the image. Sources: P1 to P10 in the
// names of tests are those of docs/explanation/accuracy.md.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fathom::test {

inline std::string grey(double value) {
  const std::string number = std::to_string(value);
  return "[" + number + "," + number + "," + number + "]";
}

struct LightScene {
  std::string name;
  std::string json;
  double radiance;  // mean of the image
};

// P1: inside a closed body whose walls emit 1 and have albedo a, the radiance is 1 + a + a^2 + ... everywhere.
inline LightScene closed_room(double albedo, const std::string& body = R"("type": "sphere", "radius": 1)") {
  return {"closed room of albedo " + std::to_string(albedo),
          R"("camera": {"position": [0.3, 0.1, 0.2], "target": [0, 0, -1], "fov": 90},
             "materials": {"lamp": {"type": "emissive", "emission": [1, 1, 1], "color": )" +
              grey(albedo) + R"(}}, "objects": [{)" + body + R"(, "material": "lamp"}])",
          1 / (1 - albedo)};
}

// P2, P7: a body that absorbs nothing cannot be told from a uniform background.
inline LightScene in_even_light(const std::string& material,
                                const std::string& body = R"("type": "sphere", "radius": 1)") {
  return {material,
          R"("camera": {"position": [0, 0, 3], "fov": 30}, "background": [1, 1, 1], "render": {"rr_depth": 60},
             "materials": {"m": )" +
              material + R"(}, "objects": [{)" + body + R"(, "material": "m"}])",
          1};
}

// Small spot of a white box, seen along z, inside water that does not refract (ior 1).
inline LightScene in_sea(const std::string& name, const std::string& sea, const std::string& rest) {
  return {name,
          R"("camera": {"type": "orthographic", "position": [0, 0, 3], "target": [0, 0, 0], "width": 0.002},
             "materials": {"water": {"type": "transparent", "ior": 1, "priority": 1},
                           "white": {"type": "diffuse", "color": [1, 1, 1]},
                           "glow": {"type": "principled", "transmission": 1, "ior": 1, "emission": [9, 9, 9]}},
             "objects": [{)" +
              sea + R"(, "material": "water"},
                         {"type": "box", "half_size": [1, 1, 0.1], "translate": [0, 0, -0.1], "material": "white"})" +
              rest,
          0};
}

// Water outranks the glowing ball of clear glass, so the ball has no surface inside the water and does not emit.
inline LightScene submerged_area_light() {
  return in_sea("a lamp that is not there", R"("type": "sphere", "radius": 10)",
                R"(, {"type": "sphere", "radius": 0.5, "translate": [0, 3, 3], "material": "glow"}])");
}

// No ray leaves a half-space of water downwards.
inline LightScene bottomless_sea() {
  return in_sea("a sea without a ground", R"("type": "plane", "normal": [0, 0, -1], "offset": 1)",
                R"(], "background": [1, 1, 1], "lights": {"far": {"type": "directional", "direction": [0, 0, -1],
                   "irradiance": [1, 1, 1], "angle": 2}})");
}

// Floor of albedo 1/2 through the origin. The camera sees only a spot of the floor, too small for the light to vary
// over it.
inline std::string floor_spot(const std::string& lights, const std::string& objects,
                              const std::string& materials = "") {
  return R"("camera": {"type": "orthographic", "position": [3, 0.4, 0.2], "target": [0, 0, 0], "width": 0.002},
            "materials": {"floor": {"type": "diffuse", "color": [0.5, 0.5, 0.5]},
                          "lamp": {"type": "emissive", "emission": [8, 8, 8]})" +
         materials + "}, " + lights + R"("objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"})" +
         objects + "]";
}

// P3: irradiance pi L (R/d)^2 cos of a ball entirely above the horizon.
inline LightScene under_ball(double radius, double x, double y) {
  const double squared = x * x + y * y;
  return {"under a ball",
          floor_spot("", R"(, {"type": "sphere", "radius": )" + std::to_string(radius) + R"(, "translate": [0, )" +
                             std::to_string(y) + ", " + std::to_string(x) + R"(], "material": "lamp"})"),
          0.5 * 8 * radius * radius / squared * y / std::sqrt(squared)};
}

// Flat sheet between the floor's spot and the objects above, and the fraction of light that the sheet's two walls
// transmit.
struct Veil {
  const char* material;
  double passes;
};
inline std::string veiled_spot(const Veil& veil, const std::string& lights, const std::string& objects) {
  return floor_spot(
      lights,
      objects + R"(, {"type": "box", "half_size": [0.5, 0.01, 0.5], "translate": [0, 0.5, 0], "material": "veil"})",
      R"(, "veil": )" + std::string(veil.material));
}
// Black gauze: the holes of each wall transmit three fifths of the light.
inline constexpr Veil kGauze{R"({"type": "principled", "color": [0, 0, 0], "specular_weight": 0, "opacity": 0.4})",
                             0.36};
// Glass pane at normal incidence: transmits (1 - R) / (1 + R), R = .04.
inline constexpr Veil kPane{R"({"type": "principled", "transmission": 1, "roughness": 0, "thin_walled": true})",
                            (0.96 / 1.04) * (0.96 / 1.04)};

inline LightScene veiled_ball(const Veil& veil) {
  LightScene scene = under_ball(0.3, 0, 1.4);
  return {
      "a ball behind a veil",
      veiled_spot(veil, "", R"(, {"type": "sphere", "radius": 0.3, "translate": [0, 1.4, 0], "material": "lamp"})"),
      scene.radiance * veil.passes};
}

// Smooth gauze reflects R = .04 where the sheet is not a hole. The sheet reflects nothing from inside.
inline LightScene smooth_gauze() {
  LightScene scene = in_even_light(R"({"type": "principled", "color": [0, 0, 0], "roughness": 0, "opacity": 0.4})",
                                   R"("type": "box", "half_size": [3, 3, 0.1])");
  scene.radiance = 0.4 * 0.04 + kGauze.passes;
  return scene;
}

// Black gauze that fills the image before a background of 1. A camera ray crosses two walls, each of which covers the
// fraction `opacity` and emits 3 there.
inline LightScene glowing_gauze(double opacity) {
  LightScene scene =
      in_even_light(R"({"type": "principled", "color": 0, "specular_weight": 0, "emission": [3, 3, 3], "opacity": )" +
                        std::to_string(opacity) + "}",
                    R"("type": "box", "half_size": [3, 3, 0.1])");
  const double holes = 1 - opacity;
  scene.radiance = 3 * opacity * (1 + holes) + holes * holes;
  return scene;
}

// P3 under a ball that covers only the fraction `opacity` of its surface. The near side emits towards the floor, and
// the far side emits through the holes of the near side.
inline LightScene under_glowing_gauze(double opacity) {
  LightScene scene = under_ball(0.5, 0, 2);
  scene.json = floor_spot("", R"(, {"type": "sphere", "radius": 0.5, "translate": [0, 2, 0], "material": "veil"})",
                          R"(, "veil": {"type": "principled", "color": 0, "specular_weight": 0,
                                        "emission": [8, 8, 8], "opacity": )" +
                              std::to_string(opacity) + "}");
  scene.radiance *= opacity * (2 - opacity);
  return scene;
}

// P3 under a black ball with a coat. The coat reflects nothing, transmits half of the light per crossing and covers
// the whole ball.
inline LightScene under_coated_ball() {
  LightScene scene = under_ball(0.5, 0, 2);
  scene.json = floor_spot("", R"(, {"type": "sphere", "radius": 0.5, "translate": [0, 2, 0], "material": "coated"})",
                          R"(, "coated": {"type": "principled", "color": 0, "specular_weight": 0, "coat": 1,
                                          "coat_ior": 1, "coat_color": 0.25, "emission": [8, 8, 8]})");
  scene.radiance *= 0.5;
  return scene;
}

inline std::string gauze_at(double y) {
  return R"(, {"type": "box", "half_size": [0.5, 0.01, 0.5], "translate": [0, )" + std::to_string(y) +
         R"(, 0], "material": "veil"})";
}

inline LightScene many_veils() {
  return {"a ball behind four veils",
          floor_spot("",
                     R"(, {"type": "sphere", "radius": 0.3, "translate": [0, 1.4, 0], "material": "lamp"})" +
                         gauze_at(0.45) + gauze_at(0.55) + gauze_at(0.65) + gauze_at(0.75),
                     R"(, "veil": )" + std::string(kGauze.material)),
          under_ball(0.3, 0, 1.4).radiance * std::pow(kGauze.passes, 4)};
}

// Absorbing liquid (0.5 per unit) between two veils that outrank it, under a point light of intensity 3 straight
// above. The liquid fills the 0.08 between the veils and the 0.02 inside the second veil: a body without an interior
// medium contains the medium in front of it.
inline LightScene veiled_drink() {
  return {"a drink between veils",
          floor_spot(R"("lights": {"bulb": {"type": "point", "position": [0, 1, 0], "intensity": [3, 3, 3]}}, )",
                     gauze_at(0.45) + gauze_at(0.55) +
                         R"(, {"type": "box", "half_size": [0.45, 0.05, 0.45], "translate": [0, 0.5, 0],
                              "material": "drink"})",
                     R"(, "veil": )" + std::string(kGauze.material) +
                         R"(, "drink": {"type": "transparent", "ior": 1, "absorption": [0.5, 0.5, 0.5]})"),
          0.5 * 3 / std::numbers::pi * kGauze.passes * kGauze.passes * std::exp(-0.5 * 0.1)};
}

// Irradiance I / d^2 of a point light straight above: intensity 3 at distance 1.
inline LightScene veiled_point(const Veil& veil) {
  return {"a point light behind a veil",
          veiled_spot(
              veil, R"("lights": {"bulb": {"type": "point", "position": [0, 1, 0], "intensity": [3, 3, 3]}}, )", ""),
          0.5 * 3 / std::numbers::pi * veil.passes};
}

// P4: irradiance pi L R^2 / (R^2 + h^2) of a disc straight above.
inline LightScene under_disc(double radius, double height) {
  return {"under a disc",
          floor_spot("", R"(, {"type": "cylinder", "radius": )" + std::to_string(radius) +
                             R"(, "half_height": 0.05, "translate": [0, )" + std::to_string(height + 0.05) +
                             R"(, 0], "material": "lamp"})"),
          0.5 * 8 * radius * radius / (radius * radius + height * height)};
}

// P5: Lambert's sum over the edges of a polygon: E = L/2 sum angle_i (edge normal_i . n). Source: Lambert,
// "Photometria", 1760.
inline double polygon_irradiance(const std::vector<std::array<double, 3>>& corners, double radiance) {
  double sum = 0;
  const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const std::array<double, 3> cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                      a[0] * b[1] - a[1] * b[0]};
    const double length = std::sqrt(dot(cross, cross));
    sum += std::atan2(length, dot(a, b)) * cross[1] / length;
  }
  return radiance * std::abs(sum) / 2;
}

// Box light of which the floor's spot sees only the lower face. The floor must lie below that face.
inline LightScene under_rectangle(double half_x, double half_z, double x, double y) {
  const auto face = [&] {
    return std::vector<std::array<double, 3>>{
        {x - half_x, y, -half_z}, {x + half_x, y, -half_z}, {x + half_x, y, half_z}, {x - half_x, y, half_z}};
  }();
  return {"under a rectangle",
          floor_spot("", R"(, {"type": "box", "half_size": [)" + std::to_string(half_x) + ", 0.05, " +
                             std::to_string(half_z) + R"(], "translate": [)" + std::to_string(x) + ", " +
                             std::to_string(y + 0.05) + R"(, 0], "material": "lamp"})"),
          0.5 * polygon_irradiance(face, 8) / std::numbers::pi};
}

// P6: spherical cavity of albedo rho with a hole of half angle a, in uniform light of radiance 1. The radiance is rho
// f / (1 - rho (1 - f)) with f = (1 - cos a) / 2. The camera looks through the hole at a spot of the wall.
inline LightScene cavity(double albedo, double degrees) {
  const double f = (1 - std::cos(degrees * std::numbers::pi / 180)) / 2;
  return {"cavity",
          R"("camera": {"type": "orthographic", "position": [0, 0, 3], "target": [0, 0, 0], "width": 0.02},
             "background": [1, 1, 1], "render": {"rr_depth": 40},
             "materials": {"wall": {"type": "diffuse", "color": )" +
              grey(albedo) + R"(}}, "objects": [{"type": "subtraction", "material": "wall", "of": [
                {"type": "onion", "thickness": 0.0005, "of": {"type": "sphere", "radius": 1}},
                {"type": "solid_angle", "radius": 2, "angle": )" +
              std::to_string(degrees) + R"(, "rotate": [90, 0, 0]}]}])",
          albedo * f / (1 - albedo * (1 - f))};
}

// P8: slab of glass at normal incidence, with internal reflections: transmits (1 - R) / (1 + R), R = .04. The light
// that the slab reflects comes from a dark background.
inline LightScene slab() {
  return {
      "slab of glass",
      R"("camera": {"type": "orthographic", "position": [0, 3, 0], "target": [0, 0, 0], "up": [0, 0, 1], "width": 0.5},
             "background": {"bottom": [2, 2, 2], "top": [0, 0, 0]}, "render": {"rr_depth": 60},
             "materials": {"glass": {"type": "transparent"}},
             "objects": [{"type": "box", "half_size": [1, 0.25, 1], "material": "glass"}])",
      2 * 0.96 / 1.04};
}

// P10: white ball under a distant light at phase angle g. The mean over the ball's disc is 2 (sin g + (pi - g) cos g)
// / (3 pi) times irradiance / pi (Lambert's sphere).
inline LightScene moon(double degrees) {
  const double g = degrees * std::numbers::pi / 180;
  const double irradiance = 3, disc = std::numbers::pi / 4;  // `disc`: fraction of the image that the ball covers
  const double phase = 2 * (std::sin(g) + (std::numbers::pi - g) * std::cos(g)) / (3 * std::numbers::pi);
  return {"moon",
          R"("camera": {"type": "orthographic", "position": [0, 0, 5], "width": 2}, "render": {"rr_depth": 1},
             "lights": {"sun": {"type": "directional", "direction": [)" +
              std::to_string(-std::sin(g)) + ", 0, " + std::to_string(-std::cos(g)) + R"(], "irradiance": [3, 3, 3]}},
             "materials": {"white": {"type": "diffuse", "color": [1, 1, 1]}},
             "objects": [{"type": "sphere", "radius": 1, "material": "white"}])",
          disc * phase * irradiance / std::numbers::pi};
}

// Room with all kinds of lights, glass, a mirror and a rough surface, in which all light sampling strategies must
// agree.
inline constexpr const char* kAreaLightRoom =
    R"("camera": {"position": [0, 1, 3.6], "target": [0, 0.9, 0], "fov": 55},
    "background": {"bottom": [0.1, 0.1, 0.1], "top": [0.4, 0.5, 0.7]}, "render": {"rr_depth": 4},
    "materials": {"white": {"type": "diffuse", "color": [0.7, 0.7, 0.7]}, "glass": {"type": "transparent"},
      "mirror": {"type": "specular"}, "lamp": {"type": "emissive", "emission": [6, 5, 4]},
      "gloss": {"type": "principled", "color": [0.6, 0.2, 0.1], "roughness": 0.3},
      "gold": {"type": "principled", "preset": "gold", "roughness": 0.25}},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "white"},
      {"type": "box", "half_size": [2, 1.5, 0.1], "translate": [0, 1.5, -1.5], "material": "gloss"},
      {"type": "sphere", "radius": 0.4, "translate": [-0.9, 0.4, 0], "material": "glass"},
      {"type": "sphere", "radius": 0.4, "translate": [0, 0.4, -0.5], "material": "gold"},
      {"type": "torus", "major_radius": 0.35, "minor_radius": 0.12, "translate": [0.9, 0.3, 0], "material": "mirror"},
      {"type": "sphere", "radius": 0.15, "translate": [0.4, 1.9, 0.5], "material": "lamp"},
      {"type": "box", "half_size": [0.3, 0.02, 0.2], "rotate": [0, 0, 30], "translate": [-1, 1.9, 0], "material": "lamp"},
      {"type": "capsule", "radius": 0.06, "half_height": 0.3, "rotate": [0, 0, 60], "translate": [1.3, 1.4, -0.4], "material": "lamp"},
      {"type": "cylinder", "radius": 0.2, "half_height": 0.05, "rotate": [20, 0, 10], "translate": [0, 1.3, -1], "material": "lamp"},
      {"type": "torus", "major_radius": 0.2, "minor_radius": 0.04, "translate": [-0.4, 1.4, 0.4], "material": "lamp"}])";

}  // namespace fathom::test
