// A part of a program, the result of pruning (vm/prune/specialise.h), and a writer of parts.
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vm/program/opcode_rows.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// A pruned program, and the position of its instructions in the whole program.
struct PrunedProgram {
  std::vector<std::uint32_t> words;
  std::vector<double> doubles;         // [word]
  std::vector<std::uint32_t> sources;  // [instruction] offset of its opcode word in the whole program
  std::uint32_t locals = 0, max_values = 0, max_points = 0, choices = 0;
  std::uint64_t cost = 0;  // multiply-adds per point, as vm/program/opcodes.def estimates

  std::size_t bytes() const {
    return words.size() * (sizeof(std::uint32_t) + sizeof(double)) + sources.size() * sizeof(std::uint32_t);
  }

  operator Code() const {
    return {words.data(), doubles.data(), words.size(), locals, max_values, max_points, choices};
  }
};

// Returns the whole program as a part of itself.
PrunedProgram whole(const Code& code);

// Writes a part of a program from the last instruction to the first, the order in which pruning visits them.
class PrunedProgramWriter {
 public:
  // Starts a part of `program`, which must live until finish().
  void begin(const PrunedProgram& program) {
    program_ = &program;
    at_ = words_.size(), source_at_ = sources_.size();
    values_ = max_values_ = points_ = max_points_ = 1;  // heights of the stacks at the end of a program
    cost_ = 0, choices_ = 0;
  }

  // Writes an opcode word and `count` immediates, which are at `from` in the program. `node`: the program's
  // instruction from which this one derives.
  void put(std::uint32_t node, std::uint32_t word, std::uint32_t from, std::uint32_t count) {
    const OpcodeRow& row = row_of(word);
    if (is_function(row.form)) return put_function(node, word, row, from, count);
    write(node, word, from, count);
    const StackEffect effect = effect_of(word);
    cost_ += instruction_cost(word), choices_ += is_choice(word);
    values_ -= effect.values_change, points_ -= effect.points_change;
    max_values_ = std::max(max_values_, values_), max_points_ = std::max(max_points_, points_);
  }

  // Like put(), for a Unary or Binary, the most frequent instructions of a formula. `row` is the row of `word`.
  void put_function(std::uint32_t node, std::uint32_t word, const OpcodeRow& row, std::uint32_t from,
                    std::uint32_t count) {
    write(node, word, from, count);
    const Sources sources = sources_of(word);
    cost_ += static_cast<std::uint64_t>(row.cost), choices_ += row.choice != Choice::None;
    values_ += (sources.a == Source::Stack) + (row.form == Form::Binary && sources.b == Source::Stack) - 1;
    max_values_ = std::max(max_values_, values_);
  }

  // Copies the written instructions to `out`.
  void finish(std::uint32_t locals, PrunedProgram& out) const;

 private:
  void write(std::uint32_t node, std::uint32_t word, std::uint32_t from, std::uint32_t count) {
    if (at_ < 1 + count || source_at_ == 0) make_room(1 + count);
    at_ -= 1 + count;
    words_[at_] = word, doubles_[at_] = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
      words_[at_ + 1 + k] = program_->words[from + k], doubles_[at_ + 1 + k] = program_->doubles[from + k];
    }
    sources_[--source_at_] = program_->sources[node];
  }

  // Makes room for `words` words and one instruction before the written ones.
  void make_room(std::size_t words);

  const PrunedProgram* program_ = nullptr;
  std::vector<std::uint32_t> words_;
  std::vector<double> doubles_;
  std::vector<std::uint32_t> sources_;
  std::size_t at_ = 0, source_at_ = 0;  // begin of the written words and sources
  // Heights of the stacks before the instruction written last, and their maxima.
  std::int64_t values_ = 1, max_values_ = 1, points_ = 1, max_points_ = 1;
  std::uint64_t cost_ = 0;
  std::uint32_t choices_ = 0;
};

}  // namespace fathom::vm
