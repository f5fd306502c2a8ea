// Values of flags: text to numbers, sizes, angles and points, with a message that says what would be right.
//
// Every reader stores into its last argument and returns nullopt, or leaves it alone and returns what is wrong. A
// Setter is a reader with its target bound, ready for Arguments::option.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace fathom::cli {

struct Complaint {
  std::string problem;
  std::string help;  // may be empty
};
using Verdict = std::optional<Complaint>;

class Setter {
 public:
  template <typename F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, Setter>) Setter(F set, std::vector<std::string> words = {})
      : set_(std::move(set)), words_(std::move(words)) {}

  Verdict operator()(std::string_view text) const { return set_(text); }
  const std::vector<std::string>& words() const { return words_; }  // the only texts it takes; empty: others, too

 private:
  std::function<Verdict(std::string_view text)> set_;
  std::vector<std::string> words_;
};

struct PixelSize {
  int width, height;
};
struct PointBox {
  glm::dvec3 lo, hi;
};
struct Rectangle {
  glm::dvec2 lo, hi;
};

// A rectangle of a picture, half open; each side in pixels or in hundredths of the picture's width or height.
struct CropSides {
  struct Side {
    double value = 0;
    bool percent = false;
  };
  Side x0, y0, x1, y1;
};

// The whole text as a finite number, in decimal or scientific notation.
std::optional<double> to_number(std::string_view text);

// `count` numbers between separators: commas, or blanks when `blanks`. nullopt when that is not what the text is.
std::optional<std::vector<double>> to_numbers(std::string_view text, std::size_t count, bool blanks);

// "16:9", "4x3", "2.35:1" to width over height.
Verdict read_aspect(std::string_view text, double& aspect);

// "0.785", "0.785rad" or "45deg" to radians in (0, pi). A bare number above pi was surely meant in degrees: an error
// that says how to write that.
Verdict read_angle(std::string_view text, double& radians);

// "1920x1080".
Verdict read_size(std::string_view text, PixelSize& size);

// "1,2,3".
Verdict read_point(std::string_view text, glm::dvec3& point);

// "x0,y0,z0,x1,y1,z1", two opposite corners with the smaller coordinates first.
Verdict read_box(std::string_view text, PointBox& box);

// "x0,y0,x1,y1", two opposite corners with the smaller coordinates first, the corners apart in both.
Verdict read_rectangle(std::string_view text, Rectangle& rectangle);

// "0,0,640,360", "25%,25%,75%,75%": whole pixels or percent, two opposite corners.
Verdict read_crop(std::string_view text, CropSides& crop);

// "90", "90s", "10m", "1.5h" to seconds, more than 0.
Verdict read_duration(std::string_view text, double& seconds);

// Stops within -100 and 100.
Verdict read_exposure(std::string_view text, double& stops);

Verdict read_finite(std::string_view text, double& number);
Verdict read_positive(std::string_view text, double& number);
Verdict read_whole(std::string_view text, std::int64_t lo, std::int64_t hi, std::int64_t& number);
Verdict read_seed(std::string_view text, std::uint64_t& seed);

// A whole number in [lo, hi] for `target`.
Setter whole(std::optional<int>& target, int lo, int hi = std::numeric_limits<int>::max());

// One of `words`, stored as its index; anything else is an error that lists them.
Setter one_of(std::vector<std::string_view> words, int& target);

Setter any_text(std::optional<std::string>& target);

// Adapts a reader with a plain target to an optional or a list of values.
template <typename T>
Setter into(Verdict (*read)(std::string_view, T&), std::optional<T>& target) {
  return [read, &target](std::string_view text) {
    T value{};
    Verdict verdict = read(text, value);
    if (!verdict) target = value;
    return verdict;
  };
}
template <typename T>
Setter append_to(Verdict (*read)(std::string_view, T&), std::vector<T>& target) {
  return [read, &target](std::string_view text) {
    T value{};
    Verdict verdict = read(text, value);
    if (!verdict) target.push_back(value);
    return verdict;
  };
}

}  // namespace fathom::cli
