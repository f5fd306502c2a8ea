// Rules that the text of every source file keeps. Includes: tests/layers_test.cpp. Comments: tests/house.
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/catch.h"

namespace fathom::sources_test {

namespace {

namespace fs = std::filesystem;

struct Token {
  enum class Kind { Word, Number, String, Mark };
  Kind kind;
  std::string text;  // of a string: without quotes
  long line;

  bool is(std::string_view mark) const { return kind == Kind::Mark && text == mark; }
};

// Splits C++ into tokens, without comments. "::" and "->" are one mark each, and so is every other character.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  std::vector<Token> tokens() {
    while (at_ < text_.size()) next();
    return std::move(tokens_);
  }

 private:
  static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
  bool sees(std::string_view mark) const { return text_.substr(at_).starts_with(mark); }

  // Goes on to behind the next `end`.
  void skip_past(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  void next() {
    const std::size_t begin = at_;
    const char c = text_[at_];
    if (std::isspace(static_cast<unsigned char>(c))) {
      ++at_;
    } else if (sees("//")) {
      skip_past("\n");
    } else if (sees("/*")) {
      skip_past("*/");
    } else if (sees("R\"")) {
      const std::size_t open = text_.find('(', at_);
      skip_past(")" + std::string(text_.substr(at_ + 2, open - at_ - 2)) + "\"");
      add(Token::Kind::String, begin, text_.substr(open + 1, at_ - open - 2));
    } else if (c == '"' || c == '\'') {
      for (++at_; at_ < text_.size() && text_[at_] != c; ++at_) at_ += text_[at_] == '\\';
      ++at_;
      if (c == '"') add(Token::Kind::String, begin, text_.substr(begin + 1, at_ - begin - 2));
    } else if (std::isdigit(static_cast<unsigned char>(c))) {
      while (at_ < text_.size() && (is_word(text_[at_]) || text_[at_] == '.' || text_[at_] == '\'')) ++at_;
      add(Token::Kind::Number, begin, text_.substr(begin, at_ - begin));
    } else if (is_word(c)) {
      while (at_ < text_.size() && is_word(text_[at_])) ++at_;
      add(Token::Kind::Word, begin, text_.substr(begin, at_ - begin));
    } else {
      at_ += sees("::") || sees("->") ? 2 : 1;
      add(Token::Kind::Mark, begin, text_.substr(begin, at_ - begin));
    }
  }

  void add(Token::Kind kind, std::size_t begin, std::string_view text) {
    line_ += std::count(text_.begin() + static_cast<long>(counted_), text_.begin() + static_cast<long>(begin), '\n');
    counted_ = begin;
    tokens_.push_back({kind, std::string(text), line_});
  }

  std::string_view text_;
  std::size_t at_ = 0, counted_ = 0;
  long line_ = 1;  // of text_[counted_]
  std::vector<Token> tokens_;
};

struct SourceFile {
  std::string path;  // from the repository's root
  std::vector<Token> tokens;
};

// Returns the C and C++ files of a folder and the folders below.
std::vector<SourceFile> files_of(const char* folder) {
  const std::set<std::string> suffixes = {".h", ".hpp", ".c", ".cpp", ".def"};
  std::vector<SourceFile> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(FATHOM_SOURCE_DIR) / folder)) {
    if (!entry.is_regular_file() || !suffixes.contains(entry.path().extension().string())) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    files.push_back({fs::relative(entry.path(), FATHOM_SOURCE_DIR).string(), Lexer(text).tokens()});
  }
  return files;
}

// Functions of libm, whose last bit depends on the processor and the C library. std::sqrt, std::floor, std::fmod,
// std::remainder and std::ldexp are not among them: IEEE 754 defines their results.
bool is_libm(std::string name) {
  static const std::set<std::string> names = {"acos",   "acosh",  "asin", "asinh", "atan",  "atan2", "atanh", "cbrt",
                                              "cos",    "cosh",   "erf",  "erfc",  "exp",   "exp10", "exp2",  "expm1",
                                              "hypot",  "lgamma", "log",  "log10", "log1p", "log2",  "pow",   "sin",
                                              "sincos", "sinh",   "tan",  "tanh",  "tgamma"};
  if (names.contains(name)) return true;
  if (!name.ends_with('f') && !name.ends_with('l')) return false;
  name.pop_back();
  return names.contains(name);
}

// Files in which a name without a namespace is the machine's: they declare the functions, or are templates over
// number types, which libm does not take.
bool is_of_machine(const SourceFile& file) {
  if (file.path == "vm/program/functions.def" || file.path == "runtime/base/elementary.h") return true;
  return file.path.starts_with("vm/") && (file.path.ends_with("-inl.h") || file.path.starts_with("vm/number/real.") ||
                                          file.path.starts_with("vm/number/decimal."));
}

bool includes_elementary(const SourceFile& file) {
  return std::ranges::any_of(file.tokens, [](const Token& token) {
    return token.kind == Token::Kind::String && token.text == "runtime/base/elementary.h";
  });
}

// True if the token calls libm, or takes the function of std, glm or the global namespace in any other way.
bool calls_libm(const SourceFile& file, std::size_t at) {
  const std::vector<Token>& tokens = file.tokens;
  const std::string& name = tokens[at].text;
  if (tokens[at].kind != Token::Kind::Word || !is_libm(name)) return false;
  const auto is_mark = [&](std::size_t i, std::string_view mark) { return i < tokens.size() && tokens[i].is(mark); };
  if (at > 0 && (is_mark(at - 1, ".") || is_mark(at - 1, "->"))) return false;  // a member
  if (at > 0 && is_mark(at - 1, "::")) {
    if (at < 2 || tokens[at - 2].kind != Token::Kind::Word) return true;
    constexpr std::array kWithLibm = {"std", "glm", "return", "else", "case", "throw", "co_return", "not", "and", "or"};
    return std::ranges::find(kWithLibm, tokens[at - 2].text) != kWithLibm.end();
  }
  if (!is_mark(at + 1, "(") || is_of_machine(file)) return false;
  return !((name == "exp" || name == "log") && includes_elementary(file));
}

// Returns the tag of the cases in a file: the folder below tests/vm, tests/compiler and tests/runtime, and below
// tests/ elsewhere.
std::string component_of(const std::string& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::path(path)) parts.push_back(part.string());
  if (parts.size() == 2) return "house";
  if (parts[1] == "bindings") return "library";
  const bool layered = parts[1] == "vm" || parts[1] == "compiler" || parts[1] == "runtime";
  return layered && parts.size() > 3 ? parts[2] : parts[1];
}

// Returns the text of the adjacent strings from `at` on, and moves `at` to behind them.
std::string joined_strings(const std::vector<Token>& tokens, std::size_t& at) {
  std::string text;
  for (; at < tokens.size() && tokens[at].kind == Token::Kind::String; ++at) text += tokens[at].text;
  return text;
}

}  // namespace

TEST_CASE("sources: no function of libm that differs between machines", "[house]") {
  std::size_t files = 0;
  for (const char* folder : {"vm", "compiler", "runtime", "bindings"}) {
    for (const SourceFile& file : files_of(folder)) {
      ++files;
      for (std::size_t i = 0; i < file.tokens.size(); ++i) {
        if (calls_libm(file, i)) {
          FAIL_CHECK(file.path << ":" << file.tokens[i].line << ": `" << file.tokens[i].text
                               << "` is libm's; take vm/number/real.h or runtime/base/elementary.h");
        }
      }
    }
  }
  CHECK(files > 800);
}

TEST_CASE("sources: a call of libm is found however it is written", "[house]") {
  const auto is_found = [](std::string_view text, const char* path = "runtime/light/sun.cpp") {
    const SourceFile file{path, Lexer(text).tokens()};
    for (std::size_t i = 0; i < file.tokens.size(); ++i) {
      if (calls_libm(file, i)) return true;
    }
    return false;
  };
  for (const char* text : {"std::pow(x, y)", "::expf(x)", "exp(x)", "std :: log (x)", "glm::sin(v)",
                           "map(v, std::cos)", "return ::exp(x);", "int n = 1'000; f(std::tan(x));", "using std::hypot;"}) {
    CAPTURE(text);
    CHECK(is_found(text));
  }
  for (const char* text : {"vm::real::pow(x, y)", "// std::pow(x)", "/* exp(x) */", "\"std::pow(x)\"", "std::sqrt(x)",
                           "R\"js(Math.exp(x) \"std::exp\")js\"", "light.exp(x)", "'\"' + exponent",
                           "double log = 0;", "#include \"runtime/base/elementary.h\"\nexp(x)"}) {
    CAPTURE(text);
    CHECK_FALSE(is_found(text));
  }
  CHECK_FALSE(is_found("pow(x, y)", "vm/number/dual-inl.h"));
  CHECK(is_found("std::pow(x, y)", "vm/number/dual-inl.h"));
}

// Catch runs hidden cases, which take minutes or fail, whenever one of their tags is asked for.
TEST_CASE("sources: a test case has its component's tag, unless the case is hidden", "[house]") {
  int cases = 0;
  for (const SourceFile& file : files_of("tests")) {
    const std::vector<Token>& tokens = file.tokens;
    for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
      if (tokens[i].kind != Token::Kind::Word || tokens[i].text != "TEST_CASE") continue;
      ++cases;
      const long line = tokens[i].line;
      const std::string tag = "[" + component_of(file.path) + "]";
      std::size_t at = i + 2;
      const std::string name = joined_strings(tokens, at);
      const std::string tags = tokens[at].is(",") ? joined_strings(tokens, ++at) : "";
      CAPTURE(file.path, line, name, tags, tag);
      CHECK((tags.find(tag) != std::string::npos) == (tags.find("[.") == std::string::npos));
    }
  }
  CHECK(cases > 1000);
}

}  // namespace fathom::sources_test
