#include "runtime/film/film_channels.h"

#include <utility>

namespace fathom::runtime {
namespace {

using Pixel = PixelMeans;

constexpr FilmChannel kChannels[] = {
    {"R", false, nullptr, [](const Pixel& p) { return p.radiance.x; }},
    {"G", false, nullptr, [](const Pixel& p) { return p.radiance.y; }},
    {"B", false, nullptr, [](const Pixel& p) { return p.radiance.z; }},
    {"A", false, nullptr,
     [](const Pixel& p) { return p.samples == 0 ? 0 : static_cast<double>(p.hits) / p.samples; }},
    {"Z", false, &FilmLayers::first_hit, [](const Pixel& p) { return p.depth; }},
    {"albedo.R", false, &FilmLayers::first_hit, [](const Pixel& p) { return p.albedo.x; }},
    {"albedo.G", false, &FilmLayers::first_hit, [](const Pixel& p) { return p.albedo.y; }},
    {"albedo.B", false, &FilmLayers::first_hit, [](const Pixel& p) { return p.albedo.z; }},
    {"N.X", false, &FilmLayers::first_hit, [](const Pixel& p) { return normal_of_hits(p).x; }},
    {"N.Y", false, &FilmLayers::first_hit, [](const Pixel& p) { return normal_of_hits(p).y; }},
    {"N.Z", false, &FilmLayers::first_hit, [](const Pixel& p) { return normal_of_hits(p).z; }},
    {"P.X", false, &FilmLayers::position, [](const Pixel& p) { return p.position.x; }},
    {"P.Y", false, &FilmLayers::position, [](const Pixel& p) { return p.position.y; }},
    {"P.Z", false, &FilmLayers::position, [](const Pixel& p) { return p.position.z; }},
    {"id.object", true, &FilmLayers::ids, [](const Pixel& p) { return static_cast<double>(p.surface_id); }},
    {"id.material", true, &FilmLayers::ids, [](const Pixel& p) { return static_cast<double>(p.material_id); }},
    {"sampleCount", true, nullptr, [](const Pixel& p) { return static_cast<double>(p.samples); }},
    {"variance.R", false, &FilmLayers::variance, [](const Pixel& p) { return p.variance.x; }},
    {"variance.G", false, &FilmLayers::variance, [](const Pixel& p) { return p.variance.y; }},
    {"variance.B", false, &FilmLayers::variance, [](const Pixel& p) { return p.variance.z; }},
    {"noisy.R", false, &FilmLayers::halves, [](const Pixel& p) { return p.noisy.x; }},
    {"noisy.G", false, &FilmLayers::halves, [](const Pixel& p) { return p.noisy.y; }},
    {"noisy.B", false, &FilmLayers::halves, [](const Pixel& p) { return p.noisy.z; }},
    {"evaluations", false, &FilmLayers::cost, [](const Pixel& p) { return p.evaluations; }},
    {"instructions", false, &FilmLayers::cost, [](const Pixel& p) { return p.instructions; }},
};

}  // namespace

std::span<const FilmChannel> film_channels() { return kChannels; }

ImageRows rows_of(const Film& film, int width, int height, glm::dvec3 origin, Attributes attributes) {
  ImageRows image{{width, height, film.area(), {}, std::move(attributes)}, {}};
  std::vector<const FilmChannel*> kept;
  for (const FilmChannel& channel : kChannels) {
    if (channel.layer != nullptr && !(film.layers().*channel.layer)) continue;
    kept.push_back(&channel);
    image.channels.push_back({std::string(channel.name), channel.whole});
  }
  image.fill = [&film, origin, kept = std::move(kept)](int y, std::span<const std::span<float>> rows) {
    const PixelRect area = film.area();
    for (int x = area.x0; x < area.x1; ++x) {
      PixelMeans pixel = film.means(x, y);
      if (pixel.hits > 0 && film.layers().position) pixel.position += origin;
      for (std::size_t c = 0; c < rows.size(); ++c) {
        rows[c][static_cast<std::size_t>(x - area.x0)] = static_cast<float>(kept[c]->value(pixel));
      }
    }
  };
  return image;
}

}  // namespace fathom::runtime
