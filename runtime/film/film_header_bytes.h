// Converts the head of a film file to bytes and back (docs/reference/film-file.md).
// Tested by: tests/runtime/film/film_file_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/film/film_contents.h"
#include "runtime/film/partial_render.h"
#include "vm/encoding/bytes.h"

namespace fathom::runtime {

inline constexpr std::string_view kFilmMagic = "FATHOMFM";  // format and size of the head follow
inline constexpr std::uint32_t kFilmFormat = 3;
inline constexpr int kFilmTile = 64;            // side in pixels; each tile of the sums has a digest
inline constexpr std::size_t kDigestSize = 16;  // bytes

// Returns the number of bytes after the head and its digest: the tiles' sums and their digests.
std::uint64_t sums_size(const FilmShape& shape);

void write_head(const FilmHeader& header, const PartialRender& render, vm::ByteWriter& out);
// Read the head of a file in two steps, because the file may hold any bytes: the first step gives the shape, so the
// caller can check the length of the rest before spending time on the second step. Both return the problem, as a
// message.
std::optional<std::string> read_shape(vm::ByteReader& in, FilmFile& file);
std::optional<std::string> read_covered(vm::ByteReader& in, FilmFile& file);

}  // namespace fathom::runtime
