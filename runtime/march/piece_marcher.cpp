#include "runtime/march/piece_marcher.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace fathom::runtime {
namespace {

// Points that are worth an evaluation, two registers of them, unless there are fewer everywhere.
constexpr std::size_t kFewRays = 32;
// Maximum number of rays under way: each has a lane.
constexpr std::uint32_t kMaxStates = PieceStream::kLanes;
// Length beyond an exit, relative to max(1, |p|), at which a ray is in the next piece if it goes on: above the error
// in double of an exit that the ray meets at a slope of a hundred thousandth.
constexpr double kExitResolution = 0x1p-32;
// Share of t by which an exit found in float may be off: twice the tolerance of a root (tiered-inl.h).
constexpr double kExitSlack = 0x1p-15;

}  // namespace

PieceMarcher::PieceMarcher(const Field& field, const Marching& marching)
    : Marcher(field),
      pieces_(*field.pieces),
      marching_(marching),
      register_lanes_(register_lanes()),
      searches_(field),
      streams_(pieces_.templates.size()),
      own_(pieces_.templates.size()),
      proposals_(pieces_.templates.size()),
      states_(kMaxStates) {
  for (std::uint32_t i = kMaxStates; i-- > 0;) free_.push_back(i);
  if (pieces_.fields.size() <= PieceScan::kMostPieces) scan_ = std::make_unique<PieceScan>(pieces_);
}

// Scans the rays that have come since the last scan, and ends those that have no pieces left to march through.
void PieceMarcher::scan(RayBlock& rays) {
  for (std::size_t i = scanned_; i < rays.count; ++i) {
    if (rays.side[i] == 0 && rays.clip_result(i) == ClipResult::Within)
      rays.side[i] = static_cast<std::int8_t>(side_at(rays.origin_of(i)));
  }
  const std::size_t points = scan_->scan(rays, scanned_, workspace_);
  counters_.evaluations += points;
  counters_.lanes += (points + register_lanes_ - 1) / register_lanes_ * register_lanes_;
  std::size_t kept = scanned_;
  for (std::size_t i = scanned_; i < rays.count; ++i) {
    const PieceScan::Found& found = scan_->found(i);
    if (!enters(rays, i)) continue;
    if (found.others != 0 || rays.side[i] < 0) {
      rays.move(i, kept);
      scan_->move(i, kept++);
    } else {
      const bool hit = found.piece != kNoPiece;
      report(rays.id[i], hit ? RayHit::Status::Hit : RayHit::Status::Miss, std::int8_t{1}, found.evaluations, 0u,
             found.width, hit ? rays.entry[i] + found.t : 0, found.instructions, found.piece);
    }
  }
  rays.count = kept;
}

void PieceMarcher::begin(RayBlock& rays) {
  if (scan_) scan(rays);
  while (rays.count > 0 && !free_.empty()) {
    const std::size_t i = --rays.count;
    if (scan_ || enters(rays, i)) begin_ray(rays, i);
  }
  scanned_ = rays.count;
}

void PieceMarcher::begin_ray(const RayBlock& rays, std::size_t i) {
  ++live_;
  const std::uint32_t number = free_.back();
  free_.pop_back();
  RayState& state = states_[number];
  set_clipped_ray(state.ray, rays, i);
  state.slope = rays.slope[i];
  state.leaves = rays.leaves[i];
  state.roots.clear();
  state.reach = state.ray.length;
  state.miss = RayHit::Status::Miss;
  state.exact = false;
  state.evaluations = state.certified = 0;
  state.instructions = 0;
  state.side = static_cast<std::int8_t>(rays.side[i] == 0 ? side_at(state.ray.origin) : rays.side[i]);
  if (state.side > 0) {
    begin_outside(number, i);
  } else if (enter_solid(state, 0)) {
    start(number);
  } else {  // it has left the solid where it begins
    state.roots.push_back({0, 0, kNoPiece, -1});
    end_ray(number);
  }
}

void PieceMarcher::begin_outside(std::uint32_t number, std::size_t i) {
  RayState& state = states_[number];
  ready_.push_back(number);
  if (!scan_) return pieces_.boxes.begin(state.ray.origin, state.ray.direction, state.ray.length, state.visit);
  const PieceScan::Found& found = scan_->found(i);
  scan_->list(found.others, state.ray.origin, state.ray.direction, state.ray.length, state.visit);
  state.evaluations = found.evaluations;
  state.instructions = found.instructions;
  if (found.piece != kNoPiece) add_root(state, found.t, found.width, found.piece);
}

void PieceMarcher::add_root(RayState& state, double t, float width, std::uint32_t piece) {
  state.roots.push_back({t, width, piece, state.side});
  if (state.side > 0) state.reach = std::min(state.reach, t + static_cast<double>(width));
}

// Returns -1 if a place lies within a piece, else 1. Rays of one camera begin at one place, or near it on a lens.
int PieceMarcher::side_at(glm::dvec3 place) {
  if (place == place_) return side_;
  if (glm::distance(place, clear_place_) < clear_) return 1;
  place_ = place;
  side_ = find_solid(field_, place, real_scratch_) ? -1 : 1;
  if (clear_ < 0) {
    clear_place_ = place;
    clear_ = side_ > 0 ? clear_around(place) : 0;
  }
  return side_;
}

// Returns the length around a place outside the pieces within which there is no piece, or less.
double PieceMarcher::clear_around(glm::dvec3 place) {
  double clear = std::numeric_limits<double>::infinity();
  std::uint64_t instructions = 0;
  for (const Field& piece : pieces_.fields) {
    const double outside = glm::length(glm::max(glm::max(piece.bound.lo - place, place - piece.bound.hi), 0.0));
    if (outside >= clear) continue;
    const bool bounded = !piece.may_jump() && !piece.cells;
    const double value = outside > 0 || !bounded ? 0 : piece.evaluate(place, real_scratch_, instructions);
    clear = std::max(outside, (value - piece.rounding(place)) / piece.lipschitz);
  }
  return std::max(0.0, clear);
}

// Has the ray enter the next box that it has to, or ends it.
void PieceMarcher::begin_next_piece(std::uint32_t number) {
  RayState& state = states_[number];
  if (state.side < 0) return leave_piece(number);
  for (BoxedPiece box; pieces_.boxes.next(state.visit, state.reach, box);) {
    state.piece = box.piece;
    state.from = static_cast<double>(box.entry), state.to = static_cast<double>(box.exit);
    const auto piece = static_cast<std::uint32_t>(box.piece);
    const std::uint32_t shared = pieces_.template_of[piece];
    // A ray that leaves a convex solid does not meet it again.
    if (piece == state.leaves && pieces_.templates[shared].convex) continue;
    if (pieces_.forms_of(piece).empty()) return start(number);
    if (!proposals_[shared]) proposals_[shared] = std::make_unique<PieceProposals>(pieces_, shared);
    if (proposals_[shared]->size() == PieceProposals::kCapacity) answer(shared);
    return proposals_[shared]->add(number, state.piece, state.ray.origin, state.ray.direction, state.reach);
  }
  end_ray(number);
}

double PieceMarcher::value_at(RayState& state, std::uint32_t piece, double t) {
  ++state.evaluations, ++state.certified;
  ++counters_.evaluations, ++counters_.certified_evaluations;
  const glm::dvec3 place = state.ray.origin + t * state.ray.direction;
  return pieces_.fields[piece].evaluate(place, real_scratch_, state.instructions);
}

// Has the ray go on in the first piece that it is in at t. Returns false if there is none.
bool PieceMarcher::enter_solid(RayState& state, double t) {
  const glm::dvec3 place = state.ray.origin + t * state.ray.direction;
  pieces_.boxes.begin(place, state.ray.direction, state.ray.length - t, around_);
  for (BoxedPiece box; pieces_.boxes.next(around_, 0, box);) {
    const auto piece = static_cast<std::uint32_t>(box.piece);
    const double level = kLevelRoundings * pieces_.fields[piece].rounding(place), value = value_at(state, piece, t);
    if (!(value <= level)) continue;
    // A ray that grazes a shared face is at the rounding level of 0 for a while.
    const double from = value < -level ? t : t + kMinLevel * std::max(1.0, compiler::largest_part(place));
    if (from > t && !(value_at(state, piece, from) < -level)) continue;
    state.piece = box.piece;
    state.from = from, state.to = t + static_cast<double>(box.exit);
    return true;
  }
  return false;
}

// Has a ray that has come to the exit of a piece go on in another, or ends it. If it leaves several pieces at one
// place, the first is hit.
void PieceMarcher::leave_piece(std::uint32_t number) {
  RayState& state = states_[number];
  Root& exit = state.roots.back();
  const glm::dvec3 place = state.ray.origin + exit.t * state.ray.direction;
  pieces_.boxes.begin(place, {1, 0, 0}, 0, around_);
  others_.clear();
  for (BoxedPiece box; pieces_.boxes.next(around_, 0, box);) {
    if (box.piece != state.piece) others_.push_back(static_cast<std::uint32_t>(box.piece));
  }
  if (others_.empty()) return end_ray(number);
  if (!state.exact) return search_exit(number);
  const double beyond = kExitResolution * std::max(1.0, compiler::largest_part(place));
  if (enter_solid(state, exit.t + beyond)) {
    state.roots.clear();
    return start(number);
  }
  for (const std::uint32_t other : others_) {
    if (other < exit.piece && value_at(state, other, exit.t - beyond) < 0) exit.piece = other;
  }
  end_ray(number);
}

// Finds the exit from the piece again, in double.
void PieceMarcher::search_exit(std::uint32_t number) {
  const RayState& state = states_[number];
  const Root& exit = state.roots.back();
  const double t = exit.t - state.from, slack = kExitSlack * exit.t + static_cast<double>(exit.width);
  const ClippedRay part{state.ray.origin + state.from * state.ray.direction, state.ray.direction, state.from,
                        state.to - state.from, number};
  searches_.certify_from(pieces_.fields[static_cast<std::size_t>(state.piece)], part, -1,
                         {std::max(0.0, t - slack), part.length, std::min(part.length, t + slack)}, 0, 0);
}

// Has the ray march through its box.
void PieceMarcher::start(std::uint32_t number) {
  const RayState& state = states_[number];
  const auto piece = static_cast<std::uint32_t>(state.piece);
  const std::uint32_t shared = pieces_.template_of[piece];
  const double begin = state.from, end = std::min(state.to, state.reach);
  const bool departs = piece == state.leaves || (state.side < 0 && begin == 0);
  const float slope = departs ? state.slope : -1.0f;
  if (pieces_.templates[shared].runs_program) {
    if (!streams_[shared]) streams_[shared] = std::make_unique<PieceStream>(pieces_, shared, marching_);
    return streams_[shared]->start(number, state.piece, state.ray.origin, state.ray.direction, begin, end, state.side,
                                   slope);
  }
  if (!own_[shared]) own_[shared] = std::make_unique<Stream<float>>(pieces_.fields[piece], marching_);
  while (own_[shared]->room() == 0) advance(*own_[shared]);
  own_[shared]->add(number, {state.ray.origin, state.ray.direction, end, state.side, slope, begin});
}

// Ends the template's proposals. Rays whose roots the field does not confirm march.
void PieceMarcher::answer(std::uint32_t shared) {
  const std::size_t evaluated = proposals_[shared]->answer(answers_, workspace_);
  counters_.evaluations += evaluated;
  counters_.lanes += (evaluated + register_lanes_ - 1) / register_lanes_ * register_lanes_;
  const std::uint64_t instructions = 2 * pieces_.templates[shared].code.instructions;
  for (const PieceProposals::Answer& each : answers_) {
    RayState& state = states_[each.ray];
    state.evaluations += each.evaluated ? 2 : 0;
    state.instructions += each.evaluated ? instructions : 0;
    if (each.result == PieceProposals::Result::March) {
      start(each.ray);
    } else if (each.result == PieceProposals::Result::Misses || each.t >= state.ray.length) {
      ready_.push_back(each.ray);
    } else {
      end_piece({each.ray, RayHit::Status::Hit, 1, 0, 0, each.width, each.t, 0});
    }
  }
}

void PieceMarcher::advance_stream(std::uint32_t shared, std::size_t few) {
  ended_.clear();
  streams_[shared]->advance(few, ended_, counters_, workspace_);
  const std::uint64_t instructions = pieces_.templates[shared].code.instructions;
  for (const PieceStream::Ended& each : ended_) {
    const RayState& state = states_[each.ray];
    const double begin = state.from;
    if (each.verdict == LaneVerdict::Certify) {
      const ClippedRay part{state.ray.origin + begin * state.ray.direction, state.ray.direction, begin, each.rest.end,
                            each.ray};
      searches_.certify_from(pieces_.fields[static_cast<std::size_t>(state.piece)], part, state.side, each.rest,
                             each.evaluations, each.evaluations * instructions);
      continue;
    }
    const bool hit = each.verdict == LaneVerdict::Hit;
    const RayHit::Status miss = each.verdict == LaneVerdict::Invalid ? RayHit::Status::Invalid : RayHit::Status::Miss;
    end_piece({each.ray, hit ? RayHit::Status::Hit : miss, state.side, each.evaluations, 0, hit ? each.width : 0.0f,
               begin + static_cast<double>(each.root), each.evaluations * instructions});
  }
}

void PieceMarcher::advance(Marcher& part) {
  part.advance();
  part.take_ray_hits(found_);
  for (const RayHit& found : found_) end_piece(found);
}

void PieceMarcher::end_piece(const RayHit& found) {
  RayState& state = states_[found.id];
  state.evaluations += found.evaluations;
  state.certified += found.certified;
  state.instructions += found.instructions;
  state.side = found.side;
  if (found.status == RayHit::Status::Hit) {
    if (state.side < 0) state.roots.clear();  // of an exit before it was searched in double
    add_root(state, found.t, found.width, static_cast<std::uint32_t>(state.piece));
    state.exact = found.certified > 0;
  } else if (found.status != RayHit::Status::Miss && state.miss != RayHit::Status::Invalid) {
    state.miss = found.status;
  }
  if (state.side < 0 && found.status != RayHit::Status::Hit) return end_ray(found.id);
  ready_.push_back(found.id);
}

// Reports the nearest root. Roots that a bracket does not tell from it are those of coincident faces: the piece that
// comes first is hit.
void PieceMarcher::end_ray(std::uint32_t number) {
  RayState& state = states_[number];
  --live_;
  free_.push_back(number);
  if (state.roots.empty()) {
    return report(state.ray.id, state.miss, state.side, state.evaluations, state.certified, 0.0f, 0.0,
                  state.instructions);
  }
  const Root& nearest = *std::ranges::min_element(state.roots, {}, &Root::t);
  const Root* hit = &nearest;
  for (const Root& root : state.roots) {
    const bool same = root.t <= nearest.t + static_cast<double>(std::min(root.width, nearest.width));
    if (same && root.piece < hit->piece) hit = &root;
  }
  report(state.ray.id, RayHit::Status::Hit, hit->side, state.evaluations, state.certified, hit->width,
         state.ray.entry + hit->t, state.instructions, hit->piece);
}

// Rays and where they ended are counted here, evaluations by the parts.
MarchCounters PieceMarcher::counters() const {
  MarchCounters all = counters_;
  const auto add = [&](const Marcher& part) {
    const MarchCounters of = part.counters();
    all.evaluations += of.evaluations;
    all.certified += of.certified;
    all.certified_evaluations += of.certified_evaluations;
    all.lanes += of.lanes;
    if (of.invalid_at) all.note_invalid(*of.invalid_at);
  };
  add(searches_);
  for (const auto& stream : own_) {
    if (stream) add(*stream);
  }
  return all;
}

void PieceMarcher::step() {
  while (!ready_.empty()) {
    const std::uint32_t number = ready_.back();
    ready_.pop_back();
    begin_next_piece(number);
  }
  if (!advance_parts(kFewRays)) advance_parts(1);
}

// Advances the parts with at least `few` rays. Returns false if there are none.
bool PieceMarcher::advance_parts(std::size_t few) {
  bool advanced = false;
  const auto has_rays = [few](const Marcher& part) { return part.under_way() >= few; };
  for (std::uint32_t i = 0; i < streams_.size(); ++i) {
    if (proposals_[i] && proposals_[i]->size() >= few) answer(i), advanced = true;
    if (streams_[i] && streams_[i]->live() >= few) advance_stream(i, few), advanced = true;
    if (own_[i] && has_rays(*own_[i])) advance(*own_[i]), advanced = true;
  }
  if (has_rays(searches_)) advance(searches_), advanced = true;
  return advanced;
}

}  // namespace fathom::runtime
