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

constexpr double kAny = 1e300;               // of numbers that must be finite alone
constexpr double kTiny = 1e-300;             // of numbers above 0
constexpr double kWhole = 9007199254740992;  // 2^53: up to here a double counts
constexpr std::string_view kProjections[] = {"perspective", "orthographic", "panorama"};
constexpr std::string_view kBackgrounds[] = {"gradient", "sky", "image"};
constexpr std::string_view kLights[] = {"point", "spot", "directional"};
constexpr std::string_view kLamps[] = {"sphere", "box", "cylinder", "capsule", "quad"};
constexpr std::string_view kMaterials[] = {"diffuse", "emissive", "specular", "transparent", "principled"};

void index(Archive& a, std::string_view name, std::uint32_t& number, std::size_t count) {
  if (a.reading() && count == 0) return a.fail(fmt::format("`{}` names something of which there is none", name));
  field(a, name, number, 0, a.reading() ? count - 1 : ~std::uint32_t{0});
}

void unit_vector(Archive& a, std::string_view name, glm::dvec3& v) {
  field(a, name, v, -1, 1);
  if (a.reading() && !(std::abs(glm::length(v) - 1) < 1e-6)) a.fail(fmt::format("`{}` is not of length 1", name));
}

void signed_whole(Archive& a, std::string_view name, int& number, int least, int most) {
  double wide = number;
  field(a, name, wide, least, most);
  const bool negative_zero = wide == 0 && std::signbit(wide);
  if (wide != std::trunc(wide) || negative_zero) a.fail(fmt::format("{} is not a whole number", wide));
  number = static_cast<int>(wide);
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
  a.begin("parameter");
  a.choice(at, names);
  a.end();
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

// A variant as the index of what it holds, by name, and that.
template <typename Variant, std::size_t... kIndex>
void make(Variant& v, std::size_t index, std::index_sequence<kIndex...>) {
  (void)((index == kIndex && (v = std::variant_alternative_t<kIndex, Variant>{}, true)) || ...);
}
template <typename Variant>
void kind(Archive& a, std::string_view name, Variant& v, ChoiceNames names) {
  std::size_t index = v.index();
  a.begin(name);
  a.choice(index, names);
  a.end();
  if (a.reading()) make(v, index, std::make_index_sequence<std::variant_size_v<Variant>>());
}

constexpr std::string_view kPatterns[] = {"checker", "stripes", "gradient", "noise", "bricks"};
constexpr std::string_view kFrameRows[] = {"x_row", "y_row", "z_row"};
constexpr std::string_view kChannels[] = {"red", "green", "blue"};
constexpr std::string_view kCorners[] = {"corner0", "corner1", "corner2", "corner3"};
constexpr std::string_view kTextures[] = {"color", "formula", "pattern"};

// `textures` is how many come before this one.
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

void fields(Archive& a, Lamp& l, const CompiledScene& scene) {
  field(a, "shape", l.shape, ChoiceNames(kLamps));
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

void media(Archive& a, CompiledScene& scene) {
  a.begin("media");
  if (a.list(scene.media.size()) != scene.media.size()) a.fail("there are not as many programs of media");
  for (Medium& medium : scene.media) {
    a.begin_record();
    index(a, "material", medium.material, scene.materials.size());
    fields(a, static_cast<CompiledField&>(medium));
    a.end_record();
  }
  a.end();
}

// Of patterns of patterns: how deep the deepest is, and how many are evaluated at a point for the dearest; one that
// two share counts twice.
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
  a.begin("textures");
  const std::size_t count = a.list(scene.textures.size());
  if (a.reading()) scene.textures.clear();
  for (std::size_t i = 0; i < count && !a.failed(); ++i) {
    if (a.reading()) scene.textures.emplace_back();
    a.begin_record();
    fields(a, scene.textures[i], i, scene.formulas.size());
    a.end_record();
  }
  a.end();
  if (!a.reading() || a.failed()) return;
  // Of a scene's text no more than there are, for there nothing is shared; a few thousand do no harm where something
  // is.
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
  if (!a.reading() || a.failed()) return;
  const glm::dvec3 view = c.target - c.position;
  const double across = glm::length(glm::cross(glm::normalize(view), glm::normalize(c.up)));
  if (!(glm::length(view) > 0 && across > 0)) a.fail("the camera has no direction of view, or looks along its `up`");
}

void fields(Archive& a, Film& f) {
  field(a, "width", f.width, 1, kMaxSide);
  field(a, "height", f.height, 1, kMaxSide);
  field(a, "exposure", f.exposure, -100, 100);
  field(a, "filter", f.filter, ChoiceNames(kFilterNames));
  field(a, "filter_width", f.filter_width, kMinFilterWidth, kMaxFilterWidth);
  field(a, "tone", f.tone, ChoiceNames(kToneCurves));
}

void fields(Archive& a, RenderSettings& s) {
  field(a, "spp", s.spp, 1, kMaxSpp);
  field(a, "rr_depth", s.rr_depth, 0, kMaxDepth);
  field(a, "tile", s.tile, 1, kMaxTile);
  field(a, "seed", s.seed, 0, ~std::uint64_t{0});
  field(a, "sampler", s.sampler, ChoiceNames(kSamplerNames));
  field(a, "noise_threshold", s.noise_threshold, 0, 1e6);
  field(a, "far", s.far, kTiny, kAny);
}

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
  field(a, "picture", b.image.name);
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
  field(a, "magnitude", f.magnitude, 0, kAny);
  field(a, "certified", f.certified);
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
  list(a, "lamps", scene.lamps, [&](Archive& archive, Lamp& lamp) { fields(archive, lamp, scene); });
  record(a, "field", static_cast<CompiledField&>(scene));
  media(a, scene);
}

void place_picture(CompiledScene& scene) {
  Background::Image& image = scene.background.image;
  const std::filesystem::path folder = std::filesystem::path(scene.source.name()).parent_path();
  image.file = image.name.empty() ? "" : (folder / image.name).string();
}

}  // namespace fathom::compiler
