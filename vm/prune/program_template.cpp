#include "vm/prune/program_template.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fathom::vm {
namespace {

// An instruction of a template.
struct Step {
  std::uint32_t word, instruction;  // opcode word in the template; number of the part's instruction
  std::uint32_t at;                 // offset of the part's opcode word
};

bool is_outline(std::uint32_t word) { return find_opcode(word & 0xff)->form == Form::Outline; }

bool is_polymorphic(std::uint32_t word) {
  const OpcodeInfo& row = *find_opcode(word & 0xff);
  return row.form == Form::Shape && can_be_polymorphic(row.immediate_names, row.cost);
}

// Returns the opcode word that a template has for a part's opcode word.
std::uint32_t as_laid_out(std::uint32_t word) {
  return is_polymorphic(word) ? opcode_word(Opcode::RoundBox, operand_of(word) | kFusedTranslate | kPolymorphic)
                              : word;
}

// Returns the number of quads of an instruction's constants.
std::uint32_t quads_of(std::uint32_t word) {
  if (is_outline(word)) return 0;
  if (is_polymorphic(word)) return 2;
  return static_cast<std::uint32_t>((instruction_length(word) - 1 + kQuad - 1) / kQuad);
}

Opcode opcode_of(std::uint32_t word) { return static_cast<Opcode>(word & 0xff); }
bool is_shape(std::uint32_t word) { return find_opcode(word & 0xff)->form == Form::Shape; }
bool is_joined_shape(std::uint32_t word) { return is_shape(word) && (operand_of(word) & kFusedMin) != 0; }

// Returns the part's instructions except tags. A shape followed by a min becomes one instruction with kFusedMin.
std::vector<Step> untagged(const PrunedProgram& part) {
  std::vector<Step> steps;
  std::uint32_t instruction = 0;
  for (std::size_t at = 0; at < part.words.size(); at += instruction_length(part.words[at]), ++instruction) {
    const std::uint32_t word = part.words[at];
    if (opcode_of(word) == Opcode::Tag) continue;
    const bool joins = word == opcode_word(Opcode::Min) && steps.size() > 1 && is_shape(steps.back().word) &&
                       !is_joined_shape(steps.back().word);
    if (joins) {
      steps.back().word |= kFusedMin << 8;
    } else {
      steps.push_back({as_laid_out(word), instruction, static_cast<std::uint32_t>(at)});
    }
  }
  return steps;
}

// Sorts the union of shapes with which a program begins by opcode words. The order of a union does not matter, so
// programs that begin with the same shapes in different orders share a template.
void sort_union(std::vector<Step>& steps) {
  if (steps.empty() || !is_shape(steps[0].word)) return;
  auto end = std::find_if(steps.begin() + 1, steps.end(), [](const Step& s) { return !is_joined_shape(s.word); });
  constexpr std::uint32_t kJoinedBit = kFusedMin << 8;
  std::stable_sort(steps.begin(), end,
                   [](const Step& a, const Step& b) { return (a.word & ~kJoinedBit) < (b.word & ~kJoinedBit); });
  for (auto s = steps.begin(); s != end; ++s) s->word |= kJoinedBit;
  steps[0].word &= ~kJoinedBit;
}

// True if immediate i belongs to the template: integers, and the corners of outlines.
bool keeps_immediate(std::uint32_t word, std::size_t i) {
  const OpcodeInfo& row = *find_opcode(word & 0xff);
  if (is_outline(word)) return true;
  const int own = static_cast<int>(i) - leading_immediates(word);
  return own >= 0 && is_integer_immediate(row, own);
}

void append_instruction(const PrunedProgram& part, std::uint32_t word, std::size_t at,
                        std::vector<std::uint32_t>& words, std::vector<double>& doubles) {
  words.push_back(word), doubles.push_back(0);
  const bool outline = is_outline(word);
  for (std::size_t i = 0; i + 1 < instruction_length(word); ++i) {
    const bool keeps = keeps_immediate(word, i);
    words.push_back(keeps ? part.words[at + 1 + i] : 0);
    doubles.push_back(outline ? part.doubles[at + 1 + i] : 0);
  }
}

// Returns the steps of a part in the order of its template.
std::vector<Step> distance_steps(const PrunedProgram& part) {
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
    if (item.words == wanted.words && item.doubles == wanted.doubles) return it->second;
  }
  return kNone;
}

template <class Item>
std::size_t bytes_of(const Item& item) {
  return item.words.size() * sizeof(std::uint32_t) + item.doubles.size() * sizeof(double);
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
  const std::uint32_t number = remainder_of(part);
  const Remainder& remainder = remainders_[number];
  pool.resize(start + 2 + part.sources.size());
  pool[start] = remainder.program_template, pool[start + 1] = number;
  std::size_t at = 0;
  for (std::size_t i = 0; i < part.sources.size(); ++i, at += instruction_length(part.words[at])) {
    const std::uint32_t source = part.sources[i];
    pool[start + 2 + remainder.place[i]] = quads_of(part.words[at]) > 0 ? constants.row(source) : source;
  }
  return static_cast<std::uint32_t>(start);
}

void ProgramTemplates::unpack(const Code& whole, const Constants& constants, const std::uint32_t* pool,
                              std::uint32_t at, PrunedProgram& out) const {
  const Remainder& remainder = remainders_[pool[at + 1]];
  out.words = remainder.words;
  out.doubles.assign(out.words.size(), 0);
  out.sources.clear();
  out.locals = remainder.locals, out.max_values = remainder.max_values, out.max_points = remainder.max_points;
  out.choices = remainder.choices, out.cost = remainder.cost;
  const std::uint32_t* entry = pool + at + 2;
  const auto offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  for (std::size_t word = 0, i = 0; word < out.words.size(); word += instruction_length(out.words[word]), ++i) {
    const std::uint32_t held = entry[remainder.place[i]];
    const std::uint32_t source = quads_of(out.words[word]) > 0 ? constants.source(held) : held;
    out.sources.push_back(source);
    if (opcode_of(out.words[word]) == Opcode::Tag) out.words[word] = whole.words[source];
    const std::size_t count = instruction_length(out.words[word]) - 1;
    std::copy_n(whole.words + source + 1, count, out.words.begin() + offset(word + 1));
    std::copy_n(whole.doubles + source + 1, count, out.doubles.begin() + offset(word + 1));
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

std::uint32_t ProgramTemplates::remainder_of(const PrunedProgram& part) {
  Remainder& wanted = wanted_;
  wanted.words.clear(), wanted.doubles.clear();
  bool outlines = false;
  for (std::size_t at = 0; at < part.words.size(); at += instruction_length(part.words[at])) {
    const bool tag = opcode_of(part.words[at]) == Opcode::Tag;
    append_instruction(part, tag ? opcode_word(Opcode::Tag) : part.words[at], at, wanted.words, wanted.doubles);
    outlines = outlines || is_outline(part.words[at]);
  }
  if (!outlines) wanted.doubles.clear();
  if (const std::uint32_t known = find(remainder_at_, remainders_, wanted); known != kNone) return known;

  Remainder remainder = wanted;
  remainder.locals = part.locals, remainder.max_values = part.max_values, remainder.max_points = part.max_points;
  remainder.choices = part.choices, remainder.cost = part.cost;
  ProgramTemplate program_template{{}, {}, part.locals, part.max_values, part.max_points, part.choices, 0, {}};
  remainder.place.assign(part.sources.size(), kNone);
  std::uint32_t places = 0;
  for (const Step& step : distance_steps(part)) {
    append_instruction(part, step.word, step.at, program_template.words, program_template.doubles);
    ++program_template.instructions;
    if (quads_of(step.word) == 0) continue;
    remainder.place[step.instruction] = places++;
    program_template.quads.push_back(static_cast<std::uint8_t>(quads_of(step.word)));
  }
  for (std::uint32_t& place : remainder.place) {
    if (place == kNone) place = places++;
  }
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
