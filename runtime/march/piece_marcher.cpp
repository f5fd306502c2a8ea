#include "runtime/march/piece_marcher.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

// Points that are worth an evaluation, two registers of them, unless there are fewer everywhere.
constexpr int kFewRays = 32;
// Maximum number of rays under way: each has a root in a template's proposals, or a lane.
constexpr std::uint32_t kMaxStates = PieceProposals::kCapacity;
static_assert(kMaxStates <= Stream<float>::kLanes);

}  // namespace

PieceMarcher::PieceMarcher(const Field& field, const Marching& marching)
    : Marcher(field),
      pieces_(*field.pieces),
      marching_(marching),
      boxes_(pieces_.boxes),
      whole_(field, marching),
      streams_(pieces_.templates.size()),
      proposals_(pieces_.templates.size()),
      piece_of_(kMaxStates),
      states_(kMaxStates) {
  for (std::uint32_t i = kMaxStates; i-- > 0;) free_.push_back(i);
}

void PieceMarcher::begin(RayBlock& rays) {
  while (rays.count > 0 && !free_.empty()) {
    const std::size_t i = --rays.count;
    if (!enters(rays, i)) continue;
    ++live_;
    const std::uint32_t number = free_.back();
    free_.pop_back();
    RayState& state = states_[number];
    set_clipped_ray(state.ray, rays, i);
    state.slope = rays.slope[i];
    state.leaves = rays.leaves[i];
    state.next = 0;
    state.roots.clear();
    state.reach = state.ray.length;
    state.miss = RayHit::Status::Miss;
    state.side = 1;
    state.evaluations = state.certified = 0;
    state.instructions = 0;
    if (rays.side[i] != 1) {
      piece_of_[number] = kNoPiece;
      whole_.add(number,
                 {state.ray.origin, state.ray.direction, state.ray.length, rays.side[i], rays.slope[i], 0, kNoPiece});
      continue;
    }
    boxes_.find(state.ray.origin, state.ray.direction, state.ray.length, state.boxes);
    begin_next_piece(number);
  }
}

// Has the ray enter the next box that it has to, or ends it.
void PieceMarcher::begin_next_piece(std::uint32_t number) {
  RayState& state = states_[number];
  for (; state.next < state.boxes.size(); ++state.next) {
    const BoxedPiece& box = state.boxes[state.next];
    if (static_cast<double>(box.entry) > state.reach) break;
    const bool leaves = box.piece == state.leaves;
    const std::uint32_t shared = pieces_.template_of[box.piece];
    // A ray that leaves a convex solid does not meet it again.
    if (leaves && pieces_.templates[shared].convex) continue;
    piece_of_[number] = box.piece;
    Entrance entrance{Meeting::Uncertain, 0, 0};
    if (const compiler::ClosedForm& form = pieces_.forms[box.piece]; form.shape != compiler::ClosedForm::Shape::None)
      entrance = find_entrance(form, state.ray.origin, state.ray.direction);
    const bool enters = entrance.meeting == Meeting::Enters;
    if (entrance.meeting == Meeting::Misses || (enters && entrance.t - entrance.slack > state.reach)) continue;
    ++state.next;
    if (enters && entrance.t + entrance.slack < static_cast<double>(box.exit)) {
      if (!proposals_[shared]) proposals_[shared] = std::make_unique<PieceProposals>(pieces_, shared);
      return proposals_[shared]->add(number, box.piece, state.ray.origin, state.ray.direction, entrance.t,
                                     entrance.slack);
    }
    return start(number, box);
  }
  end_ray(number);
}

// Has the ray march through a box.
void PieceMarcher::start(std::uint32_t number, const BoxedPiece& box) {
  const RayState& state = states_[number];
  const double begin = static_cast<double>(box.entry);
  const double end = std::min(static_cast<double>(box.exit), state.reach);
  stream(pieces_.template_of[box.piece])
      .start({state.ray.origin + begin * state.ray.direction, state.ray.direction, begin, end - begin, number}, 1,
             box.piece == state.leaves ? state.slope : -1.0f);
}

// Ends the template's proposals. Rays whose roots the field does not confirm march.
void PieceMarcher::answer(std::uint32_t shared) {
  std::vector<PieceProposals::Answer> answers;
  answers.swap(answers_);
  counters_.evaluations += 2 * proposals_[shared]->size();
  proposals_[shared]->answer(answers, workspace_);
  const std::uint32_t instructions = pieces_.templates[shared].code.instructions;
  for (const PieceProposals::Answer& each : answers) {
    RayState& state = states_[each.ray];
    // A root beyond the ray's end does not count.
    if (each.confirmed && each.t >= state.ray.length) {
      begin_next_piece(each.ray);
    } else if (each.confirmed) {
      const RayHit found{each.ray, RayHit::Status::Hit, 1, 2, 0, each.width, each.t, 2 * std::uint64_t{instructions}};
      end_piece(found);
    } else {
      state.evaluations += 2;
      state.instructions += 2 * instructions;
      start(each.ray, state.boxes[state.next - 1]);
    }
  }
  answers_.swap(answers);
}

void PieceMarcher::end_piece(const RayHit& found) {
  RayState& state = states_[found.id];
  state.evaluations += found.evaluations;
  state.certified += found.certified;
  state.instructions += found.instructions;
  state.side = found.side;
  if (found.status == RayHit::Status::Hit) {
    state.roots.push_back({found.t, found.width, piece_of_[found.id], found.side});
    state.reach = std::min(state.reach, found.t + static_cast<double>(found.width));
  } else if (found.status != RayHit::Status::Miss && state.miss != RayHit::Status::Invalid) {
    state.miss = found.status;
  }
  if (piece_of_[found.id] == kNoPiece) return end_ray(found.id);
  begin_next_piece(found.id);
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

Stream<float>& PieceMarcher::stream(std::uint32_t number) {
  if (!streams_[number])
    streams_[number] = std::make_unique<Stream<float>>(pieces_.templates[number].field, marching_,
                                                       PieceStream{&pieces_, number, piece_of_.data()});
  return *streams_[number];
}

void PieceMarcher::advance(Marcher& part) {
  part.advance();
  part.take_ray_hits(found_);
  for (const RayHit& found : found_) end_piece(found);
}

// Rays and where they ended are counted here, evaluations by the streams.
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
  add(whole_);
  for (const auto& stream : streams_) {
    if (stream) add(*stream);
  }
  return all;
}

void PieceMarcher::step() {
  if (!advance_parts(kFewRays)) advance_parts(0);
}

// Advances the parts with at least `few` rays. Returns false if there are none.
bool PieceMarcher::advance_parts(int few) {
  bool advanced = false;
  for (std::uint32_t i = 0; i < proposals_.size(); ++i) {
    if (!proposals_[i] || proposals_[i]->size() == 0 || 2 * proposals_[i]->size() < static_cast<std::size_t>(few))
      continue;
    answer(i);
    advanced = true;
  }
  for (const auto& stream : streams_) {
    if (!stream || stream->empty() || stream->live() < few) continue;
    advance(*stream);
    advanced = true;
  }
  if (whole_.empty() || whole_.capacity() - whole_.room() < few) return advanced;
  advance(whole_);
  return true;
}

}  // namespace fathom::runtime
