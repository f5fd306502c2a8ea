#include "vm/prune/skeleton.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fathom::vm {
namespace {

// An instruction of a skeleton.
struct Step {
  std::uint32_t word, instruction;  // opcode word in the skeleton; number of the part's instruction
  std::uint32_t at;                 // offset of the part's opcode word
};

bool is_outline(std::uint32_t word) { return find_opcode(word & 0xff)->form == Form::Outline; }

bool is_any_shape(std::uint32_t word) {
  const OpcodeInfo& row = *find_opcode(word & 0xff);
  return row.form == Form::Shape && can_be_any_shape(row.immediate_names, row.cost);
}

// Returns the opcode word that a skeleton has for a part's opcode word.
std::uint32_t as_laid_out(std::uint32_t word) {
  return is_any_shape(word) ? opcode_word(Opcode::RoundBox, operand_of(word) | kMoved | kAnyShape) : word;
}

// Returns the number of quads of an instruction's constants.
std::uint32_t quads_of(std::uint32_t word) {
  if (is_outline(word)) return 0;
  if (is_any_shape(word)) return 2;
  return static_cast<std::uint32_t>((instruction_length(word) - 1 + kQuad - 1) / kQuad);
}

Opcode opcode_of(std::uint32_t word) { return static_cast<Opcode>(word & 0xff); }
bool is_shape(std::uint32_t word) { return find_opcode(word & 0xff)->form == Form::Shape; }
bool is_joined_shape(std::uint32_t word) { return is_shape(word) && (operand_of(word) & kJoined) != 0; }

// Returns the part's instructions except tags. A shape followed by a min becomes one instruction with kJoined.
std::vector<Step> untagged(const Part& part) {
  std::vector<Step> steps;
  std::uint32_t instruction = 0;
  for (std::size_t at = 0; at < part.words.size(); at += instruction_length(part.words[at]), ++instruction) {
    const std::uint32_t word = part.words[at];
    if (opcode_of(word) == Opcode::Tag) continue;
    const bool joins = word == opcode_word(Opcode::Min) && steps.size() > 1 && is_shape(steps.back().word) &&
                       !is_joined_shape(steps.back().word);
    if (joins) {
      steps.back().word |= kJoined << 8;
    } else {
      steps.push_back({as_laid_out(word), instruction, static_cast<std::uint32_t>(at)});
    }
  }
  return steps;
}

// Sorts the union of shapes with which a program begins by opcode words. The order of a union does not matter, so
// programs that begin with the same shapes in different orders share a skeleton.
void sort_union(std::vector<Step>& steps) {
  if (steps.empty() || !is_shape(steps[0].word)) return;
  auto end = std::find_if(steps.begin() + 1, steps.end(), [](const Step& s) { return !is_joined_shape(s.word); });
  constexpr std::uint32_t kJoinedBit = kJoined << 8;
  std::stable_sort(steps.begin(), end,
                   [](const Step& a, const Step& b) { return (a.word & ~kJoinedBit) < (b.word & ~kJoinedBit); });
  for (auto s = steps.begin(); s != end; ++s) s->word |= kJoinedBit;
  steps[0].word &= ~kJoinedBit;
}

// True if immediate i belongs to the skeleton: integers, and the corners of outlines.
bool keeps_immediate(std::uint32_t word, std::size_t i) {
  const OpcodeInfo& row = *find_opcode(word & 0xff);
  if (is_outline(word)) return true;
  const int own = static_cast<int>(i) - leading_immediates(word);
  return own >= 0 && is_integer_immediate(row, own);
}

void append_instruction(const Part& part, std::uint32_t word, std::size_t at, std::vector<std::uint32_t>& words,
                        std::vector<double>& wide) {
  words.push_back(word), wide.push_back(0);
  const bool outline = is_outline(word);
  for (std::size_t i = 0; i + 1 < instruction_length(word); ++i) {
    const bool keeps = keeps_immediate(word, i);
    words.push_back(keeps ? part.words[at + 1 + i] : 0);
    wide.push_back(outline ? part.wide[at + 1 + i] : 0);
  }
}

// Returns the steps of a part in the order of its skeleton.
std::vector<Step> distance_steps(const Part& part) {
  std::vector<Step> steps = untagged(part);
  sort_union(steps);
  return steps;
}

// Returns the number of the item with the words and wide constants of `wanted`, or kNone.
template <class Item>
std::uint32_t find(const std::unordered_multimap<std::uint64_t, std::uint32_t>& index, const std::vector<Item>& items,
                   const Item& wanted) {
  const auto [first, last] = index.equal_range(hash_of(wanted.words));
  for (auto it = first; it != last; ++it) {
    const Item& item = items[it->second];
    if (item.words == wanted.words && item.wide == wanted.wide) return it->second;
  }
  return kNone;
}

template <class Item>
std::size_t bytes_of(const Item& item) {
  return item.words.size() * sizeof(std::uint32_t) + item.wide.size() * sizeof(double);
}

}  // namespace

Constants::Constants(const Code& whole) : row_at_(whole.size, 0) {
  bool spheres = false, boxes = false;
  for (std::size_t at = 0; at < whole.size; at += instruction_length(whole.words[at])) {
    const Opcode opcode = opcode_of(whole.words[at]);
    spheres = spheres || opcode == Opcode::Sphere;
    boxes = boxes || opcode == Opcode::Box || opcode == Opcode::RoundBox;
  }
  round_boxes_ = spheres && boxes;
  for (std::size_t at = 0; at < whole.size; at += instruction_length(whole.words[at])) {
    const std::uint32_t word = whole.words[at];
    if (quads_of(word) == 0) continue;
    row_at_[at] = static_cast<std::uint32_t>(values_.size() / kQuad);
    const std::uint32_t* immediates = whole.words + at + 1;
    if (is_any_shape(word)) {
      append_any_shape(word, immediates);
    } else {
      for (std::size_t i = 0; i + 1 < instruction_length(word); ++i) {
        values_.push_back(std::bit_cast<float>(immediates[i]));
      }
    }
    values_.resize((values_.size() + kQuad - 1) / kQuad * kQuad, 0.0f);
    source_of_.resize(values_.size() / kQuad, static_cast<std::uint32_t>(at));
  }
}

void Constants::append_any_shape(std::uint32_t word, const std::uint32_t* immediates) {
  const std::size_t moves = static_cast<std::size_t>(leading_immediates(word));
  const std::size_t own = instruction_length(word) - 1 - moves;
  std::array<float, 2 * kQuad> row{};
  const auto put = [&](std::size_t at, std::size_t from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) row[at + i] = std::bit_cast<float>(immediates[from + i]);
  };
  put(0, 0, moves);
  const Opcode opcode = laid_out(opcode_of(word));
  const bool is_ball = opcode != opcode_of(word) && opcode_of(word) == Opcode::Sphere;
  put(is_ball ? 6 : 3, moves, own);  // a round box's radius is its last immediate
  row.back() = static_cast<float>(opcode);
  values_.insert(values_.end(), row.begin(), row.end());
}

Opcode Constants::laid_out(Opcode opcode) const {
  return round_boxes_ && (opcode == Opcode::Sphere || opcode == Opcode::Box) ? Opcode::RoundBox : opcode;
}

std::size_t Constants::bytes() const {
  return values_.size() * sizeof(float) + (row_at_.size() + source_of_.size()) * sizeof(std::uint32_t);
}

std::uint32_t Skeletons::pack(const Part& part, const Constants& constants, std::vector<std::uint32_t>& pool) {
  const auto start = pool.size();
  const std::uint32_t number = frame_of(part);
  const Frame& frame = frames_[number];
  pool.resize(start + 2 + part.sources.size());
  pool[start] = frame.skeleton, pool[start + 1] = number;
  std::size_t at = 0;
  for (std::size_t i = 0; i < part.sources.size(); ++i, at += instruction_length(part.words[at])) {
    const std::uint32_t source = part.sources[i];
    pool[start + 2 + frame.place[i]] = quads_of(part.words[at]) > 0 ? constants.row(source) : source;
  }
  return static_cast<std::uint32_t>(start);
}

void Skeletons::unpack(const Code& whole, const Constants& constants, const std::uint32_t* pool, std::uint32_t at,
                       Part& out) const {
  const Frame& frame = frames_[pool[at + 1]];
  out.words = frame.words;
  out.wide.assign(out.words.size(), 0);
  out.sources.clear();
  out.locals = frame.locals, out.max_values = frame.max_values, out.max_points = frame.max_points;
  out.choices = frame.choices, out.cost = frame.cost;
  const std::uint32_t* entry = pool + at + 2;
  const auto offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  for (std::size_t word = 0, i = 0; word < out.words.size(); word += instruction_length(out.words[word]), ++i) {
    const std::uint32_t held = entry[frame.place[i]];
    const std::uint32_t source = quads_of(out.words[word]) > 0 ? constants.source(held) : held;
    out.sources.push_back(source);
    if (opcode_of(out.words[word]) == Opcode::Tag) out.words[word] = whole.words[source];
    const std::size_t count = instruction_length(out.words[word]) - 1;
    std::copy_n(whole.words + source + 1, count, out.words.begin() + offset(word + 1));
    std::copy_n(whole.wide + source + 1, count, out.wide.begin() + offset(word + 1));
  }
}

void Skeletons::adopt(const Skeletons& others, std::uint32_t* pool, std::uint32_t at) {
  const Frame& frame = others.frames_[pool[at + 1]];
  looked_for_.words = frame.words, looked_for_.wide = frame.wide;
  std::uint32_t number = find(frame_at_, frames_, looked_for_);
  if (number == kNone) {
    Frame copy = frame;
    copy.skeleton = number_of(Skeleton(others.skeletons_[frame.skeleton]));
    number = add(std::move(copy));
  }
  pool[at] = frames_[number].skeleton, pool[at + 1] = number;
}

std::uint32_t Skeletons::frame_of(const Part& part) {
  Frame& wanted = looked_for_;
  wanted.words.clear(), wanted.wide.clear();
  bool outlines = false;
  for (std::size_t at = 0; at < part.words.size(); at += instruction_length(part.words[at])) {
    const bool tag = opcode_of(part.words[at]) == Opcode::Tag;
    append_instruction(part, tag ? opcode_word(Opcode::Tag) : part.words[at], at, wanted.words, wanted.wide);
    outlines = outlines || is_outline(part.words[at]);
  }
  if (!outlines) wanted.wide.clear();
  if (const std::uint32_t known = find(frame_at_, frames_, wanted); known != kNone) return known;

  Frame frame = wanted;
  frame.locals = part.locals, frame.max_values = part.max_values, frame.max_points = part.max_points;
  frame.choices = part.choices, frame.cost = part.cost;
  Skeleton skeleton{{}, {}, part.locals, part.max_values, part.max_points, part.choices, 0, {}};
  frame.place.assign(part.sources.size(), kNone);
  std::uint32_t places = 0;
  for (const Step& step : distance_steps(part)) {
    append_instruction(part, step.word, step.at, skeleton.words, skeleton.wide);
    ++skeleton.instructions;
    if (quads_of(step.word) == 0) continue;
    frame.place[step.instruction] = places++;
    skeleton.quads.push_back(static_cast<std::uint8_t>(quads_of(step.word)));
  }
  for (std::uint32_t& place : frame.place) {
    if (place == kNone) place = places++;
  }
  if (!outlines) skeleton.wide.clear();
  frame.skeleton = number_of(std::move(skeleton));
  return add(std::move(frame));
}

std::uint32_t Skeletons::add(Frame&& frame) {
  const auto number = static_cast<std::uint32_t>(frames_.size());
  bytes_ += sizeof(frame) + bytes_of(frame) + frame.place.size() * sizeof(std::uint32_t);
  frame_at_.emplace(hash_of(frame.words), number);
  frames_.push_back(std::move(frame));
  return number;
}

std::uint32_t Skeletons::number_of(Skeleton&& skeleton) {
  if (const std::uint32_t known = find(skeleton_at_, skeletons_, skeleton); known != kNone) {
    Skeleton& other = skeletons_[known];  // shared by several frames, so its sizes are their maxima
    other.locals = std::max(other.locals, skeleton.locals);
    other.max_values = std::max(other.max_values, skeleton.max_values);
    other.max_points = std::max(other.max_points, skeleton.max_points);
    return known;
  }
  const auto number = static_cast<std::uint32_t>(skeletons_.size());
  bytes_ += sizeof(skeleton) + bytes_of(skeleton) + skeleton.quads.size();
  skeleton_at_.emplace(hash_of(skeleton.words), number);
  skeletons_.push_back(std::move(skeleton));
  return number;
}

}  // namespace fathom::vm
