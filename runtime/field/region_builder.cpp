#include "runtime/field/region_builder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "runtime/field/region_forecast.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

using Node = Regions::Node;
using Kind = Regions::Kind;

// A grid replaces at most this many of the top levels. The grid takes at most a kGridShare-th of the memory, and no
// more bytes than everything else together.
constexpr int kMaxGridLevel = 6;
constexpr std::size_t kGridShare = 8;
// Bytes per word of the whole program, as a part and as rows of constants.
constexpr std::size_t kBytesPerWord = 24;
// Bytes needed for cutting a program (vm/prune/specialise.h), per choice and per instruction of the program,
// measured.
constexpr std::size_t kBytesPerChoice = 448, kBytesPerInstruction = 64;
// Maximum number of instructions evaluated by intervals: minutes', relative to the forecast, and as a share of the
// evaluations' cost.
constexpr double kMaxWork = 3e8, kMaxSurprise = 3, kMaxShare = 0.5;
// Share of the evaluations' cost that building may take even where the forecast sees nothing to build.
constexpr double kFewShare = 0.02;
// Maximum share of the evaluations' cost that the forecast may cost.
constexpr double kSurveyShare = 0.04;
// Distance outside the root up to which rays are followed, in edges of the root.
constexpr float kOutsideSize = 64;

// Returns the bytes needed for cutting a program, with the parts for the eight children of a cell.
std::size_t cutting_bytes(std::size_t choices, std::size_t instructions, std::size_t part) {
  return choices * kBytesPerChoice + instructions * kBytesPerInstruction + 8 * part;
}

}  // namespace

RegionBuilder::RegionBuilder(const vm::Code& program, const RegionPlan& plan, const RegionOptions& options)
    : options_(options),
      plan_(plan),
      program_(program),
      budget_{options.memory, static_cast<std::size_t>(kMaxWork)},
      regions_(std::make_shared<Regions>()) {
  regions_->whole_ = program;
  regions_->far_ = plan.far;
  std::copy(plan.lo.begin(), plan.lo.end(), regions_->tree_.lo);
  regions_->tree_.size = plan.size;
  regions_->tree_.levels = plan.levels;
}

std::shared_ptr<const Regions> RegionBuilder::build() {
  const auto start = std::chrono::steady_clock::now();
  if (program_.size * kBytesPerWord > options_.memory) return nullptr;
  if (cutting_bytes(plan_.choices, plan_.instructions, 0) > budget_.build_memory()) return nullptr;
  regions_->whole_part_ = vm::whole(program_);
  regions_->constants_.emplace(program_);
  if (!split_root()) return nullptr;
  close_outside();
  choose_grid();
  make_grid();
  count_bytes();
  regions_->summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return regions_;
}

// Returns the maximum number of instructions to evaluate by intervals, given the forecast of that number.
double RegionBuilder::max_work(double forecast) const {
  if (!std::isfinite(options_.evaluations)) return kMaxWork;
  const double instructions = static_cast<double>(plan_.instructions);
  const double affordable = options_.evaluations * instructions / kCutCost;
  return std::min({kMaxWork, kMaxShare * affordable, std::max(kMaxSurprise * forecast, kFewShare * affordable)});
}

// Splits the root. When an attempt exceeds the memory, the next one makes fewer, longer leaves with the work that is
// left.
bool RegionBuilder::split_root() {
  const double survey_cost = kCutCost * RegionSurvey::cost(regions_->tree_, plan_.instructions);
  if (survey_cost > kSurveyShare * options_.evaluations * static_cast<double>(plan_.instructions)) return false;
  const SplitRules rules{options_, regions_->tree_, regions_->far_, *regions_->constants_, 1};
  const RegionSurvey survey(regions_->whole_part_, rules, budget_);
  const std::optional<RegionForecast> forecast = survey.best();
  if (!forecast) return false;
  const float all = std::numeric_limits<float>::infinity();
  double left = max_work(forecast->work);
  for (choice_factor_ = forecast->choice_factor; allows_leaves(choice_factor_, plan_.choices); choice_factor_ *= 2) {
    if (!survey.pays(survey.forecast(choice_factor_))) return false;
    budget_.max_work = static_cast<std::size_t>(left);
    regions_->nodes_.assign(1, {});
    regions_->pool_ = {}, regions_->templates_ = {};
    regions_->summary_ = {};
    budget_.bytes = regions_->constants_->bytes();
    budget_.work = 0, budget_.pending_bytes = 0;
    split_all({{{0, 0, 0}, 0, all, 0, regions_->whole_part_, 0}});
    if (budget_.interrupted) return false;
    if (!budget_.is_spent()) return true;
    left -= static_cast<double>(budget_.work);
    if (left < static_cast<double>(plan_.instructions)) return false;
  }
  return false;
}

// Returns the max number of threads that the memory suffices for, when each cuts the largest of the cells' parts.
int RegionBuilder::threads_for(const std::vector<RegionCell>& cells) const {
  std::size_t largest = 0;
  for (const RegionCell& cell : cells) {
    largest = std::max(largest, cutting_bytes(cell.part.choices, cell.part.sources.size(), cell.part.bytes()));
  }
  const std::size_t affordable = std::max<std::size_t>(1, budget_.build_memory() / std::max<std::size_t>(1, largest));
  return static_cast<int>(std::min(static_cast<std::size_t>(std::max(1, options_.threads)), affordable));
}

void RegionBuilder::split_all(std::vector<RegionCell> cells) {
  const SplitRules rules{options_, regions_->tree_, regions_->far_, *regions_->constants_, choice_factor_};
  while (!cells.empty() && !budget_.is_spent()) {
    std::vector<RegionPiece> pieces(cells.size());
    budget_.pending_bytes = 0;
    parallel_for(
        threads_for(cells), cells.size(), [&] { return RegionSplitter(rules, budget_); },
        [&](RegionSplitter& splitter, std::size_t i) {
          splitter.run(cells[i], pieces[i]);
          cells[i].part = {};
        });
    regions_->summary_.building = std::max<std::size_t>(regions_->summary_.building, budget_.pending_bytes);
    if (budget_.is_spent()) return;
    append_all(cells, pieces);
  }
}

// Appends the pieces in the order of the cells. The cells still to be split then take the place of `cells`.
void RegionBuilder::append_all(std::vector<RegionCell>& cells, std::vector<RegionPiece>& pieces) {
  std::size_t nodes = regions_->nodes_.size(), words = regions_->pool_.size();
  for (const RegionPiece& piece : pieces) nodes += piece.nodes.size(), words += piece.pool.size();
  regions_->nodes_.reserve(nodes), regions_->pool_.reserve(words);
  std::vector<RegionCell> pending;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t first = append(pieces[i]);
    regions_->nodes_[cells[i].node] = make_node(Kind::Inner, first, 0);
    for (RegionCell& cell : pieces[i].pending) {
      cell.node += first;
      pending.push_back(std::move(cell));
    }
    pieces[i] = {};
  }
  cells = std::move(pending);
}

// Returns the index that the piece's first node gets.
std::uint32_t RegionBuilder::append(RegionPiece& piece) {
  Regions& r = *regions_;
  const auto first = static_cast<std::uint32_t>(r.nodes_.size());
  const auto pool = static_cast<std::uint32_t>(r.pool_.size());
  for (const std::uint32_t at : piece.programs) r.templates_.renumber(piece.program_templates, piece.pool.data(), at);
  for (Node node : piece.nodes) {
    if (node.kind() == Kind::Inner) node.ref += first;
    if (node.kind() == Kind::Program) node.ref += pool;
    r.nodes_.push_back(node);
  }
  r.pool_.insert(r.pool_.end(), piece.pool.begin(), piece.pool.end());
  r.summary_.far += piece.summary.far, r.summary_.programs += piece.summary.programs;
  return first;
}

// Makes the leaves outside the root, one beyond each of its faces, where the cap is at its maximum.
void RegionBuilder::close_outside() {
  Regions& r = *regions_;
  const float infinity = std::numeric_limits<float>::infinity();
  r.outside_.fill(make_node(Kind::Program, Regions::kWhole, infinity));
  if (plan_.room == 0) return;  // no ray goes there
  BoxArrays boxes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::fill_n(boxes.lo[axis], vm::kEnclosedBoxes, -infinity);
    std::fill_n(boxes.hi[axis], vm::kEnclosedBoxes, infinity);
    const float margin = r.tree_.size * static_cast<float>(kCellMargin), near = r.tree_.lo[axis];
    boxes.hi[axis][2 * axis] = near + margin;
    boxes.lo[axis][2 * axis + 1] = near + r.tree_.size - margin;
  }
  vm::Specialiser specialiser;
  vm::Workspace workspace;
  specialiser.enclose_choices(r.whole_part_, boxes.view(), workspace);
  specialiser.resolve(-infinity, r.far_.most, kCellError * (kOutsideSize * r.tree_.size + options_.cancellation));
  for (std::size_t i = 0; i < r.outside_.size(); ++i) {
    vm::PrunedProgram part;
    specialiser.prune(i, part);
    r.outside_[i] = make_node(Kind::Program, r.templates_.pack(part, *r.constants_, r.pool_), r.far_.most);
  }
}

void RegionBuilder::choose_grid() {
  const std::size_t rest = budget_.bytes,
                    most = std::min({options_.memory / kGridShare, rest, options_.memory - rest});
  const auto bytes = [](int level) { return (sizeof(Node) << level) << 2 * level; };
  int level = std::min(kMaxGridLevel, regions_->tree_.levels);
  while (level > 0 && bytes(level) > most) --level;
  regions_->tree_.grid_level = level;
}

// Puts the nodes of the grid's cells, which are nodes of the grid's level or the leaves above it, before the tree's
// nodes.
void RegionBuilder::make_grid() {
  Regions& r = *regions_;
  r.tree_.scale = static_cast<float>(1u << r.tree_.levels) / r.tree_.size;
  const std::uint32_t edge = 1u << r.tree_.grid_level;
  std::vector<Node> all(std::size_t{edge} * edge * edge);
  all.reserve(all.size() + r.nodes_.size());
  const auto first = static_cast<std::uint32_t>(all.size());
  for (std::uint32_t i = 0; i < first; ++i) {
    const std::uint32_t cell[3] = {i % edge, i / edge % edge, i / edge / edge};
    std::uint32_t index = 0;
    for (int shift = r.tree_.grid_level; shift > 0 && r.nodes_[index].kind() == Kind::Inner;) {
      --shift;
      index = r.nodes_[index].payload() +
              ((cell[0] >> shift & 1) | (cell[1] >> shift & 1) << 1 | (cell[2] >> shift & 1) << 2);
    }
    all[i] = r.nodes_[index];
  }
  all.insert(all.end(), r.nodes_.begin(), r.nodes_.end());
  for (Node& node : all) {
    if (node.kind() == Kind::Inner) node.ref += first;
  }
  r.nodes_ = std::move(all);
  r.pool_.shrink_to_fit();
  static_assert(sizeof(Node) == 2 * sizeof(std::uint32_t));
  r.tree_.nodes = reinterpret_cast<const std::uint32_t*>(r.nodes_.data());
}

void RegionBuilder::count_bytes() {
  Regions& r = *regions_;
  r.summary_.levels = r.tree_.levels;
  r.summary_.program_templates = r.templates_.size();
  r.constants_->forget_rows();
  r.summary_.bytes = r.nodes_.size() * sizeof(Node) + r.pool_.size() * sizeof(std::uint32_t) + r.templates_.bytes() +
                     r.constants_->bytes();
  constexpr std::size_t kCache = 1u << 20;
  r.tree_.beyond_cache = r.summary_.bytes > kCache;
}

std::shared_ptr<const Regions> Regions::build(const vm::Code& program, const compiler::Box& contents,
                                              const RegionOptions& options) {
  const std::optional<RegionPlan> plan = plan_regions(program, contents, options.room, options.always);
  return plan ? RegionBuilder(program, *plan, options).build() : nullptr;
}

}  // namespace fathom::runtime
