#include "runtime/region_builder.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "runtime/field.h"
#include "vm/expression.h"

namespace fathom::runtime {
namespace {

using Node = Regions::Node;
using Kind = Regions::Kind;

// Programs cheaper than this, in multiply-adds, are as fast whole (bench/culling.cpp).
constexpr std::uint64_t kLeastCost = 2500;
// A cell is far when the field is at least this many half diagonals above zero all over it.
constexpr float kFar = 0.25f;
// A leaf's limit in half diagonals: how far a step from within it goes at most, but where a longer one costs nothing.
constexpr float kLimit = 0.4f;
// The same of what is split further.
constexpr float kInnerLimit = 0.5f;
// Shapes in a bundle and choices in a program short enough for a leaf.
constexpr std::uint32_t kBundleShapes = 24, kProgramChoices = 4;
// The smallest cells: so many levels below that with as many cells as there are choices.
constexpr int kExtraLevels = 3, kMostLevels = 10;
// Cells down to this level are shared out among the threads.
constexpr int kShared = 2;
// Of the root's edge: how much larger a cell is taken than it is, for the rounding that finds a point's cell.
constexpr double kCellMargin = 0x1p-20;

std::uint64_t hash_of(const std::uint32_t* words, std::size_t count) {
  std::uint64_t hash = count;
  for (std::size_t i = 0; i < count; ++i) {
    hash = (hash ^ words[i]) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

Node make_node(Kind kind, std::uint32_t payload, float value) {
  return {value, static_cast<std::uint32_t>(kind) << 30 | payload};
}

std::size_t size_of(const vm::Part& part) {
  return sizeof(part) + part.words.size() * (sizeof(std::uint32_t) + sizeof(double)) +
         part.sources.size() * sizeof(std::uint32_t);
}

// The number of an equal part in `programs`; adds it when there is none.
std::uint32_t intern(vm::Part&& part, std::vector<vm::Part>& programs,
                     std::unordered_multimap<std::uint64_t, std::uint32_t>& by_hash) {
  const std::uint64_t hash = hash_of(part.words.data(), part.words.size());
  const auto [first, last] = by_hash.equal_range(hash);
  for (auto it = first; it != last; ++it) {
    if (programs[it->second].words == part.words && programs[it->second].wide == part.wide) return it->second;
  }
  const auto number = static_cast<std::uint32_t>(programs.size());
  by_hash.emplace(hash, number);
  programs.push_back(std::move(part));
  return number;
}

// Of every shape the surface that the innermost tag above it claims, by its place; empty when there are no tags.
std::vector<std::uint32_t> surfaces_of(const vm::Expression& expression, const vm::Code& code) {
  const auto& nodes = expression.nodes();
  std::vector<std::uint32_t> by_node(nodes.size(), vm::kNone), by_word;
  bool any = false;
  for (std::size_t i = nodes.size(); i-- > 0;) {  // users come after what they use
    const std::uint32_t word = code.words[nodes[i].at];
    std::uint32_t surface = by_node[i];
    if (static_cast<vm::Opcode>(word & 0xff) == vm::Opcode::Tag) surface = vm::operand_of(word), any = true;
    for (const std::uint32_t operand : {nodes[i].a, nodes[i].b}) {
      if (operand != vm::kNone) by_node[operand] = surface;
    }
  }
  if (!any) return by_word;
  by_word.assign(code.size, vm::kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i) by_word[nodes[i].at] = by_node[i];
  return by_word;
}

// The coordinates of up to kEnclosedBoxes boxes.
struct BoxArrays {
  alignas(64) float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

}  // namespace

// Splits cells, on one thread.
class RegionBuilder::Splitter {
 public:
  explicit Splitter(RegionBuilder& builder)
      : builder_(builder),
        regions_(*builder.regions_),
        levels_(regions_.tree_.levels),
        bundle_shapes_(builder.longer_ * kBundleShapes),
        program_choices_(builder.longer_ * kProgramChoices),
        parts_(static_cast<std::size_t>(levels_) + 1) {}

  void run(const Cell& cell, Piece& piece) {
    piece_ = &piece;
    piece.nodes.resize(8);
    split(cell.part, cell.at, cell.level, cell.limit, 0);
  }

 private:
  // Makes the eight children, at nodes[first] and on, of a cell; those that are no leaves are split in turn.
  void split(const vm::Part& part, const std::array<std::uint32_t, 3>& at, int level, float limit,
             std::uint32_t first) {
    if (builder_.bytes_ > builder_.options_.memory) return;  // in vain
    const int below = level + 1;
    const std::size_t bytes_before = bytes_of(*piece_);
    const float edge = regions_.tree_.size / static_cast<float>(1u << below), half_diagonal = edge * 0.8661f;
    const BoxArrays boxes = children_of(at, below);
    specialiser_.look(part, boxes.view(), workspace_);
    std::array<bool, 8> children{};
    std::array<vm::Part, 8>& parts = parts_[static_cast<std::size_t>(below)];
    find_far(part, boxes, half_diagonal, below, limit, first, children);
    const float scale = half_diagonal * regions_.tree_.lipschitz;
    make_leaves(limit, below, first, children, parts);
    make_leaves(std::min(limit, kLimit * scale), below, first, children, parts);
    const float inner = std::min(limit, kInnerLimit * scale);
    cut(inner, children, parts);
    builder_.bytes_ += bytes_of(*piece_) - bytes_before + 8 * sizeof(Node);
    for (std::uint32_t i = 0; i < 8; ++i) {
      if (children[i]) continue;
      const std::array<std::uint32_t, 3> cell = {2 * at[0] + (i & 1), 2 * at[1] + (i >> 1 & 1), 2 * at[2] + (i >> 2)};
      if (below <= kShared) {
        piece_->pending.push_back({cell, below, inner, parts[i], first + i});
        continue;
      }
      const auto grandchildren = static_cast<std::uint32_t>(piece_->nodes.size());
      piece_->nodes.resize(grandchildren + 8);
      piece_->nodes[first + i] = make_node(Kind::Inner, grandchildren, 0);
      split(parts[i], cell, below, inner, grandchildren);
    }
  }

  // The parts of the children that are no leaves yet.
  void cut(float limit, const std::array<bool, 8>& done, std::array<vm::Part, 8>& parts) {
    if (std::all_of(done.begin(), done.end(), [](bool d) { return d; })) return;
    specialiser_.decide(-std::numeric_limits<float>::infinity(), limit);
    for (std::size_t i = 0; i < 8; ++i) {
      if (!done[i]) specialiser_.part(i, parts[i]);
    }
  }

  // Leaves of those whose parts for the limit are short enough.
  void make_leaves(float limit, int level, std::uint32_t first, std::array<bool, 8>& done,
                   std::array<vm::Part, 8>& parts) {
    if (std::all_of(done.begin(), done.end(), [](bool d) { return d; })) return;
    specialiser_.decide(-std::numeric_limits<float>::infinity(), limit);
    for (std::size_t i = 0; i < 8; ++i) {
      const std::uint32_t left = done[i] ? 0 : specialiser_.choices_left(i);
      if (done[i] || (left >= bundle_shapes_ && level < levels_)) continue;
      specialiser_.part(i, parts[i]);
      done[i] = make_leaf(parts[i], left, level, limit, first + static_cast<std::uint32_t>(i));
    }
  }

  BoxArrays children_of(const std::array<std::uint32_t, 3>& at, int level) const {
    BoxArrays boxes;
    const double size = static_cast<double>(regions_.tree_.size), edge = size / (1u << level),
                 margin = size * kCellMargin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
        const double lo = static_cast<double>(regions_.tree_.lo[axis]) + edge * (2.0 * at[axis] + (i >> axis & 1));
        boxes.lo[axis][i] = static_cast<float>(lo - margin),
        boxes.hi[axis][i] = static_cast<float>(lo + edge + margin);
      }
    }
    return boxes;
  }

  // What a piece's leaves take, but for the nodes.
  static std::size_t bytes_of(const Piece& piece) {
    return piece.bundles.size() * sizeof(std::uint32_t) + piece.program_bytes;
  }

  // Children that nothing is near.
  void find_far(const vm::Part& part, const BoxArrays& boxes, float half_diagonal, int level, float limit,
                std::uint32_t first, std::array<bool, 8>& children) {
    const float enough = kFar * half_diagonal * regions_.tree_.lipschitz;
    std::array<float, 8> x, y, z, centre;
    bool any = false;
    for (std::size_t i = 0; i < 8; ++i) {
      children[i] = specialiser_.lo(i) > enough;
      any = any || children[i];
      const auto middle = [&](std::size_t axis) { return (boxes.lo[axis][i] + boxes.hi[axis][i]) / 2; };
      x[i] = middle(0), y[i] = middle(1), z[i] = middle(2);
    }
    if (!any) return;
    vm::evaluate_distance(part, {x.data(), y.data(), z.data()}, 8, centre.data(), workspace_);
    for (std::uint32_t i = 0; i < 8; ++i) {
      if (!children[i]) continue;
      // Above the limit the part says no more than that. The rest is for rounding.
      const float error =
          4 * kDistanceError * std::max({1.0f, std::abs(x[i]), std::abs(y[i]), std::abs(z[i]), centre[i]});
      const float value = std::min(centre[i], limit) - error - 1e-5f * half_diagonal * regions_.tree_.lipschitz;
      piece_->nodes[first + i] = make_node(Kind::Far, static_cast<std::uint32_t>(level), value);
      ++piece_->facts.far;
    }
  }

  // False when the part is too long for a leaf.
  bool make_leaf(vm::Part& part, std::uint32_t choices, int level, float limit, std::uint32_t node) {
    const bool deepest = level == levels_;
    if (choices >= bundle_shapes_ && !deepest) return false;
    const std::size_t start = piece_->bundles.size();
    if (vm::pack_bundle(part, piece_->bundles)) {
      piece_->nodes[node] = make_node(Kind::Bundle, intern_bundle(start), limit);
      ++piece_->facts.bundles;
      return true;
    }
    if (choices > program_choices_ && !deepest) return false;
    const std::size_t size = size_of(part), known = piece_->programs.size();
    piece_->nodes[node] =
        make_node(Kind::Program, intern(std::move(part), piece_->programs, piece_->program_at), limit);
    if (piece_->programs.size() > known) piece_->program_bytes += size;
    part = {};
    ++piece_->facts.programs;
    return true;
  }

  // The bundle that was packed last, or an equal one before it.
  std::uint32_t intern_bundle(std::size_t start) {
    std::vector<std::uint32_t>& pool = piece_->bundles;
    const std::size_t size = pool.size() - start;
    const std::uint64_t hash = hash_of(pool.data() + start, size);
    const auto [first, last] = piece_->bundle_at.equal_range(hash);
    for (auto it = first; it != last; ++it) {
      if (it->second + size <= start && std::equal(pool.begin() + static_cast<std::ptrdiff_t>(start), pool.end(),
                                                   pool.begin() + static_cast<std::ptrdiff_t>(it->second))) {
        pool.resize(start);
        return it->second;
      }
    }
    piece_->bundle_at.emplace(hash, static_cast<std::uint32_t>(start));
    return static_cast<std::uint32_t>(start);
  }

  RegionBuilder& builder_;
  const Regions& regions_;
  const int levels_;
  const std::uint32_t bundle_shapes_, program_choices_;
  vm::Specialiser specialiser_;
  vm::Workspace workspace_;
  std::vector<std::array<vm::Part, 8>> parts_;  // [level]
  Piece* piece_ = nullptr;
};

RegionBuilder::RegionBuilder(const vm::Code& program, const compiler::Box& contents, double lipschitz,
                             const RegionOptions& options)
    : options_(options), program_(program), contents_(contents), regions_(std::make_shared<Regions>()) {
  regions_->whole_ = program;
  regions_->tree_.lipschitz = static_cast<float>(lipschitz) * 1.000001f;
  regions_->tree_.far = 0.866f * kFar * static_cast<float>(lipschitz);
}

std::shared_ptr<const Regions> RegionBuilder::build() {
  const auto start = std::chrono::steady_clock::now();
  whole_ = vm::whole(program_);
  vm::Expression expression;
  if ((whole_.cost < kLeastCost && !options_.always) || !expression.read(program_)) return nullptr;
  choices_ = std::max<std::size_t>(1, expression.choices().size());
  regions_->surfaces_ = surfaces_of(expression, program_);
  if (!choose_root(contents_)) return nullptr;
  // What takes too much memory is cut into fewer, longer leaves.
  for (;; longer_ *= 2) {
    regions_->nodes_.assign(1, {});
    regions_->bundles_.clear(), regions_->programs_.clear(), program_at_.clear();
    regions_->facts_ = {};
    bytes_ = 0;
    split_all({{{0, 0, 0}, 0, std::numeric_limits<float>::infinity(), whole_, 0}});
    if (bytes_ <= options_.memory) break;
    if (longer_ > choices_) return nullptr;
  }
  close_outside();
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
  const auto bundles = static_cast<std::uint32_t>(r.bundles_.size());
  std::vector<std::uint32_t> number;
  for (vm::Part& part : piece.programs) number.push_back(intern(std::move(part), r.programs_, program_at_));
  for (Node node : piece.nodes) {
    if (node.kind() == Kind::Inner) node.ref += first;
    if (node.kind() == Kind::Bundle) node.ref += bundles;
    if (node.kind() == Kind::Program) node = make_node(Kind::Program, number[node.payload()], node.value);
    r.nodes_.push_back(node);
  }
  r.bundles_.insert(r.bundles_.end(), piece.bundles.begin(), piece.bundles.end());
  r.facts_.far += piece.facts.far, r.facts_.bundles += piece.facts.bundles;
  r.facts_.programs += piece.facts.programs;
  return first;
}

// What matters outside the root, beyond each of its faces: a ray there may step by a tenth of the root's edge at a
// time.
void RegionBuilder::close_outside() {
  Regions& r = *regions_;
  r.whole_length_ = static_cast<std::uint32_t>(whole_.sources.size());
  if (options_.room == 0) {  // no ray goes there
    const auto whole = static_cast<std::uint32_t>(r.programs_.size());
    r.outside_.fill(make_node(Kind::Program, whole, std::numeric_limits<float>::infinity()));
    return;
  }
  BoxArrays boxes;
  const float infinity = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) boxes.lo[axis][i] = -infinity, boxes.hi[axis][i] = infinity;
    if (i >= 6) continue;
    const float margin = r.tree_.size * static_cast<float>(kCellMargin), near = r.tree_.lo[i / 2],
                far = near + r.tree_.size;
    (i % 2 == 0 ? boxes.hi : boxes.lo)[i / 2][i] = i % 2 == 0 ? near + margin : far - margin;
  }
  vm::Specialiser specialiser;
  vm::Workspace workspace;
  specialiser.look(whole_, boxes.view(), workspace);
  const float limit = r.tree_.size / 10 * r.tree_.lipschitz;
  specialiser.decide(-infinity, limit);
  for (std::size_t i = 0; i < 6; ++i) {
    vm::Part part;
    specialiser.part(i, part);
    r.outside_[i] = make_node(Kind::Program, intern(std::move(part), r.programs_, program_at_), limit);
  }
}

void RegionBuilder::make_grid() {
  Regions& r = *regions_;
  r.tree_.scale = static_cast<float>(1u << r.tree_.levels) / r.tree_.size;
  r.tree_.grid_level = std::min(4, r.tree_.levels);
  const std::uint32_t edge = 1u << r.tree_.grid_level;
  r.grid_.resize(std::size_t{edge} * edge * edge);
  for (std::uint32_t i = 0; i < r.grid_.size(); ++i) {
    const std::uint32_t cell[3] = {i % edge, i / edge % edge, i / edge / edge};
    std::uint32_t index = 0;
    for (int shift = r.tree_.grid_level; shift > 0 && r.nodes_[index].kind() == Kind::Inner;) {
      --shift;
      index = r.nodes_[index].payload() +
              ((cell[0] >> shift & 1) | (cell[1] >> shift & 1) << 1 | (cell[2] >> shift & 1) << 2);
    }
    r.grid_[i] = index;
  }
  r.bundles_.resize(r.bundles_.size() + vm::kBundlePadding);
  r.bundles_.shrink_to_fit(), r.nodes_.shrink_to_fit();
  static_assert(sizeof(Node) == 2 * sizeof(std::uint32_t));
  r.tree_.grid = r.grid_.data(), r.tree_.nodes = reinterpret_cast<const std::uint32_t*>(r.nodes_.data());
}

void RegionBuilder::count_bytes() {
  Regions& r = *regions_;
  r.facts_.levels = r.tree_.levels;
  r.facts_.distinct_programs = r.programs_.size();
  r.facts_.bytes = r.nodes_.size() * sizeof(Node) + (r.grid_.size() + r.bundles_.size()) * sizeof(std::uint32_t);
  for (const vm::Part& part : r.programs_) {
    r.facts_.bytes += size_of(part);
  }
}

std::shared_ptr<const Regions> Regions::build(const vm::Code& program, const compiler::Box& contents,
                                              double lipschitz, const RegionOptions& options) {
  return RegionBuilder(program, contents, lipschitz, options).build();
}

}  // namespace fathom::runtime
