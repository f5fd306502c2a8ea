// Points as the evaluators read them: one array per coordinate.
#pragma once

namespace fathom::vm {

// Coordinates of a batch of points in scene units: three arrays of the same length.
template <class S>
struct PointsOf {
  const S* x;  // [point]
  const S* y;
  const S* z;
};
using Points = PointsOf<float>;
using RealPoints = PointsOf<double>;

}  // namespace fathom::vm
