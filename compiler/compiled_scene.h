// What the compiler hands over to the renderer: programs and plain tables. No graph, no syntax.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/box.h"
#include "compiler/source.h"
#include "vm/verify.h"

namespace fathom::compiler {

// Largest settings a render takes, from the scene file or the command line.
inline constexpr int kMaxSide = 65535;  // pixels; what the image formats can say
inline constexpr int kMaxSpp = 1 << 20, kMaxBounces = 4096, kMaxTile = 1024;

// How a surface scatters light. Colours are linear sRGB in [0,1] unless said.
struct Material {
  enum class Type { Diffuse, Emissive, Specular, Transparent };
  std::string name;
  Type type = Type::Diffuse;
  glm::dvec3 color{0.8};       // diffuse: albedo; specular: reflectance; transparent: tint of each crossing;
                               // emissive: albedo of the lamp's own surface
  glm::dvec3 emission{0.0};    // radiance Le, both sides; emissive only
  double ior = 1.5;            // transparent: index of refraction inside relative to outside
  glm::dvec3 absorption{0.0};  // transparent: absorption coefficient inside, per scene unit
};

// What a `tag` in the surface program numbers: a part of the scene with a name and a material.
struct Surface {
  std::string name;        // of the object it belongs to
  std::uint32_t material;  // index into CompiledScene::materials
};

struct Camera {
  enum class Projection { Perspective, Orthographic };
  Projection projection = Projection::Perspective;
  glm::dvec3 position{0, 0, 5};
  glm::dvec3 target{0, 0, 0};
  glm::dvec3 up{0, 1, 0};
  double fov = 0.7853981633974483;     // perspective: horizontal field of view, radians
  std::optional<double> vertical_fov;  // instead of fov when the file gives fov_y, radians
  double width = 4;                    // orthographic: width of the picture, scene units
};

// How light becomes a display's (runtime/tone.h), and its names in scene files and on the command line, in order.
enum class ToneCurve { None, Filmic, Aces, Agx, Neutral };
inline constexpr std::array<std::string_view, 5> kToneCurves = {"none", "filmic", "aces", "agx", "neutral"};

struct Film {
  int width = 640, height = 360;  // pixels
  double exposure = 0;            // stops: the picture is multiplied by 2^exposure
  ToneCurve tone = ToneCurve::None;
};

struct RenderSettings {
  int spp = 16;      // samples per pixel
  int bounces = 10;  // before Russian roulette may end a path
  int tile = 16;     // pixels a side
  std::uint64_t seed = 0;
  std::optional<double> far;  // how far from the camera rays are followed, scene units; default: see render
};

// Radiance of rays that leave the scene: `bottom` straight down to `top` straight up, linear in the angle's sine.
struct Background {
  glm::dvec3 bottom{0.0}, top{0.0};
};

// A number of the scene that formulas know by name and the command line can set.
struct Parameter {
  std::string name;
  double value = 0;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string doc;
};

// What a scene says beside its geometry.
struct SceneTables {
  std::vector<Parameter> parameters;  // in file order
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  Camera camera;
  Film film;
  RenderSettings settings;
  Background background;
};

// All places in it, the camera's among them, are in the programs' coordinates: the scene's minus `origin`. What takes
// or prints places of the scene (runtime/cli) adds it; the renderer has no need to know.
struct CompiledScene : SceneTables {
  Source source;
  glm::dvec3 origin{0};          // where the programs' zero is in the scene, scene units (compiler/origin.h)
  vm::VerifiedProgram distance;  // the field
  vm::VerifiedProgram surface;   // the same field with `tag`s; the same program when there is one surface

  Box bound;                   // the field is positive outside
  Box contents;                // a box round every bounded part of the scene; empty when it has none
  double lipschitz = 1;        // |f(p) - f(q)| <= lipschitz * |p - q|
  double magnitude = 0;        // of the numbers that cancel in the field, scene units (compiler/bounds.h)
  bool certified = true;       // whether `lipschitz` is proved, or an estimate (a Mandelbulb is in the scene)
  std::size_t node_count = 0;  // distinct nodes after the passes
  std::string summary;         // in the scene's coordinates: "3 nodes, bound [-1,1]x[-1,1.5]x[-1,1], exact outside,
                               // Lipschitz <= 1 (proved)"
};

}  // namespace fathom::compiler
