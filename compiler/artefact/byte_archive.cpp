#include "compiler/artefact/byte_archive.h"

#include <fmt/format.h>

namespace fathom::compiler {

std::size_t ByteArchiveWriter::list(std::size_t count) {
  out_.u32(static_cast<std::uint32_t>(count));
  return count;
}

bool ByteArchiveWriter::present(bool there) {
  out_.u8(there);
  return there;
}

bool ByteArchiveReader::present(bool) {
  const std::uint8_t there = in_.u8();
  if (there > 1) fail("it is there (1) or not (0)");
  return there == 1;
}

void ByteArchiveReader::choice(std::size_t& value, std::span<const std::string_view> names) {
  const std::uint8_t index = in_.u8();
  if (in_.failed()) return;
  if (index >= names.size()) return fail(fmt::format("there is no choice {} of {}", index, names.size()));
  value = index;
}

void ByteArchiveReader::fail(std::string reason) {
  if (in_.failed()) return;
  reason_ = name_.empty() ? reason : fmt::format("`{}`: {}", name_, reason);
  in_.fail();
}

}  // namespace fathom::compiler
