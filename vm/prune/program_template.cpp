#include "vm/prune/program_template.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "vm/program/opcode_rows.h"

namespace fathom::vm {
namespace {

// If more than this share of a program's small shapes have affine maps of their own, all are placed shapes. A map
// takes more time than the shape itself, but few lanes share a template in which some shapes have maps and others do
// not.
constexpr double kPlacedShare = 0.25;

// An instruction of a template.
struct Step {
  std::uint32_t word, instruction;  // opcode word in the template; number of the part's instruction
  std::uint32_t at;                 // offset of the part's opcode word
  std::uint32_t map = kNone;        // of a placed shape: number of the part's affine map, or kNone if it has none
};

constexpr std::array<bool, kOpcodeCount> kPolymorphicRows = {
#define OP(Name, mnemonic, form, immediates, choice, cost, ...) \
  can_be_polymorphic(immediates, cost) && Form::form == Form::Shape,
#include "vm/program/opcodes.def"
#undef OP
};

bool is_outline(std::uint32_t word) { return row_of(word).form == Form::Outline; }

bool is_polymorphic(std::uint32_t word) { return kPolymorphicRows[word & 0xff]; }

// Returns the opcode word that a template has for a part's opcode word.
std::uint32_t as_laid_out(std::uint32_t word) {
  return is_polymorphic(word) ? opcode_word(Opcode::RoundBox, operand_of(word) | kFusedTranslate | kPolymorphic)
                              : word;
}

bool is_placed(std::uint32_t word) { return is_polymorphic(word) && (operand_of(word) & kPlaced) != 0; }

// Returns the number of quads of an instruction's constants, without the map of a placed shape.
std::uint32_t quads_of(std::uint32_t word) {
  if (is_outline(word)) return 0;
  if (is_polymorphic(word)) return 2;
  return static_cast<std::uint32_t>((immediates_of(word) + kQuad - 1) / kQuad);
}

Opcode opcode_of(std::uint32_t word) { return static_cast<Opcode>(word & 0xff); }
bool is_shape(std::uint32_t word) { return row_of(word).form == Form::Shape; }

// True if the last of the steps is a small shape at a point that the step before maps. A drop after them ends that
// map.
bool is_mapped(const std::vector<Step>& steps) {
  return steps.size() > 1 && is_polymorphic(steps.back().word) && steps.back().map == kNone &&
         opcode_of(steps[steps.size() - 2].word) == Opcode::Affine;
}

// Returns the part's instructions except tags. A shape followed by a min becomes one instruction with kFusedMin. If
// `placed`, a small shape and its affine map become one instruction, and so does a small shape without a map.
std::vector<Step> untagged(const PrunedProgram& part, bool placed) {
  std::vector<Step> steps;
  std::uint32_t instruction = 0;
  for (std::size_t at = 0; at < part.words.size(); at += 1 + immediates_of(part.words[at]), ++instruction) {
    const std::uint32_t word = part.words[at];
    if (opcode_of(word) == Opcode::Tag) continue;
    if (placed && opcode_of(word) == Opcode::Drop && is_mapped(steps)) {
      steps.back().map = (steps.end() - 2)->instruction;
      steps.erase(steps.end() - 2);
      continue;
    }
    const bool joins = word == opcode_word(Opcode::Min) && steps.size() > 1 && is_shape(steps.back().word) &&
                       !is_joined(steps.back().word);
    if (joins) {
      steps.back().word |= kFusedMin << 8;
    } else {
      steps.push_back({as_laid_out(word), instruction, static_cast<std::uint32_t>(at)});
    }
  }
  for (Step& step : steps) {
    if (placed && is_polymorphic(step.word)) step.word |= kPlaced << 8;
  }
  return steps;
}

// Sorts the union of shapes with which a program begins by opcode words. The order of a union does not matter, so
// programs that begin with the same shapes in different orders share a template.
void sort_union(std::vector<Step>& steps) {
  if (steps.empty() || !is_shape(steps[0].word)) return;
  auto end = std::find_if(steps.begin() + 1, steps.end(), [](const Step& s) { return !is_joined(s.word); });
  constexpr std::uint32_t kJoinedBit = kFusedMin << 8;
  std::stable_sort(steps.begin(), end,
                   [](const Step& a, const Step& b) { return (a.word & ~kJoinedBit) < (b.word & ~kJoinedBit); });
  for (auto s = steps.begin(); s != end; ++s) s->word |= kJoinedBit;
  steps[0].word &= ~kJoinedBit;
}

// Returns the number of immediates that follow an opcode word in a template: all of the row's own if integers are
// among them, the corners of outlines, none otherwise.
std::size_t kept_immediates(std::uint32_t word) {
  if (!is_outline(word) && !row_of(word).has_integers) return 0;
  return immediates_of(word) - static_cast<std::size_t>(leading_immediates(word));
}

// Appends an instruction with the part's kept immediates. Floats among them are 0, except in outlines.
template <class Part>
void append_instruction(const Part& part, std::uint32_t word, std::size_t at, std::vector<std::uint32_t>& words,
                        std::vector<double>& doubles) {
  words.push_back(word), doubles.push_back(0);
  if (kept_immediates(word) == 0) return;
  const std::size_t first = at + 1 + static_cast<std::size_t>(leading_immediates(part.words[at]));
  const bool outline = is_outline(word);
  for (std::size_t i = 0; i < kept_immediates(word); ++i) {
    const bool kept = outline || is_integer_immediate(*find_opcode(word & 0xff), static_cast<int>(i));
    words.push_back(kept ? part.words[first + i] : 0);
    doubles.push_back(outline ? part.doubles[first + i] : 0);
  }
}

// Returns the opcode word of a remainder for a part's opcode word: without the surface of a tag, and without the
// opcode of a small shape, which the whole program knows.
std::uint32_t as_remainder(std::uint32_t word) {
  return opcode_of(word) == Opcode::Tag ? opcode_word(Opcode::Tag) : as_laid_out(word);
}

// Returns the part's opcode word for the remainder's. `source`: its offset in the whole program. An instruction that
// the whole program lacks, as a sign, has none.
std::uint32_t from_remainder(std::uint32_t word, const Code& whole, std::uint32_t source) {
  if (opcode_of(word) == Opcode::Tag) return whole.words[source];
  if (!is_shape(word) || !(operand_of(word) & kPolymorphic)) return word;
  constexpr std::uint32_t kJoined = kFusedMin << 8;
  return (whole.words[source] & ~kJoined) | (word & kJoined);
}

// Returns the steps of a part in the order of its template.
std::vector<Step> distance_steps(const PrunedProgram& part, bool placed) {
  std::vector<Step> steps = untagged(part, placed);
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
    if (item.words == wanted.words && item.doubles == wanted.doubles) return it->second;
  }
  return kNone;
}

template <class Item>
std::size_t bytes_of(const Item& item) {
  return item.words.size() * sizeof(std::uint32_t) + item.doubles.size() * sizeof(double);
}

}  // namespace

ProgramTemplate template_of(const VerifiedProgram& program) {
  const Code code = program;
  ProgramTemplate result{{}, {}, code.locals, code.max_values, code.max_points, code.choices, program.instructions(),
                         {}};
  for (std::size_t at = 0; at < code.size; at += instruction_length(code.words[at])) {
    const std::uint32_t word = code.words[at];
    append_instruction(code, word, at, result.words, result.doubles);
    const std::size_t immediates = is_outline(word) ? 0 : immediates_of(word);
    if (immediates > 0) result.quads.push_back(static_cast<std::uint8_t>((immediates + kQuad - 1) / kQuad));
  }
  return result;
}

std::size_t constants_in(const ProgramTemplate& program_template) {
  const auto& quads = program_template.quads;
  return kQuad * std::accumulate(quads.begin(), quads.end(), std::size_t{0});
}

std::vector<float> constants_of(const Code& program) {
  std::vector<float> row;
  for (std::size_t at = 0; at < program.size; at += instruction_length(program.words[at])) {
    const std::size_t immediates = is_outline(program.words[at]) ? 0 : immediates_of(program.words[at]);
    for (std::size_t i = 0; i < immediates; ++i) row.push_back(std::bit_cast<float>(program.words[at + 1 + i]));
    row.resize((row.size() + kQuad - 1) / kQuad * kQuad, 0.0f);
  }
  return row;
}

Constants::Constants(const Code& whole) : row_at_(whole.size, 0) {
  bool spheres = false, boxes = false, after_map = false;
  std::size_t small = 0, mapped = 0;
  for (std::size_t at = 0; at < whole.size; at += instruction_length(whole.words[at])) {
    const Opcode opcode = opcode_of(whole.words[at]);
    spheres = spheres || opcode == Opcode::Sphere;
    boxes = boxes || opcode == Opcode::Box || opcode == Opcode::RoundBox;
    small += is_polymorphic(whole.words[at]), mapped += after_map && is_polymorphic(whole.words[at]);
    after_map = opcode == Opcode::Affine;
  }
  round_boxes_ = spheres && boxes;
  placed_ = static_cast<double>(mapped) > kPlacedShare * static_cast<double>(small);
  if (placed_) append_identity();
  for (std::size_t at = 0; at < whole.size; at += instruction_length(whole.words[at])) {
    const std::uint32_t word = whole.words[at];
    if (quads_of(word) == 0) continue;
    row_at_[at] = static_cast<std::uint32_t>(values_.size() / kQuad);
    const std::uint32_t* immediates = whole.words + at + 1;
    if (is_polymorphic(word)) {
      append_polymorphic(word, immediates);
    } else {
      for (std::size_t i = 0; i + 1 < instruction_length(word); ++i) {
        values_.push_back(std::bit_cast<float>(immediates[i]));
      }
    }
    values_.resize((values_.size() + kQuad - 1) / kQuad * kQuad, 0.0f);
    source_of_.resize(values_.size() / kQuad, static_cast<std::uint32_t>(at));
  }
}

void Constants::append_identity() {
  values_ = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  source_of_.resize(values_.size() / kQuad, 0);
}

void Constants::append_polymorphic(std::uint32_t word, const std::uint32_t* immediates) {
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

std::uint32_t ProgramTemplates::pack(const PrunedProgram& part, const Constants& constants,
                                     std::vector<std::uint32_t>& pool) {
  const auto start = pool.size();
  const std::uint32_t number = remainder_of(part, constants.placed());
  const Remainder& remainder = remainders_[number];
  pool.resize(start + 2 + remainder.entries, Constants::kIdentity);
  pool[start] = remainder.program_template, pool[start + 1] = number;
  std::size_t at = 0;
  for (std::size_t i = 0; i < part.sources.size(); ++i, at += 1 + immediates_of(part.words[at])) {
    const std::uint32_t source = part.sources[i];
    pool[start + 2 + remainder.place[i]] = quads_of(part.words[at]) > 0 ? constants.row(source) : source;
  }
  return static_cast<std::uint32_t>(start);
}

void ProgramTemplates::unpack(const Code& whole, const Constants& constants, const std::uint32_t* pool,
                              std::uint32_t at, PrunedProgram& out) const {
  const Remainder& remainder = remainders_[pool[at + 1]];
  out.locals = remainder.locals, out.max_values = remainder.max_values, out.max_points = remainder.max_points;
  out.choices = remainder.choices, out.cost = 0;
  const std::uint32_t* entry = pool + at + 2;
  out.sources.clear();
  std::size_t length = 0;
  for (std::size_t i = 0, kept_at = 0; i < remainder.place.size(); ++i) {
    const std::uint32_t kept = remainder.words[kept_at], held = entry[remainder.place[i]];
    out.sources.push_back(quads_of(kept) > 0 ? constants.source(held) : held);
    length += 1 + immediates_of(from_remainder(kept, whole, out.sources[i]));
    kept_at += 1 + kept_immediates(kept);
  }
  out.words.resize(length), out.doubles.resize(length);
  std::size_t to = 0, kept_at = 0;
  for (const std::uint32_t source : out.sources) {
    const std::uint32_t kept = remainder.words[kept_at], word = from_remainder(kept, whole, source),
                        first = source + 1;
    const std::size_t count = immediates_of(word);
    out.cost += instruction_cost(word);
    out.words[to] = word, out.doubles[to] = 0;
    std::copy_n(whole.words + first, count, out.words.data() + to + 1);
    std::copy_n(whole.doubles + first, count, out.doubles.data() + to + 1);
    to += 1 + count, kept_at += 1 + kept_immediates(kept);
  }
}

void ProgramTemplates::renumber(const ProgramTemplates& others, std::uint32_t* pool, std::uint32_t at) {
  const Remainder& remainder = others.remainders_[pool[at + 1]];
  wanted_.words = remainder.words, wanted_.doubles = remainder.doubles;
  std::uint32_t number = find(remainder_at_, remainders_, wanted_);
  if (number == kNone) {
    Remainder copy = remainder;
    copy.program_template = number_of(ProgramTemplate(others.templates_[remainder.program_template]));
    number = add(std::move(copy));
  }
  pool[at] = remainders_[number].program_template, pool[at + 1] = number;
}

std::uint32_t ProgramTemplates::remainder_of(const PrunedProgram& part, bool placed) {
  Remainder& wanted = wanted_;
  wanted.words.clear(), wanted.doubles.clear();
  bool outlines = false;
  for (std::size_t at = 0; at < part.words.size(); at += 1 + immediates_of(part.words[at])) {
    append_instruction(part, as_remainder(part.words[at]), at, wanted.words, wanted.doubles);
    outlines = outlines || is_outline(part.words[at]);
  }
  if (!outlines) wanted.doubles.clear();
  if (const std::uint32_t known = find(remainder_at_, remainders_, wanted); known != kNone) return known;

  Remainder remainder = wanted;
  remainder.locals = part.locals, remainder.max_values = part.max_values, remainder.max_points = part.max_points;
  remainder.choices = part.choices;
  ProgramTemplate program_template{{}, {}, part.locals, part.max_values, part.max_points, part.choices, 0, {}};
  remainder.place.assign(part.sources.size(), kNone);
  std::uint32_t places = 0;
  const auto add_row = [&](std::uint32_t instruction, std::uint32_t quads) {
    if (instruction != kNone) remainder.place[instruction] = places;
    program_template.quads.push_back(static_cast<std::uint8_t>(quads));
    ++places;
  };
  for (const Step& step : distance_steps(part, placed)) {
    append_instruction(part, step.word, step.at, program_template.words, program_template.doubles);
    ++program_template.instructions;
    if (is_placed(step.word)) add_row(step.map, quads_of(opcode_word(Opcode::Affine)));
    if (quads_of(step.word) > 0) add_row(step.instruction, quads_of(step.word));
  }
  for (std::uint32_t& place : remainder.place) {
    if (place == kNone) place = places++;
  }
  remainder.entries = places;
  if (!outlines) program_template.doubles.clear();
  remainder.program_template = number_of(std::move(program_template));
  return add(std::move(remainder));
}

std::uint32_t ProgramTemplates::add(Remainder&& remainder) {
  const auto number = static_cast<std::uint32_t>(remainders_.size());
  bytes_ += sizeof(remainder) + bytes_of(remainder) + remainder.place.size() * sizeof(std::uint32_t);
  remainder_at_.emplace(hash_of(remainder.words), number);
  remainders_.push_back(std::move(remainder));
  return number;
}

std::uint32_t ProgramTemplates::number_of(ProgramTemplate&& program_template) {
  if (const std::uint32_t known = find(template_at_, templates_, program_template); known != kNone) {
    ProgramTemplate& other = templates_[known];  // shared by several remainders, so its sizes are their maxima
    other.locals = std::max(other.locals, program_template.locals);
    other.max_values = std::max(other.max_values, program_template.max_values);
    other.max_points = std::max(other.max_points, program_template.max_points);
    return known;
  }
  const auto number = static_cast<std::uint32_t>(templates_.size());
  bytes_ += sizeof(program_template) + bytes_of(program_template) + program_template.quads.size();
  template_at_.emplace(hash_of(program_template.words), number);
  templates_.push_back(std::move(program_template));
  return number;
}

}  // namespace fathom::vm
