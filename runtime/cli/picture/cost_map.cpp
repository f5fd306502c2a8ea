#include "runtime/cli/picture/cost_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/chart/colormap.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/image/image_io.h"

namespace fathom::cli {
namespace {

std::string describe_values(const std::vector<float>& values, const CostMap& map) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return fmt::format("{} a sample, least {:.6g}, mean {:.6g}, most {:.6g}", map.name, *least,
                     sum / static_cast<double>(values.size()), *most);
}

}  // namespace

std::vector<float> cost_values(const runtime::Film& film, const CostMap& map) {
  std::vector<float> values;
  const runtime::PixelRect area = film.area();
  values.reserve(area.pixels());
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) values.push_back(static_cast<float>(film.means(x, y).*map.value));
  }
  return values;
}

std::vector<std::string> cost_map_files(const std::string& path) {
  std::vector<std::string> files;
  for (const CostMap& map : kCostMaps) files.push_back(with_suffix(path, map.name));
  return files;
}

std::optional<std::string> write_cost_maps(const std::string& path, const runtime::Film& film,
                                           std::vector<std::string>& lines) {
  for (const CostMap& map : kCostMaps) {
    const std::string file = with_suffix(path, map.name);
    const std::vector<float> values = cost_values(film, map);
    int height = film.height();
    std::string meaning = describe_values(values, map);
    std::optional<std::string> problem;
    if (runtime::is_float_map(file)) {
      problem = runtime::write_float_map(values, film.width(), film.height(), file);
    } else {
      const runtime::ColorScale scale = runtime::scale_for(values, true);
      const runtime::ByteImage picture = runtime::draw_map(values, film.width(), film.height(), scale);
      problem = runtime::write_image(picture, file);
      height = picture.height;
      meaning += fmt::format("; dark violet is {:.6g}, yellow {:.6g}, logarithmic, black none", scale.lo, scale.hi);
    }
    if (problem) return problem;
    lines.push_back(fmt::format("wrote {} ({}x{}): {}", file, film.width(), height, meaning));
  }
  return std::nullopt;
}

}  // namespace fathom::cli
