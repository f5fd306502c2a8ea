#include "tests/support/judge/brute_force_outlines.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "tests/support/judge/judge_outlines.h"

namespace fathom::test {
namespace {

using glm::dvec2;

constexpr int kNodes = 48;
const dvec2 kRay(std::cos(0.3), std::sin(0.3));  // parallel to no edge of the tested shapes
double height(dvec2 v) { return kRay.x * v.y - kRay.y * v.x; }

}  // namespace

BruteForceOutline::BruteForceOutline(compiler::Kind kind, std::span<const double> params) {
  for (const Piece& piece : outline_boundary(kind, params)) {
    if (piece.straight) {
      add({piece.a, piece.b - piece.a, {}, true, 0, 1, {}, 0});
      continue;
    }
    const dvec2 cosine(piece.radii.x, 0), sine(0, piece.radii.y);
    // Height is a sine wave in t, with its minimum and maximum half a turn apart. Curves are split at those extrema.
    const double peak = std::atan2(height(sine), height(cosine));
    double from = piece.from;
    for (double turn = peak - 8 * std::numbers::pi; turn < piece.to; turn += std::numbers::pi) {
      if (turn <= from) continue;
      add({piece.centre, cosine, sine, false, from, turn, {}, 0});
      from = turn;
    }
    add({piece.centre, cosine, sine, false, from, piece.to, {}, 0});
  }
}

dvec2 BruteForceOutline::Curve::at(double t) const {
  return straight ? base + t * cosine : base + std::cos(t) * cosine + std::sin(t) * sine;
}

void BruteForceOutline::add(Curve curve) {
  for (int i = 0; i <= kNodes; ++i)
    curve.nodes.push_back(curve.at(curve.from + (curve.to - curve.from) * i / kNodes));
  for (std::size_t i = 0; i < kNodes; ++i) {
    curve.longest = std::max(curve.longest, glm::length(curve.nodes[i + 1] - curve.nodes[i]));
  }
  curves_.push_back(std::move(curve));
}

double BruteForceOutline::distance(dvec2 p) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Curve& curve : curves_) {
    std::vector<double> d;
    for (dvec2 node : curve.nodes) d.push_back(glm::length(node - p));
    for (std::size_t i = 0; i < d.size(); ++i) {
      const double left = d[i > 0 ? i - 1 : i], right = d[i + 1 < d.size() ? i + 1 : i];
      if (d[i] > std::min(left, right) || d[i] > best + 2 * curve.longest) continue;
      double t = curve.from + (curve.to - curve.from) * static_cast<double>(i) / kNodes, least = d[i];
      for (double step = (curve.to - curve.from) / kNodes; step > 1e-14;) {
        const double before = std::max(curve.from, t - step), after = std::min(curve.to, t + step);
        const double to_before = glm::length(curve.at(before) - p), to_after = glm::length(curve.at(after) - p);
        if (to_before < least && to_before <= to_after) {
          t = before, least = to_before;
        } else if (to_after < least) {
          t = after, least = to_after;
        } else {
          step /= 2;
        }
      }
      best = std::min(best, least);
    }
  }
  return inside(p) ? -best : best;
}

bool BruteForceOutline::inside(dvec2 p) const {
  bool odd = false;
  for (const Curve& curve : curves_) {
    const bool up = height(curve.nodes.back() - p) > 0;
    if ((height(curve.nodes.front() - p) > 0) == up) continue;
    double lo = curve.from, hi = curve.to;  // the line of the ray crosses the curve between them
    for (int i = 0; i < 100; ++i) {
      const double t = (lo + hi) / 2;
      ((height(curve.at(t) - p) > 0) == up ? hi : lo) = t;
    }
    if (glm::dot(curve.at(hi) - p, kRay) > 0) odd = !odd;
  }
  return odd;
}

}  // namespace fathom::test
