#include "runtime/march/march.h"

#include "runtime/march/stream.h"

namespace fathom::runtime {
namespace {

// A marcher that searches every ray in double from its start.
class Certifier final : public Marcher {
 public:
  using Marcher::Marcher;

 private:
  void begin(RayBlock& rays) override {
    while (rays.count > 0) {
      const std::size_t i = --rays.count;
      if (!enters(rays, i)) continue;
      Course course;
      set_course(course, rays, i);
      certify_from(course, rays.side[i], {0, rays.length[i], 0}, 0, 0);
    }
  }
  void step() override {}
};

}  // namespace

std::unique_ptr<Marcher> make_marcher(const Field& field, const Marching& marching) {
  if (marching.method == Method::Certified) return std::make_unique<Certifier>(field);
  if (marching.precision == Precision::Double) return std::make_unique<Stream<double>>(field, marching);
  return std::make_unique<Stream<float>>(field, marching);
}

MarchCounters follow(const Field& field, std::span<const Ray> rays, const Marching& marching,
                     const std::function<void(const Arrival&)>& settle) {
  const std::unique_ptr<Marcher> marcher = make_marcher(field, marching);
  std::vector<Arrival> arrivals;
  for (std::size_t next = 0; next < rays.size() || !marcher->empty();) {
    while (next < rays.size() && marcher->room() > 0) {
      marcher->add(static_cast<std::uint32_t>(next), rays[next]);
      ++next;
    }
    marcher->advance();
    marcher->take_arrivals(arrivals);
    for (const Arrival& arrival : arrivals) settle(arrival);
  }
  return marcher->counters();
}

MarchResult march(const Field& field, std::span<const Ray> rays, const Marching& marching) {
  MarchResult result;
  result.arrivals.resize(rays.size());
  result.counters =
      follow(field, rays, marching, [&](const Arrival& arrival) { result.arrivals[arrival.id] = arrival; });
  return result;
}

}  // namespace fathom::runtime
