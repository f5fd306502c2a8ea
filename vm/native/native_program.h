// Programs as machine code of this processor: one straight line of instructions per register of points, without the
// interpreter's loads and stores between instructions. The results have the interpreter's bits.
//
//     const auto native = NativeProgram::compile(program, RecordedResults::Distance);   // null: use the interpreter
//     if (native) native->evaluate(points, count, distance);
//
// The code exists for x86 with AVX2 or AVX-512; its memory is never writable and executable at once.
// Tested by: tests/vm/native/native_program_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "vm/interpret/evaluate.h"
#include "vm/native/native_isa.h"
#include "vm/program/verify.h"
#include "vm/prune/program_template.h"
#include "vm/record/record_program.h"

namespace fathom::vm {

class NativeProgram {
 public:
  // Instruction sets with native code that vm::isa_name() includes, best first.
  static std::vector<NativeIsa> available();

  // Returns null if the program is long or has loops, or if the system grants no executable memory. `isa` is one of
  // available().
  static std::shared_ptr<const NativeProgram> compile(const VerifiedProgram& program, RecordedResults results,
                                                      NativeIsa isa);
  // The same of a template's distance, for evaluate_rows() and the best available instruction set.
  static std::shared_ptr<const NativeProgram> compile_rows(const ProgramTemplate& program_template);
  // The same for the best available instruction set; null if there is none.
  static std::shared_ptr<const NativeProgram> compile(const VerifiedProgram& program, RecordedResults results);

  NativeProgram(const NativeProgram&) = delete;
  NativeProgram& operator=(const NativeProgram&) = delete;
  ~NativeProgram();

  // Computes distance[i], and convex[i] if the program was compiled for it, as evaluate_distance() and
  // evaluate_convex() do. Thread safe, as all evaluation.
  void evaluate(Points points, std::size_t count, float* distance, float* convex = nullptr) const;
  // Computes what vm::evaluate_rows() does (vm/prune/program_template.h), by code of compile_rows().
  void evaluate_rows(Points points, std::size_t count, const float* constants, float* distance) const;
  // Computes what evaluate_surface() does, by a program compiled for RecordedResults::Surface.
  void evaluate_surface(Points points, std::size_t count, SurfaceValues out) const;

  std::size_t code_bytes() const { return code_bytes_; }

 private:
  static constexpr std::size_t kMaxResults = 6;

  NativeProgram() = default;
  static std::shared_ptr<const NativeProgram> emit(const RecordedFunction& function, NativeIsa isa);
  void run(Points points, std::size_t count, std::array<float*, kMaxResults> results) const;

  std::vector<float> constants_;
  void* code_ = nullptr;
  std::size_t mapped_bytes_ = 0, code_bytes_ = 0;
  std::size_t lanes_ = 0;    // floats per register
  std::size_t results_ = 0;  // number of results
};

}  // namespace fathom::vm
