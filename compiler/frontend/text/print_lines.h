// The lines of a text that a JSON scene becomes: its statements in groups, no wider than a page, among its comments.
// Tested by: tests/compiler/frontend/text/text_convert_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler::text {

struct PrintedStatement {
  std::string_view group;  // the property of the scene that it is from
  std::string text;
  Span span;                          // in the source
  std::vector<std::string> comments;  // on lines before it
  std::string aside;                  // a comment at its end
};

// Comments of `source`, where it is JSON, stand before or beside the statements they stand before or beside there.
std::string print_lines(std::vector<PrintedStatement> statements, const Source& source);

}  // namespace fathom::compiler::text
