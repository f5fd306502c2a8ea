#include "runtime/mesh/lost/thin_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>
#include <unordered_set>

namespace fathom::runtime {
namespace {

constexpr double kMostWidth = 2;  // to each side, in cells
// A sheet goes on for as many steps of this length, in cells, in as many directions.
constexpr int kSheetSteps = 4, kSheetDirections = 8;
constexpr double kSheetStep = 0.5;
constexpr double kTaper = 0.8;  // a part thins out if it is thinner by this factor nearby
// A tip, which has places of any thickness, has larger balls beside one. A neck is wider where it ends.
constexpr double kLongGrowth = 1.3, kTornGrowth = 2.5;
// The largest balls in a neck, in radii of its first ball.
constexpr double kNeckGrowth = 16;
// The walk over balls: its reach in cells, the length of steps and the least ball, in radii.
constexpr double kReach = 2.5, kStepShare = 0.9, kLeastBall = 0.4;

const std::vector<glm::dvec3>& directions() {
  static const std::vector<glm::dvec3> all = [] {
    std::vector<glm::dvec3> made;
    for (const double sign : {-1.0, 1.0}) {
      made.insert(made.end(), {{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}});
      for (const double y : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) made.push_back(glm::dvec3(sign, y, z) / std::sqrt(3.0));
      }
    }
    return made;
  }();
  return all;
}

// Two unit vectors that complete a unit vector to a frame.
std::array<glm::dvec3, 2> frame_of(glm::dvec3 n) {
  const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(n, axis));
  return {u, glm::cross(n, u)};
}

// Unit vectors at a right angle to one, each beside its opposite.
std::array<glm::dvec3, kSheetDirections> around_of(glm::dvec3 n) {
  constexpr double kDiagonal = 0.70710678118654752;
  const auto [u, v] = frame_of(n);
  return {u, -u, v, -v, kDiagonal * (u + v), -kDiagonal * (u + v), kDiagonal * (u - v), -kDiagonal * (u - v)};
}

}  // namespace

ThinRegionSearch::Section ThinRegionSearch::along(const ProbedPoint& from, glm::dvec3 direction) {
  const double most = kMostWidth * lattice_.cell;
  const double up = probe_.way_out(from, direction, most), down = probe_.way_out(from, -direction, most);
  return {probe_.at(from.place + 0.5 * (up - down) * direction), direction, up + down};
}

// Climbs to the middle of the part: from ball to larger ball, no further than some radii from the start, and up to a
// ball too wide for a thin part.
ProbedPoint ThinRegionSearch::middle_of(const ProbedPoint& from) {
  constexpr int kMaxSteps = 64;
  constexpr double kMostRadii = 2.5, kGrowth = 1.001;
  ProbedPoint at = from;
  double share = kStepShare;
  for (int step = 0; step < kMaxSteps && share > 0x1p-6 && !is_thick(at); ++step) {
    places_.clear();
    for (const glm::dvec3& direction : directions()) places_.push_back(at.place + share * at.radius * direction);
    probe_.at(places_, around_);
    const ProbedPoint* best = &at;
    for (const ProbedPoint& next : around_) {
      if (next.side == from.side && next.radius > best->radius) best = &next;
    }
    if (best == &at || best->radius < kGrowth * at.radius) {
      share /= 2;
    } else if (glm::distance(best->place, from.place) > kMostRadii * best->radius) {
      break;
    } else {
      at = *best;
    }
  }
  return at;
}

// Returns the thinnest of some sections through a point, of which the first follow the normals of faces.
ThinRegionSearch::Section ThinRegionSearch::thinnest(const ProbedPoint& from) {
  constexpr int kTurns = 3;
  const glm::dvec3 normal = probe_.surface_at(from.place).normal;
  Section best = along(from, normal == glm::dvec3(0) ? glm::dvec3(1, 0, 0) : normal);
  for (const glm::dvec3& side : frame_of(best.across)) {
    const Section other = along(from, side);
    if (other.width < best.width) best = other;
  }
  for (int turn = 0; turn < kTurns; ++turn) {
    const glm::dvec3 face = probe_.surface_at(best.middle.place + 0.5 * best.width * best.across).normal;
    if (face == glm::dvec3(0)) break;
    const Section other = along(from, face);
    if (!(other.width < best.width)) break;
    best = other;
  }
  return best;
}

// Looks for the part at `target` and beside it, up to `most` away. Returns false if it is not there.
bool ThinRegionSearch::find_beside(const Section& from, glm::dvec3 target, double most, Section& found) {
  const ProbedPoint point = probe_.at(target);
  if (point.side == from.middle.side) {
    found = along(point, from.across);
    return true;
  }
  for (const double sign : {-1.0, 1.0}) {
    const double way = probe_.way_out(point, sign * from.across, most);
    if (way >= most) continue;
    for (const double share : {0x1p-6, 0x1p-4, 0x1p-2}) {
      const ProbedPoint beyond = probe_.at(point.place + sign * (way + share * from.width) * from.across);
      if (beyond.side != from.middle.side) continue;
      found = along(beyond, from.across);
      return true;
    }
  }
  return false;
}

// True if the part ends in this direction, and does not go on or become wide.
bool ThinRegionSearch::ends(const Section& from, glm::dvec3 direction, Widths& widths) {
  const double length = kSheetStep * lattice_.cell;
  Section at = from;
  for (int step = 0; step < kSheetSteps; ++step) {
    Section next;
    if (!find_beside(at, at.middle.place + length * direction, length, next)) return true;
    if (next.middle.side != from.middle.side) return true;
    if (next.width > kOpenWidth * lattice_.cell) return false;
    widths.most = std::max(widths.most, next.width);
    widths.least = std::min(widths.least, next.width);
    at = next;
  }
  return false;
}

bool ThinRegionSearch::is_sheet(const Section& from, double& least) {
  Widths widths{least, least};
  const auto around = around_of(from.across);
  const bool goes_on =
      std::ranges::none_of(around, [&](glm::dvec3 direction) { return ends(from, direction, widths); });
  least = widths.least;
  return goes_on;
}

// True if the part becomes thinner or ends in one direction, and becomes wider in the opposite one.
bool ThinRegionSearch::thins_out(const Section& from) {
  const auto around = around_of(from.across);
  for (std::size_t i = 0; i < around.size(); ++i) {
    Widths ahead{from.width, from.width}, behind = ahead;
    const bool is_thinner = ends(from, around[i], ahead) || ahead.least < from.width;
    if (!is_thinner) continue;
    (void)ends(from, around[i ^ 1], behind);
    if (ahead.least < kTaper * behind.most) return true;
  }
  return false;
}

// Adds the labels of the corners on the point's side that are in its ball, or in its sight at its cell. Returns true
// if there are any.
bool ThinRegionSearch::add_contacts(const ProbedPoint& point, std::vector<std::uint32_t>& labels) {
  // The corners of the point's cell, and further ones that the ball may reach, up to two cells away.
  LatticePlace first, last;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& all = lattice_.coordinates[axis];
    const double at = point.place[static_cast<int>(axis)], radius = std::min(point.radius, 2 * lattice_.cell);
    const auto below = [&](double x) {
      return static_cast<std::int32_t>(std::ranges::upper_bound(all, static_cast<float>(x)) - all.begin()) - 1;
    };
    const std::int32_t end = static_cast<std::int32_t>(all.size()) - 1;
    first.at[axis] = std::clamp(below(at - radius), 0, end);
    last.at[axis] = std::clamp(below(at + radius) + 1, 0, end);
  }
  bool found = false;
  LatticePlace at;
  for (at.at[2] = first.at[2]; at.at[2] <= last.at[2]; ++at.at[2]) {
    for (at.at[1] = first.at[1]; at.at[1] <= last.at[1]; ++at.at[1]) {
      for (at.at[0] = first.at[0]; at.at[0] <= last.at[0]; ++at.at[0]) found |= add_contact(point, at, labels);
    }
  }
  return found;
}

bool ThinRegionSearch::add_contact(const ProbedPoint& point, LatticePlace at, std::vector<std::uint32_t>& labels) {
  const std::uint32_t corner = signs_.corners().find(key_of(at));
  if (corner == KeyMap::kNone || signs_.is_corner_inside(corner) != (point.side == Side::Inside)) return false;
  const glm::dvec3 way = glm::dvec3(lattice_.corner(at)) - point.place;
  const double distance = glm::length(way);
  if (distance >= point.radius) {
    const glm::dvec3 far = glm::abs(way);
    const bool is_at_cell = std::max({far.x, far.y, far.z}) <= lattice_.cell * (1 + 0x1p-6);
    if (!is_at_cell || probe_.way_out(point, way / distance, distance) < distance) return false;
  }
  labels.push_back(labels_.of(corner));
  return true;
}

ThinRegionSearch::Walked ThinRegionSearch::explore(const ProbedPoint& from, bool passes_corners) {
  Walked walked;
  const double least = std::max(kLeastBall * from.radius, 0x1p-10 * lattice_.cell);
  if (from.radius < least) return walked;
  // Places are taken as one if they lie in one cube of half a radius, rounded to a power of two.
  std::unordered_set<std::uint64_t> known;
  const auto is_new = [&](const ProbedPoint& point) {
    int level = 0;
    (void)std::frexp(point.radius / least, &level);
    const glm::dvec3 at = (point.place - from.place) / (0.25 * std::ldexp(least, level));
    std::uint64_t key = static_cast<std::uint64_t>(level);
    for (int axis = 0; axis < 3; ++axis)
      key = key << 19 | (static_cast<std::uint64_t>(std::floor(at[axis]) + 0x1p18));
    return known.insert(key).second;
  };
  // Places break ties, which standard libraries order differently.
  const auto smaller = [](const ProbedPoint& a, const ProbedPoint& b) {
    return std::tie(a.radius, a.place.x, a.place.y, a.place.z) < std::tie(b.radius, b.place.x, b.place.y, b.place.z);
  };
  std::priority_queue<ProbedPoint, std::vector<ProbedPoint>, decltype(smaller)> queue(smaller);
  queue.push(from);
  is_new(from);
  for (int ball = 0; ball < most_balls_ && !queue.empty(); ++ball) {
    const ProbedPoint point = queue.top();
    queue.pop();
    if (add_contacts(point, walked.labels)) {
      if (!passes_corners || point.radius > kNeckGrowth * from.radius) continue;
      const auto is_another = [&](std::uint32_t label) { return label != walked.labels.front(); };
      if (std::ranges::any_of(walked.labels, is_another)) break;
    }
    walked.largest = std::max(walked.largest, point.radius);
    if (glm::distance(point.place, from.place) > kReach * lattice_.cell) {
      walked.is_long = true;
      continue;
    }
    places_.clear();
    for (const glm::dvec3& way : directions()) places_.push_back(point.place + kStepShare * point.radius * way);
    probe_.at(places_, around_);
    for (const ProbedPoint& next : around_) {
      if (next.side == from.side && next.radius >= least && is_new(next)) queue.push(next);
    }
  }
  walked.is_explored = queue.empty();
  std::ranges::sort(walked.labels);
  walked.labels.erase(std::unique(walked.labels.begin(), walked.labels.end()), walked.labels.end());
  return walked;
}

void ThinRegionSearch::describe(const Section& section, ThinRegion& region) {
  region.place = section.middle.place, region.thickness = section.width;
  for (const double sign : {-1.0, 1.0}) {
    const glm::dvec3 face = region.place + sign * 0.5 * section.width * section.across;
    region.surfaces[sign < 0 ? 0 : 1] = probe_.surface_at(face).surface;
  }
  if (region.surfaces[0] > region.surfaces[1]) std::swap(region.surfaces[0], region.surfaces[1]);
}

// Describes the part as a sheet if it is one at the section, and if the mesh lacks it there.
bool ThinRegionSearch::find_sheet(const ThinPlace& thin, const Section& section, ThinRegion& region) {
  double least = section.width;
  if (!(section.width < kOpenWidth * lattice_.cell)) return false;
  std::vector<std::uint32_t> labels;
  if (!thin.on_edge && add_contacts(section.middle, labels)) return false;
  if (!is_sheet(section, least)) return false;
  describe(section, region);
  region.fate = ThinRegion::Fate::Lost;
  region.is_sheet = true;
  region.tapers = least < kTaper * section.width;
  return true;
}

std::optional<glm::dvec3> ThinRegionSearch::follow_gap(glm::dvec3 from, glm::dvec3 to) {
  constexpr double kFirstStep = 0.5, kNearStep = 0x1p-3, kLastStep = 0x1p-9;  // in cells
  constexpr int kMaxSteps = 64;
  const double length = glm::distance(from, to);
  const glm::dvec3 direction = (to - from) / length;
  const ProbedPoint begin = probe_.at(from), end = probe_.at(to);
  if (begin.side != end.side || begin.side == Side::Unknown) return std::nullopt;
  const double first = probe_.way_out(begin, direction, length);
  const double last = length - probe_.way_out(end, -direction, length);
  const ProbedPoint between = probe_.at(from + 0.5 * (first + last) * direction);
  if (between.side != opposite(begin.side)) return std::nullopt;
  Section at = thinnest(between);
  double step = kFirstStep * lattice_.cell;
  for (int i = 0; i < kMaxSteps && step > kLastStep * lattice_.cell; ++i) {
    if (at.middle.side != between.side) return std::nullopt;
    const auto [u, v] = frame_of(at.across);
    Section best = at;
    for (const glm::dvec3& way : {u, -u, v, -v}) {
      const glm::dvec3 target = at.middle.place + step * way;
      Section next;
      if (find_beside(at, target, step + at.width, next)) {
        if (next.middle.side == between.side && next.width < best.width) best = next;
      } else if (step < kNearStep * lattice_.cell) {
        return target;  // a gap that bends is met again by shorter steps
      }
    }
    if (best.width < at.width) {
      at = best;
    } else {
      step /= 2;
    }
  }
  return std::nullopt;
}

ThinRegion ThinRegionSearch::examine(const ThinPlace& thin, bool is_apart) {
  ThinRegion region;
  const ProbedPoint start = probe_.at(thin.place);
  if (start.side == Side::Unknown) return region;
  const ProbedPoint middle = middle_of(start);
  const bool is_thin = !is_thick(middle);
  const Section here = thinnest(start), section = is_thin ? thinnest(middle) : here;
  if (section.middle.side != start.side) return region;
  // Between two round hollows the largest ball is beside the thinnest place.
  if (is_thin && (find_sheet(thin, section, region) || find_sheet(thin, here, region))) return region;
  describe(section, region);
  // A thick part may have a thin neck, where it may be torn.
  Walked walked = explore(section.middle, thin.is_between_pieces);
  double growth = walked.largest / section.middle.radius;
  if (thin.is_between_pieces && walked.labels.size() < 2) {
    // The middle may lie beyond the neck.
    Walked near = explore(start, true);
    if (near.labels.size() >= 2) walked = std::move(near), growth = walked.largest / start.radius;
  }
  if (walked.labels.size() >= 2) {
    region.fate = ThinRegion::Fate::Torn;
    region.labels = std::move(walked.labels);
    region.tapers = growth > kTornGrowth || thins_out(section);
  } else if (is_thin && walked.labels.empty() && (walked.is_explored || walked.is_long || is_apart)) {
    region.fate = ThinRegion::Fate::Lost;
    region.tapers = (!walked.is_explored && (!walked.is_long || growth > kLongGrowth)) || thins_out(section);
  }
  return region;
}

}  // namespace fathom::runtime
