#include "vm/record/recorded_function.h"

#include <algorithm>
#include <utility>

namespace fathom::vm {
namespace {

constexpr OperationInfo kOperations[] = {
#define OPERATION(Name, operands, result, binding, cpp, glsl) \
  {#Name, operands, ResultType::result, Binding::binding, cpp, glsl},
#include "vm/record/operations.def"
#undef OPERATION
};

// Tries to read statements [begin, begin + count * length) as `count` passes of a loop. The second pass is the
// pattern: the values it takes from the first pass are the variables that the loop carries.
class Passes {
 public:
  Passes(const RecordedFunction& function, std::size_t begin, std::size_t length, std::size_t count)
      : from_(function), begin_(begin), length_(length), count_(count) {}

  std::optional<RecordedFunction> roll() {
    if (begin_ + count_ * length_ > from_.statements.size()) return std::nullopt;
    RecordedFunction result;
    result.loop = Loop{begin_, begin_ + length_, count_, {}};
    result.statements.assign(from_.statements.begin(),
                             from_.statements.begin() + static_cast<std::ptrdiff_t>(begin_));
    for (std::size_t i = 0; i < length_; ++i) {
      if (!alike(i)) return std::nullopt;
      result.statements.push_back(pattern(i));
    }
    if (!append_rest(result)) return std::nullopt;
    for (const Variable& variable : variables_) {
      result.loop->carried.push_back({variable.initial, moved(statement(1, variable.offset))});
    }
    return result;
  }

 private:
  struct Variable {
    Ref initial;
    std::size_t offset;  // within a pass, of the statement that gives the variable's next value
  };

  static Ref statement_ref(std::size_t index) { return {Ref::Kind::Statement, static_cast<std::uint32_t>(index)}; }
  Ref statement(std::size_t pass, std::size_t offset) const {
    return statement_ref(begin_ + pass * length_ + offset);
  }
  bool in_pass(const Ref& ref, std::size_t pass) const {
    return ref.kind == Ref::Kind::Statement && ref.index >= begin_ + pass * length_ &&
           ref.index < begin_ + (pass + 1) * length_;
  }
  bool outside(const Ref& ref) const { return ref.kind != Ref::Kind::Statement || ref.index < begin_; }

  // True if statement i is the same in all passes. Adds the values it takes from an earlier pass to variables_.
  bool alike(std::size_t i) {
    const Statement& first = from_.statements[begin_ + i];
    const Statement& second = from_.statements[begin_ + length_ + i];
    for (std::size_t o = 0; o < second.count(); ++o) {
      if (in_pass(second.operands[o], 0)) {
        if (!outside(first.operands[o])) return false;
        carry(first.operands[o], second.operands[o].index - begin_);
      } else if (first.operands[o] != back(second.operands[o], 1)) {
        return false;
      }
    }
    for (std::size_t pass = 0; pass < count_; ++pass) {
      const Statement& other = from_.statements[begin_ + pass * length_ + i];
      if (other.operation != second.operation) return false;
      for (std::size_t o = 0; pass > 1 && o < second.count(); ++o) {
        if (back(other.operands[o], pass - 1) != second.operands[o]) return false;
      }
    }
    return true;
  }
  // Returns the reference that corresponds to `ref` in the pass `passes` earlier.
  Ref back(const Ref& ref, std::size_t passes) const {
    return outside(ref) ? ref : statement_ref(ref.index - passes * length_);
  }

  std::size_t carry(const Ref& initial, std::size_t offset) {
    const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const Variable& variable) {
      return variable.initial == initial && variable.offset == offset;
    });
    if (found == variables_.end()) variables_.push_back({initial, offset});
    return static_cast<std::size_t>(found - variables_.begin());
  }

  Statement pattern(std::size_t i) {
    Statement result = from_.statements[begin_ + length_ + i];
    for (std::size_t o = 0; o < result.count(); ++o) {
      Ref& ref = result.operands[o];
      if (in_pass(ref, 0)) {
        const Ref& initial = from_.statements[begin_ + i].operands[o];
        ref = {Ref::Kind::Carried, static_cast<std::uint32_t>(carry(initial, ref.index - begin_))};
      } else {
        ref = moved(ref);
      }
    }
    return result;
  }
  // Moves a reference to a statement of the second pass to the first, which is the pass that stays.
  Ref moved(const Ref& ref) const { return outside(ref) ? ref : back(ref, 1); }

  // Appends the statements after the loop. Returns false if one uses a value of the loop that the loop does not
  // carry.
  bool append_rest(RecordedFunction& result) const {
    for (std::size_t i = begin_ + count_ * length_; i < from_.statements.size(); ++i) {
      Statement statement = from_.statements[i];
      for (std::size_t o = 0; o < statement.count(); ++o) {
        if (!move_after(statement.operands[o])) return false;
      }
      result.statements.push_back(statement);
    }
    result.results = from_.results;
    return std::all_of(result.results.begin(), result.results.end(), [&](Ref& ref) { return move_after(ref); });
  }
  bool move_after(Ref& ref) const {
    if (outside(ref)) return true;
    if (ref.index >= begin_ + count_ * length_) {
      ref.index -= static_cast<std::uint32_t>((count_ - 1) * length_);
      return true;
    }
    if (!in_pass(ref, count_ - 1)) return false;
    const std::size_t offset = ref.index - (begin_ + (count_ - 1) * length_);
    const auto same = [&](const Variable& variable) { return variable.offset == offset; };
    if (std::count_if(variables_.begin(), variables_.end(), same) != 1) return false;
    const auto found = std::find_if(variables_.begin(), variables_.end(), same);
    ref = {Ref::Kind::Carried, static_cast<std::uint32_t>(found - variables_.begin())};
    return true;
  }

  const RecordedFunction& from_;
  std::size_t begin_, length_, count_;
  std::vector<Variable> variables_;
};

}  // namespace

const OperationInfo& info(Operation operation) { return kOperations[static_cast<std::size_t>(operation)]; }

RecordedFunction reroll(RecordedFunction function) {
  std::vector<std::size_t> tests;
  for (std::size_t i = 0; i < function.statements.size(); ++i) {
    if (function.statements[i].operation == Operation::Any) tests.push_back(i);
  }
  if (tests.size() < 2) return function;
  const std::size_t length = tests[1] - tests[0];
  // A pass begins at most length - 1 statements before its test.
  for (std::size_t head = 0; head < length && head <= tests[0]; ++head) {
    if (auto rolled = Passes(function, tests[0] - head, length, tests.size()).roll()) return *std::move(rolled);
  }
  return function;
}

}  // namespace fathom::vm
