#include "runtime/cli/options/values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::cli {
namespace {

OptionResult option_error(std::string problem, std::string help = "") {
  return OptionError{std::move(problem), std::move(help)};
}

template <typename T>
std::optional<T> to(std::string_view text) {
  T value{};
  if (!text.empty() && text.front() == '+' && text.substr(0, 2) != "+-") text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool cut_suffix(std::string_view& text, std::string_view suffix) {
  if (!text.ends_with(suffix)) return false;
  text.remove_suffix(suffix.size());
  return true;
}

template <typename Target>
Setter whole_into(Target& target, int lo, int hi) {
  return [&target, lo, hi](std::string_view text) {
    std::int64_t value = 0;
    OptionResult error = read_whole(text, lo, hi, value);
    if (!error) target = static_cast<int>(value);
    return error;
  };
}

}  // namespace

std::optional<double> to_number(std::string_view text) {
  const auto number = to<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<std::vector<double>> to_numbers(std::string_view text, std::size_t count, bool blanks) {
  const std::string_view separators = blanks ? " \t\r,;" : ",";
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    if (end > at || !blanks) {
      const auto number = to_number(text.substr(at, end - at));
      if (!number) return std::nullopt;
      numbers.push_back(*number);
    }
    at = end + 1;
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

OptionResult read_aspect(std::string_view text, double& aspect) {
  const std::size_t middle = text.find_first_of(":x");
  if (middle != std::string_view::npos) {
    const auto width = to_number(text.substr(0, middle)), height = to_number(text.substr(middle + 1));
    if (width && height && *width > 0 && *height > 0 && std::isfinite(*width / *height) && *width / *height > 0) {
      aspect = *width / *height;
      return std::nullopt;
    }
  }
  return option_error(fmt::format("`{}` is not a ratio of two positive numbers", text), "write it as 16:9 or 4x3");
}

OptionResult read_angle(std::string_view text, double& radians) {
  std::string_view digits = text;
  const bool degrees = cut_suffix(digits, "deg");
  const bool unit = degrees || cut_suffix(digits, "rad");
  const auto number = to_number(digits);
  if (!number)
    return option_error(fmt::format("`{}` is not an angle", text), "write 0.785 (radians), 0.785rad or 45deg");
  const double angle = degrees ? *number * std::numbers::pi / 180 : *number;
  if (!unit && angle > std::numbers::pi && *number < 180) {
    return option_error(fmt::format("{} radians is more than half a turn", text),
                        fmt::format("a number without a unit is in radians; did you mean `{}deg`?", text));
  }
  if (angle <= 0 || angle >= std::numbers::pi) {
    return option_error(fmt::format("`{}` is not between 0 and 180 degrees", text),
                        unit ? "" : "a number without a unit is in radians; write for example 45deg");
  }
  radians = angle;
  return std::nullopt;
}

OptionResult read_size(std::string_view text, PixelSize& size) {
  const std::size_t middle = text.find('x');
  if (middle != std::string_view::npos) {
    const auto width = to<int>(text.substr(0, middle)), height = to<int>(text.substr(middle + 1));
    if (width && height && *width >= 1 && *height >= 1 && *width <= compiler::kMaxSide &&
        *height <= compiler::kMaxSide) {
      size = {*width, *height};
      return std::nullopt;
    }
  }
  return option_error(fmt::format("`{}` is not a size in pixels, each side from 1 to {}", text, compiler::kMaxSide),
                      "write it as 1920x1080");
}

OptionResult read_point(std::string_view text, glm::dvec3& point) {
  const auto numbers = to_numbers(text, 3, false);
  if (!numbers) return option_error(fmt::format("`{}` is not a point", text), "write three numbers: 0,1.5,-2");
  point = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  return std::nullopt;
}

OptionResult read_box(std::string_view text, PointBox& box) {
  const auto n = to_numbers(text, 6, false);
  if (!n) return option_error(fmt::format("`{}` is not a box", text), "write its two corners: -1,-1,-1,1,1,1");
  const PointBox read = {{(*n)[0], (*n)[1], (*n)[2]}, {(*n)[3], (*n)[4], (*n)[5]}};
  for (int axis = 0; axis < 3; ++axis) {
    if (read.lo[axis] > read.hi[axis]) {
      return option_error(fmt::format("`{}`: the first corner's {} is above the second's", text, "xyz"[axis]),
                          "give the corner with the smaller coordinates first");
    }
  }
  box = read;
  return std::nullopt;
}

OptionResult read_rectangle(std::string_view text, Rectangle& rectangle) {
  const auto n = to_numbers(text, 4, false);
  if (!n || !((*n)[0] < (*n)[2]) || !((*n)[1] < (*n)[3])) {
    return option_error(
        fmt::format("`{}` is not a rectangle", text),
        n ? "give the corner with the smaller coordinates first" : "write its two corners: -1,-1,1,1");
  }
  rectangle = {{(*n)[0], (*n)[1]}, {(*n)[2], (*n)[3]}};
  return std::nullopt;
}

OptionResult read_crop(std::string_view text, CropSides& crop) {
  const auto wrong = [&] {
    return option_error(fmt::format("`{}` is not a part of a picture", text),
                        "write its two corners in pixels or percent: 0,0,640,360 or 25%,25%,75%,75%");
  };
  CropSides read;
  CropSides::Side* sides[] = {&read.x0, &read.y0, &read.x1, &read.y1};
  std::size_t at = 0;
  for (CropSides::Side* side : sides) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    if (at > text.size() || (end == text.size()) != (side == sides[3])) return wrong();
    std::string_view digits = text.substr(at, end - at);
    side->percent = cut_suffix(digits, "%");
    const auto number = to_number(digits);
    if (!number || *number < 0 || (side->percent ? *number > 100 : *number != std::floor(*number))) return wrong();
    side->value = *number;
    at = end + 1;
  }
  crop = read;
  return std::nullopt;
}

OptionResult read_duration(std::string_view text, double& seconds) {
  std::string_view digits = text;
  double unit = 1;
  if (cut_suffix(digits, "h")) {
    unit = 3600;
  } else if (cut_suffix(digits, "m")) {
    unit = 60;
  } else {
    cut_suffix(digits, "s");
  }
  const auto number = to_number(digits);
  if (!number || *number <= 0 || !std::isfinite(*number * unit)) {
    return option_error(fmt::format("`{}` is not a time", text), "write 90s, 10m or 1.5h; a number alone is seconds");
  }
  seconds = *number * unit;
  return std::nullopt;
}

OptionResult read_exposure(std::string_view text, double& stops) {
  return read_between(text, -compiler::kMaxExposure, compiler::kMaxExposure, "", stops);
}

OptionResult read_finite(std::string_view text, double& number) {
  const auto value = to_number(text);
  if (!value) return option_error(fmt::format("`{}` is not a number", text));
  number = *value;
  return std::nullopt;
}

OptionResult read_positive(std::string_view text, double& number) {
  const auto value = to_number(text);
  if (!value || *value <= 0) return option_error(fmt::format("`{}` is not a positive number", text));
  number = *value;
  return std::nullopt;
}

OptionResult read_between(std::string_view text, double least, double most, std::string_view help, double& number) {
  const auto value = to_number(text);
  if (!value || *value < least || *value > most) {
    return option_error(fmt::format("`{}` is not a number from {} to {}", text, least, most), std::string(help));
  }
  number = *value;
  return std::nullopt;
}

OptionResult read_whole(std::string_view text, std::int64_t lo, std::int64_t hi, std::int64_t& number) {
  const auto value = to<std::int64_t>(text);
  if (!value || *value < lo || *value > hi) {
    return option_error(fmt::format("`{}` is not a whole number from {} to {}", text, lo, hi));
  }
  number = *value;
  return std::nullopt;
}

OptionResult read_range(std::string_view text, std::string_view what, std::int64_t most, NumberRange& range) {
  const std::size_t middle = text.find(':');
  std::int64_t first = 0, last = 0;
  if (middle == std::string_view::npos || read_whole(text.substr(0, middle), 0, most, first) ||
      read_whole(text.substr(middle + 1), 1, most, last) || first >= last) {
    return OptionError{
        fmt::format("`{}` is not a range of {}", text, what),
        fmt::format("write it as 0:32: the {} from the first number up to the second, which is not in it", what)};
  }
  range = {static_cast<std::size_t>(first), static_cast<std::size_t>(last)};
  return std::nullopt;
}

OptionResult read_seed(std::string_view text, std::uint64_t& seed) {
  const auto value = to<std::uint64_t>(text);
  if (!value) return option_error(fmt::format("`{}` is not a whole number from 0 to 2^64 - 1", text));
  seed = *value;
  return std::nullopt;
}

Setter whole(std::optional<int>& target, int lo, int hi) { return whole_into(target, lo, hi); }
Setter whole(int& target, int lo, int hi) { return whole_into(target, lo, hi); }

Setter one_of(std::vector<std::string_view> words, std::function<void(int)> take) {
  std::vector<std::string> all(words.begin(), words.end());
  const auto set = [words = std::move(words), take = std::move(take)](std::string_view text) -> OptionResult {
    const auto found = std::find(words.begin(), words.end(), text);
    if (found != words.end()) {
      take(static_cast<int>(found - words.begin()));
      return std::nullopt;
    }
    const std::string_view near = compiler::nearest(text, words);
    return option_error(fmt::format("`{}` is not one of {}", text, fmt::join(words, ", ")),
                        near.empty() ? "" : fmt::format("did you mean `{}`?", near));
  };
  return {set, std::move(all)};
}

Setter one_of(std::vector<std::string_view> words, int& target) {
  return one_of(std::move(words), [&target](int index) { target = index; });
}

Setter any_text(std::optional<std::string>& target) {
  return [&target](std::string_view text) -> OptionResult {
    target = text;
    return std::nullopt;
  };
}

}  // namespace fathom::cli
