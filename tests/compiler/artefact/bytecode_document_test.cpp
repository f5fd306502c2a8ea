// Checks that docs/reference/bytecode.md contains the current table of opcodes and list of fields.
// FATHOM_UPDATE_GOLDEN=1 in the environment rewrites both parts of the document.
#include <fmt/format.h>

#include <catch2/catch.hpp>
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

// Archive that records the names and types of the fields instead of their values.
class FieldTable : public Archive {
 public:
  void begin(std::string_view name) override {
    path_.push_back(std::string(name));
    types_.clear();
  }
  void end() override {
    if (!types_.empty()) {
      std::string path;
      for (const std::string& part : path_) path += (path.empty() ? "" : ".") + part;
      text_ += fmt::format("| {} | {} |\n", path, types_);
    }
    types_.clear();
    path_.pop_back();
  }
  void number(double&) override { add("f64"); }
  void whole(std::uint64_t&) override { add("u64"); }
  void text(std::string&) override { add("text"); }
  void choice(std::size_t&, std::span<const std::string_view> names) override {
    add(fmt::format("u8: {}", fmt::join(names, ", ")));
  }
  void begin_record() override { types_.clear(); }
  void end_record() override { types_.clear(); }
  std::size_t list(std::size_t count) override {
    add("a list of:");
    end_keeping_name();
    return count;
  }
  bool present(bool) override {
    add("may be missing:");
    return true;
  }
  bool reading() const override { return false; }
  void fail(std::string) override {}
  bool failed() const override { return false; }

  std::string table() const { return "| field | type |\n|---|---|\n" + text_; }

 private:
  void add(const std::string& type) {
    const std::size_t times = types_.ends_with(type) ? 1 : 0;
    if (times == 0) {
      types_ += (types_.empty() ? "" : " ") + type;
      count_ = 1;
      return;
    }
    types_ = types_.substr(0, types_.size() - type.size());
    if (count_ > 1) types_ = types_.substr(0, types_.size() - std::to_string(count_).size() - 3);
    types_ += fmt::format("{} x {}", ++count_, type);
  }
  void end_keeping_name() {
    const std::string name = path_.back();
    end();
    path_.push_back(name);
  }

  std::vector<std::string> path_;
  std::string types_, text_;
  int count_ = 0;
};

// Scene with at least one of each field, including every form of the fields that have several.
std::string field_table() {
  CompiledScene scene = tests::compiled(R"scene({
    "version": 1, "params": {"r": {"default": 1}},
    "lights": {"lamp": {"type": "point", "position": [0, 3, 0]}},
    "materials": {"glass": {"type": "transparent"}, "glow": {"type": "emissive"},
                  "varied": {"type": "principled", "roughness": "0.2 + 0.1 * sin(x)"}},
    "objects": [{"type": "sphere", "radius": "r", "material": "glass"},
                {"type": "sphere", "radius": 1, "translate": [3, 0, 0], "material": "glow"},
                {"type": "sphere", "radius": 1, "translate": [6, 0, 0], "material": "varied"}]})scene");
  scene.camera.vertical_fov = scene.camera.focal_length = scene.camera.lens_radius = scene.camera.f_stop =
      scene.camera.focus_distance = scene.film.filter_width = scene.settings.far = 1;
  scene.materials = {scene.materials[2]};
  scene.surfaces.resize(1);
  scene.textures = {Texture(glm::dvec3(0)), scene.textures[0]};
  const Affine map{};
  scene.textures.push_back(Pattern{Pattern::Checker{}, map, 0, 0});
  scene.textures.push_back(Pattern{Pattern::Stripes{}, map, 0, 0});
  scene.textures.push_back(Pattern{Pattern::Gradient{}, map, 0, 0});
  scene.textures.push_back(Pattern{Pattern::Noise{}, map, 0, 0});
  scene.textures.push_back(Pattern{Pattern::Bricks{}, map, 0, 0});
  FieldTable table;
  fields(table, scene);
  return table.table();
}

// Returns the document with the text between the marks replaced by `part`.
std::string with_part(const std::string& document, const std::string& mark, const std::string& part) {
  const std::string begin = "<!-- " + mark + " -->\n";
  const std::size_t at = document.find(begin) + begin.size(), end = document.find("<!-- end -->", at);
  REQUIRE(end != std::string::npos);
  return document.substr(0, at) + part + document.substr(end);
}

}  // namespace

TEST_CASE("docs/reference/bytecode.md has the table of opcodes and the list of fields", "[golden]") {
  const std::string path = FATHOM_SOURCE_DIR "/docs/reference/bytecode.md";
  const std::string document = tests::read_file(path);
  const std::string expected = with_part(with_part(document, "opcodes", opcode_table()), "fields", field_table());
  if (std::getenv("FATHOM_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path) << expected;
  } else {
    CHECK((document == expected));
  }
}

}  // namespace fathom::test::bytecode_document_test
