// The functions that asmjit calls when its own assertions fail. Debian's libasmjit.a has them in an object that uses
// stderr in a way that no shared library can. The linker takes that object only for functions that are not defined
// elsewhere.
#include <asmjit/core.h>

#include <cstdlib>

namespace asmjit {

const char* DebugUtils::errorAsString(Error) noexcept { return "asmjit error"; }
void DebugUtils::debugOutput(const char*) noexcept {}
void DebugUtils::assertionFailed(const char*, int, const char*) noexcept { std::abort(); }

}  // namespace asmjit
