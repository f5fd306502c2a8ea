// Images of scenes that move while the shutter is open.
#include <cmath>
#include <vector>

#include "runtime/render.h"
#include "runtime/sampling/shutter.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::motion_blur_test {
namespace {

using namespace fathom;
using runtime::RenderOptions;
using runtime::RenderResult;

// A board off its axis of rotation, over a floor. One turn per second.
const char* const kSpinning = R"({
  "version": 1,
  "params": {"time": 0},
  "camera": {"position": [0, 1, 4], "target": [0, 0, 0]},
  "film": {"width": 24, "height": 16},
  "render": {"rr_depth": 2, "sampler": "independent"},
  "background": {"bottom": [0.3, 0.3, 0.3], "top": [1, 1, 1]},
  "materials": {"checked": {"type": "diffuse", "color": {"pattern": "checker", "a": 0.1, "b": 0.9, "scale": 0.3}},
                "grey": {"type": "diffuse", "color": 0.5}},
  "objects": [
    {"name": "board", "type": "union", "rotate": [0, 0, "360*time"], "material": "checked",
     "of": [{"type": "box", "half_size": [0.6, 0.3, 0.2], "translate": [0.5, 0.1, 0]}]},
    {"name": "floor", "type": "plane", "normal": [0, 1, 0], "offset": -1.2, "material": "grey"}]
})";

compiler::CompiledScene at(double time, const char* text = kSpinning) {
  compiler::CompileOptions options;
  options.definitions = {{"time", time}};
  return test::compiled(text, options);
}

// The scenes that a shutter sees while it is open for `open` seconds, and the options for them.
struct Blurred {
  compiler::CompiledScene scene = at(0);
  std::vector<compiler::CompiledScene> scenes;
  RenderOptions options;

  Blurred(int spp, int times, double open, std::uint64_t seed = 0) {
    options.spp = spp;
    options.seed = seed;
    options.layers = runtime::kAllLayers;
    options.layers.halves = true;
    const auto runs = runtime::shutter_intervals(spp, times, seed, 0);
    for (const runtime::ShutterInterval& run : runs) scenes.push_back(at(open * run.time));
    for (std::size_t i = 0; i < runs.size(); ++i) options.moments.push_back({&scenes[i], runs[i].samples});
  }

  RenderResult render() const { return runtime::render(scene, options); }
};

TEST_CASE("motion blur: the film is the sum of the moments' own, each with its samples", "[runtime]") {
  const Blurred blurred(16, 4, 0.4);
  const RenderResult whole = blurred.render();
  REQUIRE(whole.covered.front().covers({{0, 0, 24, 16}, {0, 16}}));
  runtime::Film sum(24, 16, whole.film.layers());
  for (const runtime::Moment& moment : blurred.options.moments) {
    RenderOptions still = blurred.options;
    still.moments.clear();
    still.sample_range = moment.samples;
    CHECK(sum.merge(runtime::render(*moment.scene, still).film));
  }
  CHECK(whole.film.hash() == sum.hash());
  RenderOptions still = blurred.options;
  still.moments.clear();
  CHECK_FALSE(runtime::render(blurred.scene, still).film.hash() == sum.hash());
}

TEST_CASE("motion blur: threads, tiles, ranges of samples and crops leave no trace", "[runtime]") {
  Blurred blurred(16, 3, 0.4);  // runs of 4, 6 and 6 samples
  const RenderResult whole = blurred.render();
  blurred.options.threads = 3;
  blurred.options.tile = 5;
  CHECK(blurred.render().film.hash() == whole.film.hash());
  runtime::Film sum(24, 16, whole.film.layers());
  for (const runtime::SampleRange range : {runtime::SampleRange{5, 13}, {0, 5}, {13, 16}}) {
    blurred.options.sample_range = range;
    for (const runtime::PixelRect crop : {runtime::PixelRect{0, 0, 7, 16}, {7, 0, 24, 16}}) {
      blurred.options.crop = crop;
      CHECK(sum.merge(blurred.render().film));
    }
  }
  CHECK(sum.hash() == whole.film.hash());
}

TEST_CASE("motion blur: a render that is stopped goes on with the same bits, wherever it was", "[runtime]") {
  Blurred blurred(16, 4, 0.4);
  blurred.options.tile = 4;
  const std::uint64_t wanted = blurred.render().film.hash();
  std::size_t stopped = 0;
  for (const double moment : {0.0, 0.1, 0.3, 0.5, 0.9}) {
    std::atomic<bool> cancel = false;
    blurred.options.cancel = &cancel;
    blurred.options.on_progress = [&](const runtime::Progress& progress) {
      CHECK(progress.fraction <= 1);
      if (progress.fraction > moment) cancel = true;
    };
    RenderResult part = blurred.render();
    stopped += part.stats.end == runtime::RenderEnd::Cancelled;
    blurred.options.cancel = nullptr;
    blurred.options.on_progress = nullptr;
    blurred.options.resume_from = std::make_shared<runtime::PartialRender>(std::move(part));
    const RenderResult rest = blurred.render();
    blurred.options.resume_from = nullptr;
    CHECK(rest.stats.end == runtime::RenderEnd::Done);
    CHECK(rest.film.hash() == wanted);
  }
  CHECK(stopped >= 4);
}

TEST_CASE("motion blur: a time limit gives every pixel the first moment, and says how it ended", "[runtime]") {
  Blurred blurred(16, 4, 0.4);
  blurred.options.time_limit = 1e-9;
  const RenderResult result = blurred.render();
  CHECK(result.stats.end == runtime::RenderEnd::TimeLimit);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 24; ++x) CHECK((result.film.samples(x, y) >= 1 && result.film.samples(x, y) <= 4));
  }
}

TEST_CASE("motion blur: ids are those of moments whose tables are the picture's own", "[runtime]") {
  const char* const appearing = R"({
    "version": 1, "params": {"time": 0}, "background": [1, 1, 1], "film": {"width": 8, "height": 8},
    "camera": {"position": [0, 0, 4]}, "objects": [{"name": "a", "type": "sphere", "radius": 1}]})";
  const char* const another = R"({
    "version": 1, "background": [1, 1, 1], "film": {"width": 8, "height": 8}, "params": {"time": 0},
    "camera": {"position": [0, 0, 4]}, "objects": [{"name": "b", "type": "sphere", "radius": 1}]})";
  const compiler::CompiledScene own = at(0, appearing), other = at(0, another);
  RenderOptions options;
  options.spp = 4;
  options.layers = runtime::kAllLayers;
  options.moments = {{&own, {0, 2}}, {&other, {2, 4}}};
  CHECK(runtime::render(own, options).film.means(4, 4).surface_id == 1);
  options.moments = {{&other, {0, 2}}, {&own, {2, 4}}};
  CHECK(runtime::render(own, options).film.means(4, 4).surface_id == 0);
  CHECK(runtime::render(own, options).film.means(4, 4).depth == Approx(3.0).margin(0.1));
}

// The mean of many images of 16 moments equals an image of 4096 moments. The images' spread gives the tolerance. With
// 64 images, the mean square deviation of 384 pixels, in standard deviations, is 1.03 (t-distributed, 63 degrees of
// freedom: 63/61), within 0.075. The largest deviation is seldom above 4.
TEST_CASE("motion blur: 16 moments give the light of 4096 on average, within their noise", "[runtime][heavy]") {
  constexpr int kPictures = 64, kWidth = 24, kHeight = 16, kReferenceSpp = 8192;
  Blurred reference(kReferenceSpp, 4096, 0.5, 1000);
  reference.options.layers = {};
  reference.options.layers.variance = true;
  const RenderResult wanted = reference.render();
  std::vector<double> sum(kWidth * kHeight), squares(kWidth * kHeight);
  for (int i = 0; i < kPictures; ++i) {
    Blurred blurred(32, 16, 0.5, static_cast<std::uint64_t>(i));
    const RenderResult picture = blurred.render();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double value = picture.film.means(x, y).radiance.x;
        sum[static_cast<std::size_t>(y * kWidth + x)] += value;
        squares[static_cast<std::size_t>(y * kWidth + x)] += value * value;
      }
    }
  }
  double most = 0, all = 0;
  int pixels = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(y * kWidth + x);
      const double mean = sum[at] / kPictures;
      const double spread = (squares[at] / kPictures - mean * mean) / (kPictures - 1);
      const runtime::PixelMeans truth = wanted.film.means(x, y);
      const double variance = spread + truth.variance.x;
      if (!(variance > 1e-14)) continue;  // the background at the top, equal in all images
      const double z = (mean - truth.radiance.x) / std::sqrt(variance);
      most = std::max(most, std::abs(z));
      all += z * z;
      ++pixels;
    }
  }
  INFO("pixels " << pixels << ", mean square of z " << all / pixels << ", largest " << most);
  CHECK(pixels > 200);
  CHECK(all / pixels == Approx(1.03).margin(4 * std::sqrt(2.0 / pixels)));
  CHECK(most < 5.5);
}

}  // namespace
}  // namespace fathom::motion_blur_test
