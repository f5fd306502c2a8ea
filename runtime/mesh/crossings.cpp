#include "runtime/mesh/crossings.h"

#include <cmath>

namespace fathom::runtime {
namespace {

// Root search on an edge, by false position with halved ends (Dowell and Jarratt, "A modified regula falsi method for
// computing the root of an equation", 1971). A bisection every third time bounds the number of steps.
struct EdgeSearch {
  glm::vec3 start;  // the lower end
  int axis;
  float in, out;               // coordinates along the axis of a point inside and of one outside
  double f_in = 0, f_out = 0;  // values there, the Illinois factor included
  int last = 0;                // side that the last step replaced: -1 inside, 1 outside
  double root = 0;

  glm::vec3 at(float t) const {
    glm::vec3 p = start;
    p[axis] = t;
    return p;
  }
  // Returns the coordinate of the next evaluation, strictly between the ends, or one of the ends if floats end there.
  float next(int step) const {
    const double middle = 0.5 * (static_cast<double>(in) + static_cast<double>(out));
    double t = middle;
    if (step % 3 != 2 && f_out > f_in) {
      t = static_cast<double>(in) + (static_cast<double>(out) - static_cast<double>(in)) * (-f_in / (f_out - f_in));
    }
    auto rounded = static_cast<float>(t);
    if (!(rounded > std::min(in, out) && rounded < std::max(in, out))) rounded = static_cast<float>(middle);
    return rounded;
  }
  // Takes the value at t. Returns true if the search goes on.
  bool take(float t, double value, double error, double width) {
    root = static_cast<double>(t);
    if (!(std::abs(value) > error)) return false;  // the root within float error; a NaN cannot be searched
    if (value < 0) {
      in = t, f_in = value;
      if (last == -1) f_out /= 2;
      last = -1;
    } else {
      out = t, f_out = value;
      if (last == 1) f_in /= 2;
      last = 1;
    }
    return std::abs(static_cast<double>(in) - static_cast<double>(out)) > width;
  }
};

// Width of the bracket at which a search ends, as a share of a cell.
constexpr double kRootWidth = 0x1p-16;
constexpr int kMostSteps = 64;

std::vector<EdgeSearch> begin_searches(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                                       int threads) {
  std::vector<EdgeSearch> searches;
  PointArrays ends;
  for (std::uint32_t edge = 0; edge < signs.edges().size(); ++edge) {
    const LatticePlace place = place_of(signs.edges()[edge]);
    const int axis = axis_of(signs.edges()[edge]);
    const glm::vec3 lo = lattice.corner(place), hi = lattice.corner(place.moved(axis, 1));
    const bool lower = signs.is_lower_inside(edge);
    searches.push_back({lo, axis, lower ? lo[axis] : hi[axis], lower ? hi[axis] : lo[axis]});
    ends.push_back(glm::dvec3(searches.back().at(searches.back().in)));
    ends.push_back(glm::dvec3(searches.back().at(searches.back().out)));
  }
  std::vector<float> values;
  field.evaluate(ends, MeshField::Values::Distance, values, threads);
  for (std::size_t i = 0; i < searches.size(); ++i) {
    // Double may have decided the side of a corner against the sign of the float.
    searches[i].f_in = std::min(static_cast<double>(values[2 * i]), -0.0);
    searches[i].f_out = std::max(static_cast<double>(values[2 * i + 1]), 0.0);
    searches[i].root = 0.5 * (static_cast<double>(searches[i].in) + static_cast<double>(searches[i].out));
  }
  return searches;
}

}  // namespace

std::vector<Crossing> find_crossings(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                                     int threads) {
  std::vector<EdgeSearch> searches = begin_searches(field, lattice, signs, threads);
  std::vector<std::size_t> active(searches.size());
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = i;
  PointArrays points;
  std::vector<float> values;
  for (int step = 0; step < kMostSteps && !active.empty(); ++step) {
    points.clear();
    for (const std::size_t i : active) points.push_back(glm::dvec3(searches[i].at(searches[i].next(step))));
    field.evaluate(points, MeshField::Values::Distance, values, threads);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < active.size(); ++k) {
      EdgeSearch& search = searches[active[k]];
      const float t = points[k][search.axis];
      const bool stuck = t == search.in || t == search.out;
      const double error = static_cast<double>(field.error(points[k], values[k]));
      if (search.take(t, static_cast<double>(values[k]), error, kRootWidth * lattice.cell) && !stuck) {
        active[kept++] = active[k];
      }
    }
    active.resize(kept);
  }

  points.clear();
  for (const EdgeSearch& search : searches) points.push_back(glm::dvec3(search.at(static_cast<float>(search.root))));
  std::vector<MeshField::SurfacePoint> surfaces;
  field.find_surfaces(points, surfaces, threads);
  std::vector<Crossing> crossings;
  crossings.reserve(searches.size());
  for (std::size_t i = 0; i < searches.size(); ++i) {
    crossings.push_back({glm::dvec3(points[i]), surfaces[i].normal, surfaces[i].surface});
  }
  return crossings;
}

}  // namespace fathom::runtime
