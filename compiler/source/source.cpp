#include "compiler/source/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fathom::compiler {

namespace {

constexpr std::size_t kStride = 256;

// Every byte except a UTF-8 continuation byte begins a code point.
bool begins_code_point(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

}  // namespace

Source::Source(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {
  line_starts_.push_back(0);
  std::uint32_t code_points = 0;
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (i % kStride == 0) code_points_.push_back(code_points);
    code_points += begins_code_point(text_[i]);
    if (text_[i] == '\n') line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
  }
}

const Source& Source::import(std::string path, std::string name, std::string text, bool derived) {
  auto file = std::make_shared<Source>(std::move(name), std::move(text));
  file->base_ = static_cast<std::uint32_t>(size());
  imports_.push_back({std::move(path), std::move(file), derived});
  return *imports_.back().file;
}

// Counts one byte between files, so that the end of a file differs from the beginning of the next.
std::uint64_t Source::size() const {
  const Source& last = imports_.empty() ? *this : *imports_.back().file;
  return std::uint64_t{last.base_} + last.text_.size() + 1;
}

Source Source::renamed(std::string name) const {
  Source same = *this;
  same.name_ = std::move(name);
  return same;
}

const Import* Source::find(std::uint32_t offset) const {
  const auto after = std::upper_bound(imports_.begin(), imports_.end(), offset,
                                      [](std::uint32_t at, const Import& import) { return at < import.file->base_; });
  return after == imports_.begin() ? nullptr : &*std::prev(after);
}

const Source& Source::file(std::uint32_t offset) const {
  const Import* import = find(offset);
  return import ? *import->file : *this;
}

std::string Source::in_import(std::uint32_t offset) const {
  const Import* import = find(offset);
  return import ? " in " + import->path : "";
}

Position Source::locate(std::uint32_t offset) const {
  if (const Source& other = file(offset); &other != this) return other.locate(offset);
  if (line_starts_.empty()) return {1, 1};
  const std::uint32_t at = std::min(offset - base_, static_cast<std::uint32_t>(text_.size()));
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), at);
  const std::uint32_t start = *(after - 1);
  const std::uint32_t before =
      at - start < kStride ? count_code_points(start, at) : code_points_before(at) - code_points_before(start);
  return {static_cast<std::uint32_t>(after - line_starts_.begin()), before + 1};
}

std::string Source::place(std::uint32_t offset) const {
  const Position at = locate(offset);
  return fmt::format("{}:{}:{}", file(offset).name(), at.line, at.column);
}

std::string_view Source::excerpt(Span span) const {
  const Source& in = file(span.begin);
  const std::size_t begin = std::min<std::size_t>(span.begin - in.base_, in.text_.size());
  return std::string_view(in.text_).substr(begin, span.end - span.begin);
}

std::uint32_t Source::code_points_before(std::uint32_t at) const {
  if (code_points_.empty()) return 0;
  const std::size_t stride = std::min(at / kStride, code_points_.size() - 1);
  return code_points_[stride] + count_code_points(static_cast<std::uint32_t>(stride * kStride), at);
}

std::uint32_t Source::count_code_points(std::uint32_t from, std::uint32_t to) const {
  return static_cast<std::uint32_t>(std::count_if(text_.begin() + from, text_.begin() + to, begins_code_point));
}

std::string_view Source::line(std::uint32_t number) const {
  if (number == 0 || number > line_starts_.size()) return {};
  const std::size_t begin = line_starts_[number - 1];
  const std::size_t end = number < line_starts_.size() ? line_starts_[number] - 1 : text_.size();
  std::string_view line(text_.data() + begin, end - begin);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace fathom::compiler
