// Program templates: parts come out of a pool as they were put in. Many parts evaluated side by side have the same
// distances as each alone.
#include "vm/prune/program_template.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "compiler/lower/fuse.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test::skeleton_test {
namespace {

constexpr float kFarAway = std::numeric_limits<float>::infinity();
constexpr std::size_t kParts = vm::kEnclosedBoxes;

// Parts of one program, in boxes at random positions.
std::vector<vm::PrunedProgram> parts_of(const vm::Code& code, Random& random) {
  alignas(64) float lo[3][kParts], hi[3][kParts];
  for (std::size_t i = 0; i < kParts; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis][i] = static_cast<float>(random.uniform(-2, 2));
      hi[axis][i] = lo[axis][i] + static_cast<float>(random.uniform(0.02, 1));
    }
  }
  vm::Specialiser specialiser;
  vm::Workspace workspace;
  const vm::PrunedProgram whole = vm::whole(code);
  if (!specialiser.enclose_choices(whole, {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}, workspace)) return {};
  specialiser.resolve(-kFarAway, kFarAway);
  std::vector<vm::PrunedProgram> parts(kParts);
  for (std::size_t i = 0; i < kParts; ++i) specialiser.prune(i, parts[i]);
  return parts;
}

bool equal(const vm::PrunedProgram& a, const vm::PrunedProgram& b) {
  return a.words == b.words && a.doubles == b.doubles && a.sources == b.sources && a.locals == b.locals &&
         a.max_values == b.max_values && a.max_points == b.max_points && a.choices == b.choices && a.cost == b.cost;
}

// Parts of one program in a pool.
struct Packed {
  explicit Packed(const vm::Code& whole, const std::vector<vm::PrunedProgram>& parts) : constants(whole) {
    for (const vm::PrunedProgram& part : parts) at.push_back(program_templates.pack(part, constants, pool));
  }
  vm::Constants constants;
  vm::ProgramTemplates program_templates;
  std::vector<std::uint32_t> pool, at;
};

// Evaluates random points in random parts. Returns the number of distances that differ from those of the part alone.
std::size_t wrong_distances(const Packed& packed, const std::vector<vm::PrunedProgram>& parts, std::size_t count,
                            Random& random) {
  std::vector<float> alone(count), together(count);
  vm::Workspace workspace;
  std::map<std::uint32_t, std::vector<vm::TemplateJob>> jobs;  // by template
  for (std::uint32_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(random.uniform(-2, 3)), y = static_cast<float>(random.uniform(-2, 3)),
                z = static_cast<float>(random.uniform(-2, 3));
    const std::size_t part = random.below(parts.size());
    const float most = random.chance(0.2) ? 0.1f : kFarAway;
    vm::evaluate_distance(parts[part], {&x, &y, &z}, 1, &alone[i], workspace);
    alone[i] = std::min(alone[i], most);
    jobs[packed.pool[packed.at[part]]].push_back({x, y, z, most, packed.at[part], i});
  }
  for (const auto& [program_template, some] : jobs) {
    vm::evaluate_template(packed.program_templates[program_template], packed.constants, packed.pool.data(), some,
                          together.data(), workspace);
  }
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i)
    wrong += !(alone[i] == together[i]) && !(std::isnan(alone[i]) && std::isnan(together[i]));
  return wrong;
}

}  // namespace

TEST_CASE("skeletons: parts of random scenes come out as they were put in, with their own distances",
          "[prune][skeleton]") {
  std::size_t parts_seen = 0, program_templates = 0, compared = 0, wrong = 0;
  const std::string before(vm::isa_name());
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Random random(seed);
    GraphOptions options;
    options.depth = 4;
    const auto verified = vm::verify(compiler::fuse(plain_lowering(random_scene(random, options)).program()));
    const auto& program = std::get<vm::VerifiedProgram>(verified);
    const std::vector<vm::PrunedProgram> parts = parts_of(program, random);
    if (parts.empty()) continue;
    const Packed packed(program, parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      vm::PrunedProgram part;
      packed.program_templates.unpack(program, packed.constants, packed.pool.data(), packed.at[i], part);
      INFO("seed " << seed << ", part " << i);
      CHECK(equal(part, parts[i]));
    }
    parts_seen += parts.size(), program_templates += packed.program_templates.size();
    const auto isas = vm::available_isas();
    vm::force_isa(isas[seed % isas.size()]);
    constexpr std::size_t kPoints = 300;
    compared += kPoints;
    const std::size_t here = wrong_distances(packed, parts, kPoints, random);
    if (here > 0 && wrong == 0) FAIL_CHECK("seed " << seed << " on " << vm::isa_name() << ": " << here << " wrong");
    wrong += here;
  }
  vm::force_isa(before);
  CHECK(wrong == 0);
  CHECK(compared > 30000);
  CHECK(program_templates < parts_seen / 2);
}

TEST_CASE("skeletons: small shapes are one, whichever they are and whatever surface they belong to",
          "[prune][skeleton]") {
  std::string objects;
  for (const char* shape : {"\"sphere\", \"radius\": 0.3", "\"box\", \"half_size\": [0.3, 0.2, 0.1]",
                            "\"torus\", \"major_radius\": 0.3, \"minor_radius\": 0.1",
                            "\"cylinder\", \"radius\": 0.2, \"half_height\": 0.3",
                            "\"capsule\", \"radius\": 0.1, \"half_height\": 0.3"}) {
    for (int i = 0; i < 30; ++i) {
      const double at = 0.11 * i - 1.6;
      objects += (objects.empty() ? "" : ",\n") + std::string("{\"type\": ") + shape + ", \"translate\": [" +
                 std::to_string(at) + ", " + std::to_string(at * at - 1) + ", " + std::to_string(1 - at) + "]}";
    }
  }
  const compiler::CompiledScene scene = test::compiled("{\"version\": 1, \"objects\": [" + objects + "]}");
  Random random(1);
  const std::vector<vm::PrunedProgram> parts = parts_of(scene.surface, random);
  const Packed packed(scene.surface, parts);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const vm::ProgramTemplate& program_template = packed.program_templates[packed.pool[packed.at[i]]];
    // one joined shape per choice: no tags and no separate minima
    CHECK(program_template.instructions == parts[i].choices + 1);
    for (std::size_t j = 0; j < i; ++j) {
      const bool same = packed.pool[packed.at[i]] == packed.pool[packed.at[j]];
      CHECK(same == (parts[i].choices == parts[j].choices));
    }
  }
  CHECK(wrong_distances(packed, parts, 2000, random) == 0);
}

// Each turned shape had a map and a drop of its own, so that 10,000 blended bodies had 42,160 templates, and a batch
// of lanes was a quarter full.
TEST_CASE("skeletons: turned shapes and those that are not are one", "[prune][skeleton]") {
  Random random(3);
  std::string objects;
  for (int i = 0; i < 120; ++i) {
    const auto number = [&](double most) { return std::to_string(random.uniform(0.01, most)); };
    const std::string place = "\"translate\": [" + number(2) + ", " + number(2) + ", " + number(2) + "]";
    const std::string turn = ", \"rotate\": [" + number(90) + ", " + number(90) + ", " + number(90) + "]}";
    objects += i == 0 ? "" : ", ";
    objects += i % 3 == 0   ? "{\"type\": \"sphere\", \"radius\": " + number(0.3) + ", " + place + "}"
               : i % 3 == 1 ? "{\"type\": \"box\", \"half_size\": [0.2, 0.1, 0.3], " + place + turn
                            : "{\"type\": \"torus\", \"major_radius\": 0.2, \"minor_radius\": 0.05, " + place + turn;
  }
  for (const char* join : {"\"smooth_union\", \"k\": 0.1", "\"union\""}) {
    const compiler::CompiledScene scene = test::compiled(
        "{\"version\": 1, \"objects\": [{\"type\": " + std::string(join) + ", \"of\": [" + objects + "]}]}");
    const std::vector<vm::PrunedProgram> parts = parts_of(scene.distance, random);
    const Packed packed(scene.distance, parts);
    CHECK(packed.constants.placed());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      vm::PrunedProgram part;
      packed.program_templates.unpack(scene.distance, packed.constants, packed.pool.data(), packed.at[i], part);
      CHECK(equal(part, parts[i]));
      for (std::size_t j = 0; j < i; ++j) {
        const bool same = packed.pool[packed.at[i]] == packed.pool[packed.at[j]];
        CHECK(same == (parts[i].choices == parts[j].choices));
      }
    }
    CHECK(wrong_distances(packed, parts, 2000, random) == 0);
  }
}

TEST_CASE("skeletons: what several threads have packed becomes one", "[prune][skeleton]") {
  Random random(5);
  const auto verified = vm::verify(compiler::fuse(plain_lowering(random_scene(random, {})).program()));
  const auto& program = std::get<vm::VerifiedProgram>(verified);
  const std::vector<vm::PrunedProgram> first = parts_of(program, random), second = parts_of(program, random);
  REQUIRE_FALSE(first.empty());
  Packed a(program, first);
  const Packed b(program, second);
  std::vector<std::uint32_t> pool = b.pool;
  for (const std::uint32_t at : b.at) a.program_templates.renumber(b.program_templates, pool.data(), at);
  for (std::size_t i = 0; i < second.size(); ++i) {
    vm::PrunedProgram part;
    a.program_templates.unpack(program, a.constants, pool.data(), b.at[i], part);
    CHECK(equal(part, second[i]));
  }
  const std::size_t known = a.program_templates.size();
  for (const vm::PrunedProgram& part : second) a.program_templates.pack(part, a.constants, a.pool);
  CHECK(a.program_templates.size() == known);
}

}  // namespace fathom::test::skeleton_test
