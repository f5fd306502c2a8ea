#include "compiler/frontend/text/print_lines.h"

#include <algorithm>

namespace fathom::compiler::text {
namespace {

constexpr std::size_t kWidestText = 120;  // columns, for lines that can be broken

// Returns the offsets in a statement where a line may begin: before operators outside all brackets. Without such
// operators, before the dots. Without dots either, after the opening bracket and the commas.
std::vector<std::size_t> breaks(std::string_view text) {
  std::vector<std::size_t> operators, dots, commas;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\';
      continue;
    }
    if (c == ')' || c == ']' || c == '}') --depth;
    if (c == '(' || c == '[' || c == '{') ++depth;
    const char next = i + 2 < text.size() ? text[i + 2] : ' ';
    const bool joint =
        c == ' ' && i + 1 < text.size() && std::string_view("+-&").find(text[i + 1]) != std::string_view::npos;
    if (depth == 0 && joint && (next == ' ' || next == '{')) operators.push_back(i + 1);
    const bool calls = c == '.' && i + 1 < text.size() && text[i + 1] >= 'a' && text[i + 1] <= 'z';
    if (depth == 0 && calls) dots.push_back(i);
    if (depth == 1 && c == ',') commas.push_back(i + 2);
    if (depth == 1 && (c == '(' || c == '[')) commas.push_back(i + 1);
  }
  return !operators.empty() ? operators : !dots.empty() ? dots : commas;
}

// Breaks the text into lines of at most kWidestText columns where possible.
std::string in_lines(const std::string& text) {
  if (text.size() <= kWidestText) return text;
  std::string out;
  std::size_t copied = 0;
  for (const std::size_t at : breaks(text)) {
    std::string_view part = std::string_view(text).substr(copied, at - copied);
    if (part.ends_with(' ')) part.remove_suffix(1);
    out += std::string(part) + "\n  ";
    copied = at;
  }
  return out + text.substr(copied);
}

bool is_json(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && std::string_view("{/\xEF").find(text[first]) != std::string_view::npos;
}

struct SourceComment {
  Span span;
  bool is_first;  // on its line
};

std::vector<SourceComment> comments_of_json(std::string_view text) {
  std::vector<SourceComment> comments;
  bool first = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\';
    } else if (text.substr(i, 2) == "//" || text.substr(i, 2) == "/*") {
      const bool block = text[i + 1] == '*';
      std::size_t end = block ? text.find("*/", i + 2) + 2 : std::min(text.find('\n', i), text.size());
      const std::size_t last = end - 1;
      while (!block && (text[end - 1] == ' ' || text[end - 1] == '\r')) --end;
      comments.push_back({{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end)}, first});
      i = last;
      continue;
    }
    first = text[i] == '\n' || (first && (text[i] == ' ' || text[i] == '\t' || text[i] == '\r' || text[i] == '{'));
  }
  return comments;
}

// Assigns each comment to the statement that it precedes or follows on the same line in the source. Returns the
// comments after the last statement.
std::vector<std::string> share_out(const Source& source, std::vector<PrintedStatement>& statements) {
  std::vector<PrintedStatement*> in_source;
  for (PrintedStatement& statement : statements) in_source.push_back(&statement);
  const auto begin_of = [](const PrintedStatement* statement) { return statement->span.begin; };
  std::ranges::stable_sort(in_source, {}, begin_of);
  std::vector<std::string> rest;
  for (const SourceComment& comment : comments_of_json(source.text())) {
    const std::string text = source.text().substr(comment.span.begin, comment.span.end - comment.span.begin);
    const auto after = std::ranges::lower_bound(in_source, comment.span.begin, {}, begin_of);
    PrintedStatement* last = after == in_source.begin() ? nullptr : after[-1];
    const auto next = std::ranges::lower_bound(in_source, comment.span.end, {}, begin_of);
    const bool beside = last != nullptr && !comment.is_first && text.starts_with("//");
    if (beside && last->aside.empty()) {
      last->aside = text;
    } else if (beside) {
      last->comments.push_back(text);
    } else if (next != in_source.end()) {
      (*next)->comments.push_back(text);
    } else {
      rest.push_back(text);
    }
  }
  return rest;
}

}  // namespace

std::string print_lines(std::vector<PrintedStatement> statements, const Source& source) {
  const std::vector<std::string> rest =
      is_json(source.text()) ? share_out(source, statements) : std::vector<std::string>{};
  std::string out = "fathom 1\n";
  std::string_view group;
  for (const PrintedStatement& statement : statements) {
    if (statement.group != group || !statement.comments.empty()) out += '\n';
    group = statement.group;
    for (const std::string& comment : statement.comments) out += comment + "\n";
    out += in_lines(statement.text) + (statement.aside.empty() ? "" : "  " + statement.aside) + "\n";
  }
  for (const std::string& comment : rest) out += "\n" + comment + "\n";
  return out;
}

}  // namespace fathom::compiler::text
