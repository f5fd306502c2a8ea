#include "compiler/analysis/nan_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <vector>

#include "vm/interpret/evaluate.h"
#include "vm/interpret/trace.h"
#include "vm/range/enclose.h"

namespace fathom::compiler {
namespace {

constexpr std::size_t kMaxBoxes = 4096;

// Searches the finite floats of a finite box for a NaN or an infinity. Boxes in which the machine may compute either
// are cut into eight, again and again.
class Search {
 public:
  Search(const vm::VerifiedProgram& program, const Box& box) : program_(program), boxes_{{box}} {}

  std::optional<glm::dvec3> run() {
    for (std::size_t looked = 0; looked < kMaxBoxes && !boxes_.empty(); looked += vm::kEnclosedBoxes) {
      if (const auto point = look()) return point;
    }
    return std::nullopt;
  }

 private:
  // Tests the first boxes of the queue.
  std::optional<glm::dvec3> look() {
    const std::size_t count = std::min(boxes_.size(), vm::kEnclosedBoxes);
    std::array<Box, vm::kEnclosedBoxes> taken;
    for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) taken[i] = boxes_[std::min(i, count - 1)];
    boxes_.erase(boxes_.begin(), boxes_.begin() + static_cast<std::ptrdiff_t>(count));
    enclose(taken);
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(lo_[i]) && std::isfinite(hi_[i])) continue;
      if (const auto point = try_points(taken[i])) return point;
      cut(taken[i]);
    }
    return std::nullopt;
  }

  void enclose(const std::array<Box, vm::kEnclosedBoxes>& taken) {
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
        ends_[0][axis][i] = static_cast<float>(taken[i].lo[axis]);
        ends_[1][axis][i] = static_cast<float>(taken[i].hi[axis]);
      }
    }
    const vm::Boxes boxes{{ends_[0][0].data(), ends_[0][1].data(), ends_[0][2].data()},
                          {ends_[1][0].data(), ends_[1][1].data(), ends_[1][2].data()}};
    vm::enclose(program_, boxes, lo_.data(), hi_.data(), choices_, workspace_);
  }

  // Evaluates the centre, and the corners moved slightly inwards.
  std::optional<glm::dvec3> try_points(const Box& box) {
    std::array<std::array<float, 9>, 3> p;
    std::array<float, 9> value;
    for (std::size_t i = 0; i < 9; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double share = i == 8 ? 0.5 : (i >> axis & 1) != 0 ? 0.99 : 0.01;
        p[static_cast<std::size_t>(axis)][i] =
            static_cast<float>(box.lo[axis] + share * (box.hi[axis] - box.lo[axis]));
      }
    }
    vm::evaluate_distance(program_, {p[0].data(), p[1].data(), p[2].data()}, 9, value.data(), workspace_);
    for (std::size_t i = 0; i < 9; ++i) {
      if (!std::isfinite(value[8 - i])) return glm::dvec3(p[0][8 - i], p[1][8 - i], p[2][8 - i]);
    }
    return std::nullopt;
  }

  void cut(const Box& box) {
    const glm::dvec3 middle = (box.lo + box.hi) * 0.5;
    for (int part = 0; part < 8 && boxes_.size() < kMaxBoxes; ++part) {
      Box next = box;
      for (int axis = 0; axis < 3; ++axis) ((part >> axis & 1) != 0 ? next.lo : next.hi)[axis] = middle[axis];
      boxes_.push_back(next);
    }
  }

  const vm::VerifiedProgram& program_;
  std::deque<Box> boxes_;  // queue, largest boxes first
  alignas(64) std::array<std::array<std::array<float, vm::kEnclosedBoxes>, 3>, 2> ends_;
  alignas(64) std::array<float, vm::kEnclosedBoxes> lo_, hi_;
  std::vector<vm::ChoiceBounds> choices_;
  vm::Workspace workspace_;
};

// Returns the box that rays pass through: a finite scene's bounding box, else the box of its contents and the camera.
Box looked_at(const CompiledField& field, const Camera& camera) {
  if (field.bound.finite()) return field.bound;
  Box box = field.contents;
  for (const glm::dvec3& place : {camera.position, camera.target}) {
    box.lo = box.empty() ? place : glm::min(box.lo, place);
    box.hi = box.empty() ? place : glm::max(box.hi, place);
  }
  return box;
}

// Returns the span of the node that the place's instruction comes from.
Span span_of(const Scene& scene, const Source& source, const NanPlace& place) {
  for (NodeId id = 0; id <= scene.root; ++id) {
    const Span span = scene.graph.origin(id).span;
    const Position at = source.locate(span.begin);
    const bool there = span.end > 0 && at.line == place.line && at.column == place.column;
    if (there && place.operation.ends_with(source.in_import(span.begin))) return span;
  }
  return scene.graph.origin(scene.root).span;
}

}  // namespace

std::optional<NanPlace> explain_nan(const vm::VerifiedProgram& program, glm::dvec3 point) {
  const std::optional<std::size_t> offset = vm::first_not_finite(program, point);
  if (!offset) return std::nullopt;
  NanPlace place{point, "", 0, 0};
  for (const vm::DebugEntry& entry : program.program().debug) {
    if (entry.offset > *offset) break;
    place.operation = entry.symbol, place.line = entry.line, place.column = entry.column;
  }
  return place;
}

std::optional<NanPlace> find_nan(const vm::VerifiedProgram& program, const Box& box) {
  if (box.empty() || !box.finite()) return std::nullopt;
  const std::optional<glm::dvec3> point = Search(program, box).run();
  return point ? explain_nan(program, *point) : std::nullopt;
}

void warn_of_nan(const Scene& scene, const CompiledField& field, const SceneTables& tables, glm::dvec3 origin,
                 const Source& source, Diagnostics& diagnostics) {
  const std::optional<NanPlace> place = find_nan(field.distance, looked_at(field, tables.camera));
  if (!place) return;
  const glm::dvec3 at = place->point + origin;
  diagnostics.warning(
      "W0514", span_of(scene, source, *place),
      fmt::format("no number at {:.4g},{:.4g},{:.4g}: rays that come there see nothing", at.x, at.y, at.z),
      fmt::format("this {} has no value there", place->operation), {kNanRemedy});
}

}  // namespace fathom::compiler
