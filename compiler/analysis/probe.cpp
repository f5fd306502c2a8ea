#include "compiler/analysis/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <variant>

#include "compiler/lower/lower.h"
#include "compiler/shapes/node_table.h"
#include "compiler/source/limits.h"
#include "vm/interpret/evaluate.h"
#include "vm/number/real.h"
#include "vm/program/parallel_for.h"
#include "vm/program/verify.h"

namespace fathom::compiler {
namespace {

constexpr double kLargestSide = 1e17;    // a box's coordinates beyond this count as infinite
constexpr std::uint64_t kFewest = 256;   // minimum number of points per row
constexpr std::uint64_t kChunk = 4096;   // points that a thread takes at once
constexpr int kWalk = 3;                 // steps towards the surface
constexpr double kTolerance = 1 + 1e-6;  // allows for rounding in a ratio
constexpr std::uint64_t kLowering = 64;  // cost of lowering an instruction, in runs of it

// SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014), seeded by row and point.
class Random {
 public:
  Random(std::uint64_t row, std::uint64_t point) : state_((row + 1) * 0x9E3779B97F4A7C15u ^ (point << 20)) { next(); }
  double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(next() >> 11) * 0x1p-53; }
  glm::dvec3 direction() {
    const double y = uniform(-1, 1), r = std::sqrt(std::max(0.0, 1 - y * y));
    const auto [sine, cosine] = vm::real::sin_cos_turns(uniform(0, 1));
    return {r * cosine, y, r * sine};
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

Box region(const Box& box, double reach) {
  if (box.empty()) return Box::centred(glm::dvec3(reach));
  Box out;
  for (int i = 0; i < 3; ++i) {
    const bool ends = box.lo[i] > -kLargestSide && box.hi[i] < kLargestSide;
    const double grow = ends ? 0.2 * (box.hi[i] - box.lo[i]) : 0;
    out.lo[i] = box.lo[i] > -kLargestSide ? box.lo[i] - grow : std::min(-reach, box.hi[i] - reach);
    out.hi[i] = box.hi[i] < kLargestSide ? box.hi[i] + grow : std::max(reach, box.lo[i] + reach);
  }
  return out;
}

// Evaluates the points of one row.
class Prober {
 public:
  Prober(const vm::VerifiedProgram& program, const Box& box, std::uint64_t seed, double cancellation)
      : program_(program), box_(box), seed_(seed), magnitude_(cancellation) {
    const glm::dvec3 size = box.hi - box.lo;
    size_ = std::max({size.x, size.y, size.z, 1e-9});
  }

  // Adds the results of points [first, last) to `row`.
  void run(std::uint64_t first, std::uint64_t last, ProbeRow& row) {
    for (std::uint64_t i = first; i < last; ++i) {
      Random random(seed_, i);
      glm::dvec3 p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(box_.lo[axis], box_.hi[axis]);
      vm::SurfaceValue value = look(p, row);
      for (int step = 0; i % 2 == 1 && step < kWalk; ++step) {
        const double slope2 = glm::dot(value.gradient, value.gradient);
        if (!(slope2 > 1e-12) || !std::isfinite(value.distance)) break;
        const glm::dvec3 move = value.gradient * (value.distance / slope2);
        if (!(glm::dot(move, move) < size_ * size_)) break;
        p -= move;
        value = look(p, row);
      }
      const double length = size_ * vm::real::pow(10, random.uniform(-5, -1));
      compare(p, value.distance, p + random.direction() * length, row);
    }
    row.points += last - first;
  }

 private:
  vm::SurfaceValue look(glm::dvec3 p, ProbeRow& row) {
    const vm::SurfaceValue value = vm::evaluate_surface(program_, p, workspace_);
    const double slope = glm::length(value.gradient);
    if (std::isnan(value.distance) || std::isnan(slope)) ++row.invalid;
    if (slope > row.gradient) {
      if (slope > row.seen()) row.at = p;
      row.gradient = slope;
    }
    return value;
  }

  void compare(glm::dvec3 p, double at_p, glm::dvec3 q, ProbeRow& row) {
    const double at_q = vm::evaluate_distance(program_, q, workspace_);
    // Allows for rounding in double: a thousand roundings of the largest number involved.
    const double rounding = 1e3 * 0x1p-53 * (std::max({1.0, glm::length(p), std::abs(at_p)}) + magnitude_);
    const double quotient = (std::abs(at_p - at_q) - rounding) / glm::length(p - q);
    if (quotient > row.quotient) {
      if (quotient > row.seen()) row.at = p;
      row.quotient = quotient;
    }
  }

  const vm::VerifiedProgram& program_;
  const Box box_;
  const std::uint64_t seed_;
  const double magnitude_;
  double size_;
  vm::Workspace workspace_;
};

// Adds the results of other points of the row; `more` holds later points.
void merge(ProbeRow& row, const ProbeRow& more) {
  if (more.seen() > row.seen()) row.at = more.at;
  row.gradient = std::max(row.gradient, more.gradient);
  row.quotient = std::max(row.quotient, more.quotient);
  row.points += more.points;
  row.invalid += more.invalid;
}

class Probing {
 public:
  Probing(const Scene& scene, const ProbeOptions& options) : field_(scene), options_(options) {}

  const FieldGraph& field() const { return field_; }

  // Adds a row. The row of the whole scene sets the instruction budget, and each later row takes its part of it.
  void add(ProbeRow::What what, NodeId id, std::uint64_t points, std::vector<ProbeRow>& rows) {
    const NodeFacts& known = field_.known(id);
    ProbeRow& row = rows.emplace_back(ProbeRow{what, id, field_.place(id), known.certified, known.lipschitz});
    const bool first = what == ProbeRow::What::Scene;
    const auto allowed = static_cast<std::uint64_t>(Limits{}.instructions);
    const std::uint64_t most = first ? allowed : std::min(allowed, left_ / (points + kLowering));
    const std::optional<vm::Program> program = lower(field_.graph(), id, Source("", ""), most);
    const std::uint64_t length = program ? program->debug.size() : 0;
    if (first) left_ = std::max(options_.min_work, points * length);
    // Lowering visits all nodes up to this one.
    if (!first) take(id + (program ? (points + kLowering) * length : kLowering * most));
    if (!program) return;
    const auto verified = vm::verify(*program, largest_machine());
    if (const auto* sound = std::get_if<vm::VerifiedProgram>(&verified)) run(*sound, points, row);
  }

 private:
  // Runs the points in chunks. Each chunk has its own row, and the rows are merged in order.
  void run(const vm::VerifiedProgram& program, std::uint64_t points, ProbeRow& row) const {
    const NodeFacts& known = field_.known(row.node);
    // Nodes below a transform have a zero of their own.
    const glm::dvec3 zero = row.what == ProbeRow::What::Node ? glm::dvec3(0) : options_.origin;
    const Box box = region(known.box.moved(-zero), options_.reach).moved(zero);
    const std::uint64_t chunks = (points + kChunk - 1) / kChunk;
    ProbeRow blank = row;
    blank.place = {};
    std::vector<ProbeRow> parts(chunks, blank);
    parallel_for(
        options_.threads, chunks, [&] { return Prober(program, box, row.node, known.cancellation); },
        [&](Prober& prober, std::size_t c) { prober.run(c * kChunk, std::min(points, (c + 1) * kChunk), parts[c]); });
    for (const ProbeRow& part : parts) merge(row, part);
  }

  void take(std::uint64_t work) { left_ -= std::min(left_, work); }

  const FieldGraph field_;
  const ProbeOptions options_;
  std::uint64_t left_ = 0;  // instructions left to the rows to come
};

bool has_own_proof(const FieldGraph& field, NodeId id) {
  const Kind kind = field.graph().kind(id);
  return kind != Kind::Scaled && (field.cost(id) > 1 + 1e-9 || kind == Kind::Bounded || spec(kind).derive != nullptr);
}

// [node] true if a node below is broken.
std::vector<bool> broken_below(const FieldGraph& field, const std::vector<ProbeRow>& rows) {
  std::vector<bool> broken(field.root() + 1, false), below(field.root() + 1, false);
  for (const ProbeRow& row : rows) broken[row.node] = broken[row.node] || row.broken();
  for (NodeId id = 0; id <= field.root(); ++id) {
    if (!field.reached(id)) continue;
    for (const NodeId child : field.children(id)) below[id] = below[id] || below[child] || broken[child];
  }
  return below;
}

}  // namespace

bool ProbeRow::broken() const { return certified && seen() > declared * kTolerance; }

std::vector<ProbeRow> probe(const Scene& scene, const std::vector<Surface>& surfaces, const ProbeOptions& options) {
  using What = ProbeRow::What;
  Probing probing(scene, options);
  const FieldGraph& field = probing.field();
  std::vector<std::pair<What, NodeId>> others;
  std::vector<bool> taken(field.root() + 1, false);
  taken[field.root()] = true;
  for (const NodeId object : field.objects(surfaces)) {
    if (object == field.root() || taken[object]) continue;
    others.push_back({What::Object, object});
    taken[object] = true;
  }
  for (NodeId id = 0; id < field.root(); ++id) {
    if (!field.reached(id) || taken[id] || !has_own_proof(field, id)) continue;
    others.push_back({What::Node, id});
    taken[id] = true;
  }
  std::vector<ProbeRow> rows;
  probing.add(What::Scene, field.root(), options.points, rows);
  const std::uint64_t share = std::max(kFewest, options.points / std::max<std::size_t>(others.size(), 1));
  for (const auto& [what, id] : others) probing.add(what, id, std::min(share, options.points), rows);

  // Probes every node below a broken row that no probed node below accounts for.
  const std::vector<bool> below = broken_below(field, rows);
  std::vector<bool> suspect(field.root() + 1, false);
  for (const ProbeRow& row : rows) {
    if (!row.broken() || below[row.node]) continue;
    for (const NodeId child : field.children(row.node)) suspect[child] = true;
  }
  for (NodeId id = field.root() + 1; id-- > 0;) {
    if (!suspect[id]) continue;
    for (const NodeId child : field.children(id)) suspect[child] = true;
  }
  for (NodeId id = 0; id < field.root(); ++id) {
    if (suspect[id] && !taken[id]) probing.add(What::Node, id, std::min(share, options.points), rows);
  }
  return rows;
}

std::vector<const ProbeRow*> culprits(const Scene& scene, const std::vector<ProbeRow>& rows) {
  const FieldGraph field(scene);
  const std::vector<bool> below = broken_below(field, rows);
  std::vector<const ProbeRow*> found;
  for (const ProbeRow& row : rows) {
    if (row.broken() && !below[row.node]) found.push_back(&row);
  }
  return found;
}

}  // namespace fathom::compiler
