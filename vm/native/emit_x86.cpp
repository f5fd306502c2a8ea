#include "vm/native/emit_x86.h"

#include <asmjit/x86.h>

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "vm/native/register_file.h"
#include "vm/prune/program_template.h"

namespace fathom::vm {
namespace {

namespace x86 = asmjit::x86;
using asmjit::Operand;
namespace Inst = x86::Inst;

// Comparisons that are false for NaN and raise no exception, and the one that is true for NaN.
constexpr int kLess = 0x11, kGreater = 0x1e, kUnordered = 0x03;
// Rounding without exceptions.
constexpr int kNearest = 8, kDown = 9, kUp = 10;

// Layout of a float as split_power_of_two() in vm/number/batch-inl.h has it.
constexpr int kMantissaBits = 23;
constexpr std::uint32_t kExponentBias = 127, kRootHalf = 0x3f3504f3;
constexpr float kMinNormal = 0x1p-126f, kSubnormalScale = 0x1p24f, kSubnormalShift = 24;

constexpr int kMaxSlots = 4096;  // a quarter of a megabyte of the thread's stack

class FailureFlag : public asmjit::ErrorHandler {
 public:
  void handleError(asmjit::Error, const char*, asmjit::BaseEmitter*) override { failed_ = true; }
  bool failed() const { return failed_; }

 private:
  bool failed_ = false;
};

class Emitter {
 public:
  Emitter(const OperationGraph& graph, NativeIsa isa, asmjit::CodeHolder& holder)
      : graph_(graph), wide_(isa == NativeIsa::Avx512), file_(graph, wide_ ? 29 : 13), a_(&holder) {}

  int slots() const { return file_.slots(); }
  // Emits the code. Returns its constants.
  std::vector<float> run() {
    const auto frame = prologue();
    const asmjit::Label loop = a_.newLabel();
    a_.bind(loop);
    for (std::uint32_t at = 0; at < graph_.nodes.size(); ++at) {
      at_ = at;
      const OperationNode& node = graph_.nodes[at];
      if (node.kind == OperationNode::Kind::Operation && !node.is_mask()) operation(node);
    }
    store_results();
    a_.add(kOffset, static_cast<int>(width()));
    a_.cmp(kOffset, kEnd);
    a_.jb(loop);
    epilogue();
    // The number of slots is known only now.
    const std::size_t end = a_.offset();
    a_.setOffset(frame);
    a_.sub(x86::rsp, asmjit::imm(file_.slots() * static_cast<int>(width()) + kNotShort));
    a_.setOffset(end);
    return std::move(constants_);
  }

 private:
  static constexpr x86::Gp kInputs[3] = {x86::rsi, x86::rdx, x86::rcx};
  static constexpr x86::Gp kConstants = x86::r8, kOffset = x86::r9, kEnd = x86::r10, kRow = x86::r11;
  static constexpr int kNotShort = 4096;  // so that the frame's size always takes four bytes of code

  std::size_t width() const { return wide_ ? 64 : 32; }
  Operand reg(int id) const {
    const auto n = static_cast<std::uint32_t>(id);
    return wide_ ? static_cast<Operand>(x86::zmm(n)) : static_cast<Operand>(x86::ymm(n));
  }
  // Registers that the file does not have.
  Operand scratch(int i) const { return reg(wide_ ? 29 + i : 13 + i); }

  std::size_t prologue() {
    a_.push(x86::rbp);
    a_.mov(x86::rbp, x86::rsp);
    const std::size_t frame = a_.offset();
    a_.sub(x86::rsp, asmjit::imm(kNotShort));
    a_.and_(x86::rsp, asmjit::imm(-64));
    for (int axis = 0; axis < 3; ++axis) load_pointer(kInputs[axis], offsetof(NativeArguments, inputs) + axis * 8u);
    load_pointer(kConstants, offsetof(NativeArguments, constants));
    load_pointer(kEnd, offsetof(NativeArguments, bytes));
    load_pointer(kRow, offsetof(NativeArguments, row));
    a_.xor_(x86::r9d, x86::r9d);
    return frame;
  }
  void load_pointer(x86::Gp to, std::size_t offset) { a_.mov(to, x86::ptr(x86::rdi, static_cast<int>(offset))); }
  void epilogue() {
    a_.vzeroupper();
    a_.mov(x86::rsp, x86::rbp);
    a_.pop(x86::rbp);
    a_.ret();
  }

  // A constant as an operand in memory: one float that AVX-512 broadcasts, a whole register for AVX2.
  Operand constant_bits(std::uint32_t bits) {
    const std::size_t copies = wide_ ? 1 : 8;
    const auto [found, is_new] = constant_at_.try_emplace(bits, constants_.size());
    if (is_new) constants_.insert(constants_.end(), copies, std::bit_cast<float>(bits));
    const x86::Mem at = x86::ptr(kConstants, static_cast<int>(found->second * sizeof(float)));
    return wide_ ? at._1to16() : at;
  }
  Operand constant(float value) { return constant_bits(std::bit_cast<std::uint32_t>(value)); }

  void emit(asmjit::InstId id, const Operand& to, const Operand& a) { a_.emit(id, to, a); }
  void emit(asmjit::InstId id, const Operand& to, const Operand& a, const Operand& b) { a_.emit(id, to, a, b); }
  void emit(asmjit::InstId id, const Operand& to, const Operand& a, int immediate) {
    a_.emit(id, to, a, asmjit::imm(immediate));
  }

  // The node's value as an operand that may lie in memory.
  Operand anywhere(std::uint32_t node) {
    if (file_.register_of(node) != RegisterFile::kNone) return reg(file_.register_of(node));
    const OperationNode& value = graph_.nodes[node];
    if (value.kind == OperationNode::Kind::Constant) return constant(value.constant);
    if (value.kind == OperationNode::Kind::Input) return input(value.operands[0]);
    return slot(file_.slot_of(node));
  }
  static Operand input(std::uint32_t number) {
    if (number < 3) return x86::ptr(kInputs[number], kOffset);
    return x86::ptr(kRow, kOffset, 0, static_cast<int>((number - 3) * kRowStride * sizeof(float)));
  }
  Operand slot(int index) const { return x86::ptr(x86::rsp, index * static_cast<int>(width())); }
  bool in_register(std::uint32_t node) const { return file_.register_of(node) != RegisterFile::kNone; }

  // The node's value in a register, into which it is loaded if it lies in memory.
  Operand loaded(std::uint32_t node) {
    if (in_register(node)) return reg(file_.register_of(node));
    const Operand from = anywhere(node);
    const Operand to = take(node);
    load(to, from, graph_.nodes[node].kind == OperationNode::Kind::Constant);
    return to;
  }
  void load(const Operand& to, const Operand& from, bool is_constant) {
    if (!is_constant || !wide_) return emit(Inst::kIdVmovups, to, from);
    emit(Inst::kIdVbroadcastss, to, x86::ptr(kConstants, static_cast<int>(from.as<x86::Mem>().offset())));
  }
  Operand take(std::uint32_t node) {
    const RegisterFile::Taken taken = file_.take(node, reads_);
    if (taken.spills) emit(Inst::kIdVmovaps, slot(taken.slot), reg(taken.spilled_reg));
    return reg(taken.reg);
  }

  // Takes the result's register, after the registers of operands that are read for the last time.
  Operand result() {
    file_.end_uses(reads_, at_);
    reads_.clear();
    return take(at_);
  }

  void operation(const OperationNode& node) {
    reads_ = RegisterFile::reads_of(graph_, at_);
    // Coordinates are read often, so they are worth a register.
    for (const std::uint32_t read : reads_) {
      if (graph_.nodes[read].kind == OperationNode::Kind::Input && graph_.nodes[read].operands[0] < 3) loaded(read);
    }
    switch (node.operation) {
      case Operation::Add:
        return commutative(Inst::kIdVaddps, node);
      case Operation::Multiply:
        return commutative(Inst::kIdVmulps, node);
      case Operation::Subtract:
        return binary(Inst::kIdVsubps, node.operands[0], node.operands[1]);
      case Operation::Divide:
        return binary(Inst::kIdVdivps, node.operands[0], node.operands[1]);
      case Operation::Min:
        return binary(Inst::kIdVminps, node.operands[0], node.operands[1]);
      case Operation::Max:
        return binary(Inst::kIdVmaxps, node.operands[0], node.operands[1]);
      case Operation::Negate:
        return with_bits(Inst::kIdVxorps, node, 0x80000000);
      case Operation::Abs:
        return with_bits(Inst::kIdVandps, node, 0x7fffffff);
      case Operation::Sqrt: {
        const Operand a = anywhere(node.operands[0]);
        return emit(Inst::kIdVsqrtps, result(), a);
      }
      case Operation::Floor:
        return round(node, kDown);
      case Operation::Ceil:
        return round(node, kUp);
      case Operation::Nearest:
        return round(node, kNearest);
      case Operation::Select:
        return select(node);
      case Operation::PowerOfTwo:
        return power_of_two(node);
      case Operation::Mantissa:
      case Operation::Exponent:
        return split(node);
      default:
        return;  // composed operations are expanded, masks are computed where they are used
    }
  }

  void binary(asmjit::InstId id, std::uint32_t left, std::uint32_t right) {
    const Operand a = loaded(left), b = anywhere(right);
    emit(id, result(), a, b);
  }
  void commutative(asmjit::InstId id, const OperationNode& node) {
    const std::uint32_t a = node.operands[0], b = node.operands[1];
    in_register(a) ? binary(id, a, b) : binary(id, b, a);
  }
  void with_bits(asmjit::InstId id, const OperationNode& node, std::uint32_t bits) {
    const Operand a = loaded(node.operands[0]);
    emit(id, result(), a, constant_bits(bits));
  }
  // Adds 0, as the functions of vm/number/batch-inl.h do.
  void round(const OperationNode& node, int mode) {
    const Operand a = loaded(node.operands[0]);
    const Operand to = result();
    emit(wide_ ? Inst::kIdVrndscaleps : Inst::kIdVroundps, to, a, mode);
    emit(Inst::kIdVaddps, to, to, constant(0));
  }
  void power_of_two(const OperationNode& node) {
    const Operand n = anywhere(node.operands[0]);
    const Operand to = result();
    emit(Inst::kIdVcvttps2dq, to, n);
    emit(Inst::kIdVpaddd, to, to, constant_bits(kExponentBias));
    emit(Inst::kIdVpslld, to, to, kMantissaBits);
  }
  void split(const OperationNode& node) {
    const Operand x = loaded(node.operands[0]);
    const Operand normal = scratch(0), exponent = scratch(1);
    emit(Inst::kIdVmulps, normal, x, constant(kSubnormalScale));
    const Operand mask = compare(x, constant(kMinNormal), kLess);
    blend(normal, mask, normal, x);
    emit(Inst::kIdVpsubd, exponent, normal, constant_bits(kRootHalf));
    emit(Inst::kIdVpsrad, exponent, exponent, kMantissaBits);
    const Operand to = result();
    if (node.operation == Operation::Mantissa) {
      emit(Inst::kIdVpslld, exponent, exponent, kMantissaBits);
      return emit(Inst::kIdVpsubd, to, normal, exponent);
    }
    emit(Inst::kIdVcvtdq2ps, exponent, exponent);
    emit(Inst::kIdVsubps, normal, exponent, constant(kSubnormalShift));
    blend(to, mask, normal, exponent);
  }

  // Returns the mask: of AVX-512 a mask register, of AVX2 a scratch register.
  Operand compare(const Operand& a, const Operand& b, int predicate) {
    const Operand mask = wide_ ? static_cast<Operand>(x86::k1) : scratch(2);
    a_.emit(Inst::kIdVcmpps, mask, a, b, asmjit::imm(predicate));
    return mask;
  }
  void blend(const Operand& to, const Operand& mask, const Operand& yes, const Operand& no) {
    if (wide_) {
      a_.k(mask.as<x86::KReg>());
      return emit(Inst::kIdVblendmps, to, no, yes);
    }
    a_.emit(Inst::kIdVblendvps, to, no, yes, mask);
  }
  void select(const OperationNode& node) {
    const OperationNode& mask = graph_.nodes[node.operands[0]];
    const Operand no = loaded(node.operands[2]);
    std::uint32_t a = mask.operands[0], b = mask.operands[1];
    int predicate = kLess;
    if (mask.operation == Operation::IsNan) {
      b = a, predicate = kUnordered;
    } else if (!in_register(a)) {
      std::swap(a, b), predicate = kGreater;
    }
    const Operand left = loaded(a), right = anywhere(b);
    const Operand computed = compare(left, right, predicate);
    const Operand yes = anywhere(node.operands[1]);
    blend(result(), computed, yes, no);
  }

  void store_results() {
    at_ = static_cast<std::uint32_t>(graph_.nodes.size());
    reads_ = graph_.results;
    for (std::size_t i = 0; i < graph_.results.size(); ++i) {
      const Operand value = loaded(graph_.results[i]);
      load_pointer(x86::rax, offsetof(NativeArguments, results) + i * sizeof(float*));
      emit(Inst::kIdVmovups, x86::ptr(x86::rax, kOffset), value);
    }
    file_.end_uses(reads_, at_);
  }

  const OperationGraph& graph_;
  const bool wide_;
  RegisterFile file_;
  x86::Assembler a_;
  std::vector<float> constants_;
  std::unordered_map<std::uint32_t, std::size_t> constant_at_;
  std::uint32_t at_ = 0;
  std::vector<std::uint32_t> reads_;  // nodes that the current operation reads
};

}  // namespace

NativeCode emit_x86(const OperationGraph& graph, NativeIsa isa) {
  const asmjit::Environment environment = asmjit::Environment::host();
  FailureFlag failure;
  asmjit::CodeHolder holder;
  if (holder.init(environment) != asmjit::kErrorOk) return {};
  holder.setErrorHandler(&failure);
  Emitter emitter(graph, isa, holder);
  NativeCode code;
  code.constants = emitter.run();
  if (failure.failed() || emitter.slots() > kMaxSlots) return {};
  if (holder.flatten() != asmjit::kErrorOk || holder.resolveUnresolvedLinks() != asmjit::kErrorOk) return {};
  const auto& bytes = holder.textSection()->buffer();
  code.bytes.assign(bytes.data(), bytes.data() + bytes.size());
  return code;
}

}  // namespace fathom::vm
