// fathom explain: says what the code of an error or a warning means, with an example.
// Tested by: tests/runtime/cli/cli_explain_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <vector>

#include "compiler/source/diagnostics.h"
#include "compiler/source/error_codes.h"
#include "runtime/cli/error_examples.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/values.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kExplainExamples =
    "fathom explain E0311\n"
    "fathom explain              # lists all codes";

constexpr std::string_view kExpected = "----- expected\n";

std::string indented(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) out += fmt::format("    {}", text.substr(0, end));
    out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string describe(const compiler::ErrorCode& row) {
  std::string text = fmt::format("{}: {}\n", row.code, row.meaning);
  const auto examples = error_examples();
  const auto example = std::ranges::find(examples, row.code, &compiler::EmbeddedFile::name);
  if (example == examples.end()) return text;
  const std::size_t end = example->text.find(kExpected);
  return text + "\nThis file\n\n" + indented(example->text.substr(0, end)) + "\ngets this message:\n\n" +
         indented(example->text.substr(end + kExpected.size()));
}

}  // namespace

int run_explain(std::span<const std::string> args, const Streams& streams) {
  std::string code;
  Arguments arguments("explain", "Says what the code of an error or a warning means, with an example.",
                      kExplainExamples);
  arguments.positional("code", "The code, as E0311 or w0405; all codes are listed without it", code, false, "CODE");
  if (const auto exit = arguments.parse(args, streams)) return *exit;
  if (code.empty()) {
    for (const compiler::ErrorCode& row : compiler::kErrorCodes) {
      print(streams, fmt::format("{}  {}\n", row.code, row.meaning));
    }
    return kDone;
  }
  std::ranges::transform(code, code.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const auto* const row = std::ranges::find(compiler::kErrorCodes, std::string_view(code), &compiler::ErrorCode::code);
  if (row != std::end(compiler::kErrorCodes)) {
    print(streams, describe(*row));
    return kDone;
  }
  std::vector<std::string_view> codes;
  for (const compiler::ErrorCode& known : compiler::kErrorCodes) codes.push_back(known.code);
  const std::string_view near = compiler::nearest(code, codes);
  return fail(streams, kUsage, fmt::format("there is no code `{}`", code),
              {near.empty() ? "`fathom explain` lists all codes" : fmt::format("did you mean {}?", near)});
}

}  // namespace fathom::cli
