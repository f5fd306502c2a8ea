// Line layout of the text made from a JSON scene: statements in groups, limited line width, comments in place.
// Tested by: tests/compiler/frontend/text/text_convert_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler::text {

struct PrintedStatement {
  std::string_view group;  // the scene's property that contains the statement
  std::string text;
  Span span;                          // in the source
  std::vector<std::string> comments;  // on lines before it
  std::string aside;                  // comment at the end of its line
};

// If `source` is JSON, keeps each comment on the lines before its statement or at the end of the statement's line.
std::string print_lines(std::vector<PrintedStatement> statements, const Source& source);

}  // namespace fathom::compiler::text
