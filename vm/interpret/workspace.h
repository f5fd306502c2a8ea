// Memory that the machine runs in.
#pragma once

#include <cstddef>
#include <memory>

namespace fathom::vm {

// Scratch memory for the stacks; grows to the largest program it has seen. Not to be shared between threads.
class Workspace {
 public:
  // At least `bytes` bytes, aligned to 64; what they held before is lost.
  void* reserve(std::size_t bytes);

 private:
  struct Free {
    void operator()(void* memory) const;
  };
  std::unique_ptr<void, Free> memory_;
  std::size_t size_ = 0;
};

}  // namespace fathom::vm
