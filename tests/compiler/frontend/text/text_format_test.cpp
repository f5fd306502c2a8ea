// The layout of texts: formatting keeps tokens and comments, and formatting again changes nothing.
#include <string>
#include <vector>

#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/text/format.h"
#include "compiler/frontend/text/parse/lexer.h"
#include "compiler/frontend/text/print.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_document.h"
#include "tests/support/scaled_cases.h"

namespace fathom::text_format_test {

namespace {

using namespace fathom::compiler;

std::string formatted(const std::string& text) { return text::format_text(Source("a.fathom", text)); }

// All tokens and comments in order, one per line.
std::vector<std::string> content(const std::string& text) {
  const Source source("a.fathom", text);
  Diagnostics none;
  const text::Tokens tokens = text::read_tokens(source, none);
  std::vector<std::string> out;
  for (const text::Token& token : tokens.tokens) out.emplace_back(token.text);
  for (const text::Comment& comment : tokens.comments) {
    out.push_back(text.substr(comment.span.begin, comment.span.end - comment.span.begin) + " before " +
                  std::to_string(comment.before));
  }
  return out;
}

// Changes blanks, blank lines, comments and indentation wherever they have no meaning.
std::string scrambled(const std::string& text, test::Random& random) {
  std::string out;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      out += c;
      out += text[++i];
      continue;
    }
    if (c == '"') quoted = !quoted;
    if (c == ' ' && !quoted) {
      out.append(static_cast<std::size_t>(1 + random.below(3)), random.chance(0.1) ? '\t' : ' ');
      if (random.chance(0.05)) out += "/* aside */ ";
    } else if (c == '\n') {
      if (random.chance(0.2)) out += " // at the end";
      out.append(static_cast<std::size_t>(1 + random.below(3)), '\n');
      if (random.chance(0.1)) out += "// on a line of its own\n";
    } else {
      out += c;
    }
  }
  return out;
}

TEST_CASE("text: the layout changes no token and no comment, and nothing the second time", "[frontend][text]") {
  for (int i = 0; i < test::scaled_cases(1000); ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    const syntax::File file = test::random_document(random);
    const std::string text = scrambled(text::print_text(file, Source("a.json", write_json(file))), random);
    const std::string once = formatted(text);
    CAPTURE(i, text);
    REQUIRE(content(once) == content(text));
    REQUIRE(formatted(once) == once);
  }
}

TEST_CASE("text: blanks and indentation have one form", "[frontend][text]") {
  CHECK(formatted("\n fathom   1\nlet a=-1+2 * b [ 0 ]^ 2\n") == "fathom 1\nlet a = -1 + 2*b[0]^2\n");
  CHECK(formatted("fathom 1\nobject\"a\"(b-c) . scale( 2,)+{ 0.1}d") ==
        "fathom 1\nobject \"a\" (b - c).scale(2,) +{0.1} d\n");
  CHECK(formatted("fathom 1\n\n\n\ndef f(a,b=2)=\n        let c=a\n            .scale(b)\n        in c // it\n") ==
        "fathom 1\n\ndef f(a, b = 2) =\n  let c = a\n    .scale(b)\n  in c  // it\n");
  CHECK(formatted("fathom 1\nobject [for i in 0 .. 3:\nif i>1:\n") != "");  // even for an incomplete text
  CHECK(formatted("fathom 1\nobject[if! a&&b:...c,for i in d:-e]\n") ==
        "fathom 1\nobject [if !a && b: ...c, for i in d: -e]\n");
  CHECK(formatted("") == "");
}

}  // namespace

}  // namespace fathom::text_format_test
