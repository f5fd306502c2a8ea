#include "compiler/emit/print_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "vm/encoding/repeats.h"

namespace fathom::compiler {
namespace {

using vm::Form;
using vm::Opcode;
using vm::OpcodeInfo;

// Returns text for the rest of a line. Replaces characters that could end a comment, or extend it as \ and the
// trigraph ??/ do.
std::string comment_text(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c < ' ' || c > '~' || c == '\\' || c == '?') c = '.';
  }
  return result;
}

// The texts of a value and of the number of the surface to which it belongs, -1 if no tag has been met.
struct Value {
  Expression number;
  std::string surface = "-1";
  bool tagged = false;  // true if the surface is surely not -1
};

// Returns the text of a choice between surfaces: a if `x < y`, b if `y < x`, otherwise the lesser number, as in
// vm/number/tagged-inl.h.
std::string chosen(const std::string& x, const std::string& y, const std::string& a, const std::string& b) {
  return fmt::format("({0} < {1} ? {2} : {1} < {0} ? {3} : min({2}, {3}))", x, y, a, b);
}

// Runs the program on names: both stacks and the locals hold the texts of the values that the machine's would hold.
class ProgramPrinter {
 public:
  ProgramPrinter(const Language& language, const vm::Program& program, FunctionLibrary& functions, Result result,
                 std::vector<double>* rows)
      : language_(language),
        program_(program),
        functions_(functions),
        result_(result),
        rows_(rows),
        offsets_(vm::offsets_of(program)),
        locals_(program.locals) {}

  std::string print(const glm::dvec3& origin) {
    points_.push_back({"p"});
    if (origin != glm::dvec3(0)) {
      const double by[] = {origin.x, origin.y, origin.z};
      points_ = {line("vec3", "q", functions_.apply(Opcode::Translate, points_, {{}, by}),
                      language_.has_comments ? "the scene's origin" : "")};
    }
    for (const vm::Repeat& block : blocks()) {
      if (block.rows > 1 && is_loop(block)) {
        loop(block);
      } else {
        for (const std::size_t end = next_ + block.length * block.rows; next_ < end;) instruction();
      }
    }
    if (result_ == Result::Surface) tag(values_.back(), "0");
    out_ += fmt::format("  return {};\n",
                        result_ == Result::Surface ? values_.back().surface : values_.back().number.text);
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kLeastRows = 16;  // of a loop

  std::vector<vm::Repeat> blocks() const {
    if (!rows_) return {{offsets_.size(), 1}};
    return vm::find_repeats(vm::code_keys(program_, offsets_), kLeastRows);
  }

  // True if the body of the next block changes nothing but the top value. The points of an outline are no numbers of
  // its function, and a local would be needed after the loop.
  bool is_loop(const vm::Repeat& block) const {
    if (values_.empty()) return false;
    int values = 0, points = 0;
    for (std::size_t i = next_; i < next_ + block.length; ++i) {
      const std::uint32_t word = program_.words[offsets_[i]];
      const OpcodeInfo& row = vm::info(static_cast<Opcode>(word & 0xff));
      const vm::StackEffect effect = vm::effect_of(word);
      if (row.form == Form::Outline || row.opcode == Opcode::Tee) return false;
      if (values - effect.values_needed < -1 || points - effect.points_needed < -1) return false;
      values += effect.values_change, points += effect.points_change;
      if (points < 0) return false;
    }
    return values == 0 && points == 0;
  }

  // True if the body of the next block has a tag, or a local, whose value may have a surface.
  bool may_tag(const vm::Repeat& block) const {
    const auto body = std::span(offsets_).subspan(next_, block.length);
    return std::ranges::any_of(body, [this](std::size_t at) {
      const std::uint32_t word = program_.words[at];
      const OpcodeInfo& row = vm::info(static_cast<Opcode>(word & 0xff));
      const bool function = row.form == Form::Unary || row.form == Form::Binary;
      const vm::Sources sources = vm::sources_of(word);
      return row.opcode == Opcode::Tag || row.opcode == Opcode::Load ||
             (function && (sources.a == vm::Source::Local || sources.b == vm::Source::Local));
    });
  }

  void loop(const vm::Repeat& block) {
    const std::size_t after = next_ + block.length * block.rows;
    const Value start = pop();
    const std::string number = fmt::format("d{}", ++value_names_);
    out_ += fmt::format("  {} {} = {};\n", language_.number_type, number, start.number.text);
    std::string surface = "-1";
    if (result_ == Result::Surface && (start.surface != "-1" || may_tag(block))) {
      surface = fmt::format("s{}", ++surface_names_);
      out_ += fmt::format("  int {} = {};\n", surface, start.surface);
    }
    out_ += fmt::format("  for (int i = 0; i < {}; ++i) {{\n", block.rows);
    add_rows(block);
    values_.push_back({{number}, surface, false});  // as any row may leave it
    const std::string before = std::exchange(out_, "");
    loop_end_ = after, loop_length_ = block.length;
    for (std::size_t i = 0; i < block.length; ++i) instruction();
    loop_end_ = 0;
    row_texts_.clear();
    const Value end = pop();
    out_ += fmt::format("  {} = {};\n", number, end.number.text);
    if (end.surface != surface) out_ += fmt::format("  {} = {};\n", surface, end.surface);
    const std::string body = std::exchange(out_, before);
    for (std::size_t at = 0; at < body.size();) {
      const std::size_t line_end = body.find('\n', at) + 1;
      out_ += "  " + body.substr(at, line_end - at);
      at = line_end;
    }
    out_ += "  }\n";
    next_ = after;
    values_.push_back({{number}, surface, end.tagged});
  }

  // Adds the numbers of the next block that differ between its rows, and sets the texts that stand for them.
  void add_rows(const vm::Repeat& block) {
    const std::size_t begin = offsets_[next_], stride = offsets_[next_ + block.length] - begin;
    const std::vector<std::size_t> varying = vm::varying_words(program_, begin, stride, block.rows);
    std::vector<double> numbers;
    for (std::size_t row = 0; row < block.rows; ++row) {
      for (const std::size_t word : varying) numbers.push_back(program_.doubles[word + row * stride]);
    }
    // A function of surfaces has the rows of the function of distances.
    const auto known = std::search(rows_->begin(), rows_->end(), numbers.begin(), numbers.end());
    const auto first = static_cast<std::size_t>(known - rows_->begin());
    if (known == rows_->end()) rows_->insert(rows_->end(), numbers.begin(), numbers.end());
    row_texts_.assign(stride, "");
    row_begin_ = begin;
    for (std::size_t k = 0; k < varying.size(); ++k)
      row_texts_[varying[k] - begin] = fmt::format("{}row({}{})", language_.prefix,
                                                   varying.size() == 1 ? "i" : fmt::format("{} * i", varying.size()),
                                                   first + k == 0 ? "" : fmt::format(" + {}", first + k));
  }

  // Returns the texts that stand for the immediates from `word` on, none outside of loops.
  std::span<const std::string> texts_from(std::size_t word) const {
    return row_texts_.empty() ? std::span<const std::string>() : std::span(row_texts_).subspan(word - row_begin_);
  }

  // True if the instruction is of the same node in all rows of a loop.
  bool is_one_node(std::size_t instruction) const {
    for (std::size_t i = instruction; i < loop_end_; i += loop_length_) {
      if (program_.debug[i].symbol != program_.debug[instruction].symbol) return false;
    }
    return true;
  }

  void instruction() {
    const bool known = language_.has_comments && next_ < program_.debug.size() && is_one_node(next_);
    comment_ = known && program_.debug[next_].symbol.ends_with('"') ? program_.debug[next_].symbol : "";
    const std::size_t at = offsets_[next_++];
    const std::uint32_t word = program_.words[at];
    const OpcodeInfo& row = vm::info(static_cast<Opcode>(word & 0xff));
    leading_ = at + 1;
    const std::size_t end = at + vm::instruction_length(word);
    const std::size_t first = leading_ + static_cast<std::size_t>(vm::leading_immediates(word));
    const Immediates immediates{std::span(program_.words).subspan(first, end - first),
                                std::span(program_.doubles).subspan(first, end - first), texts_from(first)};
    switch (row.form) {
      case Form::Point:
        points_.push_back(name_point(functions_.apply(row.opcode, {points_.back()}, immediates)));
        break;
      case Form::Shape:
        shape(row, word, immediates);
        break;
      case Form::Outline:
        push({functions_.apply(row.opcode, {points_.back()}, immediates)});
        break;
      case Form::Unary:
      case Form::Binary:
        function(row, word, immediates);
        break;
      case Form::Ternary:
        ternary(row, immediates);
        break;
      case Form::Machine:
        machine(row, word);
        break;
    }
  }

  void shape(const OpcodeInfo& row, std::uint32_t word, const Immediates& immediates) {
    const std::uint32_t modes = vm::operand_of(word);
    Expression p = points_.back();
    if (modes & vm::kFusedTranslate) {
      p = functions_.apply(Opcode::Translate, {p},
                           {{}, std::span(program_.doubles).subspan(leading_, 3), texts_from(leading_)});
    }
    Value value{functions_.apply(row.opcode, {p}, immediates)};
    if (modes & vm::kFusedMin) {
      const Value below = pop();
      if (result_ == Result::Surface && below.surface != value.surface) value = named(value);
      value = {functions_.apply(Opcode::Min, {below.number, value.number}, {}),
               surface_of(vm::info(Opcode::Min), below, value), below.tagged && value.tagged};
    }
    push(std::move(value));
  }

  void function(const OpcodeInfo& row, std::uint32_t word, const Immediates& immediates) {
    const vm::Sources sources = vm::sources_of(word);
    // An operand b on the stack is the top value. A constant operand a is the first constant.
    const bool stack = row.form == Form::Binary && sources.b == vm::Source::Stack;
    const Value top = stack ? pop() : Value{};
    const Value a = operand(sources.a, sources.local);
    if (row.form == Form::Unary)
      return push({functions_.apply(row.opcode, {a.number}, immediates), a.surface, a.tagged});
    const Value b = stack ? top : operand(sources.b, sources.local);
    const bool tagged = a.tagged && (b.tagged || row.choice == vm::Choice::None);
    push({functions_.apply(row.opcode, {a.number, b.number}, immediates), surface_of(row, a, b), tagged});
  }

  void ternary(const OpcodeInfo& row, const Immediates& immediates) {
    const Value c = pop(), b = pop(), a = pop();
    push({functions_.apply(row.opcode, {a.number, b.number, c.number}, immediates), a.surface, a.tagged});
  }

  // Returns the surface to which the value of a Binary belongs: that of the operand chosen, or that of the first.
  std::string surface_of(const OpcodeInfo& row, const Value& a, const Value& b) const {
    if (a.surface == b.surface || row.choice == vm::Choice::None || result_ != Result::Surface) return a.surface;
    const std::string &x = a.number.text, &y = b.number.text;
    switch (row.choice) {
      case vm::Choice::Lesser:
        return chosen(x, y, a.surface, b.surface);
      case vm::Choice::Greater:
        return chosen(y, x, a.surface, b.surface);
      case vm::Choice::Carve:
        return chosen(y.starts_with('-') ? fmt::format("-({})", y) : '-' + y, x, a.surface, b.surface);
      default:  // Either: the lesser of both, or minus the greater
        return chosen(fmt::format("min({}, {})", y, x), fmt::format("-max({}, {})", y, x),
                      chosen(y, x, a.surface, b.surface), chosen(x, y, a.surface, b.surface));
    }
  }

  Value operand(vm::Source source, std::uint32_t local) {
    switch (source) {
      case vm::Source::Stack:
        return pop();
      case vm::Source::Constant:
        return {language_.number(constant(leading_++))};
      case vm::Source::Local:
        return locals_[local];
      default:
        return {{points_.back().text + '.' + " xyz"[static_cast<std::size_t>(source)]}};
    }
  }

  std::string constant(std::size_t word) const {
    const std::span<const std::string> texts = texts_from(word);
    return texts.empty() || texts[0].empty() ? language_.immediate(program_.doubles[word]) : texts[0];
  }

  void machine(const OpcodeInfo& row, std::uint32_t word) {
    const std::uint32_t operand = vm::operand_of(word);
    if (row.opcode == Opcode::Drop) points_.pop_back();
    if (row.opcode == Opcode::Tee) locals_[operand] = values_.back();
    if (row.opcode == Opcode::Load) values_.push_back(locals_[operand]);
    if (row.opcode == Opcode::Tag && result_ == Result::Surface) {
      Value value = pop();
      tag(value, std::to_string(operand));
      push(std::move(value));
    }
  }

  // Assigns a surface to a value that has none. A tag leaves a value that has one, as in the machine.
  static void tag(Value& value, const std::string& surface) {
    if (value.surface == "-1") {
      value.surface = surface;
    } else if (!value.tagged) {
      value.surface = fmt::format("({0} < 0 ? {1} : {0})", value.surface, surface);
    }
    value.tagged = true;
  }

  Value pop() {
    Value top = std::move(values_.back());
    values_.pop_back();
    return top;
  }
  void push(Value value) {
    value = named(value);
    // A choice between surfaces has a name, because several later choices may use its text.
    if (value.surface.front() == '(') {
      const std::string name = fmt::format("s{}", ++surface_names_);
      out_ += fmt::format("  {}int {} = {};\n", language_.constant, name,
                          value.surface.substr(1, value.surface.size() - 2));
      value.surface = name;
    }
    values_.push_back(std::move(value));
  }
  // Returns the value with its number in a named one. A coordinate or a constant needs no name.
  Value named(const Value& value) {
    const std::string& text = value.number.text;
    const bool plain = text.find_first_of(" (,") == text.npos || text.starts_with("number(");
    return plain ? value : Value{name_value(value.number), value.surface, value.tagged};
  }
  Expression name_value(const Expression& value) {
    return line(language_.number_type, fmt::format("d{}", ++value_names_), value, comment_);
  }
  Expression name_point(const Expression& value) {
    return line("vec3", fmt::format("p{}", ++point_names_), value, comment_);
  }
  Expression line(std::string_view type, std::string name, const Expression& value, const std::string& comment) {
    out_ += fmt::format("  {}{} {} = {};", language_.constant, type, name, value.text);
    if (!comment.empty()) out_ += "  // " + comment_text(comment);
    out_ += '\n';
    return {std::move(name)};
  }

  const Language& language_;
  const vm::Program& program_;
  FunctionLibrary& functions_;
  const Result result_;
  std::vector<double>* const rows_;         // of all loops, or null
  const std::vector<std::size_t> offsets_;  // [instruction]
  std::vector<Expression> points_;
  std::vector<Value> values_, locals_;
  std::size_t next_ = 0, leading_ = 0;  // the next instruction; word of the next leading immediate
  std::vector<std::string> row_texts_;  // [word of the body] within a loop
  std::size_t loop_end_ = 0, loop_length_ = 1;  // instructions, within a loop
  std::size_t row_begin_ = 0;           // word
  std::string out_;
  std::string comment_;  // the instruction's symbol, if the scene gives it a name
  int value_names_ = 0, point_names_ = 0, surface_names_ = 0;
};

}  // namespace

std::string print_program(const Language& language, const vm::VerifiedProgram& program, const glm::dvec3& origin,
                          FunctionLibrary& functions, Result result, std::vector<double>* rows) {
  return ProgramPrinter(language, program.program(), functions, result, rows).print(origin);
}

std::string describe(const CompiledScene& scene) {
  return comment_text(fmt::format("{}: {}", scene.source.name(), scene.summary));
}

std::string list_rows(const Language& language, const std::vector<double>& rows) {
  constexpr std::size_t kPerLine = 8;
  std::string lines;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    lines += (i % kPerLine == 0 ? "  " : " ") + language.literal(rows[i]);
    if (i + 1 < rows.size()) lines += ',';
    if (i % kPerLine + 1 == kPerLine || i + 1 == rows.size()) lines += '\n';
  }
  return lines;
}

std::string list_surfaces(const CompiledScene& scene) {
  std::string lines;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    lines += fmt::format("//     {}  {}\n", i, comment_text(scene.surfaces[i].name));
  }
  return lines;
}

}  // namespace fathom::compiler
