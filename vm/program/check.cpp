#include "vm/program/check.h"

#include <cstdio>
#include <cstdlib>

namespace fathom {

void check_failed(const char* condition, const char* file, int line, const char* remark) {
  std::fprintf(
      stderr,
      "internal error: %s (%s) at %s:%d\nThis is a bug in fathom; please report it with the command that led here.\n",
      remark, condition, file, line);
  std::abort();
}

}  // namespace fathom
