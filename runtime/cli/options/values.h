// Readers of option values: numbers, sizes, angles and points from text, with messages that explain the valid form.
//
// Every reader stores into its last argument and returns nullopt, or leaves the argument unchanged and returns the
// problem. A Setter is a reader bound to its target, ready for Arguments::option.
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

struct OptionError {
  std::string problem;
  std::string help;  // may be empty
};
using OptionResult = std::optional<OptionError>;

class Setter {
 public:
  template <typename F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, Setter>) Setter(F set, std::vector<std::string> words = {})
      : set_(std::move(set)), words_(std::move(words)) {}

  OptionResult operator()(std::string_view text) const { return set_(text); }
  // The valid values. Empty: not restricted to a list.
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::function<OptionResult(std::string_view text)> set_;
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

// A half-open rectangle of the image, each side in pixels or in percent of the image's width or height.
struct CropSides {
  struct Side {
    double value = 0;
    bool percent = false;
  };
  Side x0, y0, x1, y1;
};

// Parses the whole text as a finite number, in decimal or scientific notation.
std::optional<double> to_number(std::string_view text);

// Parses exactly `count` numbers separated by commas, or by blanks if `blanks`. Returns nullopt for any other text.
std::optional<std::vector<double>> to_numbers(std::string_view text, std::size_t count, bool blanks);

// Reads width over height from "16:9", "4x3" or "2.35:1".
OptionResult read_aspect(std::string_view text, double& aspect);

// Reads an angle in (0, pi) radians from "0.785", "0.785rad" or "45deg". A bare number above pi is surely meant in
// degrees, so the error explains how to write degrees.
OptionResult read_angle(std::string_view text, double& radians);

// Reads "1920x1080".
OptionResult read_size(std::string_view text, PixelSize& size);

// Reads "1,2,3".
OptionResult read_point(std::string_view text, glm::dvec3& point);

// Reads two opposite corners, "x0,y0,z0,x1,y1,z1", the smaller coordinates first.
OptionResult read_box(std::string_view text, PointBox& box);

// Reads two opposite corners, "x0,y0,x1,y1", the smaller coordinates first. The corners differ in both coordinates.
OptionResult read_rectangle(std::string_view text, Rectangle& rectangle);

// Reads two opposite corners in whole pixels or percent: "0,0,640,360", "25%,25%,75%,75%".
OptionResult read_crop(std::string_view text, CropSides& crop);

// Reads a positive duration in seconds from "90", "90s", "10m" or "1.5h".
OptionResult read_duration(std::string_view text, double& seconds);

// Reads an exposure in stops, at most kMaxExposure in magnitude.
OptionResult read_exposure(std::string_view text, double& stops);

OptionResult read_finite(std::string_view text, double& number);
OptionResult read_positive(std::string_view text, double& number);
// Reads a number in [least, most]. `help` may be empty.
OptionResult read_between(std::string_view text, double least, double most, std::string_view help, double& number);
OptionResult read_whole(std::string_view text, std::int64_t lo, std::int64_t hi, std::int64_t& number);
// Reads "0:32": whole numbers of `what`, as "samples", from the first up to the second, which is not among them.
using NumberRange = std::pair<std::size_t, std::size_t>;
OptionResult read_range(std::string_view text, std::string_view what, std::int64_t most, NumberRange& range);
OptionResult read_seed(std::string_view text, std::uint64_t& seed);

// Makes a Setter for a whole number in [lo, hi].
Setter whole(std::optional<int>& target, int lo, int hi = std::numeric_limits<int>::max());
Setter whole(int& target, int lo, int hi = std::numeric_limits<int>::max());

// Makes a Setter that takes the index of a word in `words`. Any other text is an error that lists the words.
Setter one_of(std::vector<std::string_view> words, std::function<void(int)> take);
Setter one_of(std::vector<std::string_view> words, int& target);
template <typename Enum>
requires std::is_enum_v<Enum>
Setter one_of(std::vector<std::string_view> words, std::optional<Enum>& target) {
  return one_of(std::move(words), [&target](int index) { target = static_cast<Enum>(index); });
}

Setter any_text(std::optional<std::string>& target);

// Adapts a reader with a plain target to an optional or a list of values.
template <typename T>
Setter into(OptionResult (*read)(std::string_view, T&), std::optional<T>& target) {
  return [read, &target](std::string_view text) {
    T value{};
    OptionResult error = read(text, value);
    if (!error) target = value;
    return error;
  };
}
template <typename T>
Setter append_to(OptionResult (*read)(std::string_view, T&), std::vector<T>& target) {
  return [read, &target](std::string_view text) {
    T value{};
    OptionResult error = read(text, value);
    if (!error) target.push_back(value);
    return error;
  };
}

}  // namespace fathom::cli
