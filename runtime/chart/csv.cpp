#include "runtime/chart/csv.h"

#include <fmt/format.h>

namespace fathom::runtime {
namespace {

std::string field(const std::string& text) { return csv_field(text); }
std::string field(double number) { return fmt::format("{}", number); }
std::string field(int number) { return fmt::format("{}", number); }
std::string field(std::uint64_t number) { return fmt::format("{}", number); }

template <class Row>
struct CsvColumn {
  const char* name;
  std::string (*text)(const Row&, const Provenance&);
};

template <class Row, auto member>
std::string of_row(const Row& row, const Provenance&) {
  return field(row.*member);
}

template <class Row, auto member>
std::string of_provenance(const Row&, const Provenance& provenance) {
  return field(provenance.*member);
}

using MeasuredRay = RayMeasurement;
constexpr CsvColumn<MeasuredRay> kRayColumns[] = {
    {"scene", of_row<MeasuredRay, &MeasuredRay::scene>},
    {"method", of_row<MeasuredRay, &MeasuredRay::method>},
    {"precision", of_row<MeasuredRay, &MeasuredRay::precision>},
    {"eps", of_row<MeasuredRay, &MeasuredRay::eps>},
    {"relax", of_row<MeasuredRay, &MeasuredRay::relax>},
    {"steps_max", of_row<MeasuredRay, &MeasuredRay::steps_max>},
    {"class", of_row<MeasuredRay, &MeasuredRay::ray_class>},
    {"rays", of_row<MeasuredRay, &MeasuredRay::rays>},
    {"ns_med", of_row<MeasuredRay, &MeasuredRay::ns_med>},
    {"ns_min", of_row<MeasuredRay, &MeasuredRay::ns_min>},
    {"ns_max", of_row<MeasuredRay, &MeasuredRay::ns_max>},
    {"evals_mean", of_row<MeasuredRay, &MeasuredRay::evals_mean>},
    {"evals_p99", of_row<MeasuredRay, &MeasuredRay::evals_p99>},
    {"false_hit_ppm", of_row<MeasuredRay, &MeasuredRay::false_hit_ppm>},
    {"false_miss_ppm", of_row<MeasuredRay, &MeasuredRay::false_miss_ppm>},
    {"exhausted_ppm", of_row<MeasuredRay, &MeasuredRay::exhausted_ppm>},
    {"near_miss_ppm", of_row<MeasuredRay, &MeasuredRay::near_miss_ppm>},
    {"gross_ppm", of_row<MeasuredRay, &MeasuredRay::gross_ppm>},
    {"terr_p50", of_row<MeasuredRay, &MeasuredRay::terr_p50>},
    {"terr_p99", of_row<MeasuredRay, &MeasuredRay::terr_p99>},
    {"terr_max", of_row<MeasuredRay, &MeasuredRay::terr_max>},
    {"nerr_p50", of_row<MeasuredRay, &MeasuredRay::nerr_p50>},
    {"nerr_p99", of_row<MeasuredRay, &MeasuredRay::nerr_p99>},
    {"nerr_max", of_row<MeasuredRay, &MeasuredRay::nerr_max>},
    {"commit", of_provenance<MeasuredRay, &Provenance::commit>},
    {"cpu", of_provenance<MeasuredRay, &Provenance::cpu>},
    {"compiler", of_provenance<MeasuredRay, &Provenance::compiler>},
};

using Image = ImageMeasurement;
constexpr CsvColumn<Image> kImageColumns[] = {
    {"scene", of_row<Image, &Image::scene>},
    {"method", of_row<Image, &Image::method>},
    {"precision", of_row<Image, &Image::precision>},
    {"eps", of_row<Image, &Image::eps>},
    {"sampler", of_row<Image, &Image::sampler>},
    {"lights", of_row<Image, &Image::lights>},
    {"spp", of_row<Image, &Image::spp>},
    {"seeds", of_row<Image, &Image::seeds>},
    {"seconds_med", of_row<Image, &Image::seconds_med>},
    {"seconds_min", of_row<Image, &Image::seconds_min>},
    {"seconds_max", of_row<Image, &Image::seconds_max>},
    {"relmse_med", of_row<Image, &Image::relmse_med>},
    {"relmse_p05", of_row<Image, &Image::relmse_p05>},
    {"relmse_p95", of_row<Image, &Image::relmse_p95>},
    {"relmse_trimmed_med", of_row<Image, &Image::relmse_trimmed_med>},
    {"floor", of_row<Image, &Image::floor>},
    {"commit", of_provenance<Image, &Provenance::commit>},
    {"cpu", of_provenance<Image, &Provenance::cpu>},
    {"compiler", of_provenance<Image, &Provenance::compiler>},
};

template <class Row>
std::string table(std::span<const CsvColumn<Row>> columns, std::span<const Row> rows, const Provenance& provenance) {
  std::string text;
  const auto add_line = [&](const auto& field_of) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) text += ',';
      text += field_of(columns[i]);
    }
    text += '\n';
  };
  add_line([](const CsvColumn<Row>& column) { return std::string(column.name); });
  for (const Row& row : rows) add_line([&](const CsvColumn<Row>& column) { return column.text(row, provenance); });
  return text;
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string rays_csv(std::span<const RayMeasurement> rows, const Provenance& provenance) {
  return table<MeasuredRay>(kRayColumns, rows, provenance);
}

std::string images_csv(std::span<const ImageMeasurement> rows, const Provenance& provenance) {
  return table<Image>(kImageColumns, rows, provenance);
}

}  // namespace fathom::runtime
