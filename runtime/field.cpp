#include "runtime/field.h"

#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "vm/check.h"
#include "vm/convexity.h"

namespace fathom::runtime {
namespace {

struct Line {
  glm::dvec3 origin, direction;
};

// The i-th of some lines through the scene, followed to where it is near a surface; nothing when it comes to none.
// Places and directions anywhere: multiples of irrational numbers, modulo 1.
std::optional<Line> line_at_surface(const compiler::CompiledField& scene, int i, double near,
                                    vm::Workspace& workspace) {
  constexpr int kSteps = 64;
  const auto part = [i](double number) { return number * i - std::floor(number * i); };
  const glm::dvec3 share(part(0.8191725133961645), part(0.6710436067037893), part(0.5497004779019703));
  const glm::dvec3 aim(part(0.4503258693318263), part(0.3688964747453183), part(0.3021964744936211));
  Line line{scene.contents.lo + share * (scene.contents.hi - scene.contents.lo), glm::normalize(aim - 0.5)};
  for (int step = 0; step < kSteps; ++step) {
    const double distance = std::abs(vm::evaluate_distance(scene.distance, line.origin, workspace));
    if (distance < near) return line;
    line.origin += distance / scene.lipschitz * line.direction;
  }
  return std::nullopt;
}

// Field::longest_told, of lengths eight times shorter one after another.
double longest_told(const compiler::CompiledField& scene, double extent) {
  constexpr int kLengths = 14, kLines = 32;
  constexpr double kTold = 0.8, kNear = 1e-4;  // of what the field's constant alone says; of the extent
  if (scene.certified || scene.contents.empty()) return std::numeric_limits<double>::infinity();
  vm::Workspace workspace;
  std::vector<Line> lines;
  for (int i = 1; i <= kLines; ++i) {
    if (const auto line = line_at_surface(scene, i, kNear * extent, workspace)) lines.push_back(*line);
  }
  double length = extent;
  for (int i = 0; i < kLengths; ++i, length /= 8) {
    const bool told = std::all_of(lines.begin(), lines.end(), [&](const Line& line) {
      const vm::Range slope =
          vm::evaluate_along(scene.distance, line.origin, line.direction, 0, length, workspace).derivative;
      return slope.hi - slope.lo < kTold * 2 * scene.lipschitz;
    });
    if (told) return length;
  }
  return 0;
}

}  // namespace

double extent_of(const compiler::CompiledScene& scene) {
  double extent = glm::length(scene.camera.target - scene.camera.position);
  if (!(extent > 0)) extent = 1;
  if (scene.bound.empty() || !scene.bound.finite()) return extent;
  return std::min(extent, glm::length(scene.bound.hi - scene.bound.lo) / 2);
}

Field make_field(const compiler::CompiledScene& scene, std::optional<double> far) {
  return make_field(scene, extent_of(scene), far);
}

Field make_field(const compiler::CompiledField& compiled, double extent, std::optional<double> far) {
  CHECK(compiled.lipschitz > 0, "a field that never changes has no surface to march to");
  // A crossing is tried within this part of the extent. Smaller: more evaluations near the surface; larger: a chord
  // shorter than it may be missed beside a surface that is met head-on.
  constexpr double kBand = 1e-4;
  // The bound's surface may be the solid's, and a ray must see both sides of it.
  constexpr double kBoundMargin = 1e-3;

  Field field{};
  field.distance = &compiled.distance;
  field.surface = &compiled.surface;
  field.bound = compiled.bound.grown(kBoundMargin * extent);
  field.lipschitz = compiled.lipschitz;
  field.longest_told = longest_told(compiled, extent);
  field.inv_lipschitz = static_cast<float>(1 / compiled.lipschitz);
  field.magnitude = static_cast<float>(compiled.magnitude);
  field.band = static_cast<float>(kBand * extent);
  // What it costs to know how far the solid is convex pays where that is seldom no further than the distance.
  constexpr double kConvexShare = 0.25;
  field.convex = vm::convex_share(compiled.distance) >= kConvexShare;
  // Where the bound does not end a ray, `far` has to: certify() needs an end. No number of a scene is larger.
  constexpr double kFarthest = 1e18;
  const bool bounded = compiled.bound.empty() || compiled.bound.finite();
  field.far = far.value_or(bounded ? std::numeric_limits<double>::infinity() : std::max(kDefaultFar, 1e3 * extent));
  if (!bounded) field.far = std::min(field.far, kFarthest);
  return field;
}

void add_regions(Field& field, const compiler::CompiledField& compiled, const RegionOptions& options) {
  // A ray may go far from the bounded parts of an unbounded scene, and should find cells there; finer ones than a
  // float tells apart would be of no use (kCellMargin in region_builder.cpp).
  constexpr double kLeastRoom = 3, kMostRoom = 6;
  const bool bounded = field.bound.finite();
  RegionOptions chosen = options;
  if (!bounded && !compiled.contents.empty()) {
    const glm::dvec3 extents = compiled.contents.hi - compiled.contents.lo;
    const double wanted = std::log2(2 * field.far / std::max({extents.x, extents.y, extents.z}));
    chosen.room = static_cast<int>(std::clamp(std::ceil(wanted), kLeastRoom, kMostRoom));
  }
  field.regions =
      Regions::build(compiled.surface, bounded ? field.bound : compiled.contents, compiled.lipschitz, chosen);
}

void Field::evaluate(vm::Points points, std::size_t count, float* out, RegionScratch& scratch,
                     vm::Workspace& workspace) const {
  if (evaluator) return evaluator(points, count, out);
  if (regions) return regions->evaluate(points, count, out, scratch, workspace);
  vm::evaluate_distance(*distance, points, count, out, workspace);
}

double Field::evaluate(glm::dvec3 point, RealScratch& scratch, std::uint64_t& instructions) const {
  if (regions) return regions->evaluate(point, scratch, instructions);
  instructions += distance->instructions();
  return vm::evaluate_distance(*distance, point, scratch.workspace);
}

void Field::evaluate(vm::RealPoints points, std::size_t count, double* out, std::uint64_t* instructions,
                     RealScratch& scratch) const {
  if (!regions) {
    std::fill_n(instructions, count, distance->instructions());
    return vm::evaluate_distance(*distance, points, count, out, scratch.workspace);
  }
  // Points of different rays share no part.
  for (std::size_t i = 0; i < count; ++i) {
    instructions[i] = 0;
    out[i] = regions->evaluate(glm::dvec3(points.x[i], points.y[i], points.z[i]), scratch, instructions[i]);
  }
}

std::optional<vm::AlongLine> Field::along(glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                                          RealScratch& scratch, std::uint64_t& instructions) const {
  // A stretch over several cells is cheaper cut until it is within one.
  if (regions) return regions->along(origin, direction, begin, end, scratch, instructions);
  instructions += distance->instructions();
  return vm::evaluate_along(*distance, origin, direction, begin, end, scratch.workspace);
}

}  // namespace fathom::runtime
