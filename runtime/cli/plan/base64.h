// Base64 encoding of bytes. Source: S. Josefsson, The Base16, Base32, and Base64 Data Encodings, RFC 4648, 2006,
// section 4.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fathom::cli {

std::string to_base64(std::string_view bytes);
std::optional<std::string> from_base64(std::string_view text);  // nullopt if `text` is not Base64

}  // namespace fathom::cli
