// Combinators that blend, and the hard combinators that they become without the blend.
#pragma once

#include "compiler/graph/graph.h"

namespace fathom::compiler {

inline bool is_blend(Kind kind) { return kind >= Kind::SmoothUnion && kind <= Kind::StairsSubtraction; }

// Returns the combinator without the blend. A blended union contains the hard union, and a blended intersection or
// cut lies within the hard one.
inline Kind hard(Kind blend) {
  switch (blend) {
    case Kind::SmoothUnion:
    case Kind::ChamferUnion:
    case Kind::RoundUnion:
    case Kind::StairsUnion:
      return Kind::Union;
    case Kind::SmoothIntersection:
    case Kind::ChamferIntersection:
    case Kind::RoundIntersection:
    case Kind::StairsIntersection:
      return Kind::Intersection;
    default:
      return Kind::Subtraction;
  }
}

}  // namespace fathom::compiler
