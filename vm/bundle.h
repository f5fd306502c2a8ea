// Bundles: a union of shapes, packed so that one point meets many of them at once.
//
// The block machine runs one instruction for many points. Where every point has its own few shapes, as in a scene of
// a hundred thousand, that leaves its lanes empty; a bundle fills them the other way: shapes of one opcode lie side
// by side, a lane a shape, and a point is broadcast to all. The meanings are the opcodes' own, so the distance is the
// program's (but for the sign of a zero).
//
//     std::vector<std::uint32_t> pool;
//     if (pack_bundle(part, pool)) ...          // appends; a bundle is named by where it starts
//     evaluate_bundles(pool.data(), jobs, points, distance);
//
// Tested by: tests/vm/bundle_test.cpp
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vm/evaluate.h"
#include "vm/specialise.h"

namespace fathom::vm {

// Words after a pool's last bundle that may be read, and must be there.
inline constexpr std::size_t kBundlePadding = 16;

// Appends the bundle of a program that is a union of shapes (moved or not, tagged or not), offset or not; false, and
// nothing appended, when it is anything else. Layout: the number of shapes << 8 | that of offsets, of each offset its
// radius and its place in the whole program; the number of groups, and of each its opcode word (moved or not), how
// many shapes, how many words, the immediates by rows, [immediate][shape], and a row of the shapes' places in the
// whole program.
bool pack_bundle(const Part& part, std::vector<std::uint32_t>& pool);

// From a bundle's first word.
inline constexpr std::uint32_t shapes_in(std::uint32_t word) { return word >> 8; }
inline constexpr std::uint32_t offsets_in(std::uint32_t word) { return word & 0xff; }

struct BundleJob {
  std::uint32_t bundle, point;
};
// distance[job.point] = the bundle's distance there.
void evaluate_bundles(const std::uint32_t* pool, std::span<const BundleJob> jobs, Points points, float* distance);

// The places in the whole program of the shapes whose distance at the point is the least, ascending.
void nearest_in_bundle(const std::uint32_t* pool, std::uint32_t bundle, const float point[3],
                       std::vector<std::uint32_t>& shapes);
// Of all of them, ascending.
void shapes_of_bundle(const std::uint32_t* pool, std::uint32_t bundle, std::vector<std::uint32_t>& shapes);
// The bundle's program with these of its shapes; `surfaces` tells which surface the instruction at a place belongs
// to, or kNone. [word]; empty when none belongs to any.
void unpack_bundle(const Code& whole, std::span<const std::uint32_t> surfaces, const std::uint32_t* pool,
                   std::uint32_t bundle, std::span<const std::uint32_t> shapes, Part& out);

}  // namespace fathom::vm
