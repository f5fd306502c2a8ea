#include <limits>

#include "runtime/chart/csv.h"
#include "tests/runtime/chart/chart_samples.h"
#include "tests/support/catch.h"

namespace fathom::runtime::chart_csv_test {
namespace {

using test::kProvenance;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    REQUIRE(end != std::string::npos);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

TEST_CASE("chart csv: fields are quoted where a comma, a quote or a line's end asks for it", "[chart]") {
  CHECK(csv_field("plain text; 'single'") == "plain text; 'single'");
  CHECK(csv_field("") == "");
  CHECK(csv_field("a,b") == "\"a,b\"");
  CHECK(csv_field("say \"hi\"") == "\"say \"\"hi\"\"\"");
  CHECK(csv_field("two\nlines") == "\"two\nlines\"");
  CHECK(csv_field("\r") == "\"\r\"");
}

TEST_CASE("chart csv: the columns of rays and their values", "[chart]") {
  RayMeasurement row;
  row.scene = "a,b";
  row.method = "sphere tracing";
  row.precision = "f32";
  row.eps = 1e-3;
  row.relax = 1.6;
  row.steps_max = 64;
  row.ray_class = "bounce";
  row.rays = 12345678901;
  row.ns_med = 1, row.ns_min = 2, row.ns_max = 3, row.evals_mean = 4.5, row.evals_p99 = 6;
  row.false_hit_ppm = 7, row.false_miss_ppm = 8, row.exhausted_ppm = 9, row.near_miss_ppm = 10, row.gross_ppm = 11;
  row.terr_p50 = 2.5e-6, row.terr_p99 = 13, row.terr_max = std::numeric_limits<double>::quiet_NaN();
  row.nerr_p50 = 15, row.nerr_p99 = 0.1, row.nerr_max = 17;
  const std::vector<std::string> lines = lines_of(rays_csv(std::vector{row}, kProvenance));
  REQUIRE(lines.size() == 2);
  CHECK(
      lines[0] ==
      "scene,method,precision,eps,relax,steps_max,class,rays,ns_med,ns_min,ns_max,evals_mean,evals_p99,false_hit_ppm,"
      "false_miss_ppm,exhausted_ppm,near_miss_ppm,gross_ppm,terr_p50,terr_p99,terr_max,nerr_p50,nerr_p99,nerr_max,"
      "commit,cpu,compiler");
  CHECK(lines[1] ==
        "\"a,b\",sphere tracing,f32,0.001,1.6,64,bounce,12345678901,1,2,3,4.5,6,7,8,9,10,11,2.5e-06,13,nan,15,0.1,17,"
        "0123abc,\"Xeon, 2 cores\",g++ 12.2");
}

TEST_CASE("chart csv: the columns of pictures and their values", "[chart]") {
  const ImageMeasurement row{"s", "tiered", "f32", 0, "sobol", "bsdf", 16, 20, 1, 2, 3, 4, 5, 6, 7, 8e-9};
  const std::vector<std::string> lines = lines_of(images_csv(std::vector{row}, kProvenance));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] ==
        "scene,method,precision,eps,sampler,lights,spp,seeds,seconds_med,seconds_min,seconds_max,relmse_med,relmse_"
        "p05,relmse_p95,"
        "relmse_trimmed_med,floor,commit,cpu,compiler");
  CHECK(lines[1] == "s,tiered,f32,0,sobol,bsdf,16,20,1,2,3,4,5,6,7,8e-09,0123abc,\"Xeon, 2 cores\",g++ 12.2");
}

TEST_CASE("chart csv: a line a row", "[chart]") {
  CHECK(lines_of(rays_csv({}, kProvenance)).size() == 1);
  const auto rows = test::sample_rays();
  CHECK(lines_of(rays_csv(rows, kProvenance)).size() == rows.size() + 1);
}

}  // namespace
}  // namespace fathom::runtime::chart_csv_test
