#include "vm/native/native_program.h"

#include <algorithm>
#include <cstring>

#include "vm/interpret/evaluate.h"

#ifdef FATHOM_NATIVE
#include <asmjit/core.h>

#include "vm/native/emit_x86.h"
#include "vm/native/operation_graph.h"
#include "vm/program/opcode_rows.h"
#endif

namespace fathom::vm {
namespace {

constexpr std::size_t kMaxLanes = 16;

#ifdef FATHOM_NATIVE
// Maximum length of a program, multiply-adds and operations: about half a megabyte of code, which streams from the
// second-level cache. Bounds the memory that an untrusted program takes while it is recorded.
constexpr std::uint32_t kMaxCost = 1 << 14;
constexpr std::size_t kMaxOperations = 1 << 15;
// Operations of a surface program per operation of the distance: a value, three derivatives, a radius and a tag.
constexpr std::uint32_t kSurfaceCost = 6;

// True if an instruction has an integer immediate, its number of iterations.
bool iterates(const Program& program) {
  for (std::size_t at = 0; at < program.words.size(); at += 1 + immediates_of(program.words[at])) {
    if (row_of(program.words[at]).has_integers) return true;
  }
  return false;
}
#endif

}  // namespace

#ifdef FATHOM_NATIVE

std::vector<NativeIsa> NativeProgram::available() {
  const std::string_view name = isa_name();
  if (name == "avx512") return {NativeIsa::Avx512, NativeIsa::Avx2};
  if (name == "avx2") return {NativeIsa::Avx2};
  return {};
}

std::shared_ptr<const NativeProgram> NativeProgram::compile(const VerifiedProgram& program, RecordedResults results,
                                                            NativeIsa isa) {
  const std::uint32_t max_cost = results == RecordedResults::Surface ? kMaxCost / kSurfaceCost : kMaxCost;
  if (program.cost() > max_cost || iterates(program.program())) return nullptr;
  return emit(record_program(program, results), isa);
}

std::shared_ptr<const NativeProgram> NativeProgram::compile_rows(const ProgramTemplate& program_template) {
  const std::vector<NativeIsa> isas = available();
  if (isas.empty() || program_template.words.size() > kMaxCost) return nullptr;
  return emit(record_program(program_template, RecordedResults::DistanceOfRow), isas.front());
}

std::shared_ptr<const NativeProgram> NativeProgram::emit(const RecordedFunction& function, NativeIsa isa) {
  namespace memory = asmjit::VirtMem;
  const auto graph = make_operation_graph(function, kMaxOperations);
  if (!graph) return nullptr;
  NativeCode code = emit_x86(*graph, isa);
  if (code.bytes.empty()) return nullptr;

  std::shared_ptr<NativeProgram> native(new NativeProgram);
  const std::size_t page = memory::info().pageSize;
  const std::size_t mapped = (code.bytes.size() + page - 1) / page * page;
  if (memory::alloc(&native->code_, mapped, memory::MemoryFlags::kAccessReadWrite) != asmjit::kErrorOk)
    return nullptr;
  native->mapped_bytes_ = mapped;
  native->code_bytes_ = code.bytes.size();
  std::memcpy(native->code_, code.bytes.data(), code.bytes.size());
  if (memory::protect(native->code_, mapped, memory::MemoryFlags::kAccessRX) != asmjit::kErrorOk) return nullptr;
  native->constants_ = std::move(code.constants);
  native->results_ = graph->results.size();
  native->lanes_ = isa == NativeIsa::Avx512 ? 16 : 8;
  return native;
}

NativeProgram::~NativeProgram() {
  if (mapped_bytes_ > 0) asmjit::VirtMem::release(code_, mapped_bytes_);
}

void NativeProgram::run(Points points, std::size_t count, std::array<float*, kMaxResults> results) const {
  const auto code = reinterpret_cast<NativeFunction>(code_);
  const std::size_t whole = count / lanes_ * lanes_, rest = count - whole;
  NativeArguments arguments{{points.x, points.y, points.z}, constants_.data(), whole * sizeof(float), {}, nullptr};
  std::copy(results.begin(), results.end(), arguments.results);
  if (whole > 0) code(&arguments);
  if (rest == 0) return;
  // Lanes past the end repeat the last point.
  alignas(64) float inputs[3][kMaxLanes], last[kMaxResults][kMaxLanes];
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    const std::size_t from = whole + std::min(lane, rest - 1);
    inputs[0][lane] = points.x[from], inputs[1][lane] = points.y[from], inputs[2][lane] = points.z[from];
  }
  for (int axis = 0; axis < 3; ++axis) arguments.inputs[axis] = inputs[axis];
  for (std::size_t i = 0; i < kMaxResults; ++i) arguments.results[i] = last[i];
  arguments.bytes = lanes_ * sizeof(float);
  code(&arguments);
  for (std::size_t i = 0; i < results_; ++i) std::copy_n(last[i], rest, results[i] + whole);
}

void NativeProgram::evaluate(Points points, std::size_t count, float* distance, float* convex) const {
  run(points, count, {distance, convex});
}

void NativeProgram::evaluate_rows(Points points, std::size_t count, const float* constants, float* distance) const {
  const std::size_t whole = (count + lanes_ - 1) / lanes_ * lanes_;
  const NativeArguments arguments{
      {points.x, points.y, points.z}, constants_.data(), whole * sizeof(float), {distance}, constants};
  reinterpret_cast<NativeFunction>(code_)(&arguments);
}

void NativeProgram::evaluate_surface(Points points, std::size_t count, SurfaceValues out) const {
  constexpr std::size_t kBlock = 256;
  alignas(64) float surfaces[kBlock], convex[kBlock];
  for (std::size_t at = 0; at < count; at += kBlock) {
    const std::size_t size = std::min(kBlock, count - at);
    run({points.x + at, points.y + at, points.z + at}, size,
        {out.distance + at, out.gradient_x + at, out.gradient_y + at, out.gradient_z + at,
         out.convex != nullptr ? out.convex + at : convex, surfaces});
    std::transform(surfaces, surfaces + size, out.surface + at,
                   [](float s) { return s < 0 ? 0 : static_cast<std::uint32_t>(s); });
  }
}

#else

std::vector<NativeIsa> NativeProgram::available() { return {}; }
std::shared_ptr<const NativeProgram> NativeProgram::compile_rows(const ProgramTemplate&) { return nullptr; }
void NativeProgram::evaluate_rows(Points, std::size_t, const float*, float*) const {}
std::shared_ptr<const NativeProgram> NativeProgram::compile(const VerifiedProgram&, RecordedResults, NativeIsa) {
  return nullptr;
}
NativeProgram::~NativeProgram() = default;
void NativeProgram::evaluate(Points, std::size_t, float*, float*) const {}
void NativeProgram::evaluate_surface(Points, std::size_t, SurfaceValues) const {}

#endif

std::shared_ptr<const NativeProgram> NativeProgram::compile(const VerifiedProgram& program, RecordedResults results) {
  const std::vector<NativeIsa> isas = available();
  return isas.empty() ? nullptr : compile(program, results, isas.front());
}

}  // namespace fathom::vm
