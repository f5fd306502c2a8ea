#include "runtime/march/marcher.h"

#include <utility>

#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

// Minimum number of rays searched side by side: two registers of doubles, and few enough not to be missed in the
// stream.
constexpr std::size_t kMinSearchBatch = 16;

}  // namespace

int Marcher::capacity_for(const Field& field) { return field.regions ? kMaxRays : kMaxRays / 2; }

// With regions every point has its own program, so that evaluating many points at once gains nothing.
Marcher::Marcher(const Field& field)
    : field_(field),
      capacity_(capacity_for(field)),
      max_waiting_(static_cast<std::size_t>(capacity_)),
      min_batch_(field.regions ? 1 : kMinSearchBatch) {}

void Marcher::fail_full() { check_failed("room() > 0", __FILE__, __LINE__, "a ray was added to a full marcher"); }

void Marcher::advance() {
  if (waiting_.count > 0) begin_waiting();
  if (live_ > 0) step();
  search();
  max_waiting_ = static_cast<std::size_t>(capacity_ - live_) - searched_.size();
}

void Marcher::begin_waiting() {
  clip(waiting_, clipped_, field_.bound, field_.far);
  begin(waiting_);
  clipped_ = waiting_.count;
}

void Marcher::certify_from(const ClippedRay& ray, int side, const RayInterval& interval, std::uint32_t evaluations,
                           std::uint64_t instructions) {
  searched_.push_back({CertifiedSearch(field_, ray.origin, ray.direction, side, interval), ray.entry, ray.id,
                       evaluations, instructions});
}

// Searches as long as enough rays are left to fill the machine's registers, or no other rays are under way.
void Marcher::search() {
  if (searched_.size() < min_batch_ && (live_ > 0 || searched_.empty())) return;
  const Stage before = clock_.enter(Stage::Certify);
  do {
    evaluate_searches();
  } while (searched_.size() >= min_batch_);
  clock_.enter(before);
}

// Evaluates the field once for every searched ray.
void Marcher::evaluate_searches() {
  const std::size_t count = searched_.size();
  for (std::vector<double>& coordinates : points_) coordinates.resize(count);
  values_.resize(count);
  instructions_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 point = searched_[i].search.point();
    for (int axis = 0; axis < 3; ++axis) points_[axis][i] = point[axis];
  }
  field_.evaluate({points_[0].data(), points_[1].data(), points_[2].data()}, count, values_.data(),
                  instructions_.data(), real_scratch_);
  for (std::size_t i = count; i-- > 0;) {
    searched_[i].search.supply(values_[i], instructions_[i], real_scratch_);
    if (searched_[i].search.done()) end_search(i);
  }
}

// Reports searched ray i. The last searched ray takes its place.
void Marcher::end_search(std::size_t i) {
  const SearchedRay& ray = searched_[i];
  const CertifiedResult& found = ray.search.result();
  if (found.status == RayHit::Status::Invalid) counters_.note_invalid(ray.search.point());
  ++counters_.certified;
  counters_.certified_evaluations += found.evaluations;
  counters_.evaluations += found.evaluations;
  report(ray.id, found.status, static_cast<std::int8_t>(found.side), ray.evaluations + found.evaluations,
         found.evaluations, static_cast<float>(found.width), ray.entry + found.t,
         ray.instructions + found.instructions);
  if (i + 1 < searched_.size()) searched_[i] = std::move(searched_.back());
  searched_.pop_back();
}

}  // namespace fathom::runtime
