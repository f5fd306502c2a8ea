#include "compiler/frontend/text/parse/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>

namespace fathom::compiler::text {
namespace {

struct ForeignText {
  std::string_view text, help;
};

constexpr std::string_view kProduct = "for a product write a*b";

// Marks of other languages, with help on what to write instead.
constexpr ForeignText kForeignTexts[] = {
    {";", "a statement ends where the next one begins"},
    {"|", "a union is written a + b; `or` of conditions is ||"},
    {"%", "for a remainder write mod(a, b)"},
    {"?", "for a choice write if condition then a else b"},
    {"'", "texts are written in double quotes"},
    {"#", "a comment begins with //; a colour is a text: \"#c04020\""},
    {"@", ""},
    {"$", ""},
    {"\\", ""},
    {"\u00D7", kProduct},
    {"\u00B7", kProduct},
    {"\u00F7", "for a quotient write a/b"},
    {"\u2212", "for minus write -"},
    {"\u2013", "for minus write -"},
    {"\u00B2", "for a square write a^2"},
    {"\u00B3", "for a cube write a^3"},
    {"\u03C0", "write pi"},
    {"\u00B0", "angles of a scene are in degrees: write 45; sin, cos and tan take radians: 45*pi/180"},
};

// Longer marks come before their prefixes.
constexpr std::string_view kMarks[] = {"...", "..", "==", "!=", "<=", ">=", "&&", "||", "+", "-", "*", "/", "^", "(",
                                       ")",   "[",  "]",  "{",  "}",  ",",  ".",  "=",  "<", ">", "&", "!", ":"};

bool is_figure(char c) { return c >= '0' && c <= '9'; }
bool starts_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

class TextLexer {
 public:
  TextLexer(const Source& source, Diagnostics& diagnostics)
      : text_(source.text()), base_(source.base()), diagnostics_(diagnostics) {}

  Tokens run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = line_start_ = 3;
    while (skip_blanks()) read();
    push(Token::Kind::End, 0);
    return std::move(out_);
  }

  // Returns the span of the first token above the limit, or nullopt if there is none.
  std::optional<Span> find_excess(double most) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    for (double count = 0; skip_blanks(); ++count) {
      out_ = {};
      read();
      if (count >= most && !out_.tokens.empty()) return out_.tokens.back().span;
    }
    return std::nullopt;
  }

 private:
  std::string_view rest() const { return text_.substr(at_); }

  // Skips to the next token and stores the comments on the way. Returns false at the end.
  bool skip_blanks() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n') {
        ++at_, line_start_ = at_, is_first_ = true;
      } else if (c == ' ' || c == '\t' || c == '\r') {
        ++at_;
      } else if (rest().starts_with("//")) {
        comment(std::min(text_.find('\n', at_), text_.size()));
      } else if (rest().starts_with("/*")) {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) {
          diagnostics_.error("E0006", {place(at_), place(at_ + 2)}, "the comment is never closed", "",
                             {"close it with */"});
        }
        comment(end == std::string_view::npos ? text_.size() : end + 2);
      } else {
        return true;
      }
    }
    return false;
  }

  void comment(std::size_t end) {
    std::size_t last = end;
    while (last > at_ && (text_[last - 1] == '\r' || text_[last - 1] == ' ' || text_[last - 1] == '\t')) --last;
    out_.comments.push_back({{place(at_), place(last)}, out_.tokens.size(), is_first_});
    const std::size_t line = text_.substr(at_, end - at_).rfind('\n');
    if (line != std::string_view::npos) line_start_ = at_ + line + 1, is_first_ = true;
    at_ = end;
  }

  void read() {
    const char c = text_[at_];
    if (starts_name(c)) {
      std::size_t end = at_ + 1;
      while (end < text_.size() && (starts_name(text_[end]) || is_figure(text_[end]))) ++end;
      push(Token::Kind::Name, end - at_);
    } else if (is_figure(c) || (c == '.' && at_ + 1 < text_.size() && is_figure(text_[at_ + 1]))) {
      number();
    } else if (c == '"') {
      quoted();
    } else {
      mark();
    }
  }

  // Reads a number. "1..5" is the number 1 and the mark "..".
  void number() {
    std::size_t end = at_;
    while (end < text_.size() && (is_figure(text_[end]) || text_[end] == '.') && !text_.substr(end).starts_with("..")) ++end;
    const bool range = text_.substr(end).starts_with("..");
    const char* begin = text_.data() + at_;
    double value = 0;
    const auto [last, error] = std::from_chars(begin, text_.data() + (range ? end : text_.size()), value);
    const std::string digits(begin, last);
    // The number is out of the range of double. strtod says which way, by returning infinity or zero.
    if (error == std::errc::result_out_of_range) value = std::strtod(digits.c_str(), nullptr);
    push(Token::Kind::Number, digits.size());
    out_.tokens.back().value = value;
  }

  void quoted() {
    std::size_t end = at_ + 1;
    while (end < text_.size() && text_[end] != '"' && text_[end] != '\n') end += text_[end] == '\\' ? 2 : 1;
    if (end >= text_.size() || text_[end] == '\n') {
      const std::size_t last = std::min(end, text_.size());
      diagnostics_.error("E0003", {place(at_), place(last)}, "the text is never closed", "",
                         {"close it with \" on the same line"});
      push(Token::Kind::Text, last - at_);
      return;
    }
    push(Token::Kind::Text, end + 1 - at_);
  }

  void mark() {
    for (const std::string_view mark : kMarks) {
      if (rest().starts_with(mark)) return push(Token::Kind::Mark, mark.size());
    }
    std::size_t length = 1;  // one character: in UTF-8, a byte and its continuation bytes
    while (at_ + length < text_.size() && (static_cast<unsigned char>(text_[at_ + length]) & 0xC0) == 0x80) ++length;
    std::vector<std::string> help;
    for (const ForeignText& foreign : kForeignTexts) {
      if (rest().starts_with(foreign.text) && !foreign.help.empty()) help = {std::string(foreign.help)};
    }
    diagnostics_.error("E0005", {place(at_), place(at_ + length)},
                       fmt::format("scenes have no `{}`", text_.substr(at_, length)), "", std::move(help));
    at_ += length;
  }

  void push(Token::Kind kind, std::size_t length) {
    out_.tokens.push_back({kind,
                           is_first_,
                           static_cast<std::uint32_t>(at_ - line_start_),
                           {place(at_), place(at_ + length)},
                           text_.substr(at_, length)});
    at_ += length;
    is_first_ = false;
  }

  std::uint32_t place(std::size_t at) const { return base_ + static_cast<std::uint32_t>(at); }

  std::string_view text_;
  std::uint32_t base_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0, line_start_ = 0;
  bool is_first_ = true;
  Tokens out_;
};

void append_utf8(unsigned code, std::string& out) {
  const auto put = [&](unsigned byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) return put(0xC0 | code >> 6), put(0x80 | (code & 0x3F));
  if (code >= 0x10000) {
    put(0xF0 | code >> 18), put(0x80 | (code >> 12 & 0x3F));
  } else {
    put(0xE0 | code >> 12);
  }
  put(0x80 | (code >> 6 & 0x3F)), put(0x80 | (code & 0x3F));
}

// Returns the value of four hexadecimal digits.
std::optional<unsigned> hex(std::string_view digits) {
  unsigned code = 0;
  if (digits.size() < 4) return std::nullopt;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + 4, code, 16);
  return end == digits.data() + 4 && error == std::errc() ? std::optional(code) : std::nullopt;
}

// Returns the character of an escape \uXXXX, which is a pair of escapes for a character beyond the first 65,536.
// Removes the characters it reads from `rest`.
std::optional<unsigned> escaped_character(std::string_view& rest) {
  const auto high = hex(rest);
  if (!high) return std::nullopt;
  rest.remove_prefix(4);
  if (*high < 0xD800 || *high > 0xDFFF) return high;
  if (*high > 0xDBFF || !rest.starts_with("\\u")) return std::nullopt;
  const auto low = hex(rest.substr(2));
  if (!low || *low < 0xDC00 || *low > 0xDFFF) return std::nullopt;
  rest.remove_prefix(6);
  return 0x10000 + ((*high - 0xD800) << 10 | (*low - 0xDC00));
}

}  // namespace

Tokens read_tokens(const Source& source, Diagnostics& diagnostics) { return TextLexer(source, diagnostics).run(); }

bool check_tokens(const Source& source, const Limits& limits, Diagnostics& diagnostics) {
  // A text has fewer tokens than bytes.
  if (static_cast<double>(source.text().size()) <= limits.tokens) return true;
  Diagnostics ignored;
  const std::optional<Span> excess = TextLexer(source, ignored).find_excess(limits.tokens);
  if (!excess) return true;
  diagnostics.error(
      "E0008", *excess, fmt::format("the text has more than {} values, names and marks", limits.tokens),
      "one too many",
      {"what repeats itself is a list: [for i in 0..10: ...]", raise(&Limits::tokens, 2 * limits.tokens)});
  return false;
}

std::string_view first_word(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty()) {
    std::size_t skip = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    if (skip == 0 && text.starts_with("//")) skip = std::min(text.find('\n'), text.size());
    if (skip == 0 && text.starts_with("/*")) skip = std::min(text.find("*/", 2), text.size() - 2) + 2;
    if (skip == 0) break;
    text.remove_prefix(skip);
  }
  std::size_t end = 0;
  while (end < text.size() && (starts_name(text[end]) || (end > 0 && is_figure(text[end])))) ++end;
  return text.substr(0, end);
}

std::string unquoted(const Token& token, Diagnostics& diagnostics) {
  std::string_view rest = token.text.substr(1);
  if (rest.ends_with('"')) rest.remove_suffix(1);
  std::string out;
  bool good = true;
  while (!rest.empty()) {
    const char c = rest[0];
    rest.remove_prefix(1);
    if (c != '\\') {
      out += c;
      continue;
    }
    const char which = rest.empty() ? ' ' : rest[0];
    if (!rest.empty()) rest.remove_prefix(1);
    if (which == '"' || which == '\\' || which == '/') {
      out += which;
    } else if (which == 'u') {
      const auto code = escaped_character(rest);
      good = good && code;
      if (code) append_utf8(*code, out);
    } else {
      good = good && std::string_view("bfnrt").find(which) != std::string_view::npos;
      out += '\n';  // placeholder for a control character, which is reported below
    }
  }
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (!good) {
    diagnostics.error("E0003", token.span, "an escape that there is not", "",
                      {"escapes are \\\" \\\\ \\/ and \\u with four hexadecimal digits"});
  } else if (std::any_of(out.begin(), out.end(), control)) {
    diagnostics.error("E0003", token.span, "a control character in a text", "",
                      {"leave out line breaks, tabs and escapes such as \\u001b"});
    std::erase_if(out, control);
  }
  return out;
}

}  // namespace fathom::compiler::text
