#include "compiler/frontend/formats/expression_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <deque>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/formula/formula_functions.h"
#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/frontend/formula/formula_parser.h"
#include "compiler/frontend/syntax/json_error.h"
#include "compiler/frontend/syntax/make_syntax.h"
#include "compiler/geometry/fits_float.h"

namespace fathom::compiler {
namespace {

struct Operation {
  std::string_view name;
  std::size_t operands;
  std::string_view formula;  // {0} and {1} are the operands
};

// Fidget defines the meaning of the operations: round takes halves away from zero, mod is Euclidean, compare returns
// -1, 0 or 1, and `and` and `or` return one of their operands.
constexpr Operation kOperations[] = {
    {"var-x", 0, "x"},
    {"var-y", 0, "y"},
    {"var-z", 0, "z"},
    {"neg", 1, "-{0}"},
    {"abs", 1, "abs({0})"},
    {"sqrt", 1, "sqrt({0})"},
    {"square", 1, "square({0})"},
    {"floor", 1, "floor({0})"},
    {"ceil", 1, "ceil({0})"},
    {"round", 1, "sign({0})*floor(abs({0}) + 0.5)"},
    {"sin", 1, "sin({0})"},
    {"cos", 1, "cos({0})"},
    {"tan", 1, "tan({0})"},
    {"asin", 1, "asin({0})"},
    {"acos", 1, "acos({0})"},
    {"atan", 1, "atan({0})"},
    {"ln", 1, "log({0})"},
    {"exp", 1, "exp({0})"},
    {"not", 1, "not({0})"},
    {"add", 2, "{0} + {1}"},
    {"sub", 2, "{0} - {1}"},
    {"mul", 2, "{0}*{1}"},
    {"div", 2, "{0}/{1}"},
    {"min", 2, "min({0}, {1})"},
    {"max", 2, "max({0}, {1})"},
    {"atan2", 2, "atan2({0}, {1})"},
    {"compare", 2, "compare({0}, {1})"},
    {"mod", 2, "modulo_euclid({0}, {1})"},
    {"and", 2, "and({0}, {1})"},
    {"or", 2, "or({0}, {1})"},
};
constexpr std::string_view kConst = "const";

const Operation* find_operation(std::string_view name) {
  const auto found = std::find_if(std::begin(kOperations), std::end(kOperations),
                                  [&](const Operation& row) { return row.name == name; });
  return found == std::end(kOperations) ? nullptr : found;
}

std::vector<std::string_view> operation_names() {
  std::vector<std::string_view> names = {kConst};
  for (const Operation& row : kOperations) names.push_back(row.name);
  return names;
}

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n'); }

// Appends the first `most` words of a line.
void split_words(std::string_view line, std::size_t most, std::vector<std::string_view>& words) {
  for (std::size_t at = 0; at < line.size() && most > 0;) {
    if (is_space(line[at])) {
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    while (end < line.size() && !is_space(line[end])) ++end;
    words.push_back(line.substr(at, end - at));
    --most;
    at = end;
  }
}

// Removes the first line from `rest` and returns it.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

// Removes a byte order mark, which has no meaning in UTF-8.
std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

using Words = std::span<const std::string_view>;

bool is_comment(Words words) { return words.empty() || words[0].starts_with('#'); }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool in_name(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '$'; }

std::string filled_in(std::string_view formula, const std::array<std::string_view, 2>& operands) {
  std::string out;
  out.reserve(2 * formula.size() + 2 * (operands[0].size() + operands[1].size()));
  for (std::size_t at = 0; at < formula.size(); ++at) {
    if (formula[at] == '{') {
      out += operands[formula[at + 1] == '1'];
      at += 2;
    } else {
      out += formula[at];
    }
  }
  return out;
}

class ListReader {
 public:
  ListReader(const Source& source, Diagnostics& diagnostics, const Limits& limits)
      : text_(source.text()), diagnostics_(diagnostics), limits_(limits) {}

  std::optional<syntax::File> read() {
    if (!check_words()) return std::nullopt;
    std::string_view rest = without_mark(text_);
    while (!rest.empty()) {
      const std::size_t first = words_.size();
      split_words(take_line(rest), text_.size(), words_);
      if (is_comment(Words(words_).subspan(first))) {
        words_.resize(first);
        continue;
      }
      taken_.insert(words_[first]);
      ends_.push_back(words_.size());
    }
    if (ends_.empty()) {
      diagnostics_.error("E0606", {}, "the list has no operation in it", "",
                         {"the smallest list that means something is `_0 var-x`"});
    }
    names_.reserve(ends_.size()), formula_.reserve(ends_.size());
    std::size_t first = 0;
    for (const std::size_t end : ends_) {
      if (diagnostics_.full()) break;
      read_line(Words(words_).subspan(first, end - first), end == words_.size());
      first = end;
    }
    if (diagnostics_.has_errors()) return std::nullopt;
    return syntax::File{scene()};
  }

 private:
  Span span(std::string_view part) const {
    const auto begin = static_cast<std::uint32_t>(part.data() - text_.data());
    return {begin, begin + static_cast<std::uint32_t>(part.size())};
  }
  static Span join(Span from, Span to) { return {from.begin, to.end}; }

  // Checks the number of words, including words in comments, before storing any word.
  bool check_words() {
    double words = 0;
    for (std::size_t at = 0; at < text_.size(); ++at) {
      const bool begins = at == 0 || is_space(text_[at - 1]) || text_[at - 1] == '\n';
      if (!begins || is_space(text_[at]) || text_[at] == '\n' || ++words <= limits_.tokens) continue;
      diagnostics_.error("E0008", span(std::string_view(text_).substr(at, 1)),
                         fmt::format("the list has more than {} words", limits_.tokens), "one too many",
                         {raise(&Limits::tokens, 2 * limits_.tokens)});
      return false;
    }
    return true;
  }

  void read_line(Words words, bool last) {
    const Span place = join(span(words.front()), span(words.back()));
    std::string formula = words.size() < 2 ? no_operation(words[0]) : formula_of(words, place);
    const auto [entry, fresh] = names_.emplace(words[0], formula_name(words[0]));
    if (!fresh) {
      diagnostics_.error("E0604", span(words[0]), fmt::format("`{}` is given twice", words[0]), "",
                         {"every line needs a name of its own"});
    }
    if (!last) formula.insert(0, " = ").insert(0, entry->second);
    formula_.push_back({place, std::move(formula)});
  }

  std::string formula_of(Words words, Span place) {
    const std::string_view name = words[1];
    const Operation* operation = find_operation(name);
    if (operation == nullptr && name != kConst) return unknown_operation(name);
    const std::size_t wanted = operation ? operation->operands : 1, given = words.size() - 2;
    if (given != wanted) {
      diagnostics_.error("E0602", place,
                         fmt::format("`{}` takes {} operand{}, not {}", name, wanted, wanted == 1 ? "" : "s", given));
      return "0";
    }
    if (operation == nullptr) return constant(words[2]);
    std::array<std::string_view, 2> operands;
    for (std::size_t i = 0; i < wanted; ++i) operands[i] = resolve(words[i + 2]);
    has_z_ = has_z_ || name == "var-z";
    return filled_in(operation->formula, operands);
  }

  std::string no_operation(std::string_view name) {
    diagnostics_.error("E0601", span(name), "a line without an operation", "",
                       {"a line is: name operation operands"});
    return "0";
  }

  std::string unknown_operation(std::string_view name) {
    const std::string_view near = nearest(name, operation_names());
    std::vector<std::string> help;
    if (!near.empty()) help.push_back(fmt::format("did you mean `{}`?", near));
    if (near.empty()) help.push_back(fmt::format("known: {}", fmt::join(operation_names(), ", ")));
    diagnostics_.error("E0601", span(name), fmt::format("unknown operation `{}`", name), "", std::move(help));
    return "0";
  }

  std::string constant(std::string_view word) {
    double value = 0;
    auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range && word.find("e-") != word.npos) error = {};  // underflow: reads as 0
    if (error == std::errc() && end == word.data() + word.size() && fits_float(value)) {
      return fmt::format("{}", value);
    }
    diagnostics_.error("E0605", span(word), fmt::format("`{}` is not a number that a float can be", word), "",
                       {"a constant is written as 0.5, -3 or 1e-3"});
    return "0";
  }

  std::string_view resolve(std::string_view word) {
    const auto found = names_.find(word);
    if (found != names_.end()) return found->second;
    const bool later = taken_.contains(word);
    diagnostics_.error("E0603", span(word), fmt::format("`{}` has no value {}", word, later ? "yet" : "here"), "",
                       {later ? "an operand must be the name of a line above" : "no line has this name"});
    return "0";
  }

  // Returns the line's own name if formulas can use it, otherwise a generated name.
  std::string formula_name(std::string_view name) {
    if (misfit_name(name, functions_).empty()) return std::string(name);
    std::string& made = made_.emplace_back(fmt::format("line{}", names_.size() + 1));
    while (taken_.contains(made)) made += '_';
    taken_.insert(made);
    return made;
  }

  syntax::Value scene() {
    const Span whole = {0, static_cast<std::uint32_t>(text_.size())};
    syntax::List lines;
    for (auto& [place, formula] : formula_) lines.push_back({place, std::move(formula)});
    RecordMaker object(whole), camera(whole), film(whole), material(whole), materials(whole), background(whole);
    object.add("type", "expression")
        .add("half_size", glm::dvec3(1))
        .add("formula", syntax::Value{whole, std::move(lines)})
        .add("material", "model");
    // View a planar drawing without perspective, which would show its sides.
    if (!has_z_) camera.add("type", "orthographic").add("width", 2.1);
    camera.add("position", glm::dvec3(0, 0, 5)).add("target", glm::dvec3(0));
    if (has_z_) camera.add("fov_y", 32.0);
    film.add("width", 512.0).add("height", 512.0);
    material.add("type", "diffuse").add("color", glm::dvec3(0.05, 0.12, 0.35));
    materials.add("model", material.take());
    background.add("bottom", glm::dvec3(0.6)).add("top", glm::dvec3(1));
    syntax::List objects;
    objects.push_back(object.take());
    return RecordMaker(whole)
        .add("version", 1.0)
        .add("camera", camera.take())
        .add("film", film.take())
        .add("background", background.take())
        .add("materials", materials.take())
        .add("objects", syntax::Value{whole, std::move(objects)})
        .take();
  }

  struct Line {
    Span place;
    std::string formula;
  };

  const std::string& text_;
  Diagnostics& diagnostics_;
  const Limits& limits_;
  std::vector<std::string_view> words_;                      // of all lines
  std::vector<std::size_t> ends_;                            // [line] end of its words in words_
  std::unordered_map<std::string_view, std::string> names_;  // of the lines so far, to their names in the formula
  std::unordered_set<std::string_view> taken_;               // names of lines, and generated names
  std::deque<std::string> made_;                             // generated names
  std::vector<Line> formula_;
  const std::vector<FormulaFunction> functions_ = formula_functions(machine_functions());
  bool has_z_ = false;
};

}  // namespace

bool is_expression_list(std::string_view text) {
  bool comment = false;
  text = without_mark(text);
  while (!text.empty()) {
    std::vector<std::string_view> words;
    split_words(take_line(text), 2, words);
    if (is_comment(words)) {
      comment = comment || !words.empty();
      continue;
    }
    return words.size() > 1 && std::all_of(words[0].begin(), words[0].end(), in_name) && is_letter(words[1][0]) &&
           std::all_of(words[1].begin(), words[1].end(), [](char c) { return in_name(c) || c == '-'; });
  }
  return comment;
}

std::optional<syntax::File> read_expression_list(const Source& source, Diagnostics& diagnostics,
                                                 const Limits& limits) {
  if (!check_text(source, diagnostics)) return std::nullopt;
  return ListReader(source, diagnostics, limits).read();
}

}  // namespace fathom::compiler
