#include "compiler/derive/formula_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <queue>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/lower/fuse.h"
#include "compiler/lower/lower.h"
#include "compiler/source/limits.h"
#include "vm/interpret/evaluate.h"
#include "vm/program/verify.h"
#include "vm/prune/specialise.h"
#include "vm/range/slope.h"

namespace fathom::compiler {
namespace {

constexpr double kCloseEnough = 1.02;

struct Cell {
  Box box;
  vm::SlopeBound bound;
  std::shared_ptr<const vm::PrunedProgram> part;  // the part of the formula that matters within the box
  // Orders the queue by steepness, steepest on top. Among cells that are equally steep except for rounding the
  // smaller comes first, because it is nearer to the place of that slope. Among jumps the larger comes first, so that
  // the search visits many places before a cell is too small to split.
  bool operator<(const Cell& other) const {
    const auto slope = static_cast<float>(bound.lipschitz), other_slope = static_cast<float>(other.bound.lipschitz);
    if (slope != other_slope) return slope < other_slope;
    return std::isfinite(slope) ? longest_side() > other.longest_side() : longest_side() < other.longest_side();
  }
  double longest_side() const {
    const glm::dvec3 size = box.hi - box.lo;
    return std::max({size.x, size.y, size.z});
  }
};

class Bisection {
 public:
  // `used`: the coordinates that the formula contains. The formula is constant along the others.
  Bisection(const vm::VerifiedProgram& program, const Box& box, std::array<bool, 3> used)
      : length_(static_cast<int>(program.instructions())), cost_(program.cost()), whole_(box), used_(used) {
    add(box, std::make_shared<const vm::PrunedProgram>(vm::whole(program)));
  }

  FormulaBound run(SearchAllowance& allowance) {
    // The number of cells depends on the formula's length: at most a tenth of a second even if no cell's part is
    // shorter. A formula so long that few cells remain gets a second by the cost of its functions.
    const int cells = 4'000'000 / (length_ + 1);
    const bool is_long = cells < kFew;
    const int full = is_long ? std::clamp(static_cast<int>(8'000'000 / (cost_ + 1)), 4, kFew) : std::min(cells, 8192);
    const double price = is_long ? 10 : 1;
    const int budget = static_cast<int>(std::ceil(full * std::min(1.0, allowance.left / (kShare * price))));
    int done = 0;
    for (; done < budget && !cells_.empty(); ++done) {
      const Cell steepest = cells_.top();
      if (steepest.bound.lipschitz <= kCloseEnough * seen_ || !split(steepest)) break;
    }
    allowance.left = std::max(0.0, allowance.left - price * done / full);
    FormulaBound result{kInfinity, -kInfinity, 0, seen_, 0, 0};
    double smallest = kInfinity;
    for (; !cells_.empty(); cells_.pop()) {
      const vm::SlopeBound& b = cells_.top().bound;
      result.least = std::min(result.least, b.value.lo);
      result.most = std::max(result.most, b.value.hi);
      result.lipschitz = std::max(result.lipschitz, b.lipschitz);
      result.float_error = std::max(result.float_error, b.float_error);
      if (std::isfinite(b.lipschitz)) continue;
      result.unbounded_share += share(cells_.top().box);
      if (cells_.top().longest_side() > smallest) continue;
      smallest = cells_.top().longest_side();
      result.unbounded = cells_.top().box;
    }
    return result;
  }

 private:
  // Returns the share of the whole box that a cell fills. Infinite sides are never cut.
  double share(const Box& cell) const {
    double share = 1;
    for (int i = 0; i < 3; ++i) {
      const double side = whole_.hi[i] - whole_.lo[i];
      if (std::isfinite(side) && side > 0) share *= (cell.hi[i] - cell.lo[i]) / side;
    }
    return share;
  }

  // `part`: the part of an enclosing cell.
  void add(const Box& box, std::shared_ptr<const vm::PrunedProgram> part) {
    Cell cell{box, specialiser_.enclose_choices(*part, box.lo, box.hi, workspace_), part};
    if (cell.bound.lipschitz > kCloseEnough * seen_) cell.part = cut(part);
    if (cell.bound.lipschitz > seen_) see(cell);
    cells_.push(std::move(cell));
  }

  // Raises seen_ to the slope in the middle of a cell, evaluated with the cell's part.
  void see(const Cell& cell) {
    const Box& box = cell.box;
    glm::dvec3 middle;
    for (int i = 0; i < 3; ++i) {
      middle[i] = std::isfinite(box.lo[i]) && std::isfinite(box.hi[i]) ? (box.lo[i] + box.hi[i]) / 2
                                                                       : std::clamp(0.0, box.lo[i], box.hi[i]);
    }
    const double slope = glm::length(vm::evaluate_surface(*cell.part, middle, workspace_).gradient);
    if (std::isfinite(slope)) seen_ = std::max(seen_, slope);
  }

  // Specialises the part for the cell that add() has just bounded.
  std::shared_ptr<const vm::PrunedProgram> cut(const std::shared_ptr<const vm::PrunedProgram>& part) {
    if (part->choices == 0) return part;
    specialiser_.resolve(-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity());
    // specialising would remove next to nothing
    if (10 * specialiser_.choices_left(0) > 9 * part->choices) return part;
    auto smaller = std::make_shared<vm::PrunedProgram>();
    specialiser_.prune(0, *smaller);
    return smaller;
  }

  // Returns false if the cell is too small for its slope to be anything except a jump.
  bool split(const Cell& cell) {
    const glm::dvec3 size = cell.box.hi - cell.box.lo, whole = whole_.hi - whole_.lo;
    int axis = -1;
    for (int i = 0; i < 3; ++i) {
      if (!used_[static_cast<std::size_t>(i)]) continue;
      if (std::isfinite(size[i]) && size[i] > 1e-4 * whole[i] && (axis < 0 || size[i] > size[axis])) axis = i;
    }
    if (axis < 0) return false;
    cells_.pop();
    const double middle = (cell.box.lo[axis] + cell.box.hi[axis]) / 2;
    Box lower = cell.box, upper = cell.box;
    lower.hi[axis] = upper.lo[axis] = middle;
    add(lower, cell.part);
    add(upper, cell.part);
    return true;
  }

  static constexpr int kFew = 64;
  static constexpr double kShare = 16;  // a search takes at most a sixteenth of what is left

  const int length_;
  const std::uint32_t cost_;
  const Box whole_;
  const std::array<bool, 3> used_;
  vm::Workspace workspace_;
  vm::Specialiser specialiser_;
  std::priority_queue<Cell> cells_;
  double seen_ = 0;
};

// Points are multiples of irrational numbers, modulo 1. Source: Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences", 2018.
double slope_of_nearest(const vm::VerifiedProgram& program, const Box& box) {
  constexpr std::ptrdiff_t kPoints = 256, kNearest = 16;
  constexpr glm::dvec3 kSteps(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  struct Sample {
    double distance, slope;
  };
  vm::Workspace workspace;
  std::vector<Sample> samples;
  for (std::ptrdiff_t i = 1; i <= kPoints; ++i) {
    const glm::dvec3 share = glm::fract(static_cast<double>(i) * kSteps);
    const vm::SurfaceValue found = vm::evaluate_surface(program, box.lo + share * (box.hi - box.lo), workspace);
    const double slope = glm::length(found.gradient);
    if (slope > 0 && std::isfinite(found.distance)) samples.push_back({std::abs(found.distance) / slope, slope});
  }
  const std::ptrdiff_t nearest = std::min(kNearest, std::ssize(samples)), quartile = 3 * nearest / 4;
  if (nearest == 0) return 0;
  std::ranges::nth_element(samples, samples.begin() + nearest - 1, {}, &Sample::distance);
  std::ranges::nth_element(samples.begin(), samples.begin() + quartile, samples.begin() + nearest, {},
                           &Sample::slope);
  return samples[static_cast<std::size_t>(quartile)].slope;
}

// Returns nullopt if no machine runs the formula. A later step then refuses the scene's program, which contains the
// formula.
std::optional<vm::VerifiedProgram> program_of(const Graph& graph, NodeId formula) {
  const auto longest = static_cast<std::size_t>(limit_row(&Limits::instructions).largest);
  std::optional<vm::Program> program = lower(graph, formula, Source("", ""), longest);
  if (!program) return std::nullopt;
  auto verified = vm::verify(fuse(std::move(*program)), largest_machine());
  if (std::holds_alternative<vm::VerifyError>(verified)) return std::nullopt;
  return std::get<vm::VerifiedProgram>(std::move(verified));
}

std::array<bool, 3> coordinates_of(const Graph& graph, NodeId formula) {
  std::array<bool, 3> used = {false, false, false};
  std::vector<bool> reached(formula + 1, false);
  reached[formula] = true;
  for (NodeId id = formula + 1; id-- > 0;) {
    if (!reached[id]) continue;
    used[0] = used[0] || graph.kind(id) == Kind::X;
    used[1] = used[1] || graph.kind(id) == Kind::Y;
    used[2] = used[2] || graph.kind(id) == Kind::Z;
    for (const NodeId child : graph.children(id)) reached[child] = true;
  }
  return used;
}

}  // namespace

FormulaBound bound_formula(const Graph& graph, NodeId formula, const Box& box, SearchAllowance& allowance) {
  const std::optional<vm::VerifiedProgram> program = program_of(graph, formula);
  if (!program) return {-kInfinity, kInfinity, kInfinity, 0, kInfinity, 1};
  return Bisection(*program, box, coordinates_of(graph, formula)).run(allowance);
}

double slope_at_surface(const Graph& graph, NodeId formula, const Box& box) {
  const std::optional<vm::VerifiedProgram> program = program_of(graph, formula);
  return program && box.finite() ? slope_of_nearest(*program, box) : 0;
}

NodeId find_unbounded(const Graph& graph, NodeId formula, const Box& box) {
  SearchAllowance allowance;
  const Box cell = bound_formula(graph, formula, box, allowance).unbounded;
  if (cell.empty()) return formula;
  vm::Workspace workspace;
  double left = 4e6;  // budget of instructions to evaluate: seconds
  const auto unbounded = [&](NodeId id) {
    const std::optional<vm::VerifiedProgram> program = program_of(graph, id);
    if (!program || (left -= program->instructions()) < 0) return false;
    return !std::isfinite(vm::evaluate_slope(*program, cell.lo, cell.hi, workspace).lipschitz);
  };
  for (NodeId at = formula;;) {
    const std::span<const NodeId> operands = graph.children(at);
    const auto next = std::find_if(operands.begin(), operands.end(), unbounded);
    if (next == operands.end()) return at;
    at = *next;
  }
}

}  // namespace fathom::compiler
