// B14: every instruction set computes the same bits.
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

#include "bench/bars/bars.h"
#include "bench/closed_forms.h"
#include "bench/clouds.h"
#include "runtime/march/march.h"

namespace fathom::bench {
namespace {

// IEEE 754 leaves the sign and payload of a NaN to the processor, so all NaNs count as equal.
std::uint32_t bits_of(float a) {
  return std::bit_cast<std::uint32_t>(std::isnan(a) ? std::numeric_limits<float>::quiet_NaN() : a);
}

// Random points in and around the scenes. Every third point may have coordinates that break formulas: zeros,
// subnormals, huge numbers, infinities and NaN.
Cloud nasty_cloud(std::size_t count) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kNasty[] = {0.0f,  -0.0f, 1e-40f, -1e-45f, 1e-20f, 1e5f, -1e5f,
                              1e20f, 3e38f, -3e38f, kInf,    -kInf,  1.0f, std::numeric_limits<float>::quiet_NaN()};
  Engine random(23);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [&] {
      if (i % 3 == 0 && random() % 2 == 0) return kNasty[random() % std::size(kNasty)];
      return static_cast<float>(uniform(random, -4, 4));
    };
    cloud.x.push_back(number());
    cloud.y.push_back(number());
    cloud.z.push_back(number());
  }
  return cloud;
}

// Returns the bits of the distances, gradients and surface ids at the cloud's points.
std::vector<std::uint32_t> all_bits(const compiler::CompiledScene& scene, const Cloud& cloud) {
  const std::size_t n = cloud.x.size();
  vm::Workspace workspace;
  std::vector<float> alone(n), distance(n), x(n), y(n), z(n);
  std::vector<std::uint32_t> bits(n);
  vm::evaluate_distance(scene.distance, cloud.points(), n, alone.data(), workspace);
  vm::evaluate_surface(scene.surface, cloud.points(), n, {distance.data(), x.data(), y.data(), z.data(), bits.data()},
                       workspace);
  for (const auto* values : {&alone, &distance, &x, &y, &z}) {
    for (const float value : *values) bits.push_back(bits_of(value));
  }
  return bits;
}

std::size_t differences(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::size_t count = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += a[i] != b[i];
  return count;
}

// Calls `measure` with each available instruction set, the scalar one first. Returns how many numbers differ from the
// scalar ones.
template <class Measure>
std::size_t differences_from_scalar(const Measure& measure, std::size_t& compared) {
  const std::string before(vm::isa_name());
  vm::force_isa("scalar");
  const std::vector<std::uint32_t> scalar = measure();
  std::size_t count = 0;
  for (const std::string_view isa : vm::available_isas()) {
    if (isa == "scalar") continue;
    vm::force_isa(isa);
    count += differences(scalar, measure());
    compared += scalar.size();
  }
  vm::force_isa(before);
  return count;
}

std::string others() {
  std::string names;
  for (const std::string_view isa : vm::available_isas()) {
    if (isa != "scalar") names += (names.empty() ? "" : ", ") + std::string(isa);
  }
  return names;
}

void evaluation(BarTable& table, std::size_t samples) {
  namespace fs = std::filesystem;
  std::size_t scenes = 0, compared = 0, count = 0;
  for (const char* folder : {"scenes", "scenes/bench"}) {
    for (const auto& entry : fs::directory_iterator(std::string(FATHOM_SOURCE_DIR) + "/" + folder)) {
      if (entry.path().extension() != ".json") continue;
      const auto scene = compile_file(folder + ("/" + entry.path().filename().string()));
      // Fewer points for longer programs, so that each scene takes about equally long. Some have ten thousand
      // instructions.
      const std::size_t points =
          std::clamp<std::size_t>(samples / (1 + scene.distance.instructions() / 10), 67, 65536);
      const Cloud cloud = nasty_cloud(points);
      count += differences_from_scalar([&] { return all_bits(scene, cloud); }, compared);
      ++scenes;
    }
  }
  table.none("B14", fmt::format("{} scenes: numbers that differ from the scalar machine's on {}", scenes, others()),
             count, compared);
}

void ray_hits(BarTable& table, std::size_t samples) {
  const compiler::CompiledScene scene = compile_file("scenes/bench/h-composite.json");
  const runtime::Field field = runtime::make_field(scene, 30);
  Engine random(29);
  std::vector<runtime::Ray> rays;
  for (std::size_t i = 0; i < samples / 20; ++i) {
    const double x = uniform(random, -3, 3), y = uniform(random, -1, 2), z = uniform(random, -3, 3);
    rays.push_back({glm::dvec3(x, y, z), random_direction(random)});
  }
  std::size_t compared = 0;
  const auto measure = [&] {
    std::vector<std::uint32_t> bits;
    for (const runtime::RayHit& ray_hit : runtime::march(field, rays).ray_hits) {
      const auto t = std::bit_cast<std::uint64_t>(ray_hit.t);
      bits.insert(bits.end(),
                  {static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(t >> 32), bits_of(ray_hit.width),
                   ray_hit.evaluations, static_cast<std::uint32_t>(ray_hit.status), ray_hit.certified});
    }
    return bits;
  };
  const std::size_t count = differences_from_scalar(measure, compared);
  table.none("B14", fmt::format("H, {} rays from anywhere: numbers of ray hits that differ", rays.size()), count,
             compared);
}

}  // namespace

void machine_bars(BarTable& table, const Counts& counts) {
  evaluation(table, counts.samples);
  ray_hits(table, counts.samples);
}

}  // namespace fathom::bench
