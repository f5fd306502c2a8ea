#include "vm/encoding/assemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vm/encoding/escape.h"
#include "vm/encoding/repeats.h"
#include "vm/program/verify.h"

namespace fathom::vm {
namespace {

using Token = std::string_view;

const OpcodeInfo* find_mnemonic(Token word) {
  static const auto* const rows = [] {
    auto* table = new std::unordered_map<std::string_view, const OpcodeInfo*>;
    for (std::uint32_t i = 0; i < kOpcodeCount; ++i) (*table)[find_opcode(i)->mnemonic] = find_opcode(i);
    return table;
  }();
  const auto found = rows->find(word);
  return found == rows->end() ? nullptr : found->second;
}

template <typename Number>
std::optional<Number> to_number(Token token) {
  Number value{};
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

// Columns of a listing: offset, length, two stack heights, cost.
constexpr int kColumns = 5;

// True for "12" or "0->1".
bool is_column(Token token) {
  const auto is_number = [](Token part) {
    return !part.empty() && part.find_first_not_of("0123456789") == Token::npos;
  };
  const std::size_t arrow = std::min(token.find("->"), token.size());
  return is_number(token.substr(0, arrow)) && (arrow == token.size() || is_number(token.substr(arrow + 2)));
}

// Operand and immediates of the instruction being read.
struct Draft {
  std::uint32_t operand = 0;
  std::vector<double> immediates;
};

// The instructions between `each` and `rows`, and the immediates that rows give, in the order of the text.
struct Body {
  struct Part {
    Opcode opcode;
    Draft draft;
    DebugEntry place;
  };
  std::vector<Part> parts;
  struct Slot {
    const char* at;  // in the text
    std::size_t part, immediate;
  };
  std::vector<Slot> slots;
  std::size_t rows = 0, read = 0;  // number of rows, and of those that were read
  bool complete = false;           // rows follow
};

class Assembler {
 public:
  Assembler(std::string_view text, std::vector<std::size_t>* lines, std::size_t most)
      : text_(text), lines_(lines), most_(most) {}

  std::variant<Program, AssembleError> run() {
    for (std::size_t at = 0; at < text_.size() && !error_;) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      line_ = at;
      read_line(text_.substr(at, end - at));
      at = end + 1;
    }
    if (body_ && !error_) fail(text_.substr(each_, 4), "`each` has no `end`");
    if (error_) return *std::move(error_);
    if (!placed_) program_.debug.clear();
    return std::move(program_);
  }

 private:
  void read_line(std::string_view line) {
    if (body_ && body_->complete) return read_row(line);
    DebugEntry place{};
    split(line, place);
    if (error_ || tokens_.empty()) return;
    if (tokens_[0] == "each") return begin_body();
    if (tokens_[0] == "rows" && body_) return begin_rows();
    if (tokens_[0] == "end" && body_) return fail(tokens_[0], "`rows` is missing before `end`");
    if (tokens_[0] == "locals" && program_.words.empty()) return read_locals();
    const OpcodeInfo* row = find_mnemonic(tokens_[0]);
    if (row == nullptr) {
      fail(tokens_[0], fmt::format("no instruction is called `{}`", tokens_[0]));
      error_->unknown_instruction = true;
      return;
    }
    Draft draft;
    read_operands(*row, draft);
    if (error_) return;
    if (body_) return body_->parts.push_back({row->opcode, std::move(draft), std::move(place)});
    append(row->opcode, draft, std::move(place));
  }

  void append(Opcode opcode, const Draft& draft, DebugEntry place) {
    program_.append(opcode, draft.operand, draft.immediates, std::move(place));
    if (lines_) lines_->push_back(line_);
  }
  void append_row() {
    for (const Body::Part& part : body_->parts) append(part.opcode, part.draft, part.place);
  }

  // Reads "each 5952".
  void begin_body() {
    const auto rows = tokens_.size() == 2 ? to_number<std::uint32_t>(tokens_[1]) : std::nullopt;
    if (body_ || !rows || *rows == 0)
      return fail(tokens_[0], "`each` stands before a body of instructions, with how many rows it has");
    body_.emplace().rows = *rows;
    each_ = line_;
  }
  void begin_rows() {
    Body& body = *body_;
    if (body.parts.empty()) return fail(tokens_[0], "`rows` stands after the instructions that they are of");
    std::ranges::sort(body.slots, {}, &Body::Slot::at);
    body.complete = true;
    // A few characters ask for any number of rows.
    Program once;
    std::size_t symbols = 0;
    for (const Body::Part& part : body.parts) {
      once.append(part.opcode, part.draft.operand, part.draft.immediates, {});
      symbols += part.place.symbol.size();
    }
    const std::size_t instructions = program_.debug.size() + body.rows * body.parts.size();
    if (instructions > most_ || body.rows * once.words.size() > kWordsPerInstruction * most_ ||
        body.rows * symbols > kMostRowSymbols) {
      fail(text_.substr(each_, 4), fmt::format("the rows make a program larger than one of {} instructions may be: "
                                               "`--limit instructions=N` allows more",
                                               most_));
    }
  }

  // Reads the numbers of a row, or `end`.
  void read_row(std::string_view line) {
    Body& body = *body_;
    tokens_.clear();
    for (std::size_t at = 0;;) {
      at = line.find_first_not_of(" \t\r", at);
      if (at == line.npos || line[at] == ';') break;
      const std::size_t end = std::min(line.find_first_of(" \t\r;", at), line.size());
      tokens_.push_back(line.substr(at, end - at));
      at = end;
    }
    if (tokens_.empty()) return;
    const Token first = tokens_[0];
    if (first == "end") return tokens_.size() == 1 ? end_body(first) : fail(tokens_[1], "nothing follows `end`");
    if (first == "...") return fail(first, "this listing leaves out rows: `fathom dump --stage file` lists all");
    if (!to_number<double>(first)) return fail(first, "neither a row of numbers nor `end`");
    if (body.read == body.rows || body.slots.empty())
      return fail(first, fmt::format("`each` has {} rows with numbers: `end` is missing here", body.read));
    if (tokens_.size() != body.slots.size())
      return fail(line, fmt::format("a row has {} numbers, not {}", body.slots.size(), tokens_.size()));
    for (std::size_t i = 0; i < tokens_.size() && !error_; ++i) {
      const Body::Slot& slot = body.slots[i];
      body.parts[slot.part].draft.immediates[slot.immediate] = number(tokens_[i]);
    }
    ++body.read;
    if (!error_) append_row();
  }
  void end_body(Token token) {
    const Body& body = *body_;
    // A listing has no lines for rows without numbers.
    for (std::size_t row = 0; body.slots.empty() && row < body.rows; ++row) append_row();
    if (!body.slots.empty() && body.read != body.rows)
      return fail(token, fmt::format("`each` has {} rows, not {}", body.rows, body.read));
    body_.reset();
  }

  // Splits `line` into tokens_, without the listing's columns and the comment. The source location goes to `place`.
  void split(std::string_view line, DebugEntry& place) {
    tokens_.clear();
    int columns = 0;
    for (std::size_t at = 0; !error_;) {
      at = line.find_first_not_of(" \t\r", at);
      if (at == line.npos || line[at] == ';') break;
      if (line[at] == '@') return read_place(line.substr(at), place);
      if (line[at] == '"') {
        at += read_source(line.substr(at));
        continue;
      }
      const std::size_t end = std::min(line.find_first_of(" \t\r;", at), line.size());
      const Token token = line.substr(at, end - at);
      at = end;
      if (!tokens_.empty() || !is_column(token)) {
        tokens_.push_back(token);
      } else if (++columns > kColumns) {
        fail(token, "an instruction begins with its name");
      }
    }
    if (columns > 0 && tokens_.empty()) fail(line, "a line of columns without an instruction");
  }

  // Reads "@6:5 symbol" or "@ symbol"; the symbol extends to the end of the line.
  void read_place(std::string_view text, DebugEntry& place) {
    const std::size_t end = std::min(text.find_first_of(" \r"), text.size());
    const Token where = text.substr(1, end - 1);
    if (!where.empty()) {
      const std::size_t colon = std::min(where.find(':'), where.size());
      const auto line = to_number<std::uint32_t>(where.substr(0, colon));
      const auto column = to_number<std::uint32_t>(where.substr(std::min(colon + 1, where.size())));
      if (!line || !column || *line == 0) return fail(text.substr(0, end), "a place is @line:column, or @ alone");
      place.line = *line;
      place.column = *column;
    }
    placed_ = true;
    Token symbol = text.substr(std::min(end + 1, text.size()));
    if (symbol.ends_with('\r')) symbol.remove_suffix(1);
    if (!unescape(symbol, place.symbol))
      fail(symbol, "a backslash here must be followed by n, r, t, \\, \" or u00XX");
  }

  // Reads the quoted name after `source`. Returns the length of the quoted text in bytes.
  std::size_t read_source(std::string_view line) {
    const bool alone = tokens_.size() == 1 && tokens_[0] == "source" && program_.words.empty();
    const std::size_t length = quoted_length(line);
    if (!alone || named_) {
      fail(line.substr(0, 1), "a text in quotes stands after `source`, once, before the code");
    } else if (length == 0 || !unescape(line.substr(1, length - 2), program_.source_name)) {
      fail(line, "the text in quotes is not whole");
    }
    named_ = true;
    tokens_.clear();
    return length;
  }

  void read_locals() {
    const auto count = tokens_.size() == 2 ? to_number<std::uint32_t>(tokens_[1]) : std::nullopt;
    if (!count || counted_) return fail(tokens_[0], "`locals` stands once, with how many there are");
    program_.locals = *count;
    counted_ = true;
  }

  void read_operands(const OpcodeInfo& row, Draft& draft) {
    std::size_t first = 1, last = tokens_.size();
    if (row.form == Form::Unary || row.form == Form::Binary) first = read_sources(row, draft);
    if (row.form == Form::Shape) last = read_modes(row, draft);
    if (row.has_operand) first = read_count(row, draft);
    if (error_) return;
    const std::size_t own = static_cast<std::size_t>(row.immediates), given = last - first;
    const std::size_t expected = row.form == Form::Outline ? own * draft.operand : own;
    if (given != expected) {
      return fail(tokens_[0],
                  fmt::format("`{}` takes {} number{}{}{}, not {}", row.mnemonic, expected, expected == 1 ? "" : "s",
                              own == 0 ? "" : fmt::format(" ({})", names(row)),
                              row.form == Form::Outline ? " after the first, which says how often" : "", given));
    }
    for (std::size_t i = 0; i < given && !error_; ++i) {
      const Token token = tokens_[first + i];
      const bool integer = is_integer_immediate(row, static_cast<int>(i % own));
      draft.immediates.push_back(integer ? whole(token) : immediate(token, draft));
    }
    if (row.form == Form::Outline) draft.operand = 0;  // append() counts the groups itself
  }

  static std::string names(const OpcodeInfo& row) {
    std::string text;
    for (int i = 0; i < row.immediates; ++i) {
      text += (i == 0 ? "" : " ") + std::string(immediate_name(row, i));
    }
    return row.form == Form::Outline ? text + ", again and again" : text;
  }

  // Reads the number after the mnemonic of tee, load, tag and outlines. Returns the index of the first immediate's
  // token.
  std::size_t read_count(const OpcodeInfo& row, Draft& draft) {
    if (tokens_.size() < 2) {
      fail(tokens_[0], fmt::format("`{}` takes a number", row.mnemonic));
      return 1;
    }
    const double value = whole(tokens_[1]);
    if (!error_ && value > kMaxOperand) fail(tokens_[1], fmt::format("at most {}", kMaxOperand));
    draft.operand = error_ ? 0 : static_cast<std::uint32_t>(value);
    return 2;
  }

  // Reads "at 0 1 0 min" behind a shape's own numbers. Returns the end of the shape's own numbers in tokens_.
  std::size_t read_modes(const OpcodeInfo& row, Draft& draft) {
    std::size_t last = tokens_.size();
    if (last > 1 && tokens_[last - 1] == "min") {
      draft.operand |= kFusedMin;
      --last;
    }
    if (last >= 5 && tokens_[last - 4] == "at") {
      draft.operand |= kFusedTranslate;
      for (std::size_t i = last - 3; i < last && !error_; ++i)
        draft.immediates.push_back(immediate(tokens_[i], draft));
      last -= 4;
    } else {
      for (std::size_t i = 1; i < last; ++i) {
        if (tokens_[i] == "at") fail(tokens_[i], fmt::format("`{}` is moved `at` three numbers", row.mnemonic));
      }
    }
    return last;
  }

  // Reads "_ x" before a function's own numbers. Returns the index of the first of the function's own numbers.
  std::size_t read_sources(const OpcodeInfo& row, Draft& draft) {
    const std::size_t arity = row.form == Form::Binary ? 2 : 1;
    // A function without operands in the text takes all from the stack; any other count is an error found later.
    if (tokens_.size() != 1 + arity + static_cast<std::size_t>(row.immediates)) return 1;
    Sources sources;
    std::optional<std::uint32_t> local;
    for (std::size_t i = 0; i < arity && !error_; ++i) {
      (i == 0 ? sources.a : sources.b) = read_source_of(tokens_[1 + i], local, draft);
    }
    sources.local = local.value_or(0);
    draft.operand = operand_of(sources);
    return 1 + arity;
  }

  Source read_source_of(Token token, std::optional<std::uint32_t>& local, Draft& draft) {
    if (token == "_") return Source::Stack;
    if (token == "x") return Source::X;
    if (token == "y") return Source::Y;
    if (token == "z") return Source::Z;
    if (token[0] != '%') {
      draft.immediates.push_back(immediate(token, draft));
      return Source::Constant;
    }
    const double index = whole(token.substr(1));
    if (!error_ && index > kMaxLocalSource) fail(token, fmt::format("at most %{}", kMaxLocalSource));
    if (error_) return Source::Local;
    if (local && *local != index) fail(token, "both operands can be a local only when it is the same");
    local = static_cast<std::uint32_t>(index);
    return Source::Local;
  }

  // Reads a float immediate. In a body `#` stands for a number of its rows.
  double immediate(Token token, const Draft& draft) {
    if (token != "#") return number(token);
    if (!body_) {
      fail(token, "`#` stands for the numbers of rows, in a body that `each` begins");
      return 0;
    }
    body_->slots.push_back({token.data(), body_->parts.size(), draft.immediates.size()});
    return 0;
  }
  double number(Token token) {
    const auto value = to_number<double>(token);
    if (!value || !std::isfinite(*value)) fail(token, fmt::format("`{}` is not a number that a double holds", token));
    return value.value_or(0);
  }
  double whole(Token token) {
    const auto value = to_number<std::uint32_t>(token);
    if (!value) fail(token, fmt::format("`{}` is not a whole number", token));
    return value.value_or(0);
  }

  void fail(Token at, std::string reason) {
    if (error_) return;
    const auto begin = static_cast<std::size_t>(at.data() - text_.data());
    error_ = AssembleError{begin, begin + at.size(), std::move(reason)};
  }

  std::string_view text_;
  std::vector<std::size_t>* lines_;  // [instruction] where its line begins, or null
  std::size_t most_;                 // instructions
  std::size_t line_ = 0, each_ = 0;  // where the current line begins, and that of `each`
  std::optional<Body> body_;
  Program program_;
  bool placed_ = false, named_ = false, counted_ = false;  // true once a source location, `source`, `locals` was read
  std::vector<Token> tokens_;                              // of the current line
  std::optional<AssembleError> error_;
};

}  // namespace

std::variant<Program, AssembleError> assemble(std::string_view text, std::vector<std::size_t>* lines,
                                              std::size_t most) {
  return Assembler(text, lines, most).run();
}

}  // namespace fathom::vm
