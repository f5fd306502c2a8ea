// Source text with a name, places in it, and the files that it imports.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::compiler {

// Bytes [begin, end) of a source followed by its imports. {0, 0} stands for "nowhere in particular".
struct Span {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t trace = 0;  // number of the call or loop that led there (Diagnostics::add_trace); 0: none
};

struct Position {
  std::uint32_t line;    // 1-based
  std::uint32_t column;  // 1-based, in code points
};

struct Import;

class Source {
 public:
  Source() = default;
  Source(std::string name, std::string text);

  const std::string& name() const { return name_; }
  const std::string& text() const { return text_; }
  std::uint32_t base() const { return base_; }  // offset of the text's first byte; 0 except in imports

  // Adds a file that this source imports.
  const Source& import(std::string path, std::string name, std::string text, bool derived = false);
  const std::vector<Import>& imports() const { return imports_; }
  // Bytes of this source and its imports, and one between files.
  std::uint64_t size() const;

  // Returns the same text and imports under another name.
  Source renamed(std::string name) const;

  // Returns the file of an offset: this one, or an import.
  const Source& file(std::uint32_t offset) const;
  // Places, lines and excerpts within the offset's file.
  Position locate(std::uint32_t offset) const;
  std::string place(std::uint32_t offset) const;      // scene.json:3:14
  std::string in_import(std::uint32_t offset) const;  // " in lib/gears.fathom"; empty within this file
  std::string_view excerpt(Span span) const;
  std::string_view line(std::uint32_t number) const;  // of this file, without its line break; empty past the end

 private:
  const Import* find(std::uint32_t offset) const;  // nullptr within this file
  std::uint32_t code_points_before(std::uint32_t at) const;
  std::uint32_t count_code_points(std::uint32_t from, std::uint32_t to) const;

  std::string name_, text_;
  std::uint32_t base_ = 0;
  std::vector<Import> imports_;  // in order of their base offsets
  std::vector<std::uint32_t> line_starts_;
  // number of code points before every kStride-th byte, which makes positions in long lines cheap
  std::vector<std::uint32_t> code_points_;
};

struct Import {
  std::string path;  // relative to the source's folder, e.g. `lib/gears.fathom`
  std::shared_ptr<const Source> file;
  bool derived;  // true if no file has this text: the compiler made it from another import's text
};

}  // namespace fathom::compiler
