// The compiler's output for the renderer: programs and plain tables, without graph and syntax.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compiler/geometry/box.h"
#include "compiler/scene/material.h"
#include "compiler/scene/settings.h"
#include "compiler/source/source.h"
#include "vm/program/verify.h"

namespace fathom::compiler {

inline constexpr int kMaxBlades = 32;

// The part of the scene that a `tag` in the surface program numbers, with a name and a material.
struct Surface {
  std::string name;        // of the object that the surface belongs to
  std::uint32_t material;  // index into CompiledScene::materials
  bool mixed = false;      // part of a blend of several materials: its points can have shares of all of them
  bool placed = false;     // a texture of its material is in the coordinates of the node (TextureSpace::Object)
  glm::dvec3 shift{0};     // from the coordinates at the `tag` to those of the node
};

struct Camera {
  // A panorama shows all directions: 360 degrees from left to right, 180 from top to bottom.
  enum class Projection { Perspective, Orthographic, Panorama };
  // True if the scene has no `camera`: the camera frames the scene's extent, if there is one
  // (compiler/scene/framing.h).
  bool automatic = false;
  Projection projection = Projection::Perspective;
  glm::dvec3 position{0, 0, 5};
  glm::dvec3 target{0, 0, 0};
  glm::dvec3 up{0, 1, 0};
  double fov = 0.7853981633974483;     // perspective: horizontal field of view, radians
  std::optional<double> vertical_fov;  // radians; replaces fov when the file gives fov_y
  std::optional<double> focal_length;  // mm; replaces fov
  double sensor_width = 36;            // mm; the sensor is as wide as the image
  double width = 4;                    // orthographic: width of the image, scene units
  // Share of a frame's time, from the frame's beginning, during which light enters. 0: all light is of one moment.
  // A compiled file without text has one moment.
  double shutter = 0;

  // Perspective: the lens. A camera without lens_radius and f_stop is a pinhole.
  std::optional<double> lens_radius;  // of the circle around the aperture, scene units
  // Focal length over aperture, which replaces lens_radius. A scene unit is a metre.
  std::optional<double> f_stop;
  // Distance along the view of the plane in focus, scene units. Default: the target's.
  std::optional<double> focus_distance;
  int blades = 0;                        // sides of the aperture; below 3: round
  double blade_rotation = 0;             // radians, counter-clockwise in the image; at 0 a corner is up
};

// Radiance of rays that leave the scene.
struct Background {
  enum class Type { Gradient, Sky, Image };
  struct Sky {                // clear daylight over a ground (runtime/light/sky.h)
    glm::dvec3 sun{0, 1, 0};  // unit vector towards the sun, not below the horizon
    double turbidity = 3;     // of the air, from 2 (very clear) to 10 (hazy)
    glm::dvec3 ground_albedo{0.3};
    double strength = 1;  // factor of everything, including the sun
    bool sun_disc = true;
  };
  struct Image {        // latitude-longitude environment map: its centre is the direction -z, +x is to the right
    std::string name;   // as written in the scene
    std::string file;   // as it can be opened: the scene's folder precedes the name
    double rotate = 0;  // about y, degrees, counter-clockwise seen from above
    double strength = 1;
    Span span;  // of the file's name in the scene
  };
  Type type = Type::Gradient;
  // Gradient: radiance straight down and straight up, linear in between in the sine of the elevation.
  glm::dvec3 bottom{0.0}, top{0.0};
  Sky sky;
  Image image;
};

// A light that is not part of the geometry. Rays do not hit it, but they see the disc of a directional light with an
// angle.
struct Light {
  enum class Type { Point, Spot, Directional };
  std::string name;
  Type type = Type::Point;
  glm::dvec3 position{0.0};        // point, spot
  glm::dvec3 direction{0, -1, 0};  // spot, directional: unit vector along which the light travels
  // Point, spot: radiant intensity, W/sr. Directional: irradiance of a surface that faces the light.
  glm::dvec3 intensity{1.0};
  double angle = 0;  // degrees: half of a spot's cone, or half of the angle that a directional light's disc subtends
  double blend = 0;  // spot: share of the angle, from the edge inwards, that is a soft edge, in [0,1]
};

// An area light: an emissive shape of the graph that the renderer can sample, unaltered except for its place and size
// (compiler/analysis/area_lights.h). A point q of the shape is rotation * q + translation in the programs'
// coordinates. `rotation` may mirror.
struct AreaLight {
  enum class Shape { Sphere, Box, Cylinder, Capsule, Quad };
  Shape shape = Shape::Sphere;
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
  // sphere, cylinder, capsule; quad: half the thickness, which is the radius of the edges
  double radius = 0;
  double half_height = 0;               // cylinder: along y; capsule: to the centres of the balls
  glm::dvec3 half_size{0.0};            // box
  std::array<glm::dvec2, 4> corners{};  // quad: in its xy plane, counter-clockwise seen from +z
  std::uint32_t surface = 0;            // index into CompiledScene::surfaces
  std::uint32_t material = 0;           // index into CompiledScene::materials
};

// A number of the scene that formulas refer to by name and the command line can set.
struct Parameter {
  std::string name;
  double value = 0;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string doc;
};

// Contents of a scene other than its geometry.
struct SceneTables {
  std::vector<Parameter> parameters;  // in file order
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<Texture> textures;  // of the materials, in the scene's coordinates whatever the origin
  Camera camera;
  Film film;
  RenderSettings settings;
  Background background;
  std::vector<Light> lights;  // in file order
};

// Programs of a field, and the facts that the compiler proves about the field.
struct CompiledField {
  vm::VerifiedProgram distance;
  vm::VerifiedProgram surface;  // the field with `tag`s; equals `distance` if there is one surface

  Box bound;              // the field is positive outside
  Box contents;           // around all bounded parts of the field; empty if it has none
  double lipschitz = 1;   // |f(p) - f(q)| <= lipschitz * |p - q|
  double cancellation = 0;  // of the numbers that cancel in the field, scene units (compiler/shapes/bounds.h)
  bool certified = true;  // `lipschitz` is proved; false: an estimate (a Mandelbulb is in the scene)
  // Box around formulas whose slope is proved only cell by cell (compiler/analysis/formula_cells.h); empty if there
  // are none. Outside, the field has no zero except those of the rest of the field, whose Lipschitz constant is
  // `rest_lipschitz`, 0 without a rest.
  Box formula_box = {};
  double rest_lipschitz = 0;
};

// A solid that a ray enters at a place that a formula gives: the points q = linear * p + translation of a shape
// around the origin.
struct ClosedForm {
  enum class Shape : std::uint8_t { Ball, Box, Cylinder, Capsule, HalfSpace, RoundBox, RoundedCylinder };
  Shape shape;
  bool cut = false;  // the solid is cut from the others
  glm::dmat3 linear{1.0};
  glm::dvec3 translation{0.0};
  // Ball: radius. Box: half sizes. Cylinder and Capsule, about y: radius, half height. HalfSpace: unit normal, offset
  // along it. RoundBox and RoundedCylinder: as Box and Cylinder, then the radius of the edges, which are part of
  // them.
  std::array<double, 4> size{};
};

// Maximum number of a piece's forms: with more, marching is faster.
inline constexpr std::size_t kMostForms = 8;

// A part of the scene, which is the union of its pieces (compiler/passes/split.h).
struct CompiledPiece : CompiledField {
  bool convex;  // the distance is a convex function
  // Solids whose intersection is the piece, and what is cut from it. Empty: there is no formula.
  std::vector<ClosedForm> forms;
};

// A field that may be divided.
struct SplitField : CompiledField {
  std::vector<CompiledPiece> pieces;  // in the order of the scene; empty unless CompileOptions::pieces, or if one
};

// The interior of all bodies of one transparent material (compiler/analysis/media.h).
struct Medium : SplitField {
  std::uint32_t material;  // index into CompiledScene::materials
};

// All places except those of textures, and including the camera's, are in the programs' coordinates: the scene's
// minus `origin`. Code that takes or prints places of the scene (runtime/cli, runtime/material/material.h) adds
// `origin`, which the renderer does not need.
struct CompiledScene : SceneTables, SplitField {
  Source source;
  glm::dvec3 origin{0};       // place in the scene of the programs' zero, scene units (compiler/analysis/origin.h)
  Box extent;                 // of all bounded parts (compiler/analysis/extent.h); empty if there are none
  std::vector<Medium> media;  // of the transparent materials, in the materials' order
  std::vector<AreaLight> area_lights;         // in file order; of coincident area lights only the first
  std::vector<vm::VerifiedProgram> formulas;  // of the textures; numbers, not distances, in the scene's coordinates
  std::size_t node_count = 0;                 // number of distinct nodes after the passes
  // E.g. "3 nodes, bound [-1,1]x[-1,1.5]x[-1,1], exact outside, Lipschitz <= 1 (proved)", in the scene's coordinates.
  std::string summary;
};

}  // namespace fathom::compiler
