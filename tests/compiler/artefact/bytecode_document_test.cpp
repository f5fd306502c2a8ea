// Checks that docs/reference/bytecode.md contains the current table of opcodes and the tables of a scene.
// FATHOM_UPDATE_GOLDEN=1 in the environment rewrites both parts of the document.
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "compiler/artefact/fields.h"
#include "tests/support/compiled.h"
#include "tests/support/golden.h"
#include "vm/program/opcode.h"

namespace fathom::test::bytecode_document_test {
namespace {

using namespace fathom::compiler;

constexpr const char* kMeanings[] = {
#define OP(Name, mnemonic, form, immediates, choice, cost, facts, meaning) #meaning,
#include "tests/support/catch.h"
#include "vm/program/opcodes.def"
#undef OP
};
constexpr const char* kForms[] = {"Point", "Shape", "Outline", "Unary", "Binary", "Ternary", "Machine"};
constexpr const char* kChoices[] = {"", "Lesser", "Greater", "Carve", "Either"};

std::string opcode_table() {
  std::string text =
      "| code | mnemonic | form | immediates | choice | cost | meaning |\n|---|---|---|---|---|---|---|\n";
  for (std::uint32_t i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& row = *vm::find_opcode(i);
    std::string meaning = kMeanings[i];
    if (meaning.front() == '"')
      meaning = meaning.substr(1, meaning.size() - 2);  // the meaning of a machine row is a sentence
    else
      meaning = "`" + meaning + "`";
    text +=
        fmt::format("| {} | `{}` | {} | {} | {} | {} | {} |\n", i, row.mnemonic, kForms[static_cast<int>(row.form)],
                    row.immediate_names, kChoices[static_cast<int>(row.choice)], row.cost, meaning);
  }
  return text;
}

// Returns the tables of a ball of glass, as the listing of a compiled scene has them.
std::string tables_of_ball() {
  const CompiledScene scene = test::compiled(R"({"version": 1, "params": {"r": {"default": 0.5, "min": 0}},
      "materials": {"glass": {"type": "principled", "preset": "glass"}},
      "objects": [{"name": "ball", "type": "sphere", "radius": "r", "material": "glass"}]})");
  return "```json\n" + print_tables(tables_of(scene)) + "\n```\n";
}

// Returns the document with the text between the marks replaced by `part`.
std::string with_part(const std::string& document, const std::string& mark, const std::string& part) {
  const std::string begin = "<!-- " + mark + " -->\n";
  const std::size_t at = document.find(begin) + begin.size(), end = document.find("<!-- end -->", at);
  REQUIRE(end != std::string::npos);
  return document.substr(0, at) + part + document.substr(end);
}

}  // namespace

TEST_CASE("docs/reference/bytecode.md has the table of opcodes and the tables of a scene", "[artefact][golden]") {
  const std::string path = FATHOM_SOURCE_DIR "/docs/reference/bytecode.md";
  const std::string document = test::read_file(path);
  const std::string expected = with_part(with_part(document, "opcodes", opcode_table()), "tables", tables_of_ball());
  if (std::getenv("FATHOM_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path) << expected;
  } else {
    CHECK((document == expected));
  }
}

}  // namespace fathom::test::bytecode_document_test
