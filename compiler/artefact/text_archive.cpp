#include "compiler/artefact/text_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "vm/encoding/escape.h"

namespace fathom::compiler {

void TextArchiveWriter::begin(std::string_view name) {
  out_.append(2 * depth_, ' ');
  out_ += name;
}

void TextArchiveWriter::number(double& value) { out_ += fmt::format(" {}", value); }

void TextArchiveWriter::whole(std::uint64_t& value) { out_ += fmt::format(" {}", value); }

void TextArchiveWriter::text(std::string& value) { out_ += " " + vm::quote(value); }

void TextArchiveWriter::choice(std::size_t& value, std::span<const std::string_view> names) {
  out_ += fmt::format(" {}", names[value]);
}

void TextArchiveWriter::begin_record() {
  out_ += " {\n";
  ++depth_;
}

void TextArchiveWriter::end_record() {
  --depth_;
  out_.append(2 * depth_, ' ');
  out_ += '}';
}

std::size_t TextArchiveWriter::list(std::size_t count) {
  out_ += fmt::format(" {}", count);
  return count;
}

bool TextArchiveWriter::present(bool there) {
  if (!there) out_ += " none";
  return there;
}

void TextArchiveReader::skip_blank() {
  while (at_ < in_.size()) {
    if (in_[at_] == ';') {
      at_ = std::min(in_.find('\n', at_), in_.size());
    } else if (std::string_view(" \t\r\n").find(in_[at_]) != std::string_view::npos) {
      ++at_;
    } else {
      return;
    }
  }
}

std::string_view TextArchiveReader::next() {
  skip_blank();
  fault_begin_ = at_;
  if (at_ < in_.size() && in_[at_] == '"') {
    at_ += std::max<std::size_t>(vm::quoted_length(in_.substr(at_)), 1);
  } else {
    at_ = std::min(in_.find_first_of(" \t\r\n;", at_), in_.size());
  }
  fault_end_ = at_;
  return in_.substr(fault_begin_, fault_end_ - fault_begin_);
}

void TextArchiveReader::expect(std::string_view token) {
  if (failed()) return;
  const std::string_view found = next();
  if (found == token) return;
  fail(found.empty() ? fmt::format("`{}` is missing", token) : fmt::format("`{}` should be here", token));
}

void TextArchiveReader::number(double& value) {
  if (failed()) return;
  const std::string_view token = next();
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) fail("this should be a number");
}

void TextArchiveReader::whole(std::uint64_t& value) {
  if (failed()) return;
  const std::string_view token = next();
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) fail("this should be a whole number");
}

void TextArchiveReader::text(std::string& value) {
  if (failed()) return;
  const std::string_view token = next();
  value.clear();
  const bool quoted = token.size() >= 2 && token.front() == '"' && token.back() == '"';
  if (!quoted || !vm::unescape(token.substr(1, token.size() - 2), value)) fail("this should be a text in quotes");
}

void TextArchiveReader::choice(std::size_t& value, std::span<const std::string_view> names) {
  if (failed()) return;
  const auto found = std::find(names.begin(), names.end(), next());
  if (found == names.end()) return fail(fmt::format("this should be one of: {}", fmt::join(names, ", ")));
  value = static_cast<std::size_t>(found - names.begin());
}

std::size_t TextArchiveReader::list(std::size_t) {
  std::uint64_t count = 0;
  whole(count);
  return failed() ? 0 : static_cast<std::size_t>(count);
}

bool TextArchiveReader::present(bool) {
  const std::size_t before = at_;
  if (failed() || next() == "none") return false;
  at_ = before;
  return true;
}

void TextArchiveReader::fail(std::string reason) {
  if (!failed()) reason_ = std::move(reason);
}

}  // namespace fathom::compiler
