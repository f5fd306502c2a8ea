#include "runtime/environment_file.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "runtime/image_read.h"

namespace fathom::runtime {
namespace {

float usable(float value) {
  if (!(value > 0)) return 0;
  return std::min(value, std::numeric_limits<float>::max());
}

bool ends_in(const std::string& path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  return std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

}  // namespace

std::variant<EnvironmentImage, std::string> read_environment(const std::string& path) {
  if (!ends_in(path, ".hdr") && !ends_in(path, ".exr")) return std::string("its name ends in neither .hdr nor .exr");
  const auto read = read_image(path);
  if (const auto* unread = std::get_if<UnreadImage>(&read)) return unread->problem;
  const FloatImage& image = std::get<FloatImage>(read);
  // A picture of luminance alone is grey.
  const std::vector<float>* grey = image.channel("Y");
  const std::vector<float>* channels[] = {image.channel("R"), image.channel("G"), image.channel("B")};
  for (const std::vector<float>*& channel : channels) {
    if (channel == nullptr) channel = grey;
    if (channel == nullptr) return std::string("it has neither channels R, G and B nor Y");
  }
  EnvironmentImage result{image.area.width(), image.area.height(), {}};
  for (std::size_t i = 0; i < channels[0]->size(); ++i) {
    result.pixels.emplace_back(usable((*channels[0])[i]), usable((*channels[1])[i]), usable((*channels[2])[i]));
  }
  return result;
}

}  // namespace fathom::runtime
