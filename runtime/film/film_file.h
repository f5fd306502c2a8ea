// Film files: what there is of a render, as sums, with all it takes to go on, to add it to other parts of the same
// render, and to write pictures. A checkpoint is one, `-o part.film` writes one. docs/reference/film-file.md
// gives every byte.
//
// Two films are of the same render when their identities agree: every setting that changes a sample, by name. What is
// read may be anything: nothing is set aside for what is not there, and every part has a checksum.
//
//     FilmFile file = std::get<FilmFile>(read_film("part.film"));
//     if (auto problem = write_film(file.header, file.render, "copy.film")) ...
//
// Tested by: tests/runtime/film/film_file_test.cpp
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/base/atomic_file.h"
#include "runtime/film/film_contents.h"
#include "runtime/film/partial_render.h"
#include "runtime/image/image_read.h"

namespace fathom::runtime {

// What two identities differ in, for people, with words for where each is: "spp is 64 there and 128 here".
std::vector<std::string> differences(const Identity& first, const Identity& second, std::string_view there = "there",
                                     std::string_view here = "here");

struct UnreadFilm {
  std::string problem;  // for people
  bool missing;         // there is no such file, or it cannot be read
  bool foreign;         // it does not begin as a film: it is something else of somebody's
};

// Appends everything to the file, whose problems are its own.
void write_film(const FilmHeader& header, const PartialRender& render, AtomicFile& file);
[[nodiscard]] std::optional<std::string> write_film(const FilmHeader& header, const PartialRender& render,
                                                    const std::string& path);

// Refuses one that would take more memory than the limits say before it takes it.
std::variant<FilmFile, UnreadFilm> read_film(const std::string& path, const ReadLimits& limits = {});
// The same without the sums: the film has no pixels.
std::variant<FilmFile, UnreadFilm> read_film_header(const std::string& path, const ReadLimits& limits = {});
// From now on memory that is freed is not given back to the system page by page: of many films read one after the
// other, each else takes new pages, which is half the time.
void keep_freed_memory();

}  // namespace fathom::runtime
