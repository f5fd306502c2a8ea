// The head of a film file as bytes and back (docs/FILM.md).
// Tested by: tests/runtime/film_file_test.cpp
#pragma once

#include <string>
#include <variant>

#include "runtime/film_file.h"
#include "vm/bytes.h"

namespace fathom::runtime {

void write_head(const FilmHeader& header, const PartialRender& render, vm::ByteWriter& out);
// A file without its sums, or what is wrong with it, for people.
std::variant<FilmFile, std::string> read_head(vm::ByteReader& in);

}  // namespace fathom::runtime
