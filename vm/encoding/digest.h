// Fingerprints of bytes: XXH3 of 128 bits (Yann Collet, xxHash specification), the same on every machine. A Digest
// detects differing and damaged files, but does not protect against forged files: XXH3 is not cryptographic.
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
