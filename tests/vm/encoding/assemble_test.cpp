// Tests of the assembler: a listing reads back as the program it was made from, and an error in a listing is reported
// at its position.
#include "vm/encoding/assemble.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/random/random_program.h"
#include "tests/support/same_program.h"
#include "tests/support/scaled_cases.h"
#include "vm/encoding/disassemble.h"
#include "vm/encoding/escape.h"

namespace fathom::test::assemble_test {
namespace {

vm::Program assembled(const std::string& text) {
  auto result = vm::assemble(text);
  if (const auto* error = std::get_if<vm::AssembleError>(&result)) {
    FAIL(text << "\nat " << error->begin << ": " << error->reason);
  }
  return std::get<vm::Program>(std::move(result));
}

// Checks that assembling `text` fails at the substring `at`, for a reason that contains `reason`.
void refused(const std::string& text, const std::string& at, const std::string& reason) {
  const auto result = vm::assemble(text);
  const auto* error = std::get_if<vm::AssembleError>(&result);
  INFO(text);
  REQUIRE(error != nullptr);
  CHECK(text.substr(error->begin, error->end - error->begin) == at);
  CHECK_THAT(error->reason, Catch::Contains(reason));
}

}  // namespace

TEST_CASE("random programs read back from their listings", "[encoding][assemble]") {
  const int count = scaled_cases(10000);
  for (int seed = 0; seed < count; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const vm::VerifiedProgram program = random_program(random, 1 + seed % 60);
    const std::string listing = vm::disassemble(program);
    const vm::Program back = assembled(listing);
    INFO("seed " << seed << "\n" << listing);
    REQUIRE(same_program(back, program.program()));
    auto verified = vm::verify(back);
    REQUIRE(std::holds_alternative<vm::VerifiedProgram>(verified));
    REQUIRE(vm::disassemble(std::get<vm::VerifiedProgram>(verified)) == listing);
  }
}

TEST_CASE("a program may be written without any of the listing's columns", "[encoding][assemble]") {
  const vm::Program program = assembled(
      "; two balls\r\n\n"
      "locals 1\n"
      "sphere .5 at 0 1e0 0   ; a comment\n"
      "tee 0;another\n"
      "\tsphere 0.25 min\n"
      "  0012 2 1 0->1 1   add _ %0\n"
      "min x -2.5\n");
  vm::Program expected;
  expected.locals = 1;
  expected.append(vm::Opcode::Sphere, vm::kFusedTranslate, {0, 1, 0, 0.5}, {});
  expected.append(vm::Opcode::Tee, 0, {}, {});
  expected.append(vm::Opcode::Sphere, vm::kFusedMin, {0.25}, {});
  expected.append(vm::Opcode::Add, vm::operand_of({vm::Source::Stack, vm::Source::Local, 0}), {}, {});
  expected.append(vm::Opcode::Min, vm::operand_of({vm::Source::X, vm::Source::Constant, 0}), {-2.5}, {});
  expected.debug.clear();
  CHECK(same_program(program, expected));
}

TEST_CASE("what is no program is refused where it goes wrong", "[encoding][assemble]") {
  refused("spher 1\n", "spher", "no instruction is called `spher`");
  refused("sphere\n", "sphere", "`sphere` takes 1 number (radius), not 0");
  refused("sphere 1 2\n", "sphere", "not 2");
  refused("sphere one\n", "one", "`one` is not a number");
  refused("sphere inf\n", "inf", "not a number");
  refused("sphere nan\n", "nan", "not a number");
  refused("sphere 1e999\n", "1e999", "not a number");
  refused("sphere 1 at 0 0\n", "at", "`at` three numbers");
  refused("sphere 1 at 0 x 0\n", "x", "not a number");
  refused("min _\n", "min", "`min` takes 0 numbers, not 1");
  refused("min _ q\n", "q", "not a number");
  refused("min %0 %1\n", "%1", "the same");
  refused("min %x _\n", "x", "not a whole number");
  refused("min %999999999 _\n", "%999999999", "at most");
  refused("tee\n", "tee", "takes a number");
  refused("tee 16777216\n", "16777216", "at most 16777215");
  refused("tee -1\n", "-1", "not a whole number");
  refused("polygon 3 0 0 1 0 1\n", "polygon",
          "takes 6 numbers (x y, again and again) after the first, which says how often, not 5");
  refused("mandelbulb 8 1.5 2 1 0\n", "1.5", "not a whole number");
  refused("drop 1\n", "drop", "`drop` takes 0 numbers, not 1");
  refused("locals many\n", "locals", "with how many");
  refused("sphere 1\nlocals 1\n", "locals", "no instruction is called `locals`");
  refused("source scene\n", "source", "no instruction");
  refused("source \"scene\n", "\"scene", "not whole");
  refused("source \"a\" ; the \"b\" file\nsource \"c\"\n", "\"", "once, before the code");
  refused("locals 1\nlocals 2\n", "locals", "stands once");
  refused("sphere 1\n1negate\n", "1negate", "no instruction");
  refused("sphere 1\n12 0.5\n", "0.5", "no instruction");
  refused("sphere 1\n12 13\n", "12 13", "without an instruction");
  refused("1 2 3 4 5 6 sphere 1\n", "6", "begins with its name");
  refused("sphere \"ball\"\n", "\"", "stands after `source`, once");
  refused("sphere 1 @6\n", "@6", "@line:column");
  refused("sphere 1 @0:5 ball\n", "@0:5", "@line:column");
  refused("sphere 1 @6:5 b\\x\n", "b\\x", "backslash");
}

TEST_CASE("a body that repeats is listed once, with its numbers as rows", "[encoding][assemble]") {
  vm::Program program;
  const auto add = [&](vm::Opcode opcode, std::uint32_t operand, const std::vector<double>& numbers) {
    program.append(opcode, operand, numbers, {static_cast<std::uint32_t>(program.words.size()), 3, 7, "ball"});
  };
  add(vm::Opcode::Sphere, 0, {7});
  for (int i = 0; i < 40; ++i) {
    add(vm::Opcode::Translate, 0, {0.1 * i, 5, -0.1 * i});
    add(vm::Opcode::Sphere, vm::kFusedTranslate | vm::kFusedMin, {1.0 / (1 + i), 2, 3, 0.25 * i});
    add(vm::Opcode::Drop, 0, {});
  }
  const auto verified = std::get<vm::VerifiedProgram>(vm::verify(program));
  const std::string listing = vm::disassemble(verified);
  CHECK(std::ranges::count(listing, '\n') < 52);
  CHECK_THAT(listing, Catch::Contains("each 40\n") && Catch::Contains("translate # 5 #") &&
                          Catch::Contains("sphere # at # 2 3 min") && Catch::Contains("rows\n  0 0 0 1\n  0.1 -0.1"));
  CHECK(same_program(assembled(listing), program));
  CHECK(same_program(assembled(vm::disassemble(verified, {.unrolled = true})), program));
  std::vector<std::size_t> lines;
  REQUIRE(std::holds_alternative<vm::Program>(vm::assemble(listing, &lines)));
  REQUIRE(lines.size() == 121);
  CHECK(listing.substr(lines[4], 12) == "  0.1 -0.1 0");
  CHECK(lines[4] == lines[6]);
  const std::string few = vm::disassemble(verified, {.few = true}),
                    middle = vm::disassemble(verified, {.range = std::pair<std::size_t, std::size_t>(2, 4)});
  CHECK(std::ranges::count(few, '\n') < 20);
  CHECK_THAT(middle, Catch::Contains("rows\n  ...\n  0.2 -0.2") && Catch::Contains("  ...\nend\n"));
  refused(few, "...", "leaves out rows");
}

TEST_CASE("rows without a body, or too few, are refused", "[encoding][assemble]") {
  CHECK(assembled("each 3\nsphere 1\nrows\nend\nmin\nmin\n").words.size() == 8);
  CHECK(assembled("each 2\nsphere #\nrows ; radius\n\n 1 ; the first\n2\nend\nmin\n").words.size() == 5);
  refused("each 2\nsphere #\nrows\n 1\nend\nmin\n", "end", "`each` has 2 rows, not 1");
  refused("each 2\nsphere #\nrows\n1\n2\n3\nend\nmin\n", "3", "`end` is missing here");
  refused("each 2\nsphere #\nrows\n1\n2\nmin\n", "min", "neither a row of numbers nor `end`");
  refused("each 2\nsphere # at # # #\nrows\n1 2\n", "1 2", "a row has 4 numbers, not 2");
  refused("each 2\nsphere #\nrows\nx\n", "x", "neither a row");
  refused("each 2\nsphere # at # 0 0\nrows\n1 x\n", "x", "not a number");
  refused("each 2\nsphere #\n", "each", "`each` has no `end`");
  refused("each 2\nsphere #\nend\n", "end", "`rows` is missing");
  refused("each 2\nsphere #\nrows\n1\n2\nend sphere 7 min\n", "sphere", "nothing follows `end`");
  refused("each 2\nrows\n", "rows", "after the instructions");
  refused("each\nsphere #\n", "each", "with how many rows");
  refused("each 2\neach 2\n", "each", "with how many rows");
  refused("sphere #\n", "#", "in a body that `each` begins");
  refused("rows\n", "rows", "no instruction");
}

// Each of these asked for gigabytes: rows, the points of a polygon in each row, a name in each row.
TEST_CASE("a few characters of rows make no large program", "[encoding][assemble]") {
  refused("each 4000000000\nsphere 1\nrows\nend\n", "each", "larger than one of 1000000 instructions");
  std::string polygon = "polygon 1000 ";
  for (int i = 0; i < 1000; ++i) polygon += " 0 1";
  refused("each 900000\n" + polygon + "\nrows\nend\n", "each", "larger than one of");
  refused("each 900000\nsphere 1 @1:1 " + std::string(1000, 'n') + "\nrows\nend\n", "each", "larger than one of");
}

TEST_CASE("escaped texts lie on one line and read back", "[encoding][assemble]") {
  for (const std::string& text : {std::string("plain"), std::string("a\nb\tc\rd\\e\"f"), std::string("\0\x1f", 2),
                                  std::string("ä"), std::string("\xC2\x80\xC2\x9F\xC2\xA0\xC2")}) {
    std::string back;
    CHECK(vm::escape(text).find('\n') == std::string::npos);
    CHECK(vm::escape(text).find("\xC2\x9F") ==
          std::string::npos);  // like other C1 controls, U+009F begins a command to a terminal
    CHECK(vm::unescape(vm::escape(text), back));
    CHECK(back == text);
  }
  for (const char* text : {"\\", "\\q", "\\u00", "\\u0041", "\\u00a0", "\\u00g1"}) {
    std::string out;
    CHECK_FALSE(vm::unescape(text, out));
  }
}

}  // namespace fathom::test::assemble_test
