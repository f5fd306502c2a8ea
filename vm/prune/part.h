// A part of a program, and how one is written (vm/prune/specialise.h).
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vm/program/opcode_rows.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// A shorter program and where its instructions are in the whole one.
struct Part {
  std::vector<std::uint32_t> words;
  std::vector<double> wide;            // [word]
  std::vector<std::uint32_t> sources;  // [instruction] offset of the opcode word it came from, in the whole program
  std::uint32_t locals = 0, max_values = 0, max_points = 0, choices = 0;
  std::uint64_t cost = 0;  // multiply-adds per point, by the table's estimate

  std::size_t bytes() const {
    return words.size() * (sizeof(std::uint32_t) + sizeof(double)) + sources.size() * sizeof(std::uint32_t);
  }

  operator Code() const { return {words.data(), wide.data(), words.size(), locals, max_values, max_points, choices}; }
};

// The whole program as a part of itself.
Part whole(const Code& code);

// Writes a part of a program from its last instruction to its first, as cutting comes upon them.
class PartWriter {
 public:
  // The program must outlive what is written of it.
  void begin(const Part& program) {
    program_ = &program;
    at_ = words_.size(), source_at_ = sources_.size();
    values_ = most_values_ = points_ = most_points_ = 1;  // as at the end
    cost_ = 0, choices_ = 0;
  }

  // An opcode word and `count` immediates, which are at `from` in the program; made of its instruction `node`.
  void put(std::uint32_t node, std::uint32_t word, std::uint32_t from, std::uint32_t count) {
    const OpcodeRow& row = row_of(word);
    if (is_function(row.form)) return put_function(node, word, row, from, count);
    write(node, word, from, count);
    const StackEffect effect = effect_of(word);
    cost_ += instruction_cost(word), choices_ += is_choice(word);
    values_ -= effect.values_change, points_ -= effect.points_change;
    most_values_ = std::max(most_values_, values_), most_points_ = std::max(most_points_, points_);
  }

  // The same of a function, the row of the word; most of a formula.
  void put_function(std::uint32_t node, std::uint32_t word, const OpcodeRow& row, std::uint32_t from,
                    std::uint32_t count) {
    write(node, word, from, count);
    const Sources sources = sources_of(word);
    cost_ += static_cast<std::uint64_t>(row.cost), choices_ += row.choice;
    values_ += (sources.a == Source::Stack) + (row.form == Form::Binary && sources.b == Source::Stack) - 1;
    most_values_ = std::max(most_values_, values_);
  }

  // What was written, from its beginning.
  void finish(std::uint32_t locals, Part& out) const;

 private:
  void write(std::uint32_t node, std::uint32_t word, std::uint32_t from, std::uint32_t count) {
    if (at_ < 1 + count || source_at_ == 0) make_room(1 + count);
    at_ -= 1 + count;
    words_[at_] = word, wide_[at_] = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
      words_[at_ + 1 + k] = program_->words[from + k], wide_[at_ + 1 + k] = program_->wide[from + k];
    }
    sources_[--source_at_] = program_->sources[node];
  }

  // For so many words and an instruction before what is written.
  void make_room(std::size_t words);

  const Part* program_ = nullptr;
  std::vector<std::uint32_t> words_;
  std::vector<double> wide_;
  std::vector<std::uint32_t> sources_;
  std::size_t at_ = 0, source_at_ = 0;  // where what is written begins
  // Heights of the stacks before the instruction written last, and the most of them.
  std::int64_t values_ = 1, most_values_ = 1, points_ = 1, most_points_ = 1;
  std::uint64_t cost_ = 0;
  std::uint32_t choices_ = 0;
};

}  // namespace fathom::vm
