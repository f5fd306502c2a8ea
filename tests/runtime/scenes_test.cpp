// Every shipped scene: it compiles without a warning, and its image agrees with stored means
// (tests/images/README.md).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "compiler/compile.h"
#include "runtime/render.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/import_folder.h"

namespace fathom::scenes_test {

namespace {

using namespace fathom;
using namespace fathom::compiler;
namespace fs = std::filesystem;

constexpr int kColumns = 16, kRows = 9, kCellSide = 3;  // image size in cells, cell size in pixels
constexpr std::size_t kValues = kColumns * kRows * 3;

std::vector<fs::path> scene_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "scenes")) {
    const fs::path& path = entry.path();
    if (path.extension() == ".json" || path.extension() == ".fathom") files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

CompiledScene compile_file(const fs::path& file) {
  const Source source(file.filename().string(), test::read_file(file));
  Diagnostics diagnostics;
  CompileOptions options;
  options.imports = test::imports_from(file.parent_path());
  auto scene = compile(source, diagnostics, options);
  CHECK(diagnostics.print(source, ErrorFormat::Text) == "");
  REQUIRE(scene);
  return std::move(*scene);
}

// Means over independent renders, and their standard errors.
struct Estimate {
  std::vector<double> mean, error;
  int renders = 0;
};

// [cell][channel]
std::vector<double> cells(const runtime::Film& film) {
  std::vector<double> values(kValues, 0.0);
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const glm::dvec3 radiance = film.means(x, y).radiance;
      const std::size_t cell = static_cast<std::size_t>(y / kCellSide * kColumns + x / kCellSide);
      for (int c = 0; c < 3; ++c) {
        values[3 * cell + static_cast<std::size_t>(c)] += radiance[c] / (kCellSide * kCellSide);
      }
    }
  }
  return values;
}

Estimate estimate(const CompiledScene& scene, int renders, std::uint64_t first_seed) {
  runtime::RenderOptions options;
  options.width = kColumns * kCellSide;
  options.height = kRows * kCellSide;
  options.spp = 64;
  std::vector<double> sum(kValues, 0.0), squares(kValues, 0.0);
  for (int i = 0; i < renders; ++i) {
    options.seed = first_seed + static_cast<std::uint64_t>(i);
    const std::vector<double> values = cells(runtime::render(scene, options).film);
    for (std::size_t v = 0; v < kValues; ++v) {
      sum[v] += values[v];
      squares[v] += values[v] * values[v];
    }
  }
  Estimate result{std::vector<double>(kValues), std::vector<double>(kValues), renders};
  for (std::size_t v = 0; v < kValues; ++v) {
    result.mean[v] = sum[v] / renders;
    const double variance = std::max(0.0, squares[v] / renders - result.mean[v] * result.mean[v]) / (renders - 1);
    result.error[v] = std::sqrt(variance);
  }
  return result;
}

fs::path reference_file(const fs::path& scene) {
  return fs::path(FATHOM_SOURCE_DIR) / "tests/images" / (scene.stem().string() + ".txt");
}

void store(const fs::path& scene, const Estimate& e) {
  std::ofstream out(reference_file(scene));
  out << "# " << scene.filename().string() << ": mean r g b, standard error r g b; " << e.renders << " renders\n";
  for (std::size_t v = 0; v < kValues; v += 3) {
    for (std::size_t c = 0; c < 3; ++c) out << e.mean[v + c] << ' ';
    out << e.error[v] << ' ' << e.error[v + 1] << ' ' << e.error[v + 2] << '\n';
  }
}

Estimate load(const fs::path& scene) {
  std::ifstream in(reference_file(scene));
  std::string comment;
  std::getline(in, comment);
  Estimate e{std::vector<double>(kValues), std::vector<double>(kValues), 64};
  for (std::size_t v = 0; v < kValues; v += 3) {
    in >> e.mean[v] >> e.mean[v + 1] >> e.mean[v + 2] >> e.error[v] >> e.error[v + 1] >> e.error[v + 2];
  }
  INFO("no mean is stored in " << reference_file(scene).string() << " (tests/images/README.md)");
  REQUIRE(in);
  return e;
}

}  // namespace

TEST_CASE("scenes open with a comment and compile without a word", "[runtime][scenes][released]") {
  REQUIRE(scene_files().size() >= 5);
  for (const fs::path& file : scene_files()) {
    CAPTURE(file.filename().string());
    CHECK(test::read_file(file).starts_with("//"));
    compile_file(file);
  }
}

TEST_CASE("pictures of the scenes agree with their stored means", "[runtime][scenes][heavy]") {
  const char* updated = std::getenv("FATHOM_UPDATE_IMAGES");
  for (const fs::path& file : scene_files()) {
    CAPTURE(file.filename().string());
    // These scenes are for show: they run the same code as the others, but take longer. docs/make/pictures renders
    // them.
    const fs::path folder = file.parent_path().filename();
    if (folder == "gallery" || folder == "lib" || test::read_file(file).find("\nimport ") != std::string::npos)
      continue;
    const CompiledScene scene = compile_file(file);
    if (scene.node_count > 500) continue;  // minutes of rendering; scripts/measure counts this scene's hits
    if (updated != nullptr) {
      if (updated != file.stem().string() && updated != std::string_view("all")) continue;
      store(file, estimate(scene, 64, 1000));
      continue;
    }
    const Estimate reference = load(file), now = estimate(scene, 8, 1);
    // Welch's t with at least 7 degrees of freedom: |t| > 4.8 has probability 0.002, so more than 2 % of cells beyond
    // it are not chance. No cell may be beyond 25 (probability 2e-5 for any of 432). The allowance of 1e-5 covers the
    // rounding of the stored digits where nothing varies.
    std::size_t far_off = 0;
    double worst = 0, brighter = 0, variance = 0;
    for (std::size_t v = 0; v < kValues; ++v) {
      const double difference = now.mean[v] - reference.mean[v];
      const double error = std::hypot(now.error[v], reference.error[v]) + 1e-5 * (1 + std::abs(reference.mean[v]));
      worst = std::max(worst, std::abs(difference) / error);
      far_off += std::abs(difference) > 4.8 * error;
      brighter += difference;
      variance += error * error;
    }
    INFO("largest |t| " << worst << ", mean difference in errors " << brighter / std::sqrt(variance));
    CHECK(far_off <= kValues / 50);
    CHECK(worst < 25);
    // Cells share no path, so their errors are independent, except for the three channels: 3 x 5 standard deviations.
    CHECK(std::abs(brighter) < 15 * std::sqrt(variance));
  }
}

}  // namespace fathom::scenes_test
