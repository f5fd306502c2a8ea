#include "compiler/frontend/syntax/suggest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "compiler/source/diagnostics.h"

namespace fathom::compiler {
namespace {

struct Synonym {
  std::string_view foreign, ours;
};

// Terms of other renderers, modellers and shader collections. A foreign term may have several of our words. suggest()
// takes the first that is known in its context.
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
    {"disk", "circle"},
    {"disc", "circle"},
    {"rect", "rectangle"},
    {"square", "rectangle"},
    {"rounded_square", "rounded_rectangle"},
    {"line", "segment"},
    {"capsule_2d", "segment"},
    {"polyline", "polygon"},
    {"ngon", "regular_polygon"},
    {"triangle_2d", "isosceles_triangle"},
    {"pentagon", "regular_polygon"},
    {"hexagon", "regular_polygon"},
    {"octagon", "regular_polygon"},
    {"hexagram", "star"},
    {"pentagram", "star"},
    {"rhombus_2d", "diamond"},
    {"vesica_2d", "lens"},
    {"vesica_piscis", "lens"},
    {"crescent", "moon"},
    {"sector", "pie"},
    {"circular_segment", "cut_disk"},
    {"annulus", "ring"},
    {"oval", "ellipse"},
    {"plus", "cross"},
    {"linear_extrude", "extrude"},
    {"extrusion", "extrude"},
    {"rotate_extrude", "revolve"},
    {"revolution", "revolve"},
    {"lathe", "revolve"},
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
    {"depth", "rr_depth"},
    {"max_depth", "rr_depth"},
    {"max_bounces", "rr_depth"},
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
    {"pbr", "principled"},
    {"openpbr", "principled"},
    {"disney", "principled"},
    {"standard_surface", "principled"},
    {"basecolor", "base_color"},
    {"metallic", "metalness"},
    {"metallic", "base_metalness"},
    {"clearcoat", "coat"},
    {"clear_coat", "coat"},
    {"clearcoat_roughness", "coat_roughness"},
    {"alpha", "opacity"},
    {"sheet", "thin_walled"},
    {"checkerboard", "checker"},
    {"checkers", "checker"},
    {"stripe", "stripes"},
    {"bands", "stripes"},
    {"ramp", "gradient"},
    {"perlin", "noise"},
    {"fbm", "noise"},
    {"turbulence", "noise"},
    {"brick", "bricks"},
    {"color1", "a"},
    {"color2", "b"},
    {"color_a", "a"},
    {"color_b", "b"},
    {"persistence", "gain"},
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

struct ForeignTerm {
  std::string_view term, help;
};

constexpr std::string_view kVector = "a vector is a list: [1, 2, 3]",
                           kRepeat = "copies on a grid are body.repetition(period = [2, 0, 0], count = [5, 1, 1]), in a "
                                     "turn body.polar_repetition(8)",
                           kSmoothUnion = "a smooth union is a +{0.1} b, a smooth cut a -{0.1} b",
                           kFillet = "an edge where bodies meet is rounded by a +{round = 0.1} b or a -{round = 0.1} b, "
                                     "all edges by body.round(0.1)",
                           kFog = "there is no air that scatters light; a body's inside tints it: "
                                  "transparent(absorption = 0.5)",
                           kThread = "the library has bolts and nuts: import \"std/screws\" as screws";

// The terms are those of GLSL, OpenSCAD, curv and libraries of distance functions.
constexpr ForeignTerm kForeignTerms[] = {
    {"vec2", "a vector is a list: [1, 2]"},
    {"vec3", kVector},
    {"vec4", kVector},
    {"float2", "a vector is a list: [1, 2]"},
    {"float3", kVector},
    {"vector", kVector},
    {"repeat", kRepeat},
    {"domain_repeat", kRepeat},
    {"array", kRepeat},
    {"repeat_xy", kRepeat},
    {"repeat_radial", kRepeat},
    {"smin", kSmoothUnion},
    {"smax", "a smooth intersection is a &{0.1} b"},
    {"smooth_min", kSmoothUnion},
    {"blend", kSmoothUnion},
    {"fillet", kFillet},
    {"chamfer", "a chamfer where bodies meet is a +{chamfer = 0.1} b or a -{chamfer = 0.1} b"},
    {"text", "there are no letters: an outline of points is polygon([[0, 0], [1, 0], [0, 1]])"},
    {"thread", kThread},
    {"screw", kThread},
    {"bolt", kThread},
    {"minkowski", "the Minkowski sum with a ball is body.round(0.1); there is no other"},
    {"hull", "there is no hull: of two balls it is round_cone or capsule, of points an extruded polygon"},
    {"loft", "there is no loft: a body that narrows is body.taper(...)"},
    {"fog", kFog},
    {"mist", kFog},
    {"volume", kFog},
    {"at", "a body is moved by body.translate([1, 2, 3])"},
    // Functions of numbers, which shaders apply to the distances of bodies.
    {"min", "a union is written a + b"},
    {"max", "an intersection is written a & b, a cut a - b"},
    {"mix", "what lies between two bodies is morph(a, b, t = 0.5), a soft join a +{0.2} b"},
    {"mod", "copies on a grid are body.repetition(period = [2, 0, 0])"},
    {"abs", "a shell is body.onion(0.05), a mirrored body body.mirror([1, 0, 0])"},
};

}  // namespace

std::string_view foreign_help(std::string_view word) {
  const auto* const found = std::ranges::find(kForeignTerms, word, &ForeignTerm::term);
  return found == std::end(kForeignTerms) ? "" : found->help;
}

std::string_view suggest(std::string_view word, const std::vector<std::string_view>& known) {
  for (const Synonym& synonym : kSynonyms) {
    if (synonym.foreign == word && std::find(known.begin(), known.end(), synonym.ours) != known.end()) {
      return synonym.ours;
    }
  }
  return nearest(word, known);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known) {
  // A scene may name thousands of nodes, so list at most this many. List one more rather than print "and 1 more",
  // which is as long as the name.
  constexpr std::size_t kMaxListed = 30;
  if (known.empty()) return "";
  std::vector<std::string_view> sorted = known;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t listed = sorted.size() == kMaxListed + 1 ? sorted.size() : std::min(sorted.size(), kMaxListed);
  const std::string_view meant = suggest(word, known);
  // A long list would hide the suggestion.
  if (!meant.empty() && known.size() > kMaxListed) return fmt::format("did you mean `{}`?", meant);
  std::string out = meant.empty() ? "" : fmt::format("did you mean `{}`? ", meant);
  out +=
      fmt::format("known: {}", fmt::join(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(listed), ", "));
  if (listed < sorted.size()) out += fmt::format(" and {} more", sorted.size() - listed);
  return out;
}

}  // namespace fathom::compiler
