#include "compiler/frontend/formula/formula_lexer.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>

namespace fathom::compiler {
namespace {

struct ForeignMark {
  std::string_view text, help;
};

constexpr std::string_view kCompare = "there are no comparisons; step(edge, v) is 0 where v < edge and 1 elsewhere";
constexpr std::string_view kChoose = "for a choice write mix(a, b, step(edge, v)): a where v < edge, b elsewhere";
constexpr std::string_view kLogic = "there is no logic; of values that are 0 or 1, min is `and` and max is `or`";

// Longer marks come before their prefixes.
constexpr ForeignMark kForeign[] = {
    {"**", "for a power write a^b"},
    {"==", kCompare},
    {"!=", kCompare},
    {"<=", kCompare},
    {">=", kCompare},
    {"<", kCompare},
    {">", kCompare},
    {"&&", kLogic},
    {"||", kLogic},
    {"&", kLogic},
    {"|", "for a magnitude write abs(v)"},
    {"!", kLogic},
    {"?", kChoose},
    {":", kChoose},
    {"%", "for a remainder write mod(a, b)"},
    {"[", "group with ( and )"},
    {"]", "group with ( and )"},
    {"{", "group with ( and )"},
    {"}", "group with ( and )"},
    {";", "put each definition in a string of its own: [\"a = 2*r\", \"a + 1\"]"},
    {"\u00D7", "for a product write a*b"},
    {"\u00B7", "for a product write a*b"},
    {"\u00F7", "for a quotient write a/b"},
    {"\u2212", "for minus write -"},
    {"\u2013", "for minus write -"},
    {"\u00B2", "for a square write a^2"},
    {"\u00B3", "for a cube write a^3"},
    {"\u03C0", "write pi"},
    {"\u221A", "for a root write sqrt(v)"},
    {"\u00B0", "angles of a scene are in degrees: write 45; sin, cos and tan take radians: 45*pi/180"},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_name(char c) { return begins_name(c) || is_digit(c); }

}  // namespace

bool is_formula_name(std::string_view text) {
  return !text.empty() && begins_name(text[0]) && std::all_of(text.begin(), text.end(), continues_name);
}

Token FormulaLexer::next() {
  while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  const std::string_view rest = text_.substr(at_);
  if (rest.empty()) return {Token::Kind::End, rest};
  if (is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1]))) return number();
  if (begins_name(rest[0])) {
    const auto end = std::find_if_not(rest.begin(), rest.end(), continues_name);
    return take(Token::Kind::Name, static_cast<std::size_t>(end - rest.begin()));
  }
  const bool two = rest.starts_with("**") || rest.starts_with("==");
  if (!two && std::string_view("+-*/^(),=").find(rest[0]) != std::string_view::npos) {
    return take(Token::Kind::Mark, 1);
  }
  return foreign();
}

Token FormulaLexer::take(Token::Kind kind, std::size_t length) {
  const std::string_view text = text_.substr(at_, length);
  at_ += length;
  return {kind, text};
}

Token FormulaLexer::number() {
  const char* begin = text_.data() + at_;
  double value = 0;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
  Token token = take(Token::Kind::Number, static_cast<std::size_t>(end - begin));
  // The number is out of the range of double. strtod says which way, by returning infinity or zero.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(token.text).c_str(), nullptr);
  token.value = value;
  return token;
}

Token FormulaLexer::foreign() {
  const std::string_view rest = text_.substr(at_);
  for (const ForeignMark& mark : kForeign) {
    if (!rest.starts_with(mark.text)) continue;
    Token token = take(Token::Kind::Foreign, mark.text.size());
    token.help = mark.help;
    return token;
  }
  // One character: in UTF-8, a byte and its continuation bytes.
  std::size_t length = 1;
  while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0) == 0x80) ++length;
  return take(Token::Kind::Foreign, length);
}

}  // namespace fathom::compiler
