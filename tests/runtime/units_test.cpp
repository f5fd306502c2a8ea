#include "runtime/units.h"
#include "tests/support/catch.h"

namespace fathom::runtime::units_test {
namespace {

TEST_CASE("units: rounds follow one another, short at first, and never long", "[runtime]") {
  for (const SampleRange samples : {SampleRange{0, 1}, {0, 16}, {0, 17}, {0, 5000}, {3, 9}, {100, 1000}, {31, 33}}) {
    std::uint32_t at = samples.first;
    for (const SampleRange round : split_into_rounds(samples)) {
      CHECK(round.first == at);
      CHECK(round.last > round.first);
      CHECK(round.size() <= kMaxInRound);
      at = round.last;
    }
    CHECK(at == samples.last);
  }
  CHECK(split_into_rounds({0, 16}).size() == 1);
  CHECK(split_into_rounds({0, 64}) == std::vector<SampleRange>{{0, 16}, {16, 32}, {32, 64}});
  // A part of a render begins with short rounds as well, wherever it begins.
  CHECK(split_into_rounds({20, 60}) == std::vector<SampleRange>{{20, 36}, {36, 52}, {52, 60}});
  CHECK(split_into_rounds({512, 1024}, 1).front() == SampleRange{512, 513});
}

TEST_CASE("units: a queue gives what is left, each sample once", "[runtime]") {
  const PixelRect area{3, 5, 50, 31};
  Coverage covered;
  covered.add({{3, 5, 20, 31}, {0, 20}});
  covered.add({{20, 5, 50, 6}, {7, 40}});
  covered.canonicalise();
  for (const int side : {1, 7, 16, 64}) {
    UnitQueue queue(area, side, split_into_rounds({0, 40}), covered);
    Coverage sum = covered;
    std::uint64_t samples = covered.size();
    while (const auto unit = queue.take()) {
      CHECK(unit->area.width() <= side);
      CHECK(unit->area.height() <= side);
      samples += unit->size();
      sum.add(*unit);
    }
    sum.canonicalise();
    CHECK(samples == SampleBlock{area, {0, 40}}.size());
    CHECK(sum.blocks() == std::vector<SampleBlock>{{area, {0, 40}}});
  }
}

TEST_CASE("units: the whole picture's first samples come before any pixel's last", "[runtime]") {
  const Coverage nothing;
  UnitQueue queue({0, 0, 64, 64}, 16, split_into_rounds({0, 64}), nothing);
  std::uint32_t last = 0;
  while (const auto unit = queue.take()) {
    CHECK(unit->samples.first >= last);
    last = unit->samples.first;
  }
  CHECK(last == 32);
}

}  // namespace
}  // namespace fathom::runtime::units_test
