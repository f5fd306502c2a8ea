// Opcodes with Lipschitz constant 1. Tested by: tests/vm/program/nonexpansive_test.cpp
#pragma once

#include "vm/program/opcode.h"

namespace fathom::vm {

// True if a Shape or Outline has Lipschitz constant 1, |f(p) - f(q)| <= |p - q|, or a Point row moves no two points
// further apart. Holds at all finite points, for immediates as the compiler derives them.
constexpr bool is_nonexpansive(Opcode opcode) {
  switch (opcode) {
    case Opcode::Mandelbulb:  // Mandelbulb and Julia are distance estimates
    case Opcode::Julia:
    case Opcode::Gyroid:  // periodic surfaces jump at angles too large for floats (vm/number/elementary-inl.h)
    case Opcode::SchwarzP:
    case Opcode::SchwarzD:
    case Opcode::Affine:
    case Opcode::Revolve:  // nonexpansive in its outlines' xy plane, but it also passes on z, which they ignore
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
