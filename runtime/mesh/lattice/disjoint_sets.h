// Sets of numbered elements that are joined one by one.
// Tested by: tests/runtime/mesh/mesh_measures_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace fathom::runtime {

// Disjoint sets with path halving (Tarjan, "Efficiency of a good but not linear set union algorithm", 1975). The root
// of a set is its least element.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

  std::size_t size() const { return parents_.size(); }
  std::uint32_t add() {
    parents_.push_back(static_cast<std::uint32_t>(parents_.size()));
    return parents_.back();
  }
  std::uint32_t root(std::uint32_t v) {
    while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
    return v;
  }
  // Returns false if both were in one set already.
  bool join(std::uint32_t u, std::uint32_t v) {
    u = root(u), v = root(v);
    if (u == v) return false;
    if (u > v) std::swap(u, v);
    parents_[v] = u;
    return true;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace fathom::runtime
