
#include "runtime/chart/chart_a.h"
#include "runtime/chart/chart_b.h"
#include "runtime/chart/page.h"
#include "tests/runtime/chart/chart_samples.h"
#include "tests/runtime/chart/svg_reading.h"
#include "tests/runtime/cli/markup_check.h"
#include "tests/support/catch.h"

namespace fathom::runtime::chart_page_test {
namespace {

using test::count_of;
using test::kProvenance;
using test::what_is_wrong;

Page sample_page() {
  Page page;
  page.rays = test::sample_rays();
  page.provenance = kProvenance;
  page.files = {"chart.csv", "images.csv"};
  PageScene scene{"composite", {}, {{"composite-evaluations.png", "Evaluations per pixel", "Brighter is more."}}};
  scene.charts = {{chart_a(page.rays, "composite", Cost::Time, kProvenance), kReadChartATime},
                  {chart_a(page.rays, "composite", Cost::Evaluations, kProvenance), kReadChartAEvaluations},
                  {chart_b(test::sample_images(), "composite", kProvenance), kReadChartB}};
  page.scenes = {scene};
  return page;
}

TEST_CASE("chart page: the markup judge finds what is wrong", "[chart]") {
  CHECK(what_is_wrong("<!DOCTYPE html>\n<a b=\"c\"><img x=\"y\">&amp;<br></a>") == "");
  for (const char* bad : {"<a>", "</a>", "<a><b></a></b>", "<a b=c></a>", "<a b=\"1\" b=\"2\"></a>", "a & b", "a > b",
                          "<a b=\"<\"></a>", "<a", "\x01", "&nbsp;"}) {
    CAPTURE(bad);
    CHECK(what_is_wrong(bad) != "");
  }
}

TEST_CASE("chart page: charts, maps, rows and where they are from", "[chart]") {
  const Page page = sample_page();
  const std::string html = page_html(page);
  CHECK(what_is_wrong(html) == "");
  CHECK(count_of(html, "<svg ") == 3);
  CHECK(count_of(html, "<figcaption>") == 4);
  CHECK(count_of(html, "<img src=\"composite-evaluations.png\" alt=\"Evaluations per pixel\"") == 1);
  CHECK(count_of(html, "<tr") == page.rays.size() + 1);
  CHECK(count_of(html, "<tr class=\"default\">") == 3);
  CHECK(count_of(html, "<td>0 (&lt; 60)</td>") > 0);
  CHECK(count_of(html, "<td>reference</td>") == 3);
  for (const char* fact : {"0123abc", "Xeon, 2 cores", "g++ 12.2", "avx512", "2026-11-21",
                           "fathom chart composite.json", "median of 9 rounds", "<a href=\"chart.csv\">"}) {
    CAPTURE(fact);
    CHECK(html.find(fact) != std::string::npos);
  }
  CHECK(page_html(sample_page()) == html);
}

TEST_CASE("chart page: it needs nothing from elsewhere and suits narrow and dark screens", "[chart]") {
  const std::string html = page_html(sample_page());
  CHECK(count_of(html, "http") == count_of(html, "http://www.w3.org/2000/svg"));
  for (const char* foreign : {"<script", "<link", "@import", "@font-face", "url(", "src=\"/"})
    CHECK(count_of(html, foreign) == 0);
  CHECK(html.find("<meta name=\"viewport\" content=\"width=device-width") != std::string::npos);
  CHECK(html.find("prefers-color-scheme: dark") != std::string::npos);
}

TEST_CASE("chart page: texts are escaped", "[chart]") {
  Page page = sample_page();
  for (RayMeasurement& row : page.rays) row.scene = "<script>", row.method = "a & b";
  page.scenes[0].name = "<script>";
  page.scenes[0].charts[0].reading = "x < y";
  page.scenes[0].maps[0] = {"a\"b.png", "<i>", "&"};
  page.provenance.command = "fathom chart '<x>' && rm";
  page.files = {"a&b.csv"};
  const std::string html = page_html(page);
  CHECK(what_is_wrong(html) == "");
  CHECK(count_of(html, "<script") == 0);
  CHECK(count_of(html, "&lt;script&gt;") == 1);
}

TEST_CASE("chart page: every scene has its own rows, an empty page is one too", "[chart]") {
  Page page = sample_page();
  page.scenes.push_back({"other", {}, {}});
  page.rays[0].scene = "other";
  const std::string html = page_html(page);
  CHECK(what_is_wrong(html) == "");
  CHECK(count_of(html, "<table>") == 2);
  CHECK(count_of(html.substr(html.find("<h2>other")), "<td>sphere tracing f32</td>") == 1);
  CHECK(what_is_wrong(page_html({})) == "");
}

}  // namespace
}  // namespace fathom::runtime::chart_page_test
