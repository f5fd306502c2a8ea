#include "vm/prune/pruned_program.h"

namespace fathom::vm {

PrunedProgram whole(const Code& code) {
  PrunedProgram part;
  part.words.assign(code.words, code.words + code.size);
  part.doubles.assign(code.doubles, code.doubles + code.size);
  part.locals = code.locals, part.max_values = code.max_values, part.max_points = code.max_points;
  part.choices = code.choices;
  for (std::size_t at = 0; at < code.size; at += instruction_length(code.words[at])) {
    part.sources.push_back(static_cast<std::uint32_t>(at));
    part.cost += instruction_cost(code.words[at]);
  }
  return part;
}

void PrunedProgramWriter::make_room(std::size_t words) {
  const auto grow = [](auto& list, std::size_t& at, std::size_t least) {
    const std::size_t more = list.size() + least + 64;
    list.insert(list.begin(), more, {});
    at += more;
  };
  std::size_t wide_at = at_;
  grow(words_, at_, words), grow(doubles_, wide_at, words), grow(sources_, source_at_, 1);
}

void PrunedProgramWriter::finish(std::uint32_t locals, PrunedProgram& out) const {
  const auto tail = [](const auto& from, std::size_t at, auto& to) {
    to.assign(from.begin() + static_cast<std::ptrdiff_t>(at), from.end());
  };
  tail(words_, at_, out.words), tail(doubles_, at_, out.doubles), tail(sources_, source_at_, out.sources);
  out.locals = locals, out.cost = cost_, out.choices = choices_;
  out.max_values = static_cast<std::uint32_t>(max_values_);
  out.max_points = static_cast<std::uint32_t>(max_points_);
}

}  // namespace fathom::vm
