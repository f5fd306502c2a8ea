#include "runtime/march/marcher.h"

#include <utility>

#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

// Minimum number of rays searched side by side: two registers of doubles, and few enough not to be missed in the
// stream.
constexpr std::size_t kMinSearchBatch = 16;
// Evaluations after which advance() returns, so that its caller may stop where each takes milliseconds.
constexpr std::size_t kMaxSearchEvaluations = 2048;

}  // namespace

int Marcher::best_load(const Field& field) { return field.regions || field.pieces ? kMaxRays : kMaxRays / 2; }

// With regions every point has its own program, so that evaluating many points at once gains nothing.
Marcher::Marcher(const Field& field) : field_(field), min_batch_(field.regions ? 1 : kMinSearchBatch) {}

void Marcher::fail_full() { check_failed("room() > 0", __FILE__, __LINE__, "a ray was added to a full marcher"); }

void Marcher::advance() {
  if (waiting_.count > 0) begin_waiting();
  if (live_ > 0) step();
  search();
  max_waiting_ = static_cast<std::size_t>(kMaxRays - live_) - searched_.size();
}

void Marcher::begin_waiting() {
  clip(waiting_, clipped_, field_.bound, field_.far);
  begin(waiting_);
  clipped_ = waiting_.count;
}

void Marcher::certify_from(const Field& field, const ClippedRay& ray, int side, const RayInterval& interval,
                           std::uint32_t evaluations, std::uint64_t instructions) {
  searched_.push_back({&field,
                       CertifiedSearch(field, ray.origin, ray.direction, side, interval),
                       ray,
                       interval.end,
                       {evaluations, 0, instructions}});
}

// Searches as long as enough rays are left to fill the machine's registers, or no other rays are under way.
void Marcher::search() {
  if (searched_.size() < min_batch_ && (live_ > 0 || searched_.empty())) return;
  const Stage before = clock_.enter(Stage::Certify);
  std::size_t evaluations = 0;
  do {
    evaluations += searched_.size();
    evaluate_searches();
  } while (searched_.size() >= min_batch_ && evaluations < kMaxSearchEvaluations);
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
  for (std::size_t i = 0, end = 0; i < count; i = end) {  // rays of one field together
    const Field* const field = searched_[i].field;
    while (end < count && searched_[end].field == field) ++end;
    field->evaluate({points_[0].data() + i, points_[1].data() + i, points_[2].data() + i}, end - i,
                    values_.data() + i, instructions_.data() + i, real_scratch_);
  }
  for (std::size_t i = count; i-- > 0;) {
    searched_[i].search.supply(values_[i], instructions_[i], real_scratch_);
    if (searched_[i].search.done()) end_search(i);
  }
}

// Reports searched ray i, or has it go on in float. The last searched ray takes its place.
void Marcher::end_search(std::size_t i) {
  const SearchedRay& searched = searched_[i];
  const CertifiedResult& found = searched.search.result();
  counters_.certified += !resumed_.contains(searched.ray.id);  // counts rays, some of which are searched again
  counters_.certified_evaluations += found.evaluations;
  counters_.evaluations += found.evaluations;
  if (!resume(searched)) {
    if (found.status == RayHit::Status::Invalid) counters_.note_invalid(searched.search.point());
    report(searched.ray.id, found.status, static_cast<std::int8_t>(found.side),
           searched.work.evaluations + found.evaluations, found.evaluations, static_cast<float>(found.width),
           searched.ray.entry + found.t, searched.work.instructions + found.instructions);
  }
  if (i + 1 < searched_.size()) searched_[i] = std::move(searched_.back());
  searched_.pop_back();
}

// Has a ray go on in float if the search has proved free only the beginning of what was left of it.
bool Marcher::resume(const SearchedRay& searched) {
  const CertifiedResult& found = searched.search.result();
  const bool missed = found.status == RayHit::Status::Miss || found.status == RayHit::Status::NearMiss;
  const ClippedRay& ray = searched.ray;
  if (!missed || searched.end >= ray.length) return false;
  Work& work = resumed_[ray.id];
  work.evaluations += searched.work.evaluations + found.evaluations;
  work.certified += found.evaluations;
  work.instructions += searched.work.instructions + found.instructions;
  waiting_.push_from(ray.id, ray.origin - ray.entry * ray.direction, ray.direction, ray.entry + searched.end,
                     ray.entry + ray.length, found.side);
  return true;
}

void Marcher::add_work(RayHit& ray_hit) {
  const auto work = resumed_.find(ray_hit.id);
  if (work == resumed_.end()) return;
  ray_hit.evaluations += work->second.evaluations;
  ray_hit.certified += work->second.certified;
  ray_hit.instructions += work->second.instructions;
  resumed_.erase(work);
}

}  // namespace fathom::runtime
