// The scene's DAG: hash-consed nodes, each a kind, its parameters and its children.
//
// add() is the only way to make a node, and returns the existing node if the graph has an equal one. Equal subtrees
// are therefore one node whatever names the scene gave them. Children are always made before their parents: a loop
// over ids in ascending order visits every child first, and no pass needs recursion.
//
// Parameters are doubles in the order of the kind's row in compiler/shapes/node_table.h (a vector takes three),
// followed by the numbers that the compiler derives for the row.
// Tested by: tests/compiler/graph/graph_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler {

enum class Kind : std::uint8_t {
  // solids
  Sphere,
  Ellipsoid,
  Box,
  RoundBox,
  BoxFrame,
  Torus,
  CappedTorus,
  Link,
  Plane,
  Cylinder,
  RoundedCylinder,
  InfiniteCylinder,
  Capsule,
  Cone,
  RoundCone,
  InfiniteCone,
  SolidAngle,
  CutSphere,
  CutHollowSphere,
  DeathStar,
  Tube,
  Vesica,
  Rhombus,
  HexagonalPrism,
  TriangularPrism,
  Tetrahedron,
  Octahedron,
  Dodecahedron,
  Icosahedron,
  Pyramid,
  Triangle,
  Quad,
  Gyroid,
  SchwarzP,
  SchwarzD,
  MengerSponge,
  Mandelbulb,
  Julia,
  // outlines: shapes in the xy plane, for extrude and revolve
  Circle,
  Rectangle,
  RoundedRectangle,
  Segment,
  Polygon,
  RegularPolygon,
  Star,
  Trapezoid,
  Parallelogram,
  RhombusOutline,
  IsoscelesTriangle,
  UnevenCapsule,
  Arc,
  Ring,
  Pie,
  CutDisk,
  Horseshoe,
  VesicaOutline,
  Moon,
  Egg,
  Heart,
  Cross,
  RoundedX,
  Ellipse,
  // alterations of one child
  Round,
  Onion,
  Complement,
  Elongate,
  Extrude,
  Revolve,
  Mirror,
  Repetition,
  PolarRepetition,
  Shear,
  Twist,
  Bend,
  Taper,
  Displacement,
  Expression,
  // Transform: 12 numbers, the rows of the affine map from the parent's space to the child's, then the factor of the
  // child's distance. Scene files write it as the properties scale, rotate and translate.
  Transform,
  // Displaced: a distance plus a formula. Unlike Add it keeps its operands' order, because the first has the surface.
  Displaced,
  // Bounded: a formula as a distance within a box (compiler/shapes/functions.cpp). Displacement and Expression become
  // Bounded.
  Bounded,
  // Scaled: the child's distance times params[0] > 0, which makes it a distance again if the child's changes faster
  // than a distance.
  Scaled,
  // combinators of n children, which all except the hard ones fold from the left
  Union,
  Intersection,
  Subtraction,
  Xor,
  SmoothUnion,
  SmoothIntersection,
  SmoothSubtraction,
  ChamferUnion,
  ChamferIntersection,
  ChamferSubtraction,
  RoundUnion,
  RoundIntersection,
  RoundSubtraction,
  StairsUnion,
  StairsIntersection,
  StairsSubtraction,
  Morph,
  // Paint: the child's points belong to surface number params[0] (compiled_scene.h) unless a Paint further in says
  // otherwise.
  Paint,
  // numbers and functions of numbers, for formulas
  X,
  Y,
  Z,
  Constant,
#define FUNCTION(Name, ...) Name,
#define FUNCTION_OF(Name, ...) Name,
#include "vm/program/functions.def"
};

inline constexpr std::size_t kKindCount = static_cast<std::size_t>(Kind::Noise) + 1;

// A blend narrower than this changes no float, so the compiler treats it as no blend.
inline constexpr double kMinBlend = 1e-30;

using NodeId = std::uint32_t;

// Place where the scene first writes a node, and the name that the scene gives it ("" when none).
struct SourceLocation {
  Span span;
  std::string name;
};

class Graph {
 public:
  NodeId add(Kind kind, std::span<const double> params, std::span<const NodeId> children,
             const SourceLocation& origin = {});

  std::size_t size() const { return nodes_.size(); }
  Kind kind(NodeId id) const { return nodes_[id].kind; }
  std::span<const double> params(NodeId id) const;    // valid until the next add()
  std::span<const NodeId> children(NodeId id) const;  // valid until the next add()
  const SourceLocation& origin(NodeId id) const { return nodes_[id].origin; }

 private:
  struct Node {
    Kind kind;
    std::uint32_t first_param, param_count, first_child, child_count;
    std::uint64_t hash;
    SourceLocation origin;
  };
  bool equal(NodeId id, Kind kind, std::span<const double> params, std::span<const NodeId> children) const;
  void grow_table();

  std::vector<Node> nodes_;
  std::vector<double> params_;
  std::vector<NodeId> children_;
  // Hash table with linear probing and at least twice as many entries as nodes: a node is in the first entry, from
  // that of its hash on, that was free when the node was added.
  std::vector<NodeId> table_;
  std::vector<double> new_params_;  // copy of the arguments of add()
  std::vector<NodeId> new_children_;
};

// A graph and the node that stands for the whole scene.
struct Scene {
  Graph graph;
  NodeId root = 0;
};

}  // namespace fathom::compiler
