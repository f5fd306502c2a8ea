// same_program(): true if two programs are equal bit for bit, including their source locations.
#pragma once

#include <bit>

#include "vm/program/program.h"

namespace fathom::test {

inline bool same_program(const vm::Program& a, const vm::Program& b) {
  bool same = a.words == b.words && a.doubles.size() == b.doubles.size() && a.locals == b.locals &&
              a.source_name == b.source_name && a.debug.size() == b.debug.size();
  for (std::size_t i = 0; same && i < a.doubles.size(); ++i) {
    same = std::bit_cast<std::uint64_t>(a.doubles[i]) == std::bit_cast<std::uint64_t>(b.doubles[i]);
  }
  for (std::size_t i = 0; same && i < a.debug.size(); ++i) {
    same = a.debug[i].offset == b.debug[i].offset && a.debug[i].line == b.debug[i].line &&
           a.debug[i].column == b.debug[i].column && a.debug[i].symbol == b.debug[i].symbol;
  }
  return same;
}

}  // namespace fathom::test
