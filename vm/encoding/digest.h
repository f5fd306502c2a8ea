// Fingerprints of bytes: XXH3 of 128 bits (Yann Collet, xxHash specification), the same on every machine. They tell
// files that are equal from others and from damaged ones; they are no proof against who means harm.
// Tested by: tests/vm/encoding/bytes_test.cpp
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fathom::vm {

struct Digest {
  std::uint64_t low = 0, high = 0;

  bool operator==(const Digest&) const = default;
  std::string text() const;  // 32 hexadecimal digits, the high half first
};

Digest digest(std::span<const std::uint8_t> bytes);
Digest digest(std::string_view text);

}  // namespace fathom::vm
