#include "runtime/region_builder.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "runtime/region_splitter.h"
#include "vm/expression.h"

namespace fathom::runtime {
namespace {

using Node = Regions::Node;
using Kind = Regions::Kind;

// Programs cheaper than this, in multiply-adds, are as fast whole (bench/culling.cpp).
constexpr std::uint64_t kLeastCost = 2500;
// The smallest cells: so many levels below that with as many cells as there are choices.
constexpr int kExtraLevels = 3, kMostLevels = 10;
// The top levels that are a grid, at most; it takes at most this share of the memory, and no more than all else.
constexpr int kMostGridLevel = 6;
constexpr std::size_t kGridShare = 8;

// Whether the operands of some function are both constants; the compiler folds those, and vm/skeleton.h takes it for
// granted.
bool is_unfolded(const vm::Code& code) {
  for (std::size_t at = 0; at < code.size; at += vm::instruction_length(code.words[at])) {
    if (vm::find_opcode(code.words[at] & 0xff)->form != vm::Form::Binary) continue;
    const vm::Sources sources = vm::sources_of(code.words[at]);
    if (sources.a == vm::Source::Constant && sources.b == vm::Source::Constant) return true;
  }
  return false;
}

}  // namespace

RegionBuilder::RegionBuilder(const vm::Code& program, const compiler::Box& contents, double lipschitz,
                             const RegionOptions& options)
    : options_(options), program_(program), contents_(contents), regions_(std::make_shared<Regions>()) {
  regions_->whole_ = program;
  regions_->tree_.lipschitz = static_cast<float>(lipschitz) * 1.000001f;
  regions_->tree_.far = 0.866f * kFar * static_cast<float>(lipschitz);
}

std::shared_ptr<const Regions> RegionBuilder::build() {
  const auto start = std::chrono::steady_clock::now();
  vm::Part& whole = regions_->whole_part_;
  whole = vm::whole(program_);
  vm::Expression expression;
  if ((whole.cost < kLeastCost && !options_.always) || !expression.read(program_) || is_unfolded(program_)) {
    return nullptr;
  }
  choices_ = std::max<std::size_t>(1, expression.choices().size());
  if (!choose_root(contents_)) return nullptr;
  regions_->constants_.emplace(program_);
  const std::size_t fixed_bytes = regions_->constants_->bytes();
  // What takes too much memory is cut into fewer, longer leaves.
  for (;; longer_ *= 2) {
    regions_->nodes_.assign(1, {});
    regions_->pool_.clear(), regions_->skeletons_ = {};
    regions_->facts_ = {};
    bytes_ = fixed_bytes;
    split_all({{{0, 0, 0}, 0, std::numeric_limits<float>::infinity(), 0, whole, 0}});
    if (work_ > kMostWork) return nullptr;
    if (bytes_ <= options_.memory) break;
    if (longer_ > choices_) return nullptr;
  }
  close_outside();
  choose_grid();
  make_grid();
  count_bytes();
  regions_->facts_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return regions_;
}

// A cube round the contents, with room about them; cells are as small as the contents alone warrant.
bool RegionBuilder::choose_root(const compiler::Box& contents) {
  if (contents.empty() || !contents.finite()) return false;
  const glm::dvec3 middle = (contents.lo + contents.hi) / 2.0, extents = contents.hi - contents.lo;
  const double edge = std::max({extents.x, extents.y, extents.z});
  if (!(edge > 0)) return false;
  regions_->tree_.size = static_cast<float>(edge * 1.001 * (1 << options_.room));
  for (int axis = 0; axis < 3; ++axis) {
    regions_->tree_.lo[static_cast<std::size_t>(axis)] =
        static_cast<float>(middle[axis] - static_cast<double>(regions_->tree_.size) / 2);
  }
  const int levels = kExtraLevels + static_cast<int>(std::ceil(std::log2(std::cbrt(static_cast<double>(choices_)))));
  regions_->tree_.levels = std::min(levels, kMostLevels) + options_.room;
  return true;
}

void RegionBuilder::split_all(std::vector<Cell> cells) {
  while (!cells.empty()) {
    std::vector<Piece> pieces(cells.size());
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      Splitter splitter(*this);
      for (std::size_t i = next++; i < cells.size(); i = next++) splitter.run(cells[i], pieces[i]);
    };
    std::vector<std::thread> threads;
    const auto count = std::min<std::size_t>(static_cast<std::size_t>(std::max(1, options_.threads)), cells.size());
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    std::vector<Cell> pending;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::uint32_t first = append(pieces[i]);
      regions_->nodes_[cells[i].node] = make_node(Kind::Inner, first, 0);
      for (Cell& cell : pieces[i].pending) {
        cell.node += first;
        pending.push_back(std::move(cell));
      }
    }
    cells = std::move(pending);
  }
}

// The number its first node gets.
std::uint32_t RegionBuilder::append(Piece& piece) {
  Regions& r = *regions_;
  const auto first = static_cast<std::uint32_t>(r.nodes_.size());
  const auto pool = static_cast<std::uint32_t>(r.pool_.size());
  for (const std::uint32_t at : piece.programs) r.skeletons_.adopt(piece.skeletons, piece.pool.data(), at);
  for (Node node : piece.nodes) {
    if (node.kind() == Kind::Inner) node.ref += first;
    if (node.kind() == Kind::Program) node.ref += pool;
    r.nodes_.push_back(node);
  }
  r.pool_.insert(r.pool_.end(), piece.pool.begin(), piece.pool.end());
  r.facts_.far += piece.facts.far, r.facts_.programs += piece.facts.programs;
  return first;
}

// What matters outside the root, beyond each of its faces: a ray there may step by a tenth of the root's edge at a
// time.
void RegionBuilder::close_outside() {
  Regions& r = *regions_;
  if (options_.room == 0) {  // no ray goes there
    r.outside_.fill(make_node(Kind::Program, Regions::kWhole, std::numeric_limits<float>::infinity()));
    return;
  }
  constexpr std::size_t kFaces = 6;
  const float infinity = std::numeric_limits<float>::infinity();
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
  specialiser.look(r.whole_part_, boxes.view(), workspace);
  const float limit = r.tree_.size / 10 * r.tree_.lipschitz;
  specialiser.decide(-infinity, limit);
  for (std::size_t i = 0; i < kFaces; ++i) {
    vm::Part part;
    specialiser.part(i, part);
    r.outside_[i] = make_node(Kind::Program, r.skeletons_.pack(part, *r.constants_, r.pool_), limit);
  }
}

void RegionBuilder::choose_grid() {
  const std::size_t rest = bytes_, most = std::min({options_.memory / kGridShare, rest, options_.memory - rest});
  const auto bytes = [](int level) { return (sizeof(Node) << level) << 2 * level; };
  int level = std::min(kMostGridLevel, regions_->tree_.levels);
  while (level > 0 && bytes(level) > most) --level;
  regions_->tree_.grid_level = level;
}

// Puts the cells of the grid's level, or the leaves they are in, before the tree's nodes.
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
  r.facts_.levels = r.tree_.levels;
  r.facts_.skeletons = r.skeletons_.size();
  r.constants_->forget_rows();
  r.facts_.bytes = r.nodes_.size() * sizeof(Node) + r.pool_.size() * sizeof(std::uint32_t) + r.skeletons_.bytes() +
                   r.constants_->bytes();
  constexpr std::size_t kCache = 1u << 20;
  r.tree_.beyond_cache = r.facts_.bytes > kCache;
}

std::shared_ptr<const Regions> Regions::build(const vm::Code& program, const compiler::Box& contents,
                                              double lipschitz, const RegionOptions& options) {
  return RegionBuilder(program, contents, lipschitz, options).build();
}

}  // namespace fathom::runtime
