// Convexity of shapes, and the share of convex shapes in a program. Tested by: tests/vm/program/convexity_test.cpp
#pragma once

#include "vm/program/opcode.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// True if a Shape's distance is a convex function of the point for all immediates; its solid is then convex too.
constexpr bool is_convex(Opcode shape) {
  switch (shape) {
    case Opcode::Sphere:
    case Opcode::Box:
    case Opcode::RoundBox:
    case Opcode::Plane:
    case Opcode::Cylinder:
    case Opcode::RoundedCylinder:
    case Opcode::Cone:
    case Opcode::RoundCone:
    case Opcode::InfiniteCylinder:
    case Opcode::Capsule:
    case Opcode::Tetrahedron:
    case Opcode::Octahedron:
    case Opcode::Dodecahedron:
    case Opcode::Icosahedron:
    case Opcode::Pyramid:
    case Opcode::Triangle:
    case Opcode::Quad:
    case Opcode::BoxBetween:
    case Opcode::Slab:
    case Opcode::Circle:
    case Opcode::Rectangle:
    case Opcode::RoundedRectangle:
    case Opcode::Segment:
    case Opcode::RegularPolygon:
    case Opcode::Trapezoid:
    case Opcode::Parallelogram:
    case Opcode::Diamond:
    case Opcode::IsoscelesTriangle:
    case Opcode::UnevenCapsule:
    case Opcode::Ellipse:
      return true;
    default:
      return false;
  }
}

// True if a function that is convex in the Point's output is also convex in the Point's input.
constexpr bool keeps_convex(Opcode point) { return point == Opcode::Translate || point == Opcode::Affine; }

// Returns the share of a program's cost, in [0,1], that goes to convex shapes at points reached by affine maps alone.
// Other maps do not preserve convexity.
double convex_share(const Code& program);

}  // namespace fathom::vm
