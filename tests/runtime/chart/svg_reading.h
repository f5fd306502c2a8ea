// Reads charts for tests: attributes of a class of elements, and texts with their positions.
#pragma once

#include <regex>
#include <string>
#include <vector>

namespace fathom::test {

inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

struct Circle {
  double x, y, radius;
};

// Returns the circles of a class, in drawing order.
inline std::vector<Circle> circles(const std::string& svg, const std::string& of_class) {
  const std::regex pattern("<circle cx=\"([^\"]*)\" cy=\"([^\"]*)\" r=\"([^\"]*)\" class=\"" + of_class + "\"");
  std::vector<Circle> found;
  for (std::sregex_iterator match(svg.begin(), svg.end(), pattern), end; match != end; ++match) {
    found.push_back({std::stod((*match)[1]), std::stod((*match)[2]), std::stod((*match)[3])});
  }
  return found;
}

struct Text {
  double x, y;
  std::string words;  // `^` precedes a superscript
};

inline std::vector<Text> texts(const std::string& svg) {
  static const std::regex kPattern(
      "<text x=\"([^\"]*)\" y=\"([^\"]*)\"[^>]*>([^<]*)(<tspan[^>]*>([^<]*)</tspan>)?</text>");
  std::vector<Text> found;
  for (std::sregex_iterator match(svg.begin(), svg.end(), kPattern), end; match != end; ++match) {
    const std::string power = (*match)[5];
    found.push_back(
        {std::stod((*match)[1]), std::stod((*match)[2]), (*match)[3].str() + (power.empty() ? "" : "^" + power)});
  }
  return found;
}

inline const Text* find_text(const std::vector<Text>& all, const std::string& words) {
  for (const Text& text : all) {
    if (text.words == words) return &text;
  }
  return nullptr;
}

}  // namespace fathom::test
