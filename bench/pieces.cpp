// Compares rays that meet the scene's pieces (runtime/march/piece_marcher.h) with rays through the whole field: what
// they hit, and the time of both. Camera rays, and from each hit a diffuse ray and a ray to a lamp, three times.
// If the two differ, the certified search of the whole field decides.
//
//     build/release/bench_pieces scenes/showcase.json ...
//     build/release/bench_pieces --render scenes/showcase.json ...     times of whole pictures, 320x180 at 16 samples
#include "runtime/field/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>
#include <vector>

#include "bench/scene_file.h"
#include "runtime/march/march.h"
#include "runtime/path/surface.h"
#include "runtime/render.h"
#include "runtime/sampling/camera.h"
#include "runtime/sampling/sampler.h"
#include "runtime/sampling/warp.h"

namespace {

using namespace fathom;
using runtime::Field;
using runtime::Ray;
using runtime::RayHit;

constexpr int kWidth = 320, kHeight = 180, kRounds = 5;

double seconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Runs both in turns. Returns their median times, seconds of the process.
struct Times {
  double whole, pieces;
};
template <class Whole, class Pieces>
Times median_times(const Whole& run_whole, const Pieces& run_pieces) {
  std::vector<double> whole, pieces;
  for (int i = 0; i < kRounds; ++i) {
    const double begin = seconds();
    run_whole();
    const double between = seconds();
    run_pieces();
    whole.push_back(between - begin);
    pieces.push_back(seconds() - between);
  }
  std::ranges::sort(whole);
  std::ranges::sort(pieces);
  return {whole[kRounds / 2], pieces[kRounds / 2]};
}

struct Totals {
  std::size_t rays = 0, missed = 0, added = 0, moved = 0, side = 0, material = 0, wrong = 0, whole_wrong = 0,
              instead = 0;
  double whole = 0, pieces = 0, worst = 0;
  runtime::MarchCounters whole_counts, piece_counts;
};

struct Rendering {
  compiler::CompiledScene scene;
  Field whole, pieces;
};

bool is_hit(const RayHit& hit) { return hit.status == RayHit::Status::Hit; }

double slack_of(const RayHit& a, const RayHit& b) {
  return 4e-6 * std::max(1.0, a.t) + 2 * static_cast<double>(std::max(a.width, b.width));
}

// Returns the material at a hit: of the piece that was hit, or of the whole field.
std::uint32_t material_of(const Rendering& r, const Ray& ray, const RayHit& hit, bool of_piece) {
  vm::Workspace workspace;
  const bool known = of_piece && hit.piece != runtime::kNoPiece;
  const auto& program = known ? r.scene.pieces[hit.piece].surface : r.scene.surface;
  const glm::dvec3 place = ray.origin + hit.t * ray.direction;
  return r.scene.surfaces[vm::evaluate_surface(program, place, workspace).surface].material;
}

// Returns the hits of the pieces.
std::vector<RayHit> compare(const Rendering& r, const std::vector<Ray>& rays, Totals& totals) {
  const runtime::MarchResult whole = runtime::march(r.whole, rays), pieces = runtime::march(r.pieces, rays);
  totals.rays += rays.size();
  totals.whole_counts.merge(whole.counters);
  totals.piece_counts.merge(pieces.counters);
  const Times times = median_times([&] { runtime::march(r.whole, rays); }, [&] { runtime::march(r.pieces, rays); });
  totals.whole += times.whole;
  totals.pieces += times.pieces;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit &a = whole.ray_hits[i], &b = pieces.ray_hits[i];
    if (!is_hit(a) && !is_hit(b)) continue;
    const bool both = is_hit(a) && is_hit(b);
    const double apart = both ? std::abs(a.t - b.t) : 0;
    if (both && apart <= slack_of(a, b)) {
      totals.worst = std::max(totals.worst, apart / std::max(1.0, a.t));
      totals.side += a.side != b.side;
      totals.material += material_of(r, rays[i], a, false) != material_of(r, rays[i], b, true);
      continue;
    }
    ++(both ? totals.moved : is_hit(a) ? totals.missed : totals.added);
    const RayHit truth = runtime::march(r.whole, {&rays[i], 1}, {.method = runtime::Method::Certified}).ray_hits[0];
    const auto agrees = [&](const RayHit& hit) {
      return is_hit(hit) == is_hit(truth) && (!is_hit(hit) || std::abs(hit.t - truth.t) <= slack_of(hit, truth));
    };
    totals.wrong += !agrees(b);
    totals.whole_wrong += !agrees(a);
    if (!agrees(b) && totals.instead++ < 3)
      fmt::print("    ray {} {} {} along {} {} {} side {}: whole {} {}, pieces {} {} (piece {}), certified {} {}\n",
                 rays[i].origin.x, rays[i].origin.y, rays[i].origin.z, rays[i].direction.x, rays[i].direction.y,
                 rays[i].direction.z, rays[i].side, is_hit(a), a.t, is_hit(b), b.t, static_cast<int>(b.piece),
                 is_hit(truth), truth.t);
  }
  return pieces.ray_hits;
}

std::vector<Ray> camera_rays(const Rendering& r) {
  const runtime::Camera camera(r.scene.camera, kWidth, kHeight);
  vm::Workspace workspace;
  std::vector<Ray> rays;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const runtime::CameraRay ray = camera.ray(x + 0.5, y + 0.5);
      const double f = vm::evaluate_distance(*r.whole.distance, ray.origin, workspace);
      rays.push_back({ray.origin, ray.direction, std::numeric_limits<double>::infinity(), f < 0 ? -1 : 1});
    }
  }
  return rays;
}

void spawn(const Rendering& r, const std::vector<Ray>& rays, const std::vector<RayHit>& hits,
           std::vector<Ray>& diffuse, std::vector<Ray>& shadow) {
  vm::Workspace workspace;
  const glm::dvec3 sun = glm::normalize(glm::dvec3(0.4, 0.8, 0.3));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!is_hit(hits[i])) continue;
    const runtime::Hit hit{rays[i].origin + hits[i].t * rays[i].direction, glm::vec3(-rays[i].direction),
                           hits[i].side, hits[i].width, hits[i].piece};
    runtime::SurfacePoint point{};
    runtime::find_surfaces(r.scene, r.pieces, {&hit, 1}, {&point, 1}, workspace);
    runtime::Sampler sampler(1, static_cast<std::uint32_t>(i), 0, 0);
    diffuse.push_back(runtime::spawn_ray(
        hit, point, runtime::to_frame(point.normal, runtime::square_to_cosine_hemisphere(sampler.next2())), false));
    if (glm::dot(glm::dvec3(point.normal), sun) > 0) shadow.push_back(runtime::spawn_ray(hit, point, sun, false));
  }
}

// Prints the times of whole pictures on one thread.
void render(const std::string& path) {
  const compiler::CompiledScene scene = bench::read_scene("bench_pieces", path, true);
  const auto draw = [&](bool pieces) {
    runtime::RenderOptions options;
    options.width = kWidth, options.height = kHeight, options.spp = 16;
    options.threads = 1;
    options.pieces = pieces;
    runtime::render(scene, options);
  };
  const Times times = median_times([&] { draw(false); }, [&] { draw(true); });
  fmt::print("{:36} whole {:7.2f} s, pieces {:7.2f} s, ratio {:5.2f}\n", path, times.whole, times.pieces,
             times.whole / times.pieces);
}

void run(const std::string& path) {
  compiler::CompiledScene compiled = bench::read_scene("bench_pieces", path, true);
  Rendering r{std::move(compiled), {}, {}};
  r.whole = runtime::make_field(r.scene, r.scene.settings.far);
  runtime::RegionOptions regions{.threads = 2, .memory = 1u << 30};
  regions.evaluations = 1e9;
  runtime::add_regions(r.whole, r.scene, regions);
  runtime::add_native_code(r.whole, 1e9);
  r.pieces = r.whole;
  runtime::add_pieces(r.pieces, r.scene, runtime::extent_of(r.scene), r.scene.settings.far, true);
  Totals totals;
  std::vector<Ray> rays = camera_rays(r);
  for (int bounce = 0; bounce < 3 && !rays.empty(); ++bounce) {
    const std::vector<RayHit> hits = compare(r, rays, totals);
    std::vector<Ray> diffuse, shadow;
    spawn(r, rays, hits, diffuse, shadow);
    compare(r, shadow, totals);
    rays = std::move(diffuse);
  }
  const double n = static_cast<double>(totals.rays);
  fmt::print(
      "{:36} {:6} pieces {:4} templates, {:7} rays: whole {:7.1f} ns, pieces {:7.1f} ns, ratio {:5.2f}; "
      "{:.1f} / {:.1f} evaluations, {:.2f} / {:.2f} % certified; missed {} added {} moved {} side {} material {}; "
      "wrong {} (whole {}); worst {:.1e}\n",
      path, r.scene.pieces.size(), r.pieces.pieces ? r.pieces.pieces->templates.size() : 1, totals.rays,
      1e9 * totals.whole / n, 1e9 * totals.pieces / n, totals.whole / totals.pieces,
      static_cast<double>(totals.whole_counts.evaluations) / n,
      static_cast<double>(totals.piece_counts.evaluations) / n,
      100 * static_cast<double>(totals.whole_counts.certified) / n,
      100 * static_cast<double>(totals.piece_counts.certified) / n, totals.missed, totals.added, totals.moved,
      totals.side, totals.material, totals.wrong, totals.whole_wrong, totals.worst);
}

}  // namespace

int main(int argc, char** argv) {
  const bool pictures = argc > 1 && std::string_view(argv[1]) == "--render";
  for (int i = 1 + pictures; i < argc; ++i) pictures ? render(argv[i]) : run(argv[i]);
}
