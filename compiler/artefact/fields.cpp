#include "compiler/artefact/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <utility>
#include <variant>

#include "compiler/frontend/elaborate/textures.h"

namespace fathom::compiler {
namespace {

using ChoiceNames = std::span<const std::string_view>;

constexpr double kAny = 1e300;    // bound of numbers that only have to be finite
constexpr double kTiny = 1e-300;  // bound of numbers above 0
constexpr std::string_view kProjections[] = {"perspective", "orthographic", "panorama"};
constexpr std::string_view kBackgrounds[] = {"gradient", "sky", "image"};
constexpr std::string_view kLights[] = {"point", "spot", "directional"};
constexpr std::string_view kAreaLightShapes[] = {"sphere", "box", "cylinder", "capsule", "quad"};
constexpr std::string_view kMaterials[] = {"diffuse", "emissive", "specular", "transparent", "principled"};

void index(Archive& a, std::string_view name, std::uint32_t& number, std::size_t count) {
  if (a.reading() && count == 0) return a.fail(fmt::format("`{}` has nothing to refer to", name));
  field(a, name, number, 0, a.reading() ? count - 1 : ~std::uint32_t{0});
}

void unit_vector(Archive& a, std::string_view name, glm::dvec3& v) {
  field(a, name, v, -1, 1);
  if (a.reading() && !(std::abs(glm::length(v) - 1) < 1e-6)) a.fail(fmt::format("`{}` is not of length 1", name));
}

void signed_whole(Archive& a, std::string_view name, int& number, int least, int most) {
  double doubles = number;
  field(a, name, doubles, least, most);
  const bool negative_zero = doubles == 0 && std::signbit(doubles);
  if (doubles != std::trunc(doubles) || negative_zero) a.fail(fmt::format("{} is not a whole number", doubles));
  number = static_cast<int>(doubles);
}

struct Interval {
  double least, most;
};
Interval range_of(const MaterialParameter& parameter) {
  switch (parameter.domain) {
    case ParameterDomain::Share:
      return {0, 1};
    case ParameterDomain::Positive:
      return {kTiny, kAny};
    case ParameterDomain::NotNegative:
      break;
  }
  return {0, kAny};
}

void fields(Archive& a, TexturedParameter& t, std::size_t textures) {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const MaterialParameter& row : kMaterialParameters) all.push_back(row.name);
    return all;
  }();
  std::size_t at = a.reading() ? 0 : static_cast<std::size_t>(&parameter_of(t.parameter) - kMaterialParameters);
  a.member("parameter", [&](TableJson& json) { choice(a, json, at, names); });
  t.parameter = kMaterialParameters[at].member;
  index(a, "texture", t.texture, textures);
  field(a, "least", t.least, -kAny, kAny);
  field(a, "most", t.most, -kAny, kAny);
  if (!a.reading() || a.failed()) return;
  const Interval range = range_of(kMaterialParameters[at]);
  if (t.least > t.most || t.least < range.least || t.most > range.most) {
    a.fail(fmt::format("`{}` cannot be from {} to {}", names[at], t.least, t.most));
  }
}

void fields(Archive& a, Material& m, std::size_t textures) {
  field(a, "name", m.name);
  field(a, "type", m.type, ChoiceNames(kMaterials));
  for (const MaterialParameter& row : kMaterialParameters) {
    const Interval range = range_of(row);
    std::visit([&](auto member) { field(a, row.name, m.*member, range.least, range.most); }, row.member);
  }
  field(a, "thin_walled", m.thin_walled);
  signed_whole(a, "priority", m.priority, -1000, 1000);
  list(a, "textured", m.textured, [&](Archive& archive, TexturedParameter& t) { fields(archive, t, textures); });
}

void fields(Archive& a, Pattern::Checker&) { (void)a; }
void fields(Archive& a, Pattern::Stripes& s) {
  unit_vector(a, "axis", s.axis);
  field(a, "width", s.width, 0, 1);
  field(a, "softness", s.softness, 0, 1);
}
void fields(Archive& a, Pattern::Gradient& g) {
  field(a, "from", g.from, -kAny, kAny);
  field(a, "to", g.to, -kAny, kAny);
}
void fields(Archive& a, Pattern::Noise& n) {
  field(a, "octaves", n.octaves, 1, 16);
  field(a, "gain", n.gain, 0, 1);
  field(a, "lacunarity", n.lacunarity, 1, 16);
  field(a, "contrast", n.contrast, 0, 1000);
  field(a, "seed", n.seed, 0, ~std::uint64_t{0});
}
void fields(Archive& a, Pattern::Bricks& b) {
  field(a, "width", b.width, kTiny, kAny);
  field(a, "height", b.height, kTiny, kAny);
  field(a, "mortar", b.mortar, 0, kAny);
  field(a, "shift", b.shift, 0, 1);
}

// A variant as the name of its alternative. The alternative's fields follow.
template <typename Variant, std::size_t... kIndex>
void make(Variant& v, std::size_t index, std::index_sequence<kIndex...>) {
  (void)((index == kIndex && (v = std::variant_alternative_t<kIndex, Variant>{}, true)) || ...);
}
template <typename Variant>
void kind(Archive& a, std::string_view name, Variant& v, ChoiceNames names) {
  std::size_t index = v.index();
  a.member(name, [&](TableJson& json) { choice(a, json, index, names); });
  if (a.reading()) make(v, index, std::make_index_sequence<std::variant_size_v<Variant>>());
}

constexpr std::string_view kPatterns[] = {"checker", "stripes", "gradient", "noise", "bricks"};
constexpr std::string_view kFrameRows[] = {"x_row", "y_row", "z_row"};
constexpr std::string_view kChannels[] = {"red", "green", "blue"};
constexpr std::string_view kCorners[] = {"corner0", "corner1", "corner2", "corner3"};
constexpr std::string_view kTextures[] = {"color", "formula", "pattern"};

// `textures` is the number of textures before this one.
void fields(Archive& a, Pattern& p, std::size_t textures) {
  kind(a, "pattern", p.kind, kPatterns);
  std::visit([&](auto& own) { fields(a, own); }, p.kind);
  for (int row = 0; row < 3; ++row) {
    field(a, kFrameRows[row], p.to_pattern.rows[static_cast<std::size_t>(row)], -kAny, kAny);
  }
  field(a, "translation", p.to_pattern.translation, -kAny, kAny);
  field(a, "space", p.space, ChoiceNames(kTextureSpaces));
  index(a, "a", p.a, textures);
  index(a, "b", p.b, textures);
}

void fields(Archive& a, Texture& t, std::size_t textures, std::size_t formulas) {
  kind(a, "texture", t, kTextures);
  if (auto* color = std::get_if<glm::dvec3>(&t)) field(a, "value", *color, -kAny, kAny);
  if (auto* pattern = std::get_if<Pattern>(&t)) fields(a, *pattern, textures);
  if (auto* formula = std::get_if<TextureFormula>(&t)) {
    for (std::size_t i = 0; i < 3; ++i) {
      index(a, kChannels[i], formula->programs[i], formulas);
    }
    field(a, "space", formula->space, ChoiceNames(kTextureSpaces));
  }
}

void fields(Archive& a, AreaLight& l, const CompiledScene& scene) {
  field(a, "shape", l.shape, ChoiceNames(kAreaLightShapes));
  field(a, "rotation", l.rotation, -1.001, 1.001);
  field(a, "translation", l.translation, -kAny, kAny);
  field(a, "radius", l.radius, 0, kAny);
  field(a, "half_height", l.half_height, 0, kAny);
  field(a, "half_size", l.half_size, 0, kAny);
  for (std::size_t i = 0; i < 4; ++i) {
    field(a, kCorners[i], l.corners[i], -kAny, kAny);
  }
  index(a, "surface", l.surface, scene.surfaces.size());
  index(a, "material", l.material, scene.materials.size());
}

// Work of evaluating patterns of patterns at a point: the depth of the deepest, and the number of evaluations of the
// most expensive. A pattern that two patterns share counts twice.
struct TextureWork {
  int depth = 0;
  double evaluations = 1;
};
TextureWork work_of(const std::vector<Texture>& textures) {
  std::vector<TextureWork> each;  // [texture]
  TextureWork most;
  for (const Texture& texture : textures) {
    TextureWork& work = each.emplace_back();
    if (const auto* pattern = std::get_if<Pattern>(&texture)) {
      const TextureWork &a = each[pattern->a], &b = each[pattern->b];
      work = {1 + std::max(a.depth, b.depth), 1 + a.evaluations + b.evaluations};
    }
    most = {std::max(most.depth, work.depth), std::max(most.evaluations, work.evaluations)};
  }
  return most;
}

void textures(Archive& a, CompiledScene& scene) {
  std::size_t before = 0;
  list(a, "textures", scene.textures,
       [&](Archive& archive, Texture& texture) { fields(archive, texture, before++, scene.formulas.size()); });
  if (!a.reading() || a.failed()) return;
  // Compiled text shares no textures, so that it evaluates at most textures.size(). Files may share textures, and a
  // few thousand evaluations do no harm.
  const double allowed = std::max(4096.0, static_cast<double>(scene.textures.size()));
  const TextureWork most = work_of(scene.textures);
  if (most.depth > kMaxPatternDepth + 1) a.fail(fmt::format("patterns are more than {} deep", kMaxPatternDepth));
  if (most.evaluations > allowed) {
    a.fail(
        fmt::format("a pattern evaluates {} others at each point, more than {}", most.evaluations - 1, allowed - 1));
  }
}

}  // namespace

void fields(Archive& a, Parameter& p) {
  field(a, "name", p.name);
  field(a, "value", p.value, -kAny, kAny);
  field(a, "min", p.min, -kEndless, kEndless);
  field(a, "max", p.max, -kEndless, kEndless);
  field(a, "doc", p.doc);
}

void fields(Archive& a, Camera& c) {
  field(a, "automatic", c.automatic);
  field(a, "projection", c.projection, ChoiceNames(kProjections));
  field(a, "position", c.position, -kAny, kAny);
  field(a, "target", c.target, -kAny, kAny);
  field(a, "up", c.up, -kAny, kAny);
  field(a, "fov", c.fov, kTiny, 3.1415926535897927);
  field(a, "vertical_fov", c.vertical_fov, kTiny, 3.1415926535897927);
  field(a, "focal_length", c.focal_length, kTiny, kAny);
  field(a, "sensor_width", c.sensor_width, kTiny, kAny);
  field(a, "width", c.width, kTiny, kAny);
  field(a, "lens_radius", c.lens_radius, 0, kAny);
  field(a, "f_stop", c.f_stop, kTiny, kAny);
  field(a, "focus_distance", c.focus_distance, kTiny, kAny);
  field(a, "blades", c.blades, 0, kMaxBlades);
  field(a, "blade_rotation", c.blade_rotation, -kAny, kAny);
  field(a, "shutter", c.shutter, 0, 1);
  if (!a.reading() || a.failed()) return;
  const glm::dvec3 view = c.target - c.position;
  const double across = glm::length(glm::cross(glm::normalize(view), glm::normalize(c.up)));
  if (!(glm::length(view) > 0 && across > 0)) a.fail("the camera has no direction of view, or looks along its `up`");
}

// The members of Film or RenderSettings in the order of settings.def.
template <typename Record>
void settings(Archive& a, Record& record) {
  for_each_setting_of<Record>([&](const auto& row) {
    using Value = typename std::remove_cvref_t<decltype(row)>::Value;
    auto& member = record.*row.member;
    if constexpr (std::is_enum_v<Value>) {
      field(a, row.name, member, words_of(Value{}));
    } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
      field(a, row.name, member, std::uint64_t{0}, ~std::uint64_t{0});  // an option takes all 64 bits
    } else if constexpr (std::is_integral_v<Value>) {
      field(a, row.name, member, static_cast<std::uint64_t>(row.range.least),
            static_cast<std::uint64_t>(row.range.most));
    } else {
      field(a, row.name, member, row.range.above_zero ? kTiny : row.range.least,
            row.range.above_zero ? kAny : row.range.most);
    }
  });
}
void fields(Archive& a, Film& film) { settings(a, film); }
void fields(Archive& a, RenderSettings& render) { settings(a, render); }

void fields(Archive& a, Background& b) {
  field(a, "type", b.type, ChoiceNames(kBackgrounds));
  field(a, "bottom", b.bottom, 0, kAny);
  field(a, "top", b.top, 0, kAny);
  unit_vector(a, "sun", b.sky.sun);
  if (a.reading() && b.sky.sun.y < 0) a.fail("the sun is below the horizon");
  field(a, "turbidity", b.sky.turbidity, 2, 10);
  field(a, "ground_albedo", b.sky.ground_albedo, 0, 1);
  field(a, "sky_strength", b.sky.strength, 0, kAny);
  field(a, "sun_disc", b.sky.sun_disc);
  field(a, "image", b.image.name);
  field(a, "rotate", b.image.rotate, -kAny, kAny);
  field(a, "strength", b.image.strength, 0, kAny);
}

void fields(Archive& a, Light& l) {
  field(a, "name", l.name);
  field(a, "type", l.type, ChoiceNames(kLights));
  field(a, "position", l.position, -kAny, kAny);
  unit_vector(a, "direction", l.direction);
  field(a, "intensity", l.intensity, 0, kAny);
  field(a, "angle", l.angle, 0, 90);
  field(a, "blend", l.blend, 0, 1);
}

void fields(Archive& a, CompiledField& f) {
  field(a, "bound_lo", f.bound.lo, -kEndless, kEndless);
  field(a, "bound_hi", f.bound.hi, -kEndless, kEndless);
  field(a, "contents_lo", f.contents.lo, -kEndless, kEndless);
  field(a, "contents_hi", f.contents.hi, -kEndless, kEndless);
  field(a, "lipschitz", f.lipschitz, kTiny, kAny);
  field(a, "cancellation", f.cancellation, 0, kAny);
  field(a, "certified", f.certified);
  field(a, "formula_box_lo", f.formula_box.lo, -kEndless, kEndless);
  field(a, "formula_box_hi", f.formula_box.hi, -kEndless, kEndless);
  field(a, "rest_lipschitz", f.rest_lipschitz, 0, kAny);
}

static void media(Archive& a, CompiledScene& scene) {
  const std::size_t count = scene.media.size();
  a.member("media", [&](TableJson& json) {
    a.array(
        json, count, [&](std::size_t size) { return size == count; },
        [&](TableJson& element, std::size_t i) {
          a.record(element, [&] {
            index(a, "material", scene.media[i].material, scene.materials.size());
            fields(a, static_cast<CompiledField&>(scene.media[i]));
          });
        });
  });
}

void fields(Archive& a, CompiledScene& scene) {
  field(a, "summary", scene.summary);
  field(a, "nodes", scene.node_count, 0, ~std::uint32_t{0});
  field(a, "origin", scene.origin, -kAny, kAny);
  field(a, "extent_lo", scene.extent.lo, -kEndless, kEndless);
  field(a, "extent_hi", scene.extent.hi, -kEndless, kEndless);
  list(a, "parameters", scene.parameters);
  record(a, "camera", scene.camera);
  record(a, "film", scene.film);
  record(a, "render", scene.settings);
  record(a, "background", scene.background);
  list(a, "lights", scene.lights);
  textures(a, scene);
  list(a, "materials", scene.materials,
       [&](Archive& archive, Material& material) { fields(archive, material, scene.textures.size()); });
  list(a, "surfaces", scene.surfaces, [&](Archive& archive, Surface& surface) {
    field(archive, "name", surface.name);
    index(archive, "material", surface.material, scene.materials.size());
    field(archive, "mixed", surface.mixed);
    field(archive, "placed", surface.placed);
    field(archive, "shift", surface.shift, -kAny, kAny);
  });
  if (a.reading() && !a.failed() && scene.surfaces.empty()) a.fail("there is no surface");
  list(a, "area_lights", scene.area_lights,
       [&](Archive& archive, AreaLight& area_light) { fields(archive, area_light, scene); });
  record(a, "field", static_cast<CompiledField&>(scene));
  media(a, scene);
}

TableJson tables_of(const CompiledScene& scene) {
  Archive archive;
  read_tables(archive, const_cast<CompiledScene&>(scene));  // a writer changes nothing
  return archive.json();
}

void read_tables(Archive& archive, CompiledScene& scene) {
  archive.all([&] { fields(archive, scene); });
}

void resolve_image_path(CompiledScene& scene) {
  Background::Image& image = scene.background.image;
  const std::filesystem::path folder = std::filesystem::path(scene.source.name()).parent_path();
  image.file = image.name.empty() ? "" : (folder / image.name).string();
}

}  // namespace fathom::compiler
