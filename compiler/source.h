// Source text with a name, and places in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::compiler {

// Bytes [begin, end) of a source's text. {0, 0} stands for "nowhere in particular".
struct Span {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t trace = 0;  // the call or loop that led there (Diagnostics::add_trace); 0: none
};

struct Position {
  std::uint32_t line;    // 1-based
  std::uint32_t column;  // 1-based, in code points
};

class Source {
 public:
  Source() = default;
  Source(std::string name, std::string text);

  const std::string& name() const { return name_; }
  const std::string& text() const { return text_; }
  Position locate(std::uint32_t offset) const;
  std::string_view line(std::uint32_t number) const;  // without its line break; empty past the end

 private:
  std::string name_, text_;
  std::uint32_t code_points_before(std::uint32_t offset) const;
  std::uint32_t count_code_points(std::uint32_t from, std::uint32_t to) const;

  std::vector<std::uint32_t> line_starts_;
  std::vector<std::uint32_t> code_points_;  // before every kStride-th byte: positions in long lines cost no more
};

}  // namespace fathom::compiler
