// Golden tests of the verifier's rules, each broken alone. tests/golden/verifier/*.txt hold a program as words and,
// after the line "----- expected", where and why the verifier refuses the program. Words are written
//
//     mnemonic:operand    an opcode word; without operand 0
//     f=1  f=1/1.5        a float immediate, and its unrounded constant if that differs
//     i=8  #000000ff      an integer immediate; any word
//     locals 2            what the program declares
//     limit stack 2       a limit other than the machine's: words, stack, locals
//
// FATHOM_UPDATE_GOLDEN=1 in the environment rewrites the expected part.
#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <sstream>
#include <string>
#include <variant>

#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "vm/program/verify.h"

namespace fathom::test::verifier_golden_test {
namespace {

void set_limit(vm::Limits& limits, const std::string& name, std::uint32_t value) {
  if (name == "words") limits.words = value;
  if (name == "stack") limits.stack = value;
  if (name == "locals") limits.locals = value;
}

std::uint32_t opcode_named(const std::string& name) {
  for (std::uint32_t i = 0; i < vm::kOpcodeCount; ++i) {
    if (vm::find_opcode(i)->mnemonic == name) return i;
  }
  FAIL("no opcode " << name);
  return 0;
}

void append_word(vm::Program& program, const std::string& token) {
  const std::string text = token.substr(token.find_first_of("=#") + 1);
  std::uint32_t word = 0;
  double doubles = 0;
  if (token.starts_with("f=")) {
    const float value = std::strtof(text.c_str(), nullptr);
    const std::size_t slash = text.find('/');
    doubles = slash == text.npos ? static_cast<double>(value) : std::strtod(text.c_str() + slash + 1, nullptr);
    word = std::bit_cast<std::uint32_t>(value);
  } else if (token.starts_with("i=")) {
    word = static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 10));
  } else if (token.starts_with('#')) {
    word = static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 16));
  } else {
    const std::size_t colon = token.find(':');
    const unsigned long operand = colon == token.npos ? 0 : std::strtoul(token.c_str() + colon + 1, nullptr, 10);
    word = opcode_named(token.substr(0, colon)) | static_cast<std::uint32_t>(operand) << 8;
  }
  program.words.push_back(word);
  program.doubles.push_back(doubles);
}

std::string verdict(const std::string& input) {
  vm::Program program;
  vm::Limits limits;
  std::istringstream lines(input);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream tokens(line.substr(0, line.find(';')));
    for (std::string token; tokens >> token;) {
      if (token == "locals") {
        tokens >> program.locals;
      } else if (token == "limit") {
        std::string name;
        std::uint32_t value = 0;
        tokens >> name >> value;
        set_limit(limits, name, value);
      } else {
        append_word(program, token);
      }
    }
  }
  const auto result = vm::verify(program, limits);
  const auto* error = std::get_if<vm::VerifyError>(&result);
  return error ? fmt::format("word {}: {}\n", error->offset, error->reason) : "sound\n";
}

}  // namespace

TEST_CASE("golden verifier rules", "[program][verify]") { test::check_golden("verifier", verdict); }

}  // namespace fathom::test::verifier_golden_test
