// Which shapes are convex, and how much of a program is. Tested by: tests/vm/program/convexity_test.cpp
#pragma once

#include "vm/program/opcode.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// Whether a Shape's distance is a convex function of the point, whatever its immediates, and so its solid convex.
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

// Whether what is convex at the point that a Point makes is so at the point it is made of.
constexpr bool keeps_convex(Opcode point) { return point == Opcode::Translate || point == Opcode::Affine; }

// The share of a program's cost, in [0,1], that goes to convex shapes where they stay so: at points to which affine maps
// alone have led.
double convex_share(const Code& program);

}  // namespace fathom::vm
