#include "compiler/frontend/syntax/json_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace fathom::compiler {
namespace {

Span span(std::size_t begin, std::size_t end) {
  return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$'; }

// Returns the end of the comment that begins at `at`, `at` itself if no comment begins there, or nullopt if the
// comment is not closed.
std::optional<std::size_t> comment_end(std::string_view text, std::size_t at) {
  if (text.substr(at, 2) == "//") return std::min(text.size(), text.find_first_of("\r\n", at));
  if (text.substr(at, 2) != "/*") return at;
  const std::size_t close = text.find("*/", at + 2);
  if (close == text.npos) return std::nullopt;
  return close + 2;
}

// Returns the whole UTF-8 sequence at `at`.
std::string_view character(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return text.substr(at, end - at);
}

std::string position(const Source& source, std::size_t at) {
  const Position p = source.locate(static_cast<std::uint32_t>(at));
  return fmt::format("line {}, column {}", p.line, p.column);
}

// Describes what the grammar allows at the offending token.
std::string wanted(const JsonPlace& place) {
  switch (place.inside) {
    case JsonPlace::Inside::Nothing:
      return "`{`";
    case JsonPlace::Inside::AfterRoot:
      return "the end of the file";
    case JsonPlace::Inside::List:
      if (place.empty) return "a value or `]`";
      return place.skipped.comma ? "a value" : "`,` or `]`";
    case JsonPlace::Inside::Record:
      break;
  }
  if (place.has_key) return place.skipped.colon ? fmt::format("the value of `{}`", place.key) : "`:`";
  if (place.empty) return "a property's name in double quotes or `}`";
  return place.skipped.comma ? "a property's name in double quotes" : "`,` or `}`";
}

void report_end(const Source& source, const JsonPlace& place, Diagnostics& diagnostics) {
  const std::string& text = source.text();
  if (place.inside == JsonPlace::Inside::Nothing) {
    diagnostics.error(
        "E0002", {}, "the file is empty", "",
        {"the smallest scene is {\"version\": 1, \"objects\": [{\"type\": \"sphere\", \"radius\": 1}]}"});
    return;
  }
  const bool record = place.inside == JsonPlace::Inside::Record;
  // Point after the last token, not at the empty line after it.
  std::size_t end = text.size();
  while (end > 0 && is_blank(text[end - 1])) --end;
  diagnostics.error(
      "E0002", span(end, end), "the file ends too early", fmt::format("expected {}", wanted(place)),
      {fmt::format("the `{}` at {} is never closed", record ? '{' : '[', position(source, place.opened_at))});
}

// Returns the UTF-16 code unit of the escape \uXXXX at `at`, or nullopt if there is no such escape.
std::optional<unsigned> code_unit(std::string_view text, std::size_t at) {
  if (at + 6 > text.size() || text.substr(at, 2) != "\\u") return std::nullopt;
  unsigned unit = 0;
  const auto [end, error] = std::from_chars(text.data() + at + 2, text.data() + at + 6, unit, 16);
  return error == std::errc() && end == text.data() + at + 6 ? std::optional(unit) : std::nullopt;
}

// Returns the length of the escape at `at`, counting both halves of a surrogate pair, or 0 if the escape is
// malformed.
std::size_t escape_length(std::string_view text, std::size_t at) {
  if (at + 1 < text.size() && std::string_view("\"\\/bfnrt").find(text[at + 1]) != std::string_view::npos) return 2;
  const std::optional<unsigned> unit = code_unit(text, at);
  if (!unit) return 0;
  if (*unit < 0xD800 || *unit > 0xDFFF) return 6;
  const std::optional<unsigned> second = code_unit(text, at + 6);
  return *unit < 0xDC00 && second && *second >= 0xDC00 && *second <= 0xDFFF ? 12 : 0;
}

void report_escape(std::string_view text, std::size_t at, Diagnostics& diagnostics) {
  if (text.substr(at, 2) == "\\u") {
    const bool half = code_unit(text, at).has_value();
    diagnostics.error("E0003", span(at, at + (half ? 6 : 2)),
                      half ? "half of a surrogate pair in a string" : "\\u needs four hexadecimal digits",
                      "not a character", {"write the character itself: scene files are UTF-8"});
  } else {
    diagnostics.error("E0003", span(at, at + 1 + character(text, at + 1).size()), "unknown escape in a string",
                      "not an escape",
                      {"known: \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\uXXXX; a backslash is written \\\\"});
  }
}

// Reports the first invalid byte of the string that begins at `begin`. Returns false if the string is valid.
bool report_string(std::string_view text, std::size_t begin, Diagnostics& diagnostics) {
  std::size_t at = begin + 1;
  while (at < text.size() && text[at] != '"') {
    const unsigned char c = static_cast<unsigned char>(text[at]);
    if (c == '\n' || c == '\r') break;
    if (c < 0x20) {
      diagnostics.error("E0003", span(at, at + 1), "a control character in a string", "",
                        {c == '\t' ? "write a tab as \\t" : fmt::format("write it as \\u{:04x}", c)});
      return true;
    }
    const std::size_t length = c == '\\' ? escape_length(text, at) : 1;
    if (length == 0) {
      report_escape(text, at, diagnostics);
      return true;
    }
    at += length;
  }
  if (at < text.size() && text[at] == '"') return false;
  diagnostics.error("E0003", span(begin, at), "the string does not end on its line", "no closing `\"`",
                    {"a line break inside a string is written \\n"});
  return true;
}

void report_number(std::string_view text, std::size_t begin, Diagnostics& diagnostics) {
  std::size_t end = begin;
  while (end < text.size() && (is_word(text[end]) || text[end] == '.' || text[end] == '+' || text[end] == '-')) ++end;
  const std::string_view number = text.substr(begin, end - begin);
  std::string help = "numbers look like 1, -0.5 or 2.5e-3";
  if (number.size() > 1 && number[0] == '0' && is_word(number[1])) help = "no zero stands before other digits";
  if (number[0] == '.') help = fmt::format("write 0{}: a digit stands before the point", number);
  if (number[0] == '+') help = "leave the plus sign out";
  if (number.ends_with('.')) help = fmt::format("write {}0: a digit stands after the point", number);
  if (number.find("nf") != number.npos || number.find("NF") != number.npos) help = "every number must be finite";
  diagnostics.error("E0004", span(begin, end), fmt::format("malformed number `{}`", number), "", {help});
}

void report_word(std::string_view text, const JsonPlace& place, Diagnostics& diagnostics) {
  const std::size_t begin = place.skipped.begin;
  std::size_t end = begin;
  while (end < text.size() && is_word(text[end])) ++end;
  if (end == begin) end += character(text, begin).size();
  const std::string word(text.substr(begin, end - begin));
  std::string lowered = word;
  for (char& c : lowered) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));

  const bool name_wanted = place.inside == JsonPlace::Inside::Record && !place.has_key;
  std::string message = fmt::format("unexpected `{}`", word), help = fmt::format("expected {}", wanted(place));
  if (word == "'") {
    help = "strings and names stand in double quotes";
  } else if (is_word(word[0]) && begin > 0 && text[begin - 1] == '"') {
    help = fmt::format("the string before it ends right here: is a `\"` missing, or one too many?");
  } else if (name_wanted && is_word(word[0]) && (place.empty || place.skipped.comma)) {
    message = fmt::format("the name `{}` is not in quotes", word);
    help = fmt::format("write \"{}\"", word);
  } else if (lowered == "true" || lowered == "false") {
    help = fmt::format("write {} in small letters", lowered);
  } else if (lowered == "nan" || lowered == "inf" || lowered == "infinity") {
    help = "every number must be finite";
  } else if (is_word(word[0]) && !name_wanted) {
    help = fmt::format("expected {}; text stands in double quotes: \"{}\"", wanted(place), word);
  }
  diagnostics.error("E0005", span(begin, end), message, "not JSON", {help});
}

// Reports a valid token in the wrong place.
void report_token(const Source& source, const JsonPlace& place, Diagnostics& diagnostics) {
  const std::string_view text = source.text();
  const std::size_t begin = place.skipped.begin;
  const char c = text[begin];
  if ((c == '}' || c == ']') && place.skipped.comma) {
    diagnostics.error("E0001", span(*place.skipped.comma, *place.skipped.comma + 1),
                      fmt::format("a comma before `{}`", c), "nothing follows this comma", {"remove it"});
    return;
  }
  std::size_t end = begin + 1;
  std::string found = fmt::format("`{}`", c);
  if (c == '"') {
    end = std::max(end, std::min(place.token_end, text.size()));
    found = "a string";
  } else if (is_word(c) || c == '-') {
    while (end < text.size() && (is_word(text[end]) || text[end] == '.')) ++end;
    found = fmt::format("`{}`", text.substr(begin, end - begin));
  }
  std::vector<std::string> help;
  const bool starts_value = c == '"' || c == '{' || c == '[' || is_word(c) || c == '-';
  const bool in_list = place.inside == JsonPlace::Inside::List, in_record = place.inside == JsonPlace::Inside::Record;
  if (starts_value && !place.empty && !place.skipped.comma && !place.has_key && (in_list || in_record)) {
    help.push_back("a comma is missing before it");
  } else if (place.inside == JsonPlace::Inside::AfterRoot) {
    help.push_back("a file holds one scene: {...}");
  } else if ((c == '}' && in_list) || (c == ']' && in_record)) {
    help.push_back(
        fmt::format("the `{}` at {} is still open", in_list ? '[' : '{', position(source, place.opened_at)));
  }
  diagnostics.error("E0001", span(begin, end), fmt::format("expected {}, found {}", wanted(place), found),
                    place.inside == JsonPlace::Inside::AfterRoot ? "after the end of the scene" : "",
                    std::move(help));
}

bool good_number(std::string_view text, std::size_t begin, std::size_t end) {
  return end > begin && std::isdigit(static_cast<unsigned char>(text[end - 1])) && text[begin] != '.' &&
         text[begin] != '+';
}

}  // namespace

SkippedText skip_to_token(std::string_view text, std::size_t from, std::size_t token_end) {
  SkippedText skipped;
  std::size_t at = from;
  while (at < text.size()) {
    const char c = text[at];
    if (is_blank(c)) {
      ++at;
    } else if ((c == ',' || c == ':') && at + 1 < token_end) {
      if (c == ',') skipped.comma = at;
      if (c == ':') skipped.colon = true;
      ++at;
    } else if (c == '/') {
      const std::optional<std::size_t> end = comment_end(text, at);
      if (!end || *end == at) break;
      at = *end;
    } else {
      break;
    }
  }
  skipped.begin = at;
  return skipped;
}

void report_json_error(const Source& source, const JsonPlace& place, Diagnostics& diagnostics) {
  const std::string_view text = source.text();
  const std::size_t begin = place.skipped.begin;
  if (begin >= text.size()) return report_end(source, place, diagnostics);
  const char c = text[begin];
  // `01`, `1.2.3` and `0x1F` are a number followed by another token to the lexer, but one word to the writer.
  std::size_t word = begin;
  while (word > 0 && (is_word(c) || c == '.') && (is_word(text[word - 1]) || text[word - 1] == '.')) --word;
  if (place.overflow) {
    const std::size_t end = std::min(place.token_end, text.size());
    diagnostics.error("E0009", span(begin, end),
                      fmt::format("the number {} is too large", text.substr(begin, end - begin)), "",
                      {"the largest number is about 1.8e308"});
  } else if (word < begin && std::isdigit(static_cast<unsigned char>(text[word]))) {
    report_number(text, word, diagnostics);
  } else if (c == '/') {
    const bool open = text.substr(begin, 2) == "/*";
    diagnostics.error("E0006", span(begin, begin + (open ? 2 : 1)),
                      open ? "the comment is never closed" : "a comment begins with `//` or `/*`",
                      open ? "begins here" : "", {open ? "close it with `*/`" : "write `// ...` or `/* ... */`"});
  } else if (c == '"') {
    if (!report_string(text, begin, diagnostics)) report_token(source, place, diagnostics);
  } else if (std::string_view("{}[],:").find(c) != std::string_view::npos) {
    report_token(source, place, diagnostics);
  } else if (std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.') {
    good_number(text, begin, std::min(place.token_end, text.size())) ? report_token(source, place, diagnostics)
                                                                     : report_number(text, begin, diagnostics);
  } else {
    const std::string_view token = text.substr(begin, place.token_end - begin);
    const bool literal = token == "true" || token == "false" || token == "null";
    literal ? report_token(source, place, diagnostics) : report_word(text, place, diagnostics);
  }
}

bool check_text(const Source& source, Diagnostics& diagnostics) {
  const std::string_view text = source.text();
  const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u; };
  for (std::size_t at = 0; at < text.size();) {
    const unsigned first = byte(at);
    // Table 3-7 of the Unicode standard gives the length and the range of the second byte. Later bytes are 80..BF.
    const std::size_t length = first - 1 < 0x7F ? 1
                               : first < 0xC2   ? 0
                               : first < 0xE0   ? 2
                               : first < 0xF0   ? 3
                               : first < 0xF5   ? 4
                                                : 0;
    const unsigned least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    const unsigned most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    bool good = length > 0 && (length == 1 || (byte(at + 1) >= least && byte(at + 1) <= most));
    for (std::size_t i = 2; good && i < length; ++i) good = (byte(at + i) & 0xC0) == 0x80;
    if (!good) {
      diagnostics.error("E0007", span(at, at + 1), fmt::format("byte 0x{:02X} is not UTF-8 text", first), "",
                        {"scene files are JSON in UTF-8; is this another kind of file?"});
      return false;
    }
    at += length;
  }
  return true;
}

}  // namespace fathom::compiler
