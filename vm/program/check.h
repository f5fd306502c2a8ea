// CHECK: asserts a condition that only a bug in fathom can violate.
// On failure CHECK prints the condition, its file and line and a remark, and aborts. CHECK is active in every build
// type. User mistakes go to compiler/source/diagnostics.h, untrusted programs to vm/program/verify.h.
#pragma once

namespace fathom {

[[noreturn]] void check_failed(const char* condition, const char* file, int line, const char* remark);

}  // namespace fathom

#define CHECK(condition, remark) \
  ((condition) ? static_cast<void>(0) : ::fathom::check_failed(#condition, __FILE__, __LINE__, remark))
