#include "runtime/field/field.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "runtime/field/region_plan.h"
#include "runtime/field/region_store.h"
#include "runtime/sampling/even_steps.h"
#include "vm/program/check.h"
#include "vm/program/convexity.h"

namespace fathom::runtime {
namespace {

struct Line {
  glm::dvec3 origin, direction;
};

// Returns the i-th of some lines through the scene, followed to a point near a surface, or nothing if the line comes
// to none. Origins and directions are multiples of irrational numbers, modulo 1, and so fall anywhere.
std::optional<Line> line_at_surface(const compiler::CompiledField& scene, int i, double near,
                                    vm::Workspace& workspace) {
  constexpr int kSteps = 64;
  constexpr glm::dvec3 kAimSteps(0.4503258693318263, 0.3688964747453183, 0.3021964744936211);
  const double n = i;
  const glm::dvec3 share = glm::fract(n * kEvenSteps), aim = glm::fract(n * kAimSteps);
  Line line{scene.contents.lo + share * (scene.contents.hi - scene.contents.lo), glm::normalize(aim - 0.5)};
  for (int step = 0; step < kSteps; ++step) {
    const double distance = std::abs(vm::evaluate_distance(scene.distance, line.origin, workspace));
    if (distance < near) return line;
    line.origin += distance / scene.lipschitz * line.direction;
  }
  return std::nullopt;
}

// Computes Field::max_informative_length by trying lengths, each eight times shorter than the one before.
double max_informative_length(const compiler::CompiledField& scene, double extent) {
  constexpr int kLengths = 14, kLines = 32;
  // kTold: share of the slope's range that the Lipschitz constant alone allows. kNear: share of the extent.
  constexpr double kTold = 0.8, kNear = 1e-4;
  if (scene.certified || scene.contents.empty() || !scene.formula_box.empty())
    return std::numeric_limits<double>::infinity();
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

// Returns the box that regions have to cover.
const compiler::Box& contents_of(const Field& field, const compiler::CompiledField& compiled) {
  return field.bound.finite() ? field.bound : compiled.contents;
}

// Returns RegionOptions::room. A ray may go far from the bounded parts of an unbounded scene, and should find cells
// there. Cells finer than a float resolves would be of no use (kCellMargin in region_splitter.h).
int room_of(const Field& field, const compiler::CompiledField& compiled) {
  constexpr int kMinRoom = 3, kMaxRoom = 6;
  if (field.bound.finite() || compiled.contents.empty()) return 0;
  const glm::dvec3 extents = compiled.contents.hi - compiled.contents.lo;
  const double edge = std::max({extents.x, extents.y, extents.z});
  int room = kMinRoom;
  while (room < kMaxRoom && edge * (1 << room) < 2 * field.far) ++room;
  return room;
}

// Turns off what regions cannot provide, because a large scene takes the same steps with regions as without. Regions
// know the convexity radius only within a cell. They know nothing of the field along a line, and evaluating the whole
// program there costs more than the result saves.
void become_large(Field& field, const FarLevels& levels) {
  field.far_levels = levels;
  field.convex = false;
  if (!field.cells) field.max_informative_length = 0;
}

// Makes marchers step by bounds cell by cell. If nothing else is known of the field's slope, the search in double
// relies on interval arithmetic alone.
void add_cells(Field& field, const compiler::CompiledField& compiled) {
  field.cells = std::make_shared<const SlopeCells>(compiled.distance, compiled.formula_box, compiled.rest_lipschitz);
  if (compiled.certified) {
    // The error of a value is that of its radius times the slope.
    field.value_cancellation += static_cast<double>(field.cells->cancellation()) * compiled.lipschitz;
  } else {
    field.lipschitz = std::numeric_limits<double>::infinity();
    field.inv_lipschitz = 0;
  }
  field.max_informative_length = std::numeric_limits<double>::infinity();
  field.cancellation = std::max(field.cancellation, field.cells->cancellation());
  field.convex = false;
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
  // Distance below which a crossing is tried, as a share of the extent. Smaller: more evaluations near the surface.
  // Larger: a chord shorter than this distance may be missed next to a surface that a ray meets head-on.
  constexpr double kBand = 1e-4;
  // Margin of the bound, as a share of the extent. The bound's surface may be the solid's, and a ray must see both
  // sides of the solid's surface.
  constexpr double kBoundMargin = 1e-3;

  Field field{};
  field.distance = &compiled.distance;
  field.surface = &compiled.surface;
  field.bound = compiled.bound.grown(kBoundMargin * extent);
  field.lipschitz = compiled.lipschitz;
  field.max_informative_length = max_informative_length(compiled, extent);
  field.inv_lipschitz = static_cast<float>(1 / compiled.lipschitz);
  field.cancellation = static_cast<float>(compiled.cancellation);
  field.value_cancellation = static_cast<double>(field.cancellation);
  field.band = static_cast<float>(kBand * extent);
  // Minimum share of convex shapes in the program's cost. Computing the convexity radius pays off when the radius
  // usually exceeds the distance.
  constexpr double kConvexShare = 0.25;
  field.convex = vm::convex_share(compiled.distance) >= kConvexShare;
  // A ray that the bound does not end must end at `far`, because certify() needs an end. No number of a scene is
  // larger.
  constexpr double kFarthest = 1e18;
  const bool bounded = compiled.bound.empty() || compiled.bound.finite();
  field.far = far.value_or(bounded ? std::numeric_limits<double>::infinity() : std::max(kDefaultFar, 1e3 * extent));
  if (!bounded) field.far = std::min(field.far, kFarthest);
  if (!compiled.formula_box.empty()) add_cells(field, compiled);
  const auto regions = plan_regions(compiled.surface, contents_of(field, compiled), room_of(field, compiled));
  if (regions) become_large(field, regions->far);
  return field;
}

void add_regions(Field& field, const compiler::CompiledField& compiled, const RegionOptions& options,
                 RegionStore* store) {
  RegionOptions chosen = options;
  chosen.room = room_of(field, compiled);
  chosen.cancellation = field.cancellation;
  // Steps are shorter by the Lipschitz constant, up to where other limits take over.
  constexpr double kShortest = 16;
  chosen.evaluations *= std::clamp(compiled.lipschitz, 1.0, kShortest);
  const compiler::Box& contents = contents_of(field, compiled);
  field.regions =
      store ? store->build(compiled.surface, contents, chosen) : Regions::build(compiled.surface, contents, chosen);
  if (field.regions) become_large(field, field.regions->far_levels());
}

void add_native_code(Field& field, double evaluations) {
  // Eleven primitives take half a millisecond to compile and then a nanosecond less at each point, a thousand 15 ms
  // and 20 ns (bench_interpreter).
  constexpr double kMinEvaluations = 1e6;
  if (field.regions || evaluations < kMinEvaluations) return;
  using vm::NativeProgram, vm::RecordedResults;
  if (field.has_convexity()) {
    field.native.convex = NativeProgram::compile(*field.distance, RecordedResults::DistanceAndConvexity);
  } else {
    field.native.distance = NativeProgram::compile(*field.distance, RecordedResults::Distance);
  }
  field.native.surface = NativeProgram::compile(*field.surface, RecordedResults::Surface);
}

double Field::rounded(double value, glm::dvec3 point) const {
  if (!far_levels.used()) return value;
  const glm::vec3 p(point);
  return far_levels(value, p.x, p.y, p.z);
}

void Field::evaluate(vm::Points points, std::size_t count, float* out, RegionScratch& scratch,
                     vm::Workspace& workspace) const {
  if (evaluator) return evaluator(points, count, out);
  if (regions) return regions->evaluate(points, count, out, scratch, workspace);
  if (native.distance) {
    native.distance->evaluate(points, count, out);
  } else {
    vm::evaluate_distance(*distance, points, count, out, workspace);
  }
  far_levels.apply(points, count, out);
}

void Field::evaluate_convex(vm::Points points, std::size_t count, float* out, float* convex_radius,
                            vm::Workspace& workspace) const {
  if (native.convex) return native.convex->evaluate(points, count, out, convex_radius);
  vm::evaluate_convex(*distance, points, count, out, convex_radius, workspace);
}

void Field::evaluate_surface(vm::Points points, std::size_t count, vm::SurfaceValues out,
                             vm::Workspace& workspace) const {
  if (regions) return regions->evaluate_surface(points, count, out, workspace);
  if (native.surface) return native.surface->evaluate_surface(points, count, out);
  vm::evaluate_surface(*surface, points, count, out, workspace);
}

double Field::evaluate(glm::dvec3 point, RealScratch& scratch, std::uint64_t& instructions) const {
  if (regions) return regions->evaluate(point, scratch, instructions);
  instructions += distance->instructions();
  return rounded(vm::evaluate_distance(*distance, point, scratch.workspace), point);
}

void Field::evaluate(vm::RealPoints points, std::size_t count, double* out, std::uint64_t* instructions,
                     RealScratch& scratch) const {
  if (!regions) {
    std::fill_n(instructions, count, distance->instructions());
    vm::evaluate_distance(*distance, points, count, out, scratch.workspace);
    for (std::size_t i = 0; i < count; ++i) out[i] = rounded(out[i], {points.x[i], points.y[i], points.z[i]});
    return;
  }
  // Points of different rays share no part of the program, so each point is evaluated alone.
  for (std::size_t i = 0; i < count; ++i) {
    instructions[i] = 0;
    out[i] = regions->evaluate(glm::dvec3(points.x[i], points.y[i], points.z[i]), scratch, instructions[i]);
  }
}

std::optional<vm::AlongLine> Field::along(glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                                          RealScratch& scratch, std::uint64_t& instructions) const {
  instructions += distance->instructions();
  return vm::evaluate_along(*distance, origin, direction, begin, end, scratch.workspace);
}

}  // namespace fathom::runtime
