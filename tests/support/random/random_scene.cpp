#include "tests/support/random/random_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/derive/formula_field.h"
#include "compiler/shapes/make_node.h"
#include "tests/support/random/random_shapes.h"
#include "vm/program/check.h"

namespace fathom::test {
namespace {

using compiler::Graph;
using compiler::Kind;
using compiler::NodeId;
using glm::dvec3;

// Builds nodes bottom up and remembers them, so that some are shared.
class Maker {
 public:
  Maker(Graph& graph, Random& random, const GraphOptions& options)
      : graph_(graph), maker_(graph), random_(random), options_(options) {}

  NodeId make(int depth) {
    if (!made_.empty() && random_.chance(0.15)) {
      return made_[static_cast<std::size_t>(random_.below(static_cast<int>(made_.size())))];
    }
    const NodeId id = depth == 0 || random_.chance(0.1) ? primitive() : operation(depth);
    made_.push_back(id);
    return id;
  }

 private:
  NodeId add(Kind kind, const std::vector<double>& params, const std::vector<NodeId>& children) {
    return maker_.make(kind, params, children);
  }

  NodeId primitive() {
    if (options_.formulas && random_.chance(0.1)) {
      // One declarator after the other, because compilers evaluate arguments in different orders.
      const double z = random_.length(0.3, 2), y = random_.length(0.3, 2), x = random_.length(0.3, 2);
      const dvec3 half(x, y, z);
      return compiler::make_bounded(maker_, random_formula(maker_, random_), {-half, half}, {}, allowance_);
    }
    if (options_.outlines && random_.chance(0.2)) return of_outline();
    const std::vector<Kind> kinds = primitive_kinds(compiler::Sort::Solid, options_.mandelbulbs);
    Kind kind;
    do {
      kind = kinds[static_cast<std::size_t>(random_.below(static_cast<int>(kinds.size())))];
    } while (!options_.planes && !compiler::spec(kind).bound(random_params(kind, random_)).finite());
    return add(kind, random_params(kind, random_), {});
  }

  NodeId of_outline() {
    const NodeId shape = outline(2);
    if (random_.chance(0.5)) return add(Kind::Extrude, {random_.length(0.05, 1.5)}, {shape});
    return add(Kind::Revolve, {random_.chance(0.3) ? 0 : random_.uniform(-1, 2)}, {shape});
  }

  NodeId outline(int depth) {
    const int choice = depth == 0 ? 5 : random_.below(10);
    if (choice <= 1) {
      const NodeId inner = outline(depth - 1);
      return add(choice == 0 ? Kind::Round : Kind::Onion, {random_.length(0.01, 0.3)}, {inner});
    }
    if (choice == 2) {
      const double scale = random_.length(0.5, 2), angle = random_.uniform(-4, 4);
      const double y = random_.uniform(-1, 1), x = random_.uniform(-1, 1);
      const dvec3 move(x, y, 0);
      return add(Kind::Transform, transform_params(dvec3(scale), {0, 0, 1}, angle, move), {outline(depth - 1)});
    }
    if (choice <= 4) {
      const NodeId a = outline(depth - 1), b = outline(depth - 1);
      return add(choice == 3 ? Kind::Union : Kind::Subtraction, {}, {a, b});
    }
    const std::vector<Kind> kinds = primitive_kinds(compiler::Sort::Outline, false);
    const Kind kind = kinds[static_cast<std::size_t>(random_.below(static_cast<int>(kinds.size())))];
    return add(kind, random_params(kind, random_), {});
  }

  NodeId operation(int depth) {
    const int choice = random_.below(9);
    if (choice >= 6) return combinator(depth);
    const NodeId child = make(depth - 1);
    if (choice == 0) return add(Kind::Round, {random_.length(0.01, 0.3)}, {child});
    if (choice == 1) return add(Kind::Onion, {random_.length(0.01, 0.3)}, {child});
    if (choice == 2 && options_.paints) return add(Kind::Paint, {1.0 + random_.below(6)}, {child});
    if (choice == 3 && options_.formulas) return displaced(child);
    if (choice == 4 && options_.bends) return random_domain_node(maker_, random_, child);
    return transform(child);
  }

  // Displaces the child's surface by a formula. Returns the child itself if the compiler cannot prove a slope bound.
  NodeId displaced(NodeId child) {
    const std::vector<NodeId> operands = {child, random_formula(maker_, random_)};
    const NodeId id = compiler::make_field(maker_, Kind::Displacement, {}, operands, {}, allowance_);
    return maker_.known(id).certified ? id : child;
  }

  NodeId transform(NodeId child) {
    dvec3 scale(1);
    if (random_.chance(0.4)) scale = dvec3(random_.length(0.25, 4));
    if (options_.squash && random_.chance(0.25)) {
      scale = {random_.length(0.4, 2.5), random_.length(0.4, 2.5), random_.length(0.4, 2.5)};
    }
    const double angle = random_.chance(0.6) ? random_.uniform(-std::numbers::pi, std::numbers::pi) : 0;
    const dvec3 move = random_.chance(0.8) ? random_.in_box(2) : dvec3(0);
    return add(Kind::Transform, transform_params(scale, random_.direction(), angle, move), {child});
  }

  NodeId combinator(int depth) {
    const Kind kinds[] = {Kind::Union,       Kind::Intersection,       Kind::Subtraction,
                          Kind::SmoothUnion, Kind::SmoothIntersection, Kind::SmoothSubtraction};
    Kind kind = kinds[random_.below(6)];
    int operands = 1 + random_.below(4);
    if (options_.bends && random_.chance(0.3)) {
      const int first = static_cast<int>(Kind::ChamferUnion);
      kind = static_cast<Kind>(first + random_.below(static_cast<int>(Kind::Morph) - first + 1));
      if (random_.chance(0.1)) kind = Kind::Xor;
      operands = 2;
    }
    std::vector<double> params;
    if (kind >= Kind::SmoothUnion) params.push_back(random_.chance(0.2) ? 0 : random_.length(0.01, 1));
    if (kind >= Kind::StairsUnion && kind <= Kind::StairsSubtraction) params.push_back(1 + random_.below(5));
    std::vector<NodeId> children;
    for (int i = operands; i > 0; --i) children.push_back(make(depth - 1));
    return add(kind, params, children);
  }

  Graph& graph_;
  compiler::NodeMaker maker_;
  compiler::SearchAllowance allowance_;
  Random& random_;
  const GraphOptions& options_;
  std::vector<NodeId> made_;
};

}  // namespace

std::uint64_t Random::bits() {
  std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
  if (draws_.size() >= 2) {
    z = (draws_[0] + 256u * draws_[1] + 1) * 0x9E3779B97F4A7C15u;
    draws_ = draws_.subspan(2);
  }
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}
double Random::uniform(double lo, double hi) {
  return lo + (hi - lo) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}
double Random::length(double lo, double hi) { return rounded(std::exp(uniform(std::log(lo), std::log(hi)))); }
int Random::below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
dvec3 Random::in_box(double half) {
  const double x = rounded(uniform(-half, half)), y = rounded(uniform(-half, half));
  return {x, y, rounded(uniform(-half, half))};
}
dvec3 Random::direction() {
  for (;;) {
    const dvec3 v = in_box(1);
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1) return v / length;
  }
}

std::vector<Kind> primitive_kinds(compiler::Sort sort, bool estimates) {
  std::vector<Kind> kinds;
  for (const compiler::NodeSpec& row : compiler::node_table()) {
    if (row.category != compiler::Category::Primitive || row.sort != sort || row.code == nullptr) continue;
    if (estimates || row.facts.outside != compiler::Exactness::Estimate) kinds.push_back(row.kind);
  }
  return kinds;
}

std::vector<double> plain_params(const compiler::NodeSpec& row, Random& random) {
  const auto number = [&](const compiler::ParamSpec& param) {
    if (param.type == compiler::ParamType::Integer) return 1.0 + random.below(12);
    if (param.rule == compiler::Rule::NotNegative && random.chance(0.2)) return 0.0;
    const bool length = param.rule == compiler::Rule::Positive || param.rule == compiler::Rule::NotNegative;
    return length ? random.length(0.05, 1.5) : rounded(random.uniform(-1.5, 1.5));
  };
  for (;;) {
    std::vector<double> params;
    for (const compiler::ParamSpec& param : row.params) {
      CHECK(param.type != compiler::ParamType::Points, "a primitive with a fixed number of parameters");
      for (int i = 0; i < compiler::width(param.type); ++i) params.push_back(number(param));
    }
    if (!row.check || !row.check(params)) return params;
  }
}

std::vector<double> random_params(Kind kind, Random& random) {
  if (compiler::spec(kind).sort == compiler::Sort::Outline) return random_outline_params(kind, random);
  return random_solid_params(kind, random);
}

NodeId random_formula(compiler::NodeMaker& maker, Random& random) {
  const auto number = [&](double value) { return maker.make(Kind::Constant, std::vector<double>{value}, {}); };
  const auto of = [&](Kind kind, std::vector<NodeId> operands) { return maker.make(kind, {}, operands); };
  const auto coordinate = [&] { return of(static_cast<Kind>(static_cast<int>(Kind::X) + random.below(3)), {}); };
  const auto times = [&](NodeId a, double by) { return of(Kind::Multiply, {a, number(by)}); };
  const auto wave = [&] {
    const double frequency = random.length(0.5, 8);
    return of(Kind::Sin, {times(coordinate(), frequency)});
  };
  NodeId formula = 0;
  Random other = random;  // a copy: draws for noise leave the later draws unchanged
  switch (random.below(4)) {
    case 0: {
      // Rare, because bounding the slope of noise takes a hundred times as long as bounding other formulas.
      const bool noisy = other.chance(0.5) && other.chance(0.3);
      const NodeId a = wave(), b = wave(), c = wave();
      formula = noisy ? of(Kind::Noise, {times(a, 3), b, c}) : of(Kind::Add, {a, of(Kind::Multiply, {b, c})});
      break;
    }
    case 1:
      formula = of(Kind::Minus, {of(Kind::Abs, {coordinate()}), number(random.length(0.1, 1))});
      break;
    case 2:
      formula = of(Kind::Maximum, {coordinate(), of(Kind::Minus, {wave(), coordinate()})});
      break;
    default:
      formula = of(Kind::Minus, {of(Kind::Add, {of(Kind::Square, {coordinate()}), of(Kind::Square, {coordinate()})}),
                                 number(random.length(0.1, 1))});
      break;
  }
  return times(formula, random.length(0.003, 2));
}

NodeId random_domain_node(compiler::NodeMaker& maker, Random& random, NodeId child) {
  const auto size = [&] { return random.length(0.05, 1.5); };
  const auto maybe = [&](double x) { return random.chance(0.5) ? x : 0.0; };
  Kind kind = Kind::Mirror;
  std::vector<double> params;
  switch (random.below(9)) {
    case 0: {
      const dvec3 n = random.chance(0.5) ? dvec3(random.chance(0.5) ? 1 : -2, 0, 0) : random.direction();
      params = {n.x, n.y, n.z, maybe(random.uniform(-1, 1))};
      break;
    }
    case 1:
      kind = Kind::Elongate;
      params = {size(), maybe(size()), maybe(size())};
      break;
    case 2:
    case 3: {
      kind = Kind::Repetition;
      const double jitter = random.chance(0.3) ? random.length(0.01, 0.3) : 0;  // along some of the axes
      params = {random.length(0.5, 5), maybe(random.length(0.5, 5)), maybe(random.length(0.5, 5))};
      for (int i = 0; i < 3; ++i) params.push_back(random.below(6));
      params.insert(params.end(), {maybe(jitter), maybe(jitter), maybe(jitter)});
      break;
    }
    case 4:
      kind = Kind::PolarRepetition;
      params = {1.0 + random.below(24)};
      break;
    case 5:
      kind = Kind::Shear;
      params = {random.uniform(-1, 1), random.uniform(-1, 1)};
      break;
    case 6:
      kind = Kind::Twist;
      params = {random.uniform(-90, 90)};
      break;
    case 7:
      kind = Kind::Bend;
      params = {random.uniform(-40, 40)};
      break;
    default:
      kind = Kind::Taper;
      params = {random.length(0.3, 2), random.length(0.3, 2), size()};
      break;
  }
  const NodeId only[] = {child};
  if (maker.complaint(kind, params, only)) return child;
  // The program grows with the number of copies; 16 are enough for tests.
  const compiler::NodeSpec& row = compiler::spec(kind);
  if (kind == Kind::Repetition) {
    const compiler::NodeFacts known[] = {maker.known(child)};
    if (row.code(row.with_derived(params, known)).points.size() > 16) return child;
  }
  return maker.make(kind, params, only);
}

compiler::Scene random_scene(Random& random, const GraphOptions& options) {
  compiler::Scene scene;
  scene.root = Maker(scene.graph, random, options).make(options.depth);
  return scene;
}

// child = S^-1 R^T (p - t), with R by Rodrigues' formula R = cos I + (1 - cos) a a^T + sin [a]x.
std::vector<double> transform_params(dvec3 scale, dvec3 axis, double angle, dvec3 translate) {
  const dvec3 a = glm::normalize(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  const double cross[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
  std::vector<double> params;
  for (int row = 0; row < 3; ++row) {
    double offset = 0;
    for (int column = 0; column < 3; ++column) {
      const double r = (row == column ? c : 0) + (1 - c) * a[column] * a[row] + s * cross[column][row];
      params.push_back(r / scale[row]);
      offset -= r / scale[row] * translate[column];
    }
    params.push_back(offset);
  }
  params.push_back(std::min({scale.x, scale.y, scale.z}));
  return params;
}

compiler::Scene single(Kind kind, const std::vector<double>& params) {
  compiler::Scene scene;
  scene.root = compiler::NodeMaker(scene.graph).make(kind, params, {});
  return scene;
}

}  // namespace fathom::test
