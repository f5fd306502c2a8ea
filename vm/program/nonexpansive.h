// Opcodes that never change faster than their point moves. Tested by: tests/vm/program/nonexpansive_test.cpp
#pragma once

#include "vm/program/opcode.h"

namespace fathom::vm {

// True of a Shape or Outline that never changes faster than its point moves, |f(p) - f(q)| <= |p - q|, and of a Point
// row that moves no two points further apart; at all finite points, given immediates as the compiler derives them.
constexpr bool is_nonexpansive(Opcode opcode) {
  switch (opcode) {
    case Opcode::Mandelbulb:  // estimates
    case Opcode::Julia:
    case Opcode::Gyroid:  // where the angles are too large for floats they jump (vm/number/elementary-inl.h)
    case Opcode::SchwarzP:
    case Opcode::SchwarzD:
    case Opcode::Affine:
    case Opcode::Revolve:  // does in the plane of its outlines; it leaves the z they ignore
    case Opcode::Cell:
    case Opcode::CellJitter:
    case Opcode::Sector:
    case Opcode::Twist:
    case Opcode::Bend:
    case Opcode::Taper:
      return false;
    default:
      return true;
  }
}

}  // namespace fathom::vm
