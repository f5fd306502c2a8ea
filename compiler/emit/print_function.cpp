#include "compiler/emit/print_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

using vm::Binding;
using vm::RecordedFunction;
using vm::Ref;

constexpr std::size_t kLongestInline = 72;  // maximum number of characters of a nested expression

std::string_view spelling_of(const Language& language, vm::Operation operation) {
  return vm::info(operation).*language.spelling;
}
bool is_call(const Language& language, vm::Operation operation) {
  return spelling_of(language, operation).starts_with('@');
}

// Number of uses of each statement's value, and of each loop variable; 0 for values that need not be computed.
struct Uses {
  std::vector<int> statements, carried;
};
Uses count_uses(const RecordedFunction& function) {
  Uses uses{std::vector<int>(function.statements.size()),
            std::vector<int>(function.loop ? function.loop->carried.size() : 0)};
  const auto use = [&](const Ref& ref) {
    if (ref.kind == Ref::Kind::Statement) ++uses.statements[ref.index];
    if (ref.kind == Ref::Kind::Carried) ++uses.carried[ref.index];
  };
  std::for_each(function.results.begin(), function.results.end(), use);
  if (function.loop) {
    for (const auto& [initial, next] : function.loop->carried) use(initial), use(next);
  }
  for (std::size_t i = function.statements.size(); i-- > 0;) {
    const vm::Statement& statement = function.statements[i];
    const bool ends_loop = statement.operation == vm::Operation::Any && function.loop;
    if (uses.statements[i] == 0 && !ends_loop) continue;
    std::for_each_n(statement.operands.begin(), statement.count(), use);
  }
  return uses;
}

Expression spell(const Language& language, const vm::Statement& statement, std::array<Expression, 3> operands) {
  const vm::OperationInfo& row = vm::info(statement.operation);
  if (row.binding != Binding::Call) {
    // A right operand of equal binding gets parentheses, because floating-point sums are not associative. An equally
    // binding operand of a sign or a comparison gets them, too.
    for (std::size_t o = 0; o < row.operands; ++o) {
      const bool strictly = o > 0 || row.binding == Binding::Sign || row.binding == Binding::Comparison;
      if (operands[o].binding < row.binding || (strictly && operands[o].binding == row.binding)) {
        operands[o].text = '(' + operands[o].text + ')';
      }
    }
  }
  std::string_view pattern = spelling_of(language, statement.operation);
  CHECK(!pattern.empty(), "the language has the operation");
  const bool call = is_call(language, statement.operation);
  if (call) pattern.remove_prefix(1);
  return {(call ? language.prefix : "") +
              fmt::format(fmt::runtime(pattern), operands[0].text, operands[1].text, operands[2].text),
          row.binding};
}

class BodyPrinter {
 public:
  BodyPrinter(const Language& language, const RecordedFunction& function, std::span<const Expression> parameters,
              const std::string& indent)
      : language_(language),
        function_(function),
        parameters_(parameters),
        indent_(indent),
        uses_(count_uses(function)),
        users_(function.statements.size(), kNone),
        texts_(function.statements.size()) {
    find_regions();
  }

  std::string print() {
    for (std::size_t i = 0; i < function_.statements.size(); ++i) {
      if (function_.loop && i == function_.loop->begin) open_loop();
      print_statement(i);
      if (function_.loop && i + 1 == function_.loop->end) close_loop();
    }
    std::array<std::string, 3> results;
    for (std::size_t i = 0; i < function_.results.size(); ++i) results[i] = text_of(function_.results[i]).text;
    const bool point = function_.results.size() == 3;
    line(fmt::format(
        "return {};",
        point ? fmt::format(fmt::runtime(language_.point), results[0], results[1], results[2]) : results[0]));
    return std::move(out_);
  }

 private:
  static constexpr int kNone = -1;

  // Returns 0 before the loop, 1 in the loop, 2 after it.
  int region(std::size_t statement) const {
    if (!function_.loop || statement < function_.loop->begin) return 0;
    return statement < function_.loop->end ? 1 : 2;
  }
  // Finds the region in which each value is used. A value used outside of its own region gets a name.
  void find_regions() {
    const auto use = [&](const Ref& ref, int where) {
      if (ref.kind == Ref::Kind::Statement) users_[ref.index] = where;
    };
    for (std::size_t i = 0; i < function_.statements.size(); ++i) {
      const vm::Statement& statement = function_.statements[i];
      for (std::size_t o = 0; o < statement.count(); ++o) use(statement.operands[o], region(i));
    }
    for (const Ref& ref : function_.results) use(ref, region(function_.statements.size()));
    // A returned value needs no name.
    const Ref& last = function_.results.back();
    if (function_.results.size() == 1 && last.kind == Ref::Kind::Statement) returned_ = last.index;
    if (!function_.loop) return;
    for (const auto& [initial, next] : function_.loop->carried) use(initial, 0), use(next, kNone);
  }

  Expression text_of(const Ref& ref) const {
    switch (ref.kind) {
      case Ref::Kind::Statement:
        return texts_[ref.index];
      case Ref::Kind::Number:
        return language_.number(language_.literal(ref.number));
      case Ref::Kind::Parameter:
        return parameters_[ref.index];
      case Ref::Kind::Carried:
        return {variable(ref.index)};
    }
    CHECK(false, "a kind of operand");
  }
  static std::string variable(std::size_t index) { return fmt::format("v{}", index + 1); }

  void line(const std::string& text) { out_ += indent_ + std::string(in_loop_ ? "  " : "") + text + '\n'; }

  void print_statement(std::size_t i) {
    const vm::Statement& statement = function_.statements[i];
    const bool ends_loop = statement.operation == vm::Operation::Any && region(i) == 1;
    if (uses_.statements[i] == 0 && !ends_loop) return;
    std::array<Expression, 3> operands;
    for (std::size_t o = 0; o < statement.count(); ++o) operands[o] = text_of(statement.operands[o]);
    Expression text = spell(language_, statement, operands);
    if (ends_loop) return line(fmt::format("if (!{}) break;", text.text));
    const bool long_text = text.text.size() > kLongestInline && i != returned_;
    if (uses_.statements[i] > 1 || users_[i] != region(i) || long_text) {
      const bool mask = vm::info(statement.operation).result == vm::ResultType::Mask;
      const std::string name = fmt::format("t{}", ++names_);
      line(fmt::format("{}{} {} = {};", language_.constant, mask ? language_.mask_type : language_.number_type, name,
                       text.text));
      text = {name};
    }
    texts_[i] = std::move(text);
  }

  void open_loop() {
    for (std::size_t i = 0; i < function_.loop->carried.size(); ++i) {
      if (uses_.carried[i] == 0) continue;
      line(fmt::format("{} {} = {};", language_.number_type, variable(i),
                       text_of(function_.loop->carried[i].initial).text));
    }
    line(fmt::format("for (int i = 0; i < {}; ++i) {{", function_.loop->count));
    in_loop_ = true;
  }
  // Every new value has a name, so no variable is read after its change.
  void close_loop() {
    for (std::size_t i = 0; i < function_.loop->carried.size(); ++i) {
      if (uses_.carried[i] == 0) continue;
      line(fmt::format("{} = {};", variable(i), text_of(function_.loop->carried[i].next).text));
    }
    in_loop_ = false;
    line("}");
  }

  const Language& language_;
  const RecordedFunction& function_;
  std::span<const Expression> parameters_;
  const std::string& indent_;
  Uses uses_;
  std::vector<int> users_;  // [statement] the region of a use
  std::optional<std::size_t> returned_;
  std::vector<Expression> texts_;
  std::string out_;
  int names_ = 0;
  bool in_loop_ = false;
};

}  // namespace

std::string print_body(const Language& language, const RecordedFunction& function,
                       std::span<const Expression> parameters, const std::string& indent) {
  return BodyPrinter(language, function, parameters, indent).print();
}

std::optional<Expression> as_expression(const Language& language, const RecordedFunction& function,
                                        std::span<const Expression> parameters) {
  if (function.results.size() != 1) return std::nullopt;
  const auto atom = [&](const Ref& ref) -> std::optional<Expression> {
    if (ref.kind == Ref::Kind::Parameter) return parameters[ref.index];
    if (ref.kind == Ref::Kind::Number) return language.number(language.literal(ref.number));
    return std::nullopt;
  };
  const Ref& result = function.results[0];
  if (result.kind != Ref::Kind::Statement) return atom(result);
  const vm::Statement& statement = function.statements[result.index];
  std::array<Expression, 3> operands;
  for (std::size_t o = 0; o < statement.count(); ++o) {
    const auto operand = atom(statement.operands[o]);
    if (!operand) return std::nullopt;
    operands[o] = *operand;
  }
  return spell(language, statement, operands);
}

std::vector<vm::Operation> called_functions(const Language& language, const RecordedFunction& function) {
  const Uses uses = count_uses(function);
  std::vector<vm::Operation> called;
  for (std::size_t i = 0; i < function.statements.size(); ++i) {
    const vm::Operation operation = function.statements[i].operation;
    if (uses.statements[i] == 0 || !is_call(language, operation)) continue;
    if (std::find(called.begin(), called.end(), operation) == called.end()) called.push_back(operation);
  }
  return called;
}

}  // namespace fathom::compiler
