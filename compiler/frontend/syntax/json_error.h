// What is wrong with a text that is not JSON, in plain words: nlohmann's lexer says that it stopped and where; what
// stands there and what would be right is found out here.
// Tested by: tests/golden/diagnostics (E0001 to E0009), tests/compiler/frontend/syntax/json_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// The way from the end of one token to the begin of the next.
struct Skipped {
  std::size_t begin = 0;             // of the token; the text's size at its end
  std::optional<std::size_t> comma;  // the last one passed
  bool colon = false;                // whether one was passed
};

// Passes blanks, comments, and the commas and colons that are not themselves the token that ends at `token_end`.
Skipped skip_to_token(std::string_view text, std::size_t from, std::size_t token_end);

// Where reading stopped.
struct JsonPlace {
  enum class Inside { Nothing, Record, List, AfterRoot };
  Inside inside = Inside::Nothing;
  std::size_t opened_at = 0;  // the bracket of the record or list
  bool has_key = false;       // the record's property has its name but not its value
  std::string key;
  bool empty = true;          // nothing in the record or list yet
  std::size_t token_end = 0;  // bytes read; past the text's size when its end was seen
  bool overflow = false;      // a good number, but too large
  Skipped skipped;
};

void report_json_error(const Source& source, const JsonPlace& place, Diagnostics& diagnostics);

// Whether the text is UTF-8 without zero bytes; the first fault is reported.
bool check_text(const Source& source, Diagnostics& diagnostics);

}  // namespace fathom::compiler
