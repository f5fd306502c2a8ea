// End-to-end tests of `fathom report`.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::test::cli_report_test {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++found;
  return found;
}

const char* const kText =
    "fathom 1\n"
    "object \"<b>ball</b>\" sphere(0.5) // \"quoted\" & <i>more</i>\n"
    "object box([4, 0.1, 4]).translate([0, -0.6, 0])\n"
    "camera (position = [0, 0, 4], target = [0, 0, 0])\n"
    "film (width = 32, height = 16)\n"
    "background [1, 1, 1]\n"
    "render (spp = 2)\n";

}  // namespace

TEST_CASE("report: one page has the picture, the source, the program and the costs", "[cli][report]") {
  const Folder folder;
  folder.write("scene.fathom", kText);
  const Result result = folder.run("report scene.fathom -o page.html");
  CHECK(result.code == 0);
  CHECK(contains(result.err, "wrote page.html"));
  const std::string page = folder.read("page.html");
  CHECK(page.starts_with("<!doctype html>"));
  // Picture, three layers and two cost maps; nothing comes from elsewhere.
  CHECK(count(page, "src=\"data:image/png;base64,iVBOR") == 6);
  CHECK(count(page, "src=\"") == 6);
  CHECK(count(page, "href=\"") == count(page, "href=\"#"));
  for (const char* title :
       {"Picture", "Live", "Scene", "Check", "Layers", "Cost", "Profile", "Operations", "Program"}) {
    CHECK(contains(page, std::string("<h2>") + title + "</h2>"));
  }
  CHECK(contains(page, "<span class=\"comment\">// &quot;quoted&quot; &amp; &lt;i&gt;more&lt;/i&gt;</span>"));
  CHECK(contains(page, "scene.fathom: no errors"));
  CHECK(contains(page, "sandbox=\"allow-scripts\""));
  CHECK_FALSE(contains(page, "<b>ball</b>"));
  CHECK_FALSE(contains(page, "<script"));  // those of the live view are within its frame's attribute
  // The page says how it was made.
  CHECK(contains(page, "<code>fathom report scene.fathom -o page.html</code>"));
}

// Lines of an imported file once counted as lines of the scene's own file with the same numbers.
TEST_CASE("report: what an import costs belongs to no line of the scene", "[cli][report]") {
  const Folder folder;
  folder.write("parts.fathom", "fathom 1\n\n\ndef part() = torus(1, 0.2)\n");
  folder.write("scene.fathom",
               "fathom 1\nimport \"parts.fathom\" as parts\nobject sphere(0.5) + parts.part()\n// four\n"
               "camera (position = [0, 0, 4], target = [0, 0, 0])\nfilm (width = 8, height = 8)\n"
               "background [1, 1, 1]\nrender (spp = 1)\n");
  REQUIRE(folder.run("report scene.fathom -o page.html").code == 0);
  const std::string page = folder.read("page.html");
  CHECK(contains(page, "<tr><td>3<td><meter"));
  CHECK(contains(page, "<tr><td>4<td><td>"));
}

TEST_CASE("report: its name, its size and a chart can be chosen", "[cli][report]") {
  const Folder folder;
  folder.write("chart.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"><script>alert(1)</script></svg>");
  CHECK(folder.run("report ball.json --size 20x10 -s 3 --chart chart.svg").code == 0);
  const std::string page = folder.read("ball.html");
  CHECK(contains(page, "width=\"20\" height=\"10\""));
  CHECK(contains(page, "3 samples per pixel"));
  CHECK(contains(page, "src=\"data:image/svg+xml;base64,"));  // scripts in images do not run
  CHECK_FALSE(contains(page, "alert(1)"));
}

TEST_CASE("report: says what it cannot do", "[cli][report]") {
  const Folder folder;
  CHECK(folder.run("report none.json").code == 74);
  CHECK(folder.run("report ball.json --chart none.svg").code == 74);
  CHECK(folder.run("report ball.json -o ball.json/page.html").code == 74);
  CHECK(folder.run("report ball.json -o ball.json").code == 2);
  CHECK(folder.run("report -", kBall).code == 2);
  CHECK(folder.run("report - -o page.html", kBall).code == 0);
  folder.write("bad.json", "{");
  CHECK(folder.run("report bad.json").code == 65);
  CHECK_FALSE(folder.has("bad.html"));
}

}  // namespace fathom::test::cli_report_test
