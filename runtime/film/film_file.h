// Film files hold a render, finished or not, as sums, with all data needed to resume the render, to add it to other
// parts of the same render, and to write images. A checkpoint is a film file, and `-o part.film` writes a film file.
// docs/reference/film-file.md specifies every byte.
//
// Two films belong to the same render if their identities agree. An identity lists, by name, every setting that
// changes a sample. A file may hold any bytes, so the reader allocates no memory for data that the file does not
// have, and verifies a checksum of every part.
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

// Returns a message for each difference of two identities, such as "spp is 64 there and 128 here". `there` and `here`
// say where the first and the second identity come from.
std::vector<std::string> differences(const Identity& first, const Identity& second, std::string_view there = "there",
                                     std::string_view here = "here");

struct FilmReadError {
  std::string problem;  // a message
  bool missing;         // the file does not exist or cannot be read
  bool not_a_film;      // the file does not begin like a film, so it is some other file of the user
};

// Appends the film to `file`, which records problems.
void write_film(const FilmHeader& header, const PartialRender& render, AtomicFile& file);
[[nodiscard]] std::optional<std::string> write_film(const FilmHeader& header, const PartialRender& render,
                                                    const std::string& path);

// Reads a film file. Refuses a film above the limits before allocating its memory.
std::variant<FilmFile, FilmReadError> read_film(const std::string& path, const ReadLimits& limits = {});
// Like read_film(), but without the sums: the film has no pixels.
std::variant<FilmFile, FilmReadError> read_film_header(const std::string& path, const ReadLimits& limits = {});
// Makes the process keep freed memory instead of returning it to the system page by page. Otherwise each of many
// films read in turn would take new pages, which is half the time.
void keep_freed_memory();

}  // namespace fathom::runtime
