// CHECK: the one way to say "this cannot happen unless we have a bug".
// Prints the condition, the place and a remark, and aborts; active in every build type. Not for user mistakes
// (compiler/source/diagnostics.h) nor for untrusted programs (vm/program/verify.h).
#pragma once

namespace fathom {

[[noreturn]] void check_failed(const char* condition, const char* file, int line, const char* remark);

}  // namespace fathom

#define CHECK(condition, remark) \
  ((condition) ? static_cast<void>(0) : ::fathom::check_failed(#condition, __FILE__, __LINE__, remark))
