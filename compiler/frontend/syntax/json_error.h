// Error messages in plain words for a text that is not JSON. nlohmann's lexer only says where it stopped. This code
// finds out what is there and what JSON would allow.
// Tested by: tests/golden/diagnostics (E0001 to E0009), tests/compiler/frontend/syntax/json_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Characters skipped between the end of one token and the beginning of the next.
struct SkippedText {
  std::size_t begin = 0;             // offset of the next token; the text's size if there is no next token
  std::optional<std::size_t> comma;  // offset of the last comma skipped
  bool colon = false;                // true if a colon was skipped
};

// Skips blanks, comments, and commas and colons, except a comma or colon that is itself the token ending at
// `token_end`.
SkippedText skip_to_token(std::string_view text, std::size_t from, std::size_t token_end);

// Parser state at the point where parsing stopped.
struct JsonPlace {
  enum class Inside { Nothing, Record, List, AfterRoot };
  Inside inside = Inside::Nothing;
  std::size_t opened_at = 0;  // offset of the bracket that opens the record or list
  bool has_key = false;       // a property's name has been read, but not its value
  std::string key;
  bool empty = true;          // the record or list has no entries yet
  std::size_t token_end = 0;  // bytes consumed; larger than the text's size if the lexer reached the end
  bool overflow = false;      // the number is well formed but too large for a double
  SkippedText skipped;
};

void report_json_error(const Source& source, const JsonPlace& place, Diagnostics& diagnostics);

// True if the text is UTF-8 without zero bytes. Reports the first invalid byte.
bool check_text(const Source& source, Diagnostics& diagnostics);

}  // namespace fathom::compiler
