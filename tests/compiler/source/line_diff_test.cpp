#include "compiler/source/line_diff.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"

namespace fathom::line_diff_test {

namespace {

using fathom::compiler::unified_diff;
using Lines = std::vector<std::string>;

Lines split(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string join(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// Applies a diff to `before` as patch does. Checks each hunk's ranges against the lines that follow.
std::string patched(const std::string& diff, const std::string& before) {
  const Lines old = split(before);
  Lines out;
  std::size_t at = 0, gone = 0, come = 0;
  for (const std::string& line : split(diff)) {
    if (line[0] == '@') {
      REQUIRE((gone == 0 && come == 0));
      std::size_t first = 0, first_new = 0;
      REQUIRE(std::sscanf(line.c_str(), "@@ -%zu,%zu +%zu,%zu @@", &first, &gone, &first_new, &come) == 4);
      const std::size_t begin = first - (gone > 0);
      while (at < begin) out.push_back(old.at(at++));
      CHECK(first_new - (come > 0) == out.size());
      continue;
    }
    if (line[0] != '+') {
      REQUIRE(old.at(at++) == line.substr(1));
      --gone;
    }
    if (line[0] != '-') {
      out.push_back(line.substr(1));
      --come;
    }
  }
  CHECK((gone == 0 && come == 0));
  while (at < old.size()) out.push_back(old[at++]);
  return join(out);
}

}  // namespace

TEST_CASE("line diff: a change, with what stays around it", "[source][diff]") {
  CHECK(unified_diff("a\nb\nc\nd\ne\nf\ng\n", "a\nb\nc\nd\nE\nf\ng\n") ==
        "@@ -2,6 +2,6 @@\n b\n c\n d\n-e\n+E\n f\n g\n");
  CHECK(unified_diff("a\nb\n", "a\nb\n") == "");
  CHECK(unified_diff("", "a\n") == "@@ -0,0 +1,1 @@\n+a\n");
  CHECK(unified_diff("a\n", "") == "@@ -1,1 +0,0 @@\n-a\n");
}

TEST_CASE("line diff: changes seven lines apart have hunks of their own, nearer ones share one", "[source][diff]") {
  const std::string before = "x\n1\n2\n3\n4\n5\n6\n7\ny\n";
  const std::string apart = unified_diff(before, "X\n1\n2\n3\n4\n5\n6\n7\nY\n");
  CHECK(std::count(apart.begin(), apart.end(), '@') == 8);
  const std::string near = unified_diff("x\n1\n2\n3\n4\n5\n6\ny\n", "X\n1\n2\n3\n4\n5\n6\nY\n");
  CHECK(std::count(near.begin(), near.end(), '@') == 4);
}

TEST_CASE("line diff: applied to the one text it gives the other, and marks no line too many", "[source][diff]") {
  fathom::test::Random random(1);
  for (int round = 0; round < 500; ++round) {
    Lines before, after;
    for (int i = random.below(30); i > 0; --i)
      before.push_back(std::string(1, static_cast<char>('a' + random.below(6))));
    for (const std::string& line : before) {
      if (random.chance(0.1)) after.push_back("new");
      if (!random.chance(0.15)) after.push_back(line);
    }
    const std::string diff = unified_diff(join(before), join(after));
    CAPTURE(join(before), join(after), diff);
    CHECK(patched(diff, join(before)) == join(after));
  }
}

TEST_CASE("line diff: what changes too much is not compared, however much stays around it", "[source][diff]") {
  std::string same, other;
  for (int i = 0; i < 20000; ++i) same += "line " + std::to_string(i) + "\n";
  for (int i = 0; i < 11; ++i) other += "other\n";
  CHECK(unified_diff(same + "a\n" + same, same + "b\n" + same, 10).find("-a\n+b\n") != std::string::npos);
  CHECK(unified_diff(same + "a\n", same + other, 10) == "; 1 lines became 11: too many to compare\n");
}

}  // namespace fathom::line_diff_test
