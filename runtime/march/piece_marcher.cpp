#include "runtime/march/piece_marcher.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

// Rays in a template's stream that are worth an evaluation, two registers, unless no stream has as many.
constexpr int kFewRays = 32;
// The same of proposed roots, each of which has two points.
constexpr std::size_t kFewProposals = 16;
// Maximum number of rays under way: each has a root in a template's proposals, or a lane.
constexpr std::uint32_t kMaxTravellers = PieceProposals::kCapacity;
static_assert(kMaxTravellers <= Stream<float>::kLanes);

}  // namespace

PieceMarcher::PieceMarcher(const Field& field, const Marching& marching)
    : Marcher(field),
      pieces_(*field.pieces),
      marching_(marching),
      boxes_(pieces_.boxes),
      whole_(field, marching),
      streams_(pieces_.all_templates.size()),
      proposals_(pieces_.all_templates.size()),
      piece_of_(kMaxTravellers),
      travellers_(kMaxTravellers) {
  for (std::uint32_t i = kMaxTravellers; i-- > 0;) free_.push_back(i);
}

void PieceMarcher::begin(RayBlock& rays) {
  while (rays.count > 0 && !free_.empty()) {
    const std::size_t i = --rays.count;
    if (!enters(rays, i)) continue;
    ++live_;
    const std::uint32_t number = free_.back();
    free_.pop_back();
    Traveller& traveller = travellers_[number];
    set_clipped_ray(traveller.ray, rays, i);
    traveller.slope = rays.slope[i];
    traveller.leaves = rays.piece[i];
    traveller.next = 0;
    traveller.roots.clear();
    traveller.reach = traveller.ray.length;
    traveller.miss = RayHit::Status::Miss;
    traveller.side = 1;
    traveller.evaluations = traveller.certified = 0;
    traveller.instructions = 0;
    if (rays.side[i] != 1) {
      piece_of_[number] = kNoPiece;
      whole_.add(number, {traveller.ray.origin, traveller.ray.direction, traveller.ray.length, rays.side[i],
                          rays.slope[i], 0, kNoPiece});
      continue;
    }
    boxes_.find(traveller.ray.origin, traveller.ray.direction, traveller.ray.length, traveller.boxes);
    begin_next_piece(number);
  }
}

// Has the ray enter the next box that it has to, or ends it.
void PieceMarcher::begin_next_piece(std::uint32_t number) {
  Traveller& traveller = travellers_[number];
  for (; traveller.next < traveller.boxes.size(); ++traveller.next) {
    const BoxedPiece& box = traveller.boxes[traveller.next];
    if (static_cast<double>(box.entry) > traveller.reach) break;
    const bool leaves = box.piece == traveller.leaves;
    const std::uint32_t shared = pieces_.templates[box.piece];
    // A ray that leaves a convex solid does not meet it again.
    if (leaves && pieces_.all_templates[shared].convex) continue;
    piece_of_[number] = box.piece;
    Entrance entrance{Meeting::Uncertain, 0, 0};
    if (const compiler::ClosedForm& form = pieces_.forms[box.piece]; form.shape != compiler::ClosedForm::Shape::None)
      entrance = find_entrance(form, traveller.ray.origin, traveller.ray.direction);
    const bool enters = entrance.meeting == Meeting::Enters;
    if (entrance.meeting == Meeting::Misses || (enters && entrance.t - entrance.slack > traveller.reach)) continue;
    ++traveller.next;
    if (enters && entrance.t + entrance.slack < static_cast<double>(box.exit)) {
      if (!proposals_[shared]) proposals_[shared] = std::make_unique<PieceProposals>(pieces_, shared);
      return proposals_[shared]->add(number, box.piece, traveller.ray.origin, traveller.ray.direction, entrance.t,
                                     entrance.slack);
    }
    return start(number, box);
  }
  end_ray(number);
}

// Has the ray march through a box.
void PieceMarcher::start(std::uint32_t number, const BoxedPiece& box) {
  const Traveller& traveller = travellers_[number];
  const double begin = static_cast<double>(box.entry);
  const double end = std::min(static_cast<double>(box.exit), traveller.reach);
  stream(pieces_.templates[box.piece])
      .start({traveller.ray.origin + begin * traveller.ray.direction, traveller.ray.direction, begin, end - begin,
              number},
             1, box.piece == traveller.leaves ? traveller.slope : -1.0f);
}

// Ends the template's proposals. Rays whose roots the field does not confirm march.
void PieceMarcher::answer(std::uint32_t shared) {
  std::vector<PieceProposals::Answer> answers;
  answers.swap(answers_);
  counters_.evaluations += 2 * proposals_[shared]->size();
  proposals_[shared]->answer(answers, workspace_);
  const std::uint32_t instructions = pieces_.all_templates[shared].code.instructions;
  for (const PieceProposals::Answer& each : answers) {
    Traveller& traveller = travellers_[each.ray];
    // A root beyond the ray's end does not count.
    if (each.confirmed && each.t >= traveller.ray.length) {
      begin_next_piece(each.ray);
    } else if (each.confirmed) {
      const RayHit found{each.ray, RayHit::Status::Hit, 1, 2, 0, each.width, each.t, 2 * std::uint64_t{instructions}};
      end_piece(found);
    } else {
      traveller.evaluations += 2;
      traveller.instructions += 2 * instructions;
      start(each.ray, traveller.boxes[traveller.next - 1]);
    }
  }
  answers_.swap(answers);
}

void PieceMarcher::end_piece(const RayHit& found) {
  Traveller& traveller = travellers_[found.id];
  traveller.evaluations += found.evaluations;
  traveller.certified += found.certified;
  traveller.instructions += found.instructions;
  traveller.side = found.side;
  if (found.status == RayHit::Status::Hit) {
    traveller.roots.push_back({found.t, found.width, piece_of_[found.id], found.side});
    traveller.reach = std::min(traveller.reach, found.t + static_cast<double>(found.width));
  } else if (found.status != RayHit::Status::Miss && traveller.miss != RayHit::Status::Invalid) {
    traveller.miss = found.status;
  }
  if (piece_of_[found.id] == kNoPiece) return end_ray(found.id);
  begin_next_piece(found.id);
}

// Reports the nearest root. Roots that a bracket does not tell from it are those of coincident faces: the piece that
// comes first is hit.
void PieceMarcher::end_ray(std::uint32_t number) {
  Traveller& traveller = travellers_[number];
  --live_;
  free_.push_back(number);
  if (traveller.roots.empty()) {
    return report(traveller.ray.id, traveller.miss, traveller.side, traveller.evaluations, traveller.certified, 0.0f,
                  0.0, traveller.instructions);
  }
  const Root& nearest = *std::ranges::min_element(traveller.roots, {}, &Root::t);
  const Root* hit = &nearest;
  for (const Root& root : traveller.roots) {
    const bool same = root.t <= nearest.t + static_cast<double>(std::min(root.width, nearest.width));
    if (same && root.piece < hit->piece) hit = &root;
  }
  report(traveller.ray.id, RayHit::Status::Hit, hit->side, traveller.evaluations, traveller.certified, hit->width,
         traveller.ray.entry + hit->t, traveller.instructions, hit->piece);
}

Stream<float>& PieceMarcher::stream(std::uint32_t number) {
  if (!streams_[number])
    streams_[number] = std::make_unique<Stream<float>>(pieces_.all_templates[number].field, marching_,
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
  bool advanced = false;
  for (std::uint32_t i = 0; i < proposals_.size(); ++i) {
    if (!proposals_[i] || proposals_[i]->size() < kFewProposals) continue;
    answer(i);
    advanced = true;
  }
  for (const auto& stream : streams_) {
    while (stream && stream->live() >= kFewRays) {
      advance(*stream);
      advanced = true;
    }
  }
  if (whole_.capacity() - whole_.room() >= kFewRays || (!advanced && !whole_.empty())) advance(whole_);
  if (advanced) return;
  for (std::uint32_t i = 0; i < proposals_.size(); ++i) {
    if (proposals_[i] && proposals_[i]->size() > 0) answer(i);
  }
  for (const auto& stream : streams_) {
    if (stream && !stream->empty()) advance(*stream);
  }
}

}  // namespace fathom::runtime
