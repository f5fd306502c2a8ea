#include "vm/expression.h"

#include <algorithm>

#include "vm/opcode_rows.h"

namespace fathom::vm {

bool Expression::read(const Code& code) {
  begin(code);
  std::uint32_t self = 0;
  for (std::size_t at = 0; at < code.size; at += 1 + immediates_of(code.words[at])) {
    if (self == nodes_.size()) nodes_.resize(2 * nodes_.size() + 64);
    if (!read_instruction(code, static_cast<std::uint32_t>(at), self++)) return false;
  }
  nodes_.resize(self);
  return true;
}

void Expression::begin(const Code& code) {
  values_.resize(code.max_values + 1);
  height_ = 0;
  choices_.clear(), tees_.clear(), places_.clear(), place_of_.clear();
  points_.assign(1, {kNone, 0});
  places_.push_back({kNone, kNone});
  defined_.assign(code.locals, kNone);
  locals_ = code.locals;
}

bool Expression::read_instruction(const Code& code, std::uint32_t at, std::uint32_t self) {
  const std::uint32_t word = code.words[at];
  const OpcodeRow& row = row_of(word);
  ExpressionNode node{at};
  bool sound = true;
  switch (row.form) {
    case Form::Point:
      points_.push_back({self, place_after(code, at)});
      break;
    case Form::Shape:
      if (operand_of(word) & kJoined) {
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
      if (row.choice) enter_choice(node, self);
      break;
    }
    case Form::Machine:
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

void Expression::enter_choice(ExpressionNode& node, std::uint32_t self) {
  node.choice = static_cast<std::uint32_t>(choices_.size());
  choices_.push_back(self);
}

// The top value, computed at the top point.
bool Expression::take(std::uint32_t& operand) {
  const Value value = values_[--height_];
  operand = value.node;
  return value.place == points_.back().place;
}

bool Expression::use_local(std::uint32_t local, std::uint32_t& operand) {
  operand = defined_[local];
  return place_of_[operand] == points_.back().place;
}

std::uint32_t Expression::place_after(const Code& code, std::uint32_t at) {
  const std::uint32_t before = points_.back().place;
  if (locals_ > 0) {  // else no place is met twice
    const std::size_t length = instruction_length(code.words[at]);
    for (std::uint32_t i = 1; i < places_.size(); ++i) {
      const Place& place = places_[i];
      if (place.before == before && std::equal(code.words + at, code.words + at + length, code.words + place.at)) {
        return i;
      }
    }
  }
  places_.push_back({before, at});
  return static_cast<std::uint32_t>(places_.size() - 1);
}

}  // namespace fathom::vm
