// Tables of lights and backgrounds.
#include <utility>

#include "compiler/frontend/records/property_rows.h"
#include "compiler/frontend/records/records.h"

namespace fathom::compiler {
namespace {

using namespace rows;

RecordSpec light(std::string type, std::vector<PropertySpec> own) {
  RecordSpec record{type,
                    "`" + type + "`",
                    type + " light",
                    {choice({"point", "spot", "directional"}, "where its light comes from", true)}};
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  return record;
}

RecordSpec background(std::string type, std::vector<PropertySpec> own) {
  RecordSpec record{std::move(type),
                    "`background`",
                    "background",
                    {choice({"gradient", "sky", "image"}, "what surrounds the scene", false)}};
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  return record;
}

PropertySpec intensity() {
  return color("intensity", "radiant intensity, W/sr: irradiance at a distance of 1", 1, {}, Rule::NotNegative);
}
PropertySpec strength() { return number("strength", "a factor on its radiance", {1}, {}, Rule::NotNegative); }

}  // namespace

const std::vector<RecordSpec>& light_records() {
  static const std::vector<RecordSpec> records = {
      light("point", {vec3("position", "where it is", {0, 0, 0}), intensity()}),
      light("spot", {vec3("position", "where it is", {0, 0, 0}), intensity(),
                     vec3("direction", "where it points, any length", {0, -1, 0}, Rule::NotZero),
                     instead_of({"direction"}, other("target", ValueType::Vec3, "a place it points at")),
                     number("angle", "from the axis to the edge of the cone, degrees", {30}, {1e-3, 90}),
                     number("blend", "how much of the angle is a soft edge", {0}, kUnit)}),
      light("directional",
            {vec3("direction", "the way its light goes, any length", {0, -1, 0}, Rule::NotZero),
             instead_of({"direction"}, vec3("toward", "the way to the light, any length", {}, Rule::NotZero)),
             color("irradiance", "of what faces it", 1, {}, Rule::NotNegative),
             number("angle", "half of what its disc subtends, degrees; above 0 shadows are soft", {0}, {0, 89})})};
  return records;
}

const std::vector<RecordSpec>& background_records() {
  static const std::vector<RecordSpec> records = {
      background("gradient", {color("bottom", "radiance from straight down", 0, {}, Rule::NotNegative),
                              color("top", "radiance from straight up", 0, {}, Rule::NotNegative)}),
      background("sky",
                 {vec3("sun", "the way to the sun, any length", {0, 1, 0}, Rule::NotZero),
                  instead_of({"sun"}, number("elevation", "of the sun above the horizon, degrees", {45}, {0, 90})),
                  instead_of({"sun"}, number("azimuth", "of the sun, degrees from +x towards -z", {0}, {-360, 360})),
                  number("turbidity", "of the air: 2 very clear to 10 hazy", {3}, {2, 10}),
                  color("ground_albedo", "of what lies below the horizon", 0.3), strength(),
                  other("sun_disc", ValueType::Boolean, "whether the sun itself shines; true unless given")}),
      background("image", {other("file", ValueType::Text, "a .hdr or .exr picture, beside the scene file", true),
                           number("rotate", "about y, degrees", {0}), strength()})};
  return records;
}

}  // namespace fathom::compiler
