#include "vm/interpret/workspace.h"

#include <new>

namespace fathom::vm {

void* Workspace::reserve(std::size_t bytes) {
  if (bytes > size_) {
    const std::size_t larger = bytes + bytes / 2;
    memory_.reset(::operator new(larger, std::align_val_t(64)));
    size_ = larger;
  }
  return memory_.get();
}

void Workspace::Free::operator()(void* memory) const { ::operator delete(memory, std::align_val_t(64)); }

}  // namespace fathom::vm
