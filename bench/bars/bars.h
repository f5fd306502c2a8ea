// The acceptance bars of hits, normals and the machine, measured and printed as one table. The number of each bar, B4
// to B16, and its limit stand where its row is made.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::bench {

// Prints each row as soon as it is measured.
class BarTable {
 public:
  BarTable() { print("bar", "what", "bar value", "measured", "verdict"); }

  void row(std::string_view bar, std::string_view what, std::string_view limit, std::string_view measured,
           bool holds) {
    missed_ += !holds;
    print(bar, what, limit, measured, holds ? "holds" : "misses");
  }
  // NaN misses the bar.
  void at_most(std::string_view bar, std::string_view what, double limit, double measured,
               std::string_view unit = "") {
    row(bar, what, fmt::format("<= {:.3g}{}", limit, unit), fmt::format("{:.3g}{}", measured, unit),
        measured <= limit);
  }
  // The bar: none of the `tried` cases failed. `count` is the number of failures. The printed upper limit of the
  // failure rate has 95 % confidence, 3 / n (Hanley and Lippman-Hand, "If Nothing Goes Wrong, Is Everything All
  // Right?", 1983). Zero cases tried miss the bar.
  void none(std::string_view bar, std::string_view what, std::size_t count, std::size_t tried) {
    const double most = 3e6 / static_cast<double>(tried);
    row(bar, what, "0",
        fmt::format("{} of {}{}", count, tried, count ? "" : fmt::format(" (95 % <= {:.3g} ppm)", most)),
        count == 0 && tried > 0);
  }
  int missed() const { return missed_; }

 private:
  static void print(std::string_view bar, std::string_view what, std::string_view limit, std::string_view measured,
                    std::string_view verdict) {
    fmt::print("{:<4} {:<83} {:<16} {:<36} {}\n", bar, what, limit, measured, verdict);
    std::fflush(stdout);
  }
  int missed_ = 0;
};

// Numbers of cases. kFull is what the bars ask for, the default is what a few minutes allow.
struct Counts {
  std::size_t sphere_rays = 40000, composite_rays = 500000, secondary_rays = 1000000;
  std::size_t normals = 100000, samples = 10000000;
};
inline constexpr Counts kFull{.sphere_rays = 400000,
                              .composite_rays = 1000000,
                              .secondary_rays = 10000000,
                              .normals = 10000000,
                              .samples = 100000000};

void hit_bars(BarTable& table, const Counts& counts);            // B4, B5
void composite_bars(BarTable& table, const Counts& counts);      // B6 to B9
void normal_bars(BarTable& table, const Counts& counts);         // B10, B12, B13
void random_normal_bars(BarTable& table, const Counts& counts);  // B11
void machine_bars(BarTable& table, const Counts& counts);        // B14
void range_bars(BarTable& table, const Counts& counts);          // B16

// Returns the value at k thousandths of the sorted values, or NaN when there are no values.
double permille(const std::vector<double>& sorted, std::size_t k);

}  // namespace fathom::bench
