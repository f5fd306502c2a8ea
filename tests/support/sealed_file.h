// Writes compiled scene files as an attacker who knows the format would: arbitrary sections with correct digests.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "compiler/artefact/compiled_file.h"
#include "vm/encoding/binary.h"
#include "vm/encoding/bytes.h"

namespace fathom::test {

struct Sections {
  std::vector<std::uint8_t> code, tables, debug, text;
};

inline std::vector<std::uint8_t> sealed(const Sections& parts, vm::Digest opcodes = vm::opcode_digest()) {
  const std::vector<std::uint8_t>* const all[] = {&parts.code, &parts.tables, &parts.debug, &parts.text};
  vm::ByteWriter out;
  const auto add = [&](vm::Digest digest) {
    out.u64(digest.low);
    out.u64(digest.high);
  };
  out.raw(compiler::kFileMagic);
  out.u32(compiler::kFileVersion);
  out.u32(4);
  add(opcodes);
  for (const auto* part : all) {
    out.u64(part->size());
    add(vm::digest(*part));
  }
  add(vm::digest(out.bytes()));
  for (const auto* part : all) out.raw(*part);
  return out.take();
}

// Returns the sections of a valid file.
inline Sections sections_of(std::span<const std::uint8_t> file) {
  constexpr std::size_t kHeader = 144;
  Sections sections;
  vm::ByteReader sizes(file.subspan(32));
  std::size_t at = kHeader;
  for (auto* part : {&sections.code, &sections.tables, &sections.debug, &sections.text}) {
    const auto size = static_cast<std::size_t>(sizes.u64());
    sizes.raw(16);
    part->assign(file.begin() + static_cast<std::ptrdiff_t>(at), file.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
  }
  return sections;
}

}  // namespace fathom::test
