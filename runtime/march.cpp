#include "runtime/march.h"

#include "runtime/certify.h"
#include "runtime/stream.h"
#include "vm/check.h"

namespace fathom::runtime {
namespace {

// Every ray searched in double from its start.
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

void Marcher::refuse() { check_failed("room() > 0", __FILE__, __LINE__, "a ray was added to a full marcher"); }

void Marcher::advance() {
  if (waiting_.count > 0) begin_waiting();
  if (live_ > 0) step();
}

void Marcher::begin_waiting() {
  clip(waiting_, clipped_, field_.bound, field_.far);
  begin(waiting_);
  clipped_ = waiting_.count;
}

void Marcher::certify_from(const Course& course, int side, const Stretch& stretch, std::uint32_t evaluations,
                           std::uint64_t instructions) {
  const Stage before = clock_.enter(Stage::Resolve);
  const Certified found = certify(field_, course.origin, course.direction, side, stretch, workspace_);
  clock_.enter(before);
  ++counters_.certified;
  counters_.certified_evaluations += found.evaluations;
  counters_.evaluations += found.evaluations;
  arrive(course.id, found.status, static_cast<std::int8_t>(found.side), evaluations + found.evaluations,
         found.evaluations, static_cast<float>(found.width), course.entry + found.t,
         instructions + found.instructions);
}

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
