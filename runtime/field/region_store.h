// Regions that outlive a render, for a caller that renders many images of scenes with the same programs, e.g. with a
// camera that goes round or a light that moves. Regions are a function of program, box and options, so stored regions
// equal the regions that would be built.
//
// For use by one thread. Tested by: tests/runtime/field/region_store_test.cpp
#pragma once

#include <list>
#include <memory>

#include "runtime/field/regions.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

class RegionStore {
 public:
  // Like Regions::build(), but returns the regions stored for the same program, box and options if there are any.
  std::shared_ptr<const Regions> build(const vm::VerifiedProgram& program, const compiler::Box& contents,
                                       const RegionOptions& options);

  // True if the store already held `regions` when build() last returned them.
  bool reused(const Regions& regions) const;

  // Drops the regions that build() has not returned since the last call.
  void drop_unused();

 private:
  struct Entry {
    vm::VerifiedProgram program;  // the regions refer to this program
    compiler::Box contents;
    RegionOptions options;
    // Null if the scene has no regions, which may have taken as long to find out.
    std::shared_ptr<const Regions> regions;
    bool used = true, reused = false;
  };

  std::list<std::shared_ptr<Entry>> entries_;
};

}  // namespace fathom::runtime
