#include "tests/support/emitted_programs.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/lower/fuse.h"
#include "compiler/lower/lower.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test {
namespace {

using vm::Form;
using vm::Opcode;
using vm::Source;

constexpr int kRandomScenes = 8;

EmittedProgram named(std::string name, vm::Program program, glm::dvec3 origin = glm::dvec3(0)) {
  vm::VerifiedProgram distance = verified(std::move(program));
  compiler::CompiledField field{distance, distance, {}, {}, 1, 0, true};
  return {name, {{}, {std::move(field), {}}, compiler::Source(name, ""), origin, {}, {}, {}, {}, 0, "a test's"}};
}

// Returns immediates that are not floats, so that a test notices when the emitter rounds the constants.
std::vector<double> random_immediates(const vm::OpcodeInfo& row, std::uint32_t word, Random& random) {
  std::vector<double> immediates;
  for (int i = 0; i < vm::leading_immediates(word); ++i) immediates.push_back(random.uniform(-1.5, 1.5));
  const int groups = row.form == Form::Outline ? 5 : 1;
  for (int i = 0; i < groups * row.immediates; ++i) {
    const bool integer = vm::is_integer_immediate(row, i % row.immediates);
    immediates.push_back(integer ? 2 + random.below(4) : random.uniform(-1.5, 1.5));
  }
  return immediates;
}

// Returns the smallest program that uses the opcode `row` with this operand and random immediates.
vm::Program program_of(const vm::OpcodeInfo& row, std::uint32_t operand, Random& random) {
  vm::Program program;
  const bool joined = row.form == Form::Shape && (operand & vm::kFusedMin) != 0;
  const vm::Sources sources = vm::sources_of(vm::opcode_word(row.opcode, operand));
  const bool function = row.form == Form::Unary || row.form == Form::Binary;
  if (joined || (function && sources.a == Source::Stack)) program.append(Opcode::X, 0, {}, {});
  if (row.form == Form::Binary && sources.b == Source::Stack) program.append(Opcode::Y, 0, {}, {});
  if (row.form == Form::Ternary) {
    for (const Opcode coordinate : {Opcode::X, Opcode::Y, Opcode::Z}) program.append(coordinate, 0, {}, {});
  }
  const std::uint32_t word = vm::opcode_word(row.opcode, row.form == Form::Outline ? 5 : operand);
  program.append(row.opcode, operand, random_immediates(row, word, random), {});
  if (row.form == Form::Point) {
    program.append(Opcode::Plane, 0, {1, -2, 1, 0.25}, {});  // reads all coordinates that the instruction changed
    program.append(Opcode::Drop, 0, {}, {});
  }
  return program;
}

std::string identifier(const vm::OpcodeInfo& row) { return "op_" + std::string(row.mnemonic); }

void add_opcodes(std::vector<EmittedProgram>& programs, Random& random) {
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& row = vm::info(static_cast<Opcode>(i));
    if (row.form == Form::Machine) continue;
    programs.push_back(named(identifier(row), program_of(row, 0, random)));
  }
}

// Adds moved and joined shapes, and functions whose operands do not lie on the stack.
void add_operands(std::vector<EmittedProgram>& programs, Random& random) {
  const vm::OpcodeInfo& box = vm::info(Opcode::Box);
  for (std::uint32_t modes = 1; modes <= (vm::kFusedTranslate | vm::kFusedMin); ++modes) {
    programs.push_back(named(fmt::format("box_{}", modes), program_of(box, modes, random)));
  }
  constexpr Source kSources[] = {Source::Stack, Source::X, Source::Y, Source::Z, Source::Constant};
  for (const Source a : kSources) {
    for (const Source b : kSources) {
      const std::uint32_t operand = vm::operand_of(vm::Sources{a, b, 0});
      programs.push_back(named(fmt::format("minus_{}{}", static_cast<int>(a), static_cast<int>(b)),
                               program_of(vm::info(Opcode::Minus), operand, random)));
    }
    programs.push_back(named(fmt::format("exp_{}", static_cast<int>(a)),
                             program_of(vm::info(Opcode::Exp), vm::operand_of(vm::Sources{a}), random)));
  }
}

// Returns a choice between a ball of surface 2 and a box of surface 1. If `is_outer`, the tag of surface 1 follows
// the choice: the ball keeps its surface. An outer tag once replaced inner ones in emitted GLSL.
vm::Program choice_program(const vm::OpcodeInfo& row, bool is_outer, Random& random) {
  vm::Program program;
  program.append(Opcode::Sphere, 0, {0.9}, {});
  program.append(Opcode::Tag, 2, {}, {});
  program.append(Opcode::Box, 0, {1.4, 0.4, 0.6}, {});
  if (!is_outer) program.append(Opcode::Tag, 1, {}, {});
  program.append(row.opcode, 0, random_immediates(row, vm::opcode_word(row.opcode), random), {});
  if (is_outer) program.append(Opcode::Tag, 1, {}, {});
  return program;
}

// Adds, of every choice, programs whose operands belong to different surfaces.
void add_choices(std::vector<EmittedProgram>& programs, Random& random) {
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& row = vm::info(static_cast<Opcode>(i));
    if (row.form != Form::Binary || row.choice == vm::Choice::None) continue;
    programs.push_back(named(fmt::format("choice_{}", row.mnemonic), choice_program(row, false, random)));
    programs.push_back(named(fmt::format("outer_{}", row.mnemonic), choice_program(row, true, random)));
  }
}

// Adds programs of bodies that repeat, which become loops: over shapes with and without tags, and over constants.
void add_rows(std::vector<EmittedProgram>& programs, Random& random) {
  const auto number = [&] { return random.uniform(-1.5, 1.5); };
  for (const bool tagged : {false, true}) {
    vm::Program rows;
    rows.append(Opcode::Sphere, 0, {0.3}, {});
    if (tagged) rows.append(Opcode::Tag, 1, {}, {});
    for (int i = 0; i < 20; ++i)
      rows.append(Opcode::Sphere, vm::kFusedTranslate | vm::kFusedMin, {number(), 0.25, number(), 0.1}, {});
    for (int i = 0; i < 18; ++i) {
      rows.append(Opcode::Translate, 0, {number(), number(), 0}, {});
      rows.append(Opcode::Box, 0, {0.1, 0.2 + 0.01 * i, 0.1}, {});
      rows.append(Opcode::Drop, 0, {}, {});
      if (tagged) rows.append(Opcode::Tag, 2, {}, {});
      rows.append(Opcode::SmoothMin, 0, {0.1 + 0.001 * i, 2.5}, {});
    }
    for (int i = 0; i < 17; ++i) {
      rows.append(Opcode::Minus, vm::operand_of(vm::Sources{Source::X, Source::Constant}), {number()}, {});
      rows.append(Opcode::Min, 0, {}, {});
    }
    for (int i = 0; i < 16; ++i) rows.append(Opcode::Negate, 0, {}, {});
    programs.push_back(named(tagged ? "rows_tagged" : "rows", std::move(rows)));
  }
}

// Adds loops that once had other surfaces: over a local with a surface, and with a tag for what the row before has
// left without one.
void add_odd_rows(std::vector<EmittedProgram>& programs) {
  vm::Program local, lost;
  local.locals = 1;
  local.append(Opcode::Sphere, 0, {1}, {});
  local.append(Opcode::Tag, 3, {}, {});
  local.append(Opcode::Tee, 0, {}, {});
  local.append(Opcode::Box, 0, {1, 0.5, 0.25}, {});
  lost.append(Opcode::Box, 0, {1, 0.5, 0.25}, {});
  lost.append(Opcode::Tag, 1, {}, {});
  for (int i = 0; i < 16; ++i) {
    local.append(Opcode::SmoothMin, vm::operand_of(vm::Sources{Source::Stack, Source::Local, 0}), {0.01 * (i + 1), 2},
                 {});
    lost.append(Opcode::Tag, 5, {}, {});
    lost.append(Opcode::Sphere, vm::kFusedMin, {0.1 + 0.03 * i}, {});
  }
  local.append(Opcode::Min, 0, {}, {});
  programs.push_back(named("rows_local", std::move(local)));
  programs.push_back(named("rows_lost", std::move(lost)));
}

// Adds programs with nested points, locals and tags; loops with immediates that keep the loops running; and a scene
// far from the origin.
void add_others(std::vector<EmittedProgram>& programs) {
  vm::Program stacks;
  stacks.locals = 2;
  stacks.append(Opcode::Sphere, 0, {0.7}, {});
  stacks.append(Opcode::Tee, 1, {}, {});
  stacks.append(Opcode::Tag, 3, {}, {});
  stacks.append(Opcode::Translate, 0, {0.3, 0.1, -0.2}, {});
  stacks.append(Opcode::Twist, 0, {1.7}, {});
  stacks.append(Opcode::Box, 0, {0.4, 0.5, 0.6}, {});
  stacks.append(Opcode::Drop, 0, {}, {});
  stacks.append(Opcode::Torus, 0, {0.8, 0.2}, {});
  stacks.append(Opcode::Drop, 0, {}, {});
  stacks.append(Opcode::SmoothMin, 0, {0.2, 1.25}, {});
  stacks.append(Opcode::Load, 1, {}, {});
  stacks.append(Opcode::Subtract, 0, {}, {});
  stacks.append(Opcode::Mix, 0, {0.3}, {});
  stacks.append(Opcode::Add, vm::operand_of(vm::Sources{Source::Stack, Source::Local, 1}), {}, {});
  programs.push_back(named("stacks", std::move(stacks)));

  const auto shape = [&](const char* name, Opcode opcode, const std::vector<double>& immediates,
                         glm::dvec3 origin = glm::dvec3(0)) {
    vm::Program program;
    program.append(opcode, 0, immediates, {});
    programs.push_back(named(name, std::move(program), origin));
  };
  shape("mandelbulb", Opcode::Mandelbulb, {8, 12, 16, 1.104, 0.0005});
  shape("mandelbulb_once", Opcode::Mandelbulb, {3, 1, 16, 1.104, 0.0005});
  shape("julia", Opcode::Julia, {-0.2, 0.6, 0.1, 0.3, 11, 2.1, 40, 0.001});
  shape("menger", Opcode::MengerSponge, {1, 4});
  shape("ellipse", Opcode::Ellipse, {1.2, 0.4, 1.28, 1});
  shape("clockwise", Opcode::Polygon, {0, 0, 0, 1.1, 0.9, 1, 0.5, 0.5, 0.9, 0});
  shape("far", Opcode::Sphere, {0.6}, {1.5, -0.3, 0.7});
}

void add_random_scenes(std::vector<EmittedProgram>& programs) {
  for (int i = 0; i < kRandomScenes; ++i) {
    Random random(static_cast<std::uint64_t>(7000 + i));
    GraphOptions options;
    options.mandelbulbs = i % 4 == 0;
    const compiler::Scene scene = random_scene(random, options);
    const compiler::Source source("random", "");
    programs.push_back(named(fmt::format("random_{}", i), compiler::fuse(*compiler::lower(scene, source, 100000))));
  }
}

}  // namespace

std::vector<EmittedProgram> emitted_programs() {
  std::vector<EmittedProgram> programs;
  Random random(41);
  add_opcodes(programs, random);
  add_operands(programs, random);
  add_choices(programs, random);
  add_rows(programs, random);
  add_odd_rows(programs);
  add_others(programs);
  add_random_scenes(programs);
  return programs;
}

}  // namespace fathom::test
