#include "runtime/field/region_store.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

bool same_program(const vm::Program& a, const vm::Program& b) {
  return a.words == b.words && a.doubles == b.doubles && a.locals == b.locals;
}

bool same_box(const compiler::Box& a, const compiler::Box& b) { return a.lo == b.lo && a.hi == b.hi; }

// True if all options that affect the regions are equal. The number of threads does not affect them.
bool same_options(const RegionOptions& a, const RegionOptions& b) {
  return a.memory == b.memory && a.evaluations == b.evaluations && a.always == b.always && a.room == b.room &&
         a.cancellation == b.cancellation;
}

}  // namespace

std::shared_ptr<const Regions> RegionStore::build(const vm::VerifiedProgram& program, const compiler::Box& contents,
                                                  const RegionOptions& options) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
    return same_options(entry->options, options) && same_box(entry->contents, contents) &&
           same_program(entry->program.program(), program.program());
  });
  const bool reused = found != entries_.end();
  std::shared_ptr<Entry> entry =
      reused ? *found : std::make_shared<Entry>(Entry{program, contents, options, nullptr});
  entry->options.interrupted = {};  // may refer to objects that will no longer exist
  entry->used = true;
  entry->reused = reused;
  if (!reused) {
    entry->regions = Regions::build(entry->program, contents, options);
    // An interrupted build means no regions for this render only, so the store keeps nothing.
    if (!entry->regions && options.interrupted && options.interrupted()) return nullptr;
    entries_.push_back(entry);
  }
  if (!entry->regions) return nullptr;
  return {entry, entry->regions.get()};
}

bool RegionStore::reused(const Regions& regions) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const auto& entry) { return entry->regions.get() == &regions && entry->reused; });
}

void RegionStore::drop_unused() {
  std::erase_if(entries_, [](const auto& entry) { return !entry->used; });
  for (const auto& entry : entries_) entry->used = false;
}

}  // namespace fathom::runtime
