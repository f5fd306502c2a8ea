// Formulas for the tests of scalar mathematics: programs of leaves and of functions of one, two and three numbers,
// random or written by hand.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test {

struct Step {
  vm::Opcode opcode;
  std::vector<double> immediates = {};
};

inline vm::VerifiedProgram formula(const std::vector<Step>& steps) {
  vm::Program code;
  for (const Step& step : steps) code.append(step.opcode, 0, step.immediates, {});
  return verified(std::move(code));
}

// Appends a random tree with about `size` operations over x, y, z and constants, in the order of evaluation.
inline void append_random_formula(Random& random, int size, std::vector<Step>& steps) {
  using vm::Opcode;
  static const Opcode kUnary[] = {Opcode::Abs,  Opcode::Square, Opcode::Sqrt, Opcode::Sin,    Opcode::Cos,
                                  Opcode::Tan,  Opcode::Asin,   Opcode::Acos, Opcode::Atan,   Opcode::Exp,
                                  Opcode::Log,  Opcode::Floor,  Opcode::Ceil, Opcode::Sign,   Opcode::Not,
                                  Opcode::Sqrt, Opcode::Abs,    Opcode::Sin,  Opcode::Negate, Opcode::Nearest};
  static const Opcode kBinary[] = {
      Opcode::Add,   Opcode::Minus,   Opcode::Multiply, Opcode::Divide, Opcode::Modulo,      Opcode::Atan2,
      Opcode::Power, Opcode::Compare, Opcode::And,      Opcode::Or,     Opcode::Step,        Opcode::Min,
      Opcode::Max,   Opcode::Add,     Opcode::Multiply, Opcode::Minus,  Opcode::ModuloEuclid};
  if (size <= 0) {
    const int leaf = random.below(5);
    if (leaf < 3) {
      steps.push_back({leaf == 0 ? Opcode::X : leaf == 1 ? Opcode::Y : Opcode::Z});
    } else {
      steps.push_back({Opcode::Constant, {leaf == 3 ? random.below(7) - 3 : random.uniform(-2, 2)}});
    }
  } else if (random.chance(0.06)) {
    const int first = random.below(size), second = random.below(size - first);
    append_random_formula(random, first, steps);
    append_random_formula(random, second, steps);
    append_random_formula(random, size - 1 - first - second, steps);
    steps.push_back({Opcode::Noise});
  } else if (random.chance(0.5)) {
    append_random_formula(random, size - 1, steps);
    steps.push_back({kUnary[random.below(20)]});
  } else {
    const int left = random.below(size);
    append_random_formula(random, left, steps);
    append_random_formula(random, size - 1 - left, steps);
    steps.push_back({kBinary[random.below(17)]});
  }
}

inline std::vector<Step> random_formula(std::uint64_t seed) {
  Random random(seed);
  std::vector<Step> steps;
  append_random_formula(random, 1 + random.below(6), steps);
  return steps;
}

// Appends a random smooth union by exponentials of a plane and a quotient that is infinite on a plane.
inline void append_pole(Random& random, std::vector<Step>& steps) {
  using vm::Opcode;
  static const double kSharpness[] = {0.5, 3, 11, 30};
  const double k = kSharpness[random.below(4)] * (random.chance(0.8) ? -1 : 1);
  steps.push_back({Opcode::Constant, {random.chance(0.5) ? 0.1 : random.uniform(-2, 2)}});
  steps.push_back({Opcode::X});
  steps.push_back({Opcode::Y});
  steps.push_back({Opcode::Scale, {random.below(3) * 0.4}});
  steps.push_back({Opcode::Add});
  steps.push_back({Opcode::Offset, {random.below(3) - 1.0}});
  steps.push_back({Opcode::Divide});
  if (random.chance(0.3)) steps.push_back({Opcode::Offset, {random.uniform(-1, 1)}});
  if (random.chance(0.8)) steps.push_back({Opcode::Abs});
  if (random.chance(0.5)) {
    steps.push_back({Opcode::Z});
    steps.push_back({random.chance(0.5) ? Opcode::Add : Opcode::Minus});
  }
  if (random.chance(0.2)) steps.push_back({Opcode::Negate});
  if (random.chance(0.5)) {
    steps.push_back({random.chance(0.5) ? Opcode::Y : Opcode::Z});
    steps.push_back({random.chance(0.7) ? Opcode::Max : Opcode::Min});
  }
  steps.push_back({Opcode::Scale, {k}});
  steps.push_back({Opcode::Exp});
  steps.push_back({Opcode::X});
  steps.push_back({Opcode::Scale, {k}});
  steps.push_back({Opcode::Exp});
  steps.push_back({Opcode::Add});
  steps.push_back({Opcode::Log});
  steps.push_back({Opcode::Scale, {1 / k}});
}

// Appends a random function of repeated cells or sectors, most of which are continuous from one to the next.
inline void append_cells(Random& random, std::vector<Step>& steps) {
  using vm::Opcode;
  static const double kPeriods[] = {1, 0.25, 0.9, 0.3, 2};
  const bool sectors = random.chance(0.3);
  const double period = sectors ? 2 * M_PI / (1 + random.below(12)) : kPeriods[random.below(5)];
  steps.push_back({Opcode::X});
  steps.push_back({random.chance(0.5) ? Opcode::Y : Opcode::Z});
  if (sectors) {
    steps.push_back({Opcode::Atan2});
  } else {
    steps.push_back({Opcode::Scale, {random.below(3) * 0.4}});
    steps.push_back({Opcode::Add});
    steps.push_back({Opcode::Scale, {random.chance(0.2) ? 40 : random.uniform(-2, 2)}});
  }
  if (sectors && random.chance(0.3)) {
    steps.push_back({Opcode::Scale, {1.0 + random.below(9)}});
    steps.push_back({Opcode::Z});
    steps.push_back({Opcode::Add});
    steps.push_back({random.chance(0.5) ? Opcode::Sin : Opcode::Cos});
    return;
  }
  steps.push_back({Opcode::Constant, {period}});
  steps.push_back({random.chance(0.8) ? Opcode::Modulo : Opcode::ModuloEuclid});
  steps.push_back({Opcode::Offset, {random.chance(0.8) ? period / 2 : 0.4 * period}});
  if (random.chance(0.3)) steps.push_back({Opcode::Scale, {random.uniform(-2, 2)}});
  steps.push_back({random.chance(0.5) ? Opcode::Abs : Opcode::Square});
  steps.push_back({random.chance(0.5) ? Opcode::Y : Opcode::Z});
  if (random.chance(0.5)) steps.push_back({Opcode::Square});
  steps.push_back({random.chance(0.5) ? Opcode::Add : random.chance(0.5) ? Opcode::Max : Opcode::Minus});
  if (random.chance(0.4)) steps.push_back({Opcode::Sqrt});
}

// Appends a random tree of smooth unions by exponentials, similar ones and hard unions, over distances from axes and
// planes.
inline void append_exponentials(Random& random, int size, std::vector<Step>& steps) {
  static const vm::Opcode kAxes[] = {vm::Opcode::X, vm::Opcode::Y, vm::Opcode::Z};
  static const double kSharpness[] = {0.5, 3, 11, 30, 100};
  if (size <= 0) {
    const int axis = random.below(3);
    steps.push_back({kAxes[axis]});
    if (random.chance(0.5)) {
      steps.push_back({vm::Opcode::Square});
      steps.push_back({kAxes[(axis + 1) % 3]});
      steps.push_back({vm::Opcode::Square});
      steps.push_back({vm::Opcode::Add});
      steps.push_back({vm::Opcode::Sqrt});
    }
    steps.push_back({vm::Opcode::Offset, {random.uniform(-1, 2)}});
    return;
  }
  const int left = random.below(size);
  if (random.chance(0.2)) {
    append_exponentials(random, left, steps);
    append_exponentials(random, size - 1 - left, steps);
    steps.push_back({random.chance(0.5) ? vm::Opcode::Min : vm::Opcode::Max});
    return;
  }
  const double k = kSharpness[random.below(5)] * (random.chance(0.7) ? -1 : 1);
  append_exponentials(random, left, steps);
  steps.push_back({vm::Opcode::Scale, {k}});
  steps.push_back({vm::Opcode::Exp});
  if (random.chance(0.2)) {
    steps.push_back({vm::Opcode::Constant, {random.uniform(1e-3, 2)}});
  } else {
    append_exponentials(random, size - 1 - left, steps);
    steps.push_back({vm::Opcode::Scale, {k}});
    steps.push_back({vm::Opcode::Exp});
  }
  steps.push_back({random.chance(0.8)   ? vm::Opcode::Add
                   : random.chance(0.5) ? vm::Opcode::Multiply
                                        : vm::Opcode::Divide});
  steps.push_back({vm::Opcode::Log});
  steps.push_back({vm::Opcode::Scale, {1 / k}});
}

inline std::string text_of(const std::vector<Step>& steps) {
  std::string text;
  for (const Step& step : steps) {
    text += std::string(vm::info(step.opcode).mnemonic) + ' ';
    for (double k : step.immediates) text += std::to_string(k) + ' ';
  }
  return text;
}

// Returns the programs of all subexpressions except leaves. A formula is defined where all of them are finite.
inline std::vector<vm::VerifiedProgram> subexpressions(const std::vector<Step>& steps) {
  std::vector<vm::VerifiedProgram> programs;
  std::vector<std::size_t> starts;  // first step of each operand on the stack
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const vm::Form form = vm::info(steps[i].opcode).form;
    if (form == vm::Form::Shape) {
      starts.push_back(i);
      continue;
    }
    for (int n = 1; n < vm::info(steps[i].opcode).effect.values_needed; ++n) starts.pop_back();
    const auto first = steps.begin() + static_cast<std::ptrdiff_t>(starts.back());
    programs.push_back(formula({first, steps.begin() + static_cast<std::ptrdiff_t>(i) + 1}));
  }
  return programs;
}
inline bool defined_at(const std::vector<vm::VerifiedProgram>& parts, glm::dvec3 p, vm::Workspace& workspace) {
  for (const auto& part : parts) {
    if (!std::isfinite(vm::evaluate_distance(part, p, workspace))) return false;
  }
  return true;
}

inline float evaluate_float(const vm::VerifiedProgram& program, glm::vec3 p, vm::Workspace& workspace) {
  float value;
  vm::evaluate_distance(program, {&p.x, &p.y, &p.z}, 1, &value, workspace);
  return value;
}

}  // namespace fathom::test
