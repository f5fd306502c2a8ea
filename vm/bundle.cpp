// Bundles, compiled once for each instruction set (Highway's foreach_target).
#include "vm/bundle.h"

#include <algorithm>
#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/bundle.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Distances of a group's shapes, kLanes at a time: use(first shape of the lanes, shapes in them, distances).
template <class Op, int Count, class Use>
HWY_INLINE void for_group(const Vec3<Batch>& p, const std::uint32_t* rows, std::size_t count, bool moved,
                          const Use& use) {
  const auto* immediates = reinterpret_cast<const float*>(rows);
  for (std::size_t first = 0; first < count; first += kLanes) {
    Vec3<Batch> q = p;
    const float* row = immediates + first;
    if (moved) {
      const Batch by[3] = {Batch::load(row), Batch::load(row + count), Batch::load(row + 2 * count)};
      q = TranslateOp::apply(p, by);
      row += 3 * count;
    }
    Batch k[Count > 0 ? Count : 1];
    for (int i = 0; i < Count; ++i, row += count) k[i] = Batch::load(row);
    use(first, std::min(kLanes, count - first), Op::apply(q, k, static_cast<const std::uint32_t*>(nullptr)));
  }
}

// Calls use(end of the group, its count, first, size, distances) for all shapes of the bundle at `at`.
template <class Use>
HWY_INLINE void for_bundle(const std::uint32_t* at, const Vec3<Batch>& p, const Use& use) {
  at += 1 + 2 * offsets_in(at[0]);
  for (std::uint32_t groups = *at++; groups > 0; --groups) {
    const std::uint32_t word = at[0];
    const std::size_t count = at[1];
    const std::uint32_t* rows = at + 3;
    at += at[2];
    const auto of_group = [&](std::size_t first, std::size_t size, Batch distance)
                              HWY_ATTR { use(at, count, first, size, distance); };
    const bool moved = (operand_of(word) & kMoved) != 0;
    switch (static_cast<Opcode>(word & 0xff)) {
// clang-format off
#define OP_Point(Name, immediates)
#define OP_Outline(Name, immediates)
#define OP_Unary(Name, immediates)
#define OP_Binary(Name, immediates)
#define OP_Machine(Name, immediates)
#define OP_Shape(Name, immediates)                                                                 \
  case Opcode::Name:                                                                               \
    if constexpr (std::string_view(immediates).find(":i") == std::string_view::npos)               \
      for_group<Name##Op, count_names(immediates)>(p, rows, count, moved, of_group);               \
    break;
#define OP(Name, mnemonic, form, immediates, ...) OP_##form(Name, immediates)
#include "vm/opcodes.def"
#undef OP
#undef OP_Point
#undef OP_Shape
#undef OP_Outline
#undef OP_Unary
#undef OP_Binary
#undef OP_Machine
      // clang-format on
      default:
        break;
    }
  }
}

void distances(const std::uint32_t* pool, std::span<const BundleJob> jobs, Points points, float* distance) {
  const Batch infinity = Batch::broadcast(std::numeric_limits<float>::infinity());
  for (const BundleJob& job : jobs) {
    const std::size_t i = job.point;
    const Vec3<Batch> p{Batch::broadcast(points.x[i]), Batch::broadcast(points.y[i]), Batch::broadcast(points.z[i])};
    Batch nearest = infinity;
    for_bundle(pool + job.bundle, p,
               [&](const std::uint32_t*, std::size_t, std::size_t, std::size_t size, Batch d) HWY_ATTR {
                 const FloatLanes lanes;
                 nearest = min(nearest, select(BatchMask{hn::FirstN(lanes, size)}, d, infinity));
               });
    float least = hn::GetLane(hn::MinOfLanes(FloatLanes(), nearest.v));
    const std::uint32_t* offsets = pool + job.bundle;
    for (std::uint32_t o = 0; o < offsets_in(offsets[0]); ++o)
      least = least - std::bit_cast<float>(offsets[1 + 2 * o]);
    distance[i] = least;
  }
}

void nearest_shapes(const std::uint32_t* pool, std::uint32_t bundle, const float* point,
                    std::vector<std::uint32_t>& shapes) {
  const Vec3<Batch> p{Batch::broadcast(point[0]), Batch::broadcast(point[1]), Batch::broadcast(point[2])};
  float least = std::numeric_limits<float>::infinity();
  shapes.clear();
  for_bundle(pool + bundle, p,
             [&](const std::uint32_t* end, std::size_t count, std::size_t first, std::size_t size, Batch d) HWY_ATTR {
               alignas(64) float distance[kLanes];
               d.store(distance);
               for (std::size_t lane = 0; lane < size; ++lane) {
                 if (distance[lane] > least) continue;
                 if (distance[lane] < least) shapes.clear();
                 least = distance[lane];
                 shapes.push_back(*(end - count + first + lane));
               }
             });
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::vm {

HWY_EXPORT(distances);
HWY_EXPORT(nearest_shapes);

void evaluate_bundles(const std::uint32_t* pool, std::span<const BundleJob> jobs, Points points, float* distance) {
  HWY_DYNAMIC_DISPATCH(distances)(pool, jobs, points, distance);
}

void nearest_in_bundle(const std::uint32_t* pool, std::uint32_t bundle, const float point[3],
                       std::vector<std::uint32_t>& shapes) {
  HWY_DYNAMIC_DISPATCH(nearest_shapes)(pool, bundle, point, shapes);
  std::sort(shapes.begin(), shapes.end());
}

void shapes_of_bundle(const std::uint32_t* pool, std::uint32_t bundle, std::vector<std::uint32_t>& shapes) {
  shapes.clear();
  const std::uint32_t* at = pool + bundle + 1 + 2 * offsets_in(pool[bundle]);
  for (std::uint32_t groups = *at++; groups > 0; --groups) {
    const std::size_t count = at[1];
    at += at[2];
    shapes.insert(shapes.end(), at - count, at);
  }
  std::sort(shapes.begin(), shapes.end());
}

void unpack_bundle(const Code& whole, std::span<const std::uint32_t> surfaces, const std::uint32_t* pool,
                   std::uint32_t bundle, std::span<const std::uint32_t> shapes, Part& out) {
  out.words.clear(), out.wide.clear(), out.sources.clear();
  out.locals = out.choices = 0, out.cost = 0;
  out.max_points = 1;
  out.max_values = shapes.size() > 1 ? 2 : 1;
  const auto append = [&](std::uint32_t word, std::uint32_t source, std::size_t immediates) {
    out.words.push_back(word), out.wide.push_back(0), out.sources.push_back(source);
    out.words.insert(out.words.end(), whole.words + source + 1, whole.words + source + 1 + immediates);
    out.wide.insert(out.wide.end(), whole.wide + source + 1, whole.wide + source + 1 + immediates);
    out.cost += instruction_cost(word);
    out.choices += is_choice(word);
  };
  for (const std::uint32_t shape : shapes) {
    const bool joins = shape != shapes[0];
    const std::uint32_t surface = surfaces.empty() ? kNone : surfaces[shape];
    const bool fused = joins && surface == kNone;
    const std::uint32_t plain = whole.words[shape] & ~(kJoined << 8);
    append(fused ? plain | kJoined << 8 : plain, shape, instruction_length(plain) - 1);
    if (surface != kNone) append(opcode_word(Opcode::Tag, surface), shape, 0);
    if (joins && !fused) append(opcode_word(Opcode::Min), shape, 0);
  }
  for (std::uint32_t o = 0; o < offsets_in(pool[bundle]); ++o)
    append(opcode_word(Opcode::Offset), pool[bundle + 2 + 2 * o], 1);
}

namespace {

bool has_integers(const OpcodeInfo& row) {
  for (int i = 0; i < row.immediates; ++i) {
    if (is_integer_immediate(row, i)) return true;
  }
  return false;
}

struct PackedShape {
  std::uint32_t word;  // opcode and whether it is moved
  std::uint32_t at;    // of its first immediate
  std::uint32_t source;
};

// The shapes of a union and the offsets of it all; false when the program is anything else.
bool shapes_of(const Part& part, std::vector<PackedShape>& shapes, std::vector<std::uint32_t>& offsets) {
  shapes.clear(), offsets.clear();
  std::size_t index = 0;
  for (std::size_t at = 0; at < part.words.size(); ++index) {
    const std::uint32_t word = part.words[at];
    const OpcodeInfo& row = *find_opcode(word & 0xff);
    if (row.opcode == Opcode::Offset && operand_of(word) == 0) {
      offsets.insert(offsets.end(), {part.words[at + 1], part.sources[index]});
    } else if (!offsets.empty() && row.opcode != Opcode::Tag) {
      return false;
    } else if (row.form == Form::Shape && !has_integers(row)) {
      const std::uint32_t modes = operand_of(word);
      shapes.push_back(
          {opcode_word(row.opcode, modes & kMoved), static_cast<std::uint32_t>(at + 1), part.sources[index]});
    } else if (row.opcode != Opcode::Tag && (row.opcode != Opcode::Min || operand_of(word) != 0)) {
      return false;
    }
    at += instruction_length(word);
  }
  return true;
}

}  // namespace

bool pack_bundle(const Part& part, std::vector<std::uint32_t>& pool) {
  std::vector<PackedShape> shapes;
  std::vector<std::uint32_t> offsets;
  if (!shapes_of(part, shapes, offsets) || offsets.size() / 2 > 0xff) return false;
  std::stable_sort(shapes.begin(), shapes.end(), [](const auto& a, const auto& b) { return a.word < b.word; });
  pool.push_back(static_cast<std::uint32_t>(shapes.size() << 8 | offsets.size() / 2));
  pool.insert(pool.end(), offsets.begin(), offsets.end());
  const std::size_t groups = pool.size();
  pool.push_back(0);
  for (std::size_t first = 0; first < shapes.size();) {
    std::size_t last = first;
    while (last < shapes.size() && shapes[last].word == shapes[first].word) ++last;
    ++pool[groups];
    pool.push_back(shapes[first].word);
    pool.push_back(static_cast<std::uint32_t>(last - first));
    pool.push_back(static_cast<std::uint32_t>(3 + instruction_length(shapes[first].word) * (last - first)));
    for (std::size_t i = 0; i + 1 < instruction_length(shapes[first].word); ++i) {
      for (std::size_t s = first; s < last; ++s) pool.push_back(part.words[shapes[s].at + i]);
    }
    for (std::size_t s = first; s < last; ++s) pool.push_back(shapes[s].source);
    first = last;
  }
  return true;
}

}  // namespace fathom::vm
#endif  // HWY_ONCE
