// Memory of the interpreter.
#pragma once

#include <cstddef>
#include <memory>

namespace fathom::vm {

// Scratch memory for the stacks. A Workspace grows to the largest program run in it. Not thread safe: use one per
// thread.
class Workspace {
 public:
  // Returns at least `bytes` bytes, aligned to 64. Their previous contents are lost.
  void* reserve(std::size_t bytes);

 private:
  struct Free {
    void operator()(void* memory) const;
  };
  std::unique_ptr<void, Free> memory_;
  std::size_t size_ = 0;
};

}  // namespace fathom::vm
