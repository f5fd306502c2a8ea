// The head of a film file as bytes and back (docs/reference/film-file.md).
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

inline constexpr std::string_view kFilmMagic = "FATHOMFM";  // then, before the head: format and the head's size
inline constexpr std::uint32_t kFilmFormat = 2;
inline constexpr int kFilmTile = 64;            // pixels; each tile of the sums has a digest
inline constexpr std::size_t kDigestSize = 16;  // bytes

// Of all that follows the head: the tiles' sums and their digests, bytes.
std::uint64_t sums_size(const FilmShape& shape);

void write_head(const FilmHeader& header, const PartialRender& render, vm::ByteWriter& out);
// The head of what is read, in two steps, for it may be anything: what there is to come is known after the first,
// from the shape, before time is spent on the second. What is wrong with it, for people.
std::optional<std::string> read_shape(vm::ByteReader& in, FilmFile& file);
std::optional<std::string> read_covered(vm::ByteReader& in, FilmFile& file);

}  // namespace fathom::runtime
