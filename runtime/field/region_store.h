// Regions that outlive a render, for whoever renders many pictures of scenes with the same programs: of a camera that
// goes round, of a light that moves. Regions are a function of program, box and options, so those that are there
// already are those that would be built.
//
// From one thread. Tested by: tests/runtime/field/region_store_test.cpp
#pragma once

#include <list>
#include <memory>

#include "runtime/field/regions.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

class RegionStore {
 public:
  // As Regions::build(), which is asked where there are none of the same program, box and options.
  std::shared_ptr<const Regions> build(const vm::VerifiedProgram& program, const compiler::Box& contents,
                                       const RegionOptions& options);

  // Whether they were there when they were asked for last.
  bool kept(const Regions& regions) const;

  // Drops what was not asked for since the last call.
  void forget_unused();

 private:
  struct Entry {
    vm::VerifiedProgram program;  // that the regions see
    compiler::Box contents;
    RegionOptions options;
    std::shared_ptr<const Regions> regions;  // or none, which may have taken as long to find out
    bool used = true, kept = false;
  };

  std::list<std::shared_ptr<Entry>> entries_;
};

}  // namespace fathom::runtime
