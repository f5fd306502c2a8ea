#include "runtime/measure/measure_images.h"

#include <algorithm>
#include <cmath>

#include "runtime/measure/stopwatch.h"
#include "runtime/render.h"

namespace fathom::runtime {
namespace {

// Far from the seeds of the images, which count from 1.
constexpr std::uint64_t kReferenceSeed = 1u << 20;
// Share of the reference's mean, squared, that keeps the relative error of dark pixels finite.
constexpr double kDarkShare = 0.01;
constexpr double kTrimmed = 0.001;

PixelValues channels_of(const Film& film) {
  PixelValues channels;
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const glm::dvec3 radiance = film.means(x, y).radiance;
      channels.insert(channels.end(), {radiance.x, radiance.y, radiance.z});
    }
  }
  return channels;
}

struct RelativeError {
  double all, trimmed;  // `trimmed` is without the worst 0.1 %
};

RelativeError relative_error(const PixelValues& picture, const PixelValues& reference) {
  double mean = 0;
  for (const double value : reference) mean += value / static_cast<double>(reference.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double difference = picture[i] - reference[i];
    errors.push_back(difference * difference / (reference[i] * reference[i] + kDarkShare * mean * mean + 1e-30));
  }
  std::sort(errors.begin(), errors.end());
  const std::size_t kept = errors.size() - static_cast<std::size_t>(kTrimmed * static_cast<double>(errors.size()));
  RelativeError result{0, 0};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    result.all += errors[i] / static_cast<double>(errors.size());
    if (i < kept) result.trimmed += errors[i] / static_cast<double>(kept);
  }
  return result;
}

// Measurements at one point.
struct Gathered {
  ImagePoint point;
  std::vector<double> seconds, errors, trimmed;
  PixelValues sum;

  void add(const compiler::CompiledScene& scene, RenderOptions options, const PixelValues& reference) {
    options.marching = point.variant.marching;
    options.sampler = point.variant.sampler;
    options.light_sampling = point.variant.light_sampling;
    options.spp = point.spp;
    const double start = thread_seconds();
    const RenderResult result = render(scene, options);
    seconds.push_back(thread_seconds() - start);
    const PixelValues picture = channels_of(result.film);
    const RelativeError error = relative_error(picture, reference);
    errors.push_back(error.all);
    trimmed.push_back(error.trimmed);
    sum.resize(picture.size());
    for (std::size_t i = 0; i < picture.size(); ++i) sum[i] += picture[i];
  }

  ImageMeasurement row(const PixelValues& reference) const {
    ImageMeasurement row;
    const Marching& marching = point.variant.marching;
    row.method = info(marching.method).name;
    row.precision = marching.precision == Precision::Double ? "f64" : "f32";
    row.eps = info(marching.method).uses_epsilon ? marching.epsilon : 0;
    row.sampler = compiler::kSamplerNames[static_cast<std::size_t>(point.variant.sampler)];
    row.lights = kLightSamplingNames[static_cast<std::size_t>(point.variant.light_sampling)];
    row.spp = point.spp;
    row.seeds = static_cast<int>(errors.size());
    const Spread time = spread(seconds);
    row.seconds_med = time.median, row.seconds_min = time.least, row.seconds_max = time.most;
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
      return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
    };
    row.relmse_med = at(0.5), row.relmse_p05 = at(0.05), row.relmse_p95 = at(0.95);
    row.relmse_trimmed_med = spread(trimmed).median;
    PixelValues mean = sum;
    for (double& value : mean) value /= static_cast<double>(errors.size());
    row.floor = relative_error(mean, reference).all;
    return row;
  }
};

}  // namespace

std::vector<ImageVariant> image_variants(const compiler::CompiledScene& scene) {
  using compiler::SamplerKind;
  std::vector<ImageVariant> variants = {{}};
  for (const double epsilon : {1e-2, 1e-3, 1e-4}) {
    variants.push_back({.marching = {.method = Method::Sphere, .epsilon = epsilon}});
  }
  // Sky and environment map are light sources that can be sampled.
  const bool surrounded = scene.background.type != compiler::Background::Type::Gradient;
  if (scene.area_lights.empty() && scene.lights.empty() && !surrounded) return variants;
  for (const SamplerKind sampler : {SamplerKind::Sobol, SamplerKind::Independent})
    variants.push_back({.sampler = sampler});
  variants.push_back({.light_sampling = LightSampling::Nee});
  for (const SamplerKind sampler : {SamplerKind::Blue, SamplerKind::Independent}) {
    variants.push_back({.sampler = sampler, .light_sampling = LightSampling::Bsdf});
  }
  return variants;
}

PixelValues reference_image(const compiler::CompiledScene& scene, const ImagePlan& plan) {
  RenderOptions options;
  options.width = plan.width;
  options.height = plan.height;
  options.seed = kReferenceSeed;
  options.spp = plan.reference_spp;
  options.marching = plan.reference_variant.marching;
  options.sampler = plan.reference_variant.sampler;
  options.light_sampling = plan.reference_variant.light_sampling;
  return channels_of(render(scene, options).film);
}

std::vector<ImageMeasurement> measure_points(const compiler::CompiledScene& scene, std::span<const ImagePoint> points,
                                             const ImagePlan& plan, const PixelValues& reference,
                                             const std::string& scene_name) {
  const PinnedThread pinned;
  RenderOptions options;
  options.width = plan.width;
  options.height = plan.height;
  options.threads = 1;
  std::vector<Gathered> all;
  for (const ImagePoint& point : points) all.push_back({point, {}, {}, {}, {}});
  for (int seed = 1; seed <= plan.seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    for (Gathered& gathered : all) gathered.add(scene, options, reference);
  }
  std::vector<ImageMeasurement> rows;
  for (const Gathered& gathered : all) {
    rows.push_back(gathered.row(reference));
    rows.back().scene = scene_name;
  }
  return rows;
}

std::vector<ImageMeasurement> measure_images(const compiler::CompiledScene& scene,
                                             std::span<const ImageVariant> variants, const ImagePlan& plan,
                                             const std::string& scene_name) {
  std::vector<ImagePoint> points;
  for (const ImageVariant& variant : variants) {
    // Takes at least two samples, because a single sample lies at the pixel's centre.
    for (int spp = plan.spp; spp > 1; spp /= 4) points.push_back({variant, spp});
  }
  return measure_points(scene, points, plan, reference_image(scene, plan), scene_name);
}

}  // namespace fathom::runtime
