// What the compiler hands over to the renderer: programs and plain tables. No graph, no syntax.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/geometry/box.h"
#include "compiler/scene/material.h"
#include "compiler/source/source.h"
#include "vm/program/verify.h"

namespace fathom::compiler {

// Largest settings a render takes, from the scene file or the command line.
inline constexpr int kMaxSide = 65535;  // pixels; what the image formats can say
inline constexpr int kMaxSpp = 1 << 20, kMaxBounces = 4096, kMaxTile = 1024;
inline constexpr int kMaxBlades = 32;
inline constexpr double kMinFilterWidth = 0.01, kMaxFilterWidth = 64;  // pixels
inline constexpr int kMostFrames = 100'000'000;
inline constexpr double kUsualFps = 24, kLeastFps = 1e-3, kMostFps = 1e6;  // frames a second

// What a `tag` in the surface program numbers: a part of the scene with a name and a material.
struct Surface {
  std::string name;        // of the object it belongs to
  std::uint32_t material;  // index into CompiledScene::materials
  bool mixed = false;      // part of a blend of several materials: its points can have shares of them all
  bool placed = false;     // some texture of its material is in the coordinates of the node (TextureSpace::Object)
  glm::dvec3 shift{0};     // from the coordinates where the `tag` stands to those of the node
};

struct Camera {
  // A panorama shows all directions: 360 degrees from left to right, 180 from top to bottom.
  enum class Projection { Perspective, Orthographic, Panorama };
  bool automatic =
      false;  // the scene has no `camera`: its extent is framed (compiler/scene/framing.h), as far as it has one
  Projection projection = Projection::Perspective;
  glm::dvec3 position{0, 0, 5};
  glm::dvec3 target{0, 0, 0};
  glm::dvec3 up{0, 1, 0};
  double fov = 0.7853981633974483;     // perspective: horizontal field of view, radians
  std::optional<double> vertical_fov;  // instead of fov when the file gives fov_y, radians
  std::optional<double> focal_length;  // instead of fov, mm
  double sensor_width = 36;            // as wide as the picture, mm
  double width = 4;                    // orthographic: width of the picture, scene units
  // The share of a frame's time that light comes in, from the frame's begin; 0: all is of one moment. In no file of
  // programs: without its text a scene has one moment.
  double shutter = 0;

  // Perspective: the lens. Without lens_radius and f_stop the camera is a pinhole.
  std::optional<double> lens_radius;  // of the circle round the aperture, scene units
  std::optional<double> f_stop;       // instead of lens_radius: focal length over aperture; a scene unit is a metre
  std::optional<double> focus_distance;  // of the plane that is sharp, along the view, scene units; else the target's
  int blades = 0;                        // sides of the aperture; below 3: it is round
  double blade_rotation = 0;             // radians, counter-clockwise in the picture; at 0 a corner is up
};

// How a pixel weighs the light around its centre (runtime/sampling/filter.h).
enum class FilterKind { Box, Tent, Gaussian, BlackmanHarris, Mitchell };
inline constexpr std::array<std::string_view, 5> kFilterNames = {"box", "tent", "gaussian", "blackman-harris",
                                                                 "mitchell"};  // [FilterKind]
// How light becomes a display's (runtime/image/tone.h), and its names in scene files and on the command line, in
// order.
enum class ToneCurve { None, Filmic, Aces, Agx, Neutral };
inline constexpr std::array<std::string_view, 5> kToneCurves = {"none", "filmic", "aces", "agx", "neutral"};

struct Film {
  int width = 640, height = 360;  // pixels
  double exposure = 0;            // stops: the picture is multiplied by 2^exposure
  FilterKind filter = FilterKind::Box;
  std::optional<double> filter_width;  // of its support, pixels; else the filter's own
  ToneCurve tone = ToneCurve::None;
  // Of the animation; likewise in no file of programs.
  std::optional<int> frames;
  double fps = kUsualFps;  // frames a second
};

// Where a render's random numbers come from (runtime/sampling/sampler.h).
enum class SamplerKind : std::uint8_t { Blue, Sobol, Independent };
inline constexpr std::array<std::string_view, 3> kSamplerNames = {"blue", "sobol", "independent"};  // [SamplerKind]

struct RenderSettings {
  int spp = 16;      // samples per pixel
  int bounces = 10;  // before Russian roulette may end a path
  int tile = 16;     // pixels a side
  std::uint64_t seed = 0;
  SamplerKind sampler = SamplerKind::Blue;
  bool adaptive = false;      // more samples where the picture is noisy
  std::optional<double> far;  // how far from the camera rays are followed, scene units; default: see render
};

// Radiance of rays that leave the scene.
struct Background {
  enum class Type { Gradient, Sky, Image };
  struct Sky {                // clear daylight over a ground (runtime/light/sky.h)
    glm::dvec3 sun{0, 1, 0};  // unit, towards it; not below the horizon
    double turbidity = 3;     // of the air: 2 very clear to 10 hazy
    glm::dvec3 ground_albedo{0.3};
    double strength = 1;  // a factor on everything, the sun too
    bool sun_disc = true;
  };
  struct Image {        // latitude and longitude: the middle of the picture looks along -z, +x is to its right
    std::string name;   // as the scene has it
    std::string file;   // as it can be opened: the scene's folder is put before it
    double rotate = 0;  // about y, degrees, counter-clockwise seen from above
    double strength = 1;
    Span span;  // of the file's name in the scene
  };
  Type type = Type::Gradient;
  // Gradient: straight down and straight up, linear in between in the sine of the elevation.
  glm::dvec3 bottom{0.0}, top{0.0};
  Sky sky;
  Image image;
};

// A light that is no part of the geometry. Rays do not meet it; of a directional one with an angle they see the disc.
struct Light {
  enum class Type { Point, Spot, Directional };
  std::string name;
  Type type = Type::Point;
  glm::dvec3 position{0.0};        // point, spot
  glm::dvec3 direction{0, -1, 0};  // spot, directional: unit, the way the light goes
  // Point, spot: radiant intensity, W/sr; directional: irradiance of what faces it.
  glm::dvec3 intensity{1.0};
  double angle = 0;  // degrees: half of a spot's cone; directional: half of the angle that the disc subtends
  double blend = 0;  // spot: how much of the angle, from the edge inwards, is a soft edge, in [0,1]
};

// A shape that glows and that light can be sampled on: of the graph, unaltered but for where it stands and how large
// it is (compiler/analysis/lamps.h). A place q of the shape is rotation * q + translation in the programs' coordinates;
// `rotation` may mirror.
struct Lamp {
  enum class Shape { Sphere, Box, Cylinder, Capsule, Quad };
  Shape shape = Shape::Sphere;
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
  double radius = 0;                    // sphere, cylinder, capsule; quad: half its thickness, its edges' radius
  double half_height = 0;               // cylinder: along y; capsule: to the centres of its balls
  glm::dvec3 half_size{0.0};            // box
  std::array<glm::dvec2, 4> corners{};  // quad: in its xy plane, counter-clockwise seen from +z
  std::uint32_t surface = 0;            // index into CompiledScene::surfaces
  std::uint32_t material = 0;           // index into CompiledScene::materials
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
  std::vector<Texture> textures;  // of the materials'; in the scene's coordinates, whatever the origin
  Camera camera;
  Film film;
  RenderSettings settings;
  Background background;
  std::vector<Light> lights;  // in file order
};

// A field as programs, and what is proved of it.
struct CompiledField {
  vm::VerifiedProgram distance;
  vm::VerifiedProgram surface;  // the same field with `tag`s; the same program when there is one surface

  Box bound;              // the field is positive outside
  Box contents;           // a box round every bounded part of it; empty when it has none
  double lipschitz = 1;   // |f(p) - f(q)| <= lipschitz * |p - q|
  double magnitude = 0;   // of the numbers that cancel in the field, scene units (compiler/shapes/bounds.h)
  bool certified = true;  // whether `lipschitz` is proved, or an estimate (a Mandelbulb is in the scene)
};

// The inside of all that is of one transparent material (compiler/analysis/media.h).
struct Medium : CompiledField {
  std::uint32_t material;  // index into CompiledScene::materials
};

// All places in it but those of textures, the camera's among them, are in the programs' coordinates: the scene's
// minus `origin`. What takes or prints places of the scene (runtime/cli, runtime/material/material.h) adds it; the
// renderer has no need to know.
struct CompiledScene : SceneTables, CompiledField {
  Source source;
  glm::dvec3 origin{0};       // where the programs' zero is in the scene, scene units (compiler/analysis/origin.h)
  Box extent;                 // of all parts that end (compiler/analysis/extent.h); empty when there are none
  std::vector<Medium> media;  // of the transparent materials, in their order
  std::vector<Lamp> lamps;    // in file order; of those that coincide the first alone
  std::vector<vm::VerifiedProgram> formulas;  // of the textures; numbers, not distances, in the scene's coordinates
  std::size_t node_count = 0;                 // distinct nodes after the passes
  // In the scene's coordinates: "3 nodes, bound [-1,1]x[-1,1.5]x[-1,1], exact outside, Lipschitz <= 1 (proved)".
  std::string summary;
};

}  // namespace fathom::compiler
