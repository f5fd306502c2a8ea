#include "compiler/frontend/suggest.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics.h"

namespace fathom::compiler {
namespace {

struct Synonym {
  std::string_view foreign, ours;
};

// Words of other renderers, modellers and shader collections. A foreign word may stand for several of ours; the first
// that is known at the place is meant.
constexpr Synonym kSynonyms[] = {
    {"subtract", "subtraction"},
    {"difference", "subtraction"},
    {"minus", "subtraction"},
    {"cut", "subtraction"},
    {"smooth_subtract", "smooth_subtraction"},
    {"smooth_difference", "smooth_subtraction"},
    {"intersect", "intersection"},
    {"and", "intersection"},
    {"smooth_intersect", "smooth_intersection"},
    {"add", "union"},
    {"or", "union"},
    {"group", "union"},
    {"merge", "union"},
    {"unite", "union"},
    {"smin", "smooth_union"},
    {"blend", "smooth_union"},
    {"blend", "k"},
    {"smoothness", "k"},
    {"smooth", "k"},
    {"ball", "sphere"},
    {"spheroid", "ellipsoid"},
    {"chain_link", "link"},
    {"cube", "box"},
    {"cuboid", "box"},
    {"rounded_box", "round_box"},
    {"vertical_capsule", "capsule"},
    {"pill", "capsule"},
    {"stadium", "capsule"},
    {"line_segment", "capsule"},
    {"tapered_capsule", "round_cone"},
    {"rounded_cone", "round_cone"},
    {"capped_cone", "cone"},
    {"round_cylinder", "rounded_cylinder"},
    {"donut", "torus"},
    {"ring", "torus"},
    {"arc_torus", "capped_torus"},
    {"bounding_box", "box_frame"},
    {"wireframe_box", "box_frame"},
    {"frame", "box_frame"},
    {"tetra", "tetrahedron"},
    {"octa", "octahedron"},
    {"dodeca", "dodecahedron"},
    {"icosa", "icosahedron"},
    {"schwarz", "schwarz_p"},
    {"primitive_surface", "schwarz_p"},
    {"diamond_surface", "schwarz_d"},
    {"lattice", "gyroid"},
    {"cell", "period"},
    {"menger", "menger_sponge"},
    {"sponge", "menger_sponge"},
    {"julia_set", "julia"},
    {"quaternion_julia", "julia"},
    {"quaternion", "julia"},
    {"ground", "plane"},
    {"half_space", "plane"},
    {"shell", "onion"},
    {"hollow", "onion"},
    {"offset", "round"},
    {"rounding", "radius"},
    {"fractal", "mandelbulb"},
    {"pos", "position"},
    {"eye", "position"},
    {"origin", "position"},
    {"from", "position"},
    {"location", "position"},
    {"lookat", "target"},
    {"look_at", "target"},
    {"look", "target"},
    {"to", "target"},
    {"at", "target"},
    {"vfov", "fov_y"},
    {"yfov", "fov_y"},
    {"hfov", "fov"},
    {"field_of_view", "fov"},
    {"angle", "fov"},
    {"projection", "type"},
    {"kind", "type"},
    {"shape", "type"},
    {"primitive", "type"},
    {"op", "type"},
    {"ref", "use"},
    {"instance", "use"},
    {"pos", "translate"},
    {"position", "translate"},
    {"center", "translate"},
    {"centre", "translate"},
    {"translation", "translate"},
    {"move", "translate"},
    {"rotation", "rotate"},
    {"size", "half_size"},
    {"size", "scale"},
    {"extents", "half_size"},
    {"half_extents", "half_size"},
    {"dimensions", "half_size"},
    {"r", "radius"},
    {"r", "major_radius"},
    {"radius", "bottom_radius"},
    {"radius", "major_radius"},
    {"radius", "thickness"},
    {"radius1", "bottom_radius"},
    {"r1", "bottom_radius"},
    {"radius2", "top_radius"},
    {"r2", "top_radius"},
    {"height", "half_height"},
    {"h", "half_height"},
    {"h", "height"},
    {"half_height", "height"},
    {"width", "half_width"},
    {"base", "half_width"},
    {"aperture", "angle"},
    {"half_angle", "angle"},
    {"size", "radius"},
    {"n", "normal"},
    {"distance", "offset"},
    {"d", "offset"},
    {"children", "of"},
    {"child", "of"},
    {"nodes", "of"},
    {"objects", "of"},
    {"shapes", "of"},
    {"operands", "of"},
    {"node", "of"},
    {"color", "material"},
    {"id", "name"},
    {"resolution", "width"},
    {"samples", "spp"},
    {"samples_per_pixel", "spp"},
    {"depth", "bounces"},
    {"max_depth", "bounces"},
    {"max_bounces", "bounces"},
    {"tile_size", "tile"},
    {"max_distance", "far"},
    {"ground", "bottom"},
    {"horizon", "bottom"},
    {"sky", "top"},
    {"zenith", "top"},
    {"sky", "background"},
    {"environment", "background"},
    {"scene", "objects"},
    {"image", "film"},
    {"settings", "render"},
    {"definitions", "nodes"},
    {"parameters", "params"},
    {"variables", "params"},
    {"constants", "params"},
    {"value", "default"},
    {"minimum", "min"},
    {"maximum", "max"},
    {"description", "doc"},
    {"colour", "color"},
    {"albedo", "color"},
    {"reflectance", "color"},
    {"tint", "color"},
    {"transmittance", "color"},
    {"radiance", "emission"},
    {"intensity", "emission"},
    {"power", "emission"},
    {"color", "emission"},
    {"index_of_refraction", "ior"},
    {"eta", "ior"},
    {"lambert", "diffuse"},
    {"lambertian", "diffuse"},
    {"matte", "diffuse"},
    {"mirror", "specular"},
    {"metal", "specular"},
    {"glass", "transparent"},
    {"dielectric", "transparent"},
    {"light", "emissive"},
    {"emitter", "emissive"},
    {"area_light", "emissive"},
    {"ortho", "orthographic"},
    {"persp", "perspective"},
    {"pinhole", "perspective"},
    {"ln", "log"},
    {"lerp", "mix"},
    {"fabs", "abs"},
    {"fmod", "mod"},
    {"modulo", "mod"},
    {"nearest", "round"},
    {"power", "pow"},
    {"norm", "length"},
    {"saturate", "clamp"},
    {"arcsin", "asin"},
    {"arccos", "acos"},
    {"arctan", "atan"},
    {"arctan2", "atan2"},
};

}  // namespace

std::string_view suggest(std::string_view word, const std::vector<std::string_view>& known) {
  for (const Synonym& synonym : kSynonyms) {
    if (synonym.foreign == word && std::find(known.begin(), known.end(), synonym.ours) != known.end()) {
      return synonym.ours;
    }
  }
  return nearest(word, known);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known) {
  constexpr std::size_t kMostListed = 30;  // a scene may name thousands of nodes
  if (known.empty()) return "";
  std::vector<std::string_view> sorted = known;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t listed = std::min(sorted.size(), kMostListed);
  const std::string_view meant = suggest(word, known);
  // Among many the list would bury the answer.
  if (!meant.empty() && known.size() > kMostListed) return fmt::format("did you mean `{}`?", meant);
  std::string out = meant.empty() ? "" : fmt::format("did you mean `{}`? ", meant);
  out +=
      fmt::format("known: {}", fmt::join(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(listed), ", "));
  if (listed < sorted.size()) out += fmt::format(" and {} more", sorted.size() - listed);
  return out;
}

}  // namespace fathom::compiler
