// Tests of the byte writer and reader: written values read back, and data that are cut short, too long or too many
// fail at their position. Digests match the specification.
#include "vm/encoding/bytes.h"

#include <bit>
#include <cmath>

#include "tests/support/catch.h"
#include "vm/encoding/digest.h"

namespace fathom::test::bytes_test {

TEST_CASE("what is written as bytes is read back", "[encoding][bytes]") {
  vm::ByteWriter out;
  out.u8(250);
  out.u32(0x01020304);
  out.u64(0x0102030405060708);
  out.f64(-0.0);
  out.text("ball");
  out.raw(std::vector<std::uint8_t>{1, 2});
  CHECK(out.bytes()[1] == 4);  // little endian

  vm::ByteReader in(out.bytes());
  CHECK(in.u8() == 250);
  CHECK(in.u32() == 0x01020304);
  CHECK(in.u64() == 0x0102030405060708);
  const double zero = in.f64();
  CHECK((zero == 0 && std::signbit(zero)));
  CHECK(in.text(4) == "ball");
  CHECK(in.raw(2)[1] == 2);
  CHECK(in.left() == 0);
  CHECK_FALSE(in.failed());
}

TEST_CASE("a reader never leaves its bytes", "[encoding][bytes]") {
  vm::ByteWriter out;
  out.u32(5);
  out.u32(6);
  SECTION("a number that is cut off") {
    vm::ByteReader in(std::span(out.bytes()).first(7));
    CHECK(in.u32() == 5);
    CHECK(in.u32() == 0);
    CHECK(in.failed());
    CHECK(in.offset() == 4);
    CHECK(in.u8() == 0);  // after a failure the reader returns 0 although bytes are left
  }
  SECTION("a text longer than what is left") {
    vm::ByteReader in(out.bytes());
    CHECK(in.text(100).empty());
    CHECK(in.failed());
  }
  SECTION("a text longer than may be") {
    out.raw(std::vector<std::uint8_t>(10));
    vm::ByteReader most(out.bytes());
    CHECK(most.text(5).size() == 5);
    vm::ByteReader less(out.bytes());
    CHECK(less.text(4).empty());
    CHECK(less.failed());
  }
  SECTION("more things than there is room for") {
    out.raw(std::vector<std::uint8_t>(16));
    vm::ByteReader enough(out.bytes());
    CHECK(enough.count(4) == 5);
    vm::ByteReader scaled_cases(out.bytes());
    CHECK(scaled_cases.count(5) == 0);
    CHECK(scaled_cases.failed());
  }
}

TEST_CASE("digests are those of XXH3", "[encoding][bytes]") {
  // Digest of the empty string, from the reference implementation's xxhsum -H2.
  CHECK(vm::digest(std::string_view()).text() == "99aa06d3014798d86001c324468d497f");
  CHECK(vm::digest("ball") == vm::digest("ball"));
  CHECK_FALSE(vm::digest("ball") == vm::digest("balL"));
}

}  // namespace fathom::test::bytes_test
