#include "vm/prune/def_use_graph.h"

#include <algorithm>

#include "vm/program/opcode_rows.h"

namespace fathom::vm {

bool DefUseGraph::read(const Code& code) {
  begin(code);
  std::uint32_t self = 0;
  for (std::size_t at = 0; at < code.size; at += 1 + immediates_of(code.words[at])) {
    if (self == nodes_.size()) nodes_.resize(2 * nodes_.size() + 64);
    if (!read_instruction(code, static_cast<std::uint32_t>(at), self++)) return false;
  }
  nodes_.resize(self);
  return true;
}

void DefUseGraph::begin(const Code& code) {
  values_.resize(code.max_values + 1);
  height_ = 0;
  choices_.clear(), tees_.clear(), places_.clear(), place_of_.clear();
  points_.assign(1, {kNone, 0});
  places_.push_back({kNone, kNone});
  ++reading_;
  defined_.assign(code.locals, kNone);
  locals_ = code.locals;
}

bool DefUseGraph::read_instruction(const Code& code, std::uint32_t at, std::uint32_t self) {
  const std::uint32_t word = code.words[at];
  const OpcodeRow& row = row_of(word);
  DefUseNode node{at};
  bool sound = true;
  switch (row.form) {
    case Form::Point:
      points_.push_back({self, place_after(code, at)});
      break;
    case Form::Shape:
      if (operand_of(word) & kFusedMin) {
        sound = take(node.a);
        node.b = self;
        enter_choice(node, self);
      }
      break;
    case Form::Outline:
      break;
    case Form::Unary:
    case Form::Binary: {
      const Sources sources = sources_of(word);
      if (row.form == Form::Binary) {
        if (sources.b == Source::Stack) sound = take(node.b);
        if (sources.b == Source::Local) sound = use_local(sources.local, node.b);
      }
      if (sources.a == Source::Stack) sound = take(node.a) && sound;
      if (sources.a == Source::Local) sound = use_local(sources.local, node.a) && sound;
      if (row.choice != Choice::None) enter_choice(node, self);
      break;
    }
    case Form::Ternary:
      for (std::uint32_t* operand : {&node.c, &node.b, &node.a}) sound = take(*operand) && sound;
      break;
    case Form::Machine:
      if (row.opcode == Opcode::Drop && height_ == 0) return false;
      sound = row.opcode == Opcode::Load ? use_local(operand_of(word), node.a) : take(node.a);
      if (row.opcode == Opcode::Tee) {
        defined_[operand_of(word)] = self;
        tees_.push_back(self);
      }
      if (row.opcode == Opcode::Drop) {
        node.point = points_.back().node;
        points_.pop_back();
      }
      break;
  }
  const std::uint32_t place = points_.back().place;
  nodes_[self] = node;
  place_of_.push_back(place);
  if (row.form != Form::Point) values_[height_++] = {self, place};
  return sound;
}

void DefUseGraph::enter_choice(DefUseNode& node, std::uint32_t self) {
  node.choice = static_cast<std::uint32_t>(choices_.size());
  choices_.push_back(self);
}

// Pops the top value. Returns false if the value was not computed at the top point.
bool DefUseGraph::take(std::uint32_t& operand) {
  const Value value = values_[--height_];
  operand = value.node;
  return value.place == points_.back().place;
}

bool DefUseGraph::use_local(std::uint32_t local, std::uint32_t& operand) {
  operand = defined_[local];
  return place_of_[operand] == points_.back().place;
}

std::uint32_t DefUseGraph::place_after(const Code& code, std::uint32_t at) {
  const PointChain place{points_.back().place, at};
  const auto next = static_cast<std::uint32_t>(places_.size());
  if (locals_ > 0) {  // without locals, no place occurs twice
    if (2 * places_.size() >= slots_.size()) grow_slots(code);
    Slot& slot = slots_[slot_of(code, place)];
    if (slot.reading == reading_) return slot.place;
    slot = {reading_, next};
  }
  places_.push_back(place);
  return next;
}

// Returns the index of the slot of an equal place, or of the free slot for `place`.
std::size_t DefUseGraph::slot_of(const Code& code, const PointChain& place) const {
  const std::size_t length = instruction_length(code.words[place.at]);
  std::uint64_t hash = 0xcbf29ce484222325u ^ place.before;  // FNV-1a (Fowler, Noll, Vo, 1991)
  for (std::size_t i = 0; i < length; ++i) hash = (hash ^ code.words[place.at + i]) * 0x100000001b3u;
  hash *= 0x9e3779b97f4a7c15u;  // spreads similar hashes over the table
  for (std::size_t at = hash >> 32;; ++at) {
    const std::size_t index = at & (slots_.size() - 1);
    const Slot& slot = slots_[index];
    if (slot.reading != reading_) return index;
    const PointChain& other = places_[slot.place];
    const std::uint32_t* words = code.words + place.at;
    if (other.before == place.before && std::equal(words, words + length, code.words + other.at)) return index;
  }
}

void DefUseGraph::grow_slots(const Code& code) {
  slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), Slot());
  for (std::uint32_t i = 1; i < places_.size(); ++i) slots_[slot_of(code, places_[i])] = {reading_, i};
}

}  // namespace fathom::vm
