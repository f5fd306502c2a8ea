#include "vm/encoding/digest.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace fathom::vm {
namespace {

Digest digest(const void* bytes, std::size_t size) {
  const XXH128_hash_t hash = XXH3_128bits(bytes, size);
  return {hash.low64, hash.high64};
}

}  // namespace

std::string Digest::text() const { return fmt::format("{:016x}{:016x}", high, low); }

Digest digest(std::span<const std::uint8_t> bytes) { return digest(bytes.data(), bytes.size()); }

Digest digest(std::string_view text) { return digest(text.data(), text.size()); }

}  // namespace fathom::vm
