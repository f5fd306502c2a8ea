#include "runtime/march/march.h"

#include "runtime/march/piece_marcher.h"
#include "runtime/march/stream.h"

namespace fathom::runtime {
namespace {

// A marcher that searches every ray in double from its start.
class CertifiedMarcher final : public Marcher {
 public:
  using Marcher::Marcher;

 private:
  void begin(RayBlock& rays) override {
    while (rays.count > 0) {
      const std::size_t i = --rays.count;
      if (!enters(rays, i)) continue;
      ClippedRay ray;
      set_clipped_ray(ray, rays, i);
      certify_from(field_, ray, rays.side[i], {0, rays.length[i], 0}, 0, 0);
    }
  }
  void step() override {}
};

}  // namespace

std::unique_ptr<Marcher> make_marcher(const Field& field, const Marching& marching) {
  if (marching.method == Method::Certified) return std::make_unique<CertifiedMarcher>(field);
  if (field.pieces && marching.method == Method::Tiered && marching.precision == Precision::Single)
    return std::make_unique<PieceMarcher>(field, marching);
  if (marching.precision == Precision::Double) return std::make_unique<Stream<double>>(field, marching);
  return std::make_unique<Stream<float>>(field, marching);
}

MarchCounters march_each(const Field& field, std::span<const Ray> rays, const Marching& marching,
                         const std::function<void(const RayHit&)>& use) {
  const std::unique_ptr<Marcher> marcher = make_marcher(field, marching);
  std::vector<RayHit> ray_hits;
  for (std::size_t next = 0; next < rays.size() || !marcher->empty();) {
    while (next < rays.size() && marcher->room() > 0) {
      marcher->add(static_cast<std::uint32_t>(next), rays[next]);
      ++next;
    }
    marcher->advance();
    marcher->take_ray_hits(ray_hits);
    for (const RayHit& ray_hit : ray_hits) use(ray_hit);
  }
  return marcher->counters();
}

MarchResult march(const Field& field, std::span<const Ray> rays, const Marching& marching) {
  MarchResult result;
  result.ray_hits.resize(rays.size());
  result.counters =
      march_each(field, rays, marching, [&](const RayHit& ray_hit) { result.ray_hits[ray_hit.id] = ray_hit; });
  return result;
}

}  // namespace fathom::runtime
