#include "compiler/analysis/area_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "compiler/geometry/affine.h"

namespace fathom::compiler {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

bool is_shape(Kind kind) {
  return kind == Kind::Sphere || kind == Kind::Box || kind == Kind::Cylinder || kind == Kind::Capsule ||
         kind == Kind::Quad;
}

// True for nodes that keep their children's surfaces, except for placing them.
bool is_way(Kind kind) {
  return kind == Kind::Union || kind == Kind::Transform || kind == Kind::Scaled || kind == Kind::Paint;
}

// A similarity transform into an area light's space: q = R^T (p - t) / s.
struct AreaLightPlacement {
  dmat3 rotation;
  dvec3 translation;
  double scale;
};

// Returns nullopt when the map scales directions differently.
std::optional<AreaLightPlacement> placement_of(const Affine& to_local) {
  constexpr double kTolerance = 1e-9;
  const std::array<dvec3, 3>& rows = to_local.rows;
  const double length = glm::length(rows[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(std::abs(glm::length(rows[i]) - length) <= kTolerance * length)) return std::nullopt;
    if (!(std::abs(glm::dot(rows[i], rows[(i + 1) % 3])) <= kTolerance * length * length)) return std::nullopt;
  }
  return AreaLightPlacement{dmat3(rows[0] / length, rows[1] / length, rows[2] / length),
                            inverse(to_local).translation, 1 / length};
}

// Sets the area light's space: the quad's plane becomes the xy plane, the quad's centre the origin.
void set_quad(AreaLight& area_light, std::span<const double> p, const AreaLightPlacement& place) {
  std::array<dvec3, 4> v;
  dvec3 middle(0);
  for (std::size_t i = 0; i < 4; ++i) {
    v[i] = place.rotation * (place.scale * dvec3(p[3 * i], p[3 * i + 1], p[3 * i + 2])) + place.translation;
    middle += 0.25 * v[i];
  }
  const dvec3 x = glm::normalize(v[1] - v[0]);
  // The cross product of a convex quad's diagonals is twice its area along the normal.
  const dvec3 z = glm::normalize(glm::cross(v[2] - v[0], v[3] - v[1]));
  area_light.rotation = dmat3(x, glm::cross(z, x), z);
  area_light.translation = middle;
  area_light.radius = p[12] * place.scale;
  for (std::size_t i = 0; i < 4; ++i)
    area_light.corners[i] = dvec2(glm::transpose(area_light.rotation) * (v[i] - middle));
}

std::optional<AreaLight> lamp_of(Kind kind, std::span<const double> p, const Affine& to_local) {
  const std::optional<AreaLightPlacement> place = placement_of(to_local);
  if (!place) return std::nullopt;
  AreaLight area_light;
  area_light.rotation = place->rotation;
  area_light.translation = place->translation;
  switch (kind) {
    case Kind::Box:
      area_light.shape = AreaLight::Shape::Box;
      area_light.half_size = place->scale * dvec3(p[0], p[1], p[2]);
      break;
    case Kind::Cylinder:
    case Kind::Capsule:
      area_light.shape = kind == Kind::Cylinder ? AreaLight::Shape::Cylinder : AreaLight::Shape::Capsule;
      area_light.radius = place->scale * p[0];
      area_light.half_height = place->scale * p[1];
      break;
    case Kind::Quad:
      area_light.shape = AreaLight::Shape::Quad;
      set_quad(area_light, p, *place);
      break;
    default:
      area_light.shape = AreaLight::Shape::Sphere;
      area_light.radius = place->scale * p[0];
  }
  return area_light;
}

// Visits beyond one per node. A non-uniform scale can lead to any number of visits and to no area light.
constexpr std::size_t kMaxVisits = 8 * kMaxAreaLights;

// Identifies area lights in the same place. Equal area lights that different transforms place there are rare and
// count twice.
using LampPlace = std::tuple<int, std::array<double, 12>, std::vector<double>>;

class Finder {
 public:
  Finder(const Scene& scene, std::span<const Surface> surfaces, std::span<const Material> materials)
      : graph_(scene.graph), surfaces_(surfaces), materials_(materials) {
    mark();
    count_uses(scene);
    const Affine identity{{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}, dvec3(0)};
    tasks_.push_back({scene.root, identity, std::nullopt});
    const std::size_t max_visits = graph_.size() + kMaxVisits;
    for (std::size_t i = 0; i < max_visits && !tasks_.empty() && area_lights_.size() < kMaxAreaLights; ++i) {
      const Task task = tasks_.back();
      tasks_.pop_back();
      visit(task);
    }
  }
  std::vector<AreaLight> take() { return std::move(area_lights_); }

 private:
  struct Task {
    NodeId node;
    Affine to_local;
    std::optional<std::uint32_t> surface;  // given by the innermost Paint above the node
  };

  // A shared node is visited once per combination of surface and transform.
  using Visited = std::tuple<NodeId, std::optional<std::uint32_t>, std::array<double, 12>>;

  bool glows(std::uint32_t surface) const {
    const Material& material = materials_[surfaces_[surface].material];
    return emits(material) && !transmits(material);
  }
  std::uint32_t painted(NodeId id) const { return static_cast<std::uint32_t>(graph_.params(id)[0]); }

  // Marks the nodes that hold area lights, with and without a glowing Paint above them. The walk enters only marked
  // nodes.
  void mark() {
    holds_.resize(graph_.size());
    for (NodeId id = 0; id < graph_.size(); ++id) {
      const Kind kind = graph_.kind(id);
      if (is_shape(kind)) holds_[id] = {false, true};
      if (!is_way(kind)) continue;
      for (const NodeId child : graph_.children(id)) {
        for (const bool lit : {false, true}) {
          const bool inner = kind == Kind::Paint ? glows(painted(id)) : lit;
          holds_[id][lit] = holds_[id][lit] || holds_[child][inner];
        }
      }
    }
  }

  void count_uses(const Scene& scene) {
    shared_.resize(graph_.size());
    std::vector<bool> used(graph_.size());
    for (NodeId id = 0; id <= scene.root; ++id) {
      for (const NodeId child : graph_.children(id)) {
        shared_[child] = shared_[child] || used[child];
        used[child] = true;
      }
    }
  }

  void visit(const Task& task) {
    const Kind kind = graph_.kind(task.node);
    if (!holds_[task.node][task.surface && glows(*task.surface)]) return;
    if (shared_[task.node] && !visited_.insert({task.node, task.surface, task.to_local.params()}).second) return;
    if (is_shape(kind)) return add(task);
    Task inner = task;
    if (kind == Kind::Paint) inner.surface = painted(task.node);
    if (kind == Kind::Transform)
      inner.to_local = compose(Affine::from_params(graph_.params(task.node)), task.to_local);
    const std::span<const NodeId> children = graph_.children(task.node);
    for (std::size_t i = children.size(); i > 0; --i) {  // the first child ends on top
      inner.node = children[i - 1];
      tasks_.push_back(inner);
    }
  }

  void add(const Task& task) {
    const std::span<const double> params = graph_.params(task.node);
    std::optional<AreaLight> area_light = lamp_of(graph_.kind(task.node), params, task.to_local);
    if (!area_light) return;
    LampPlace place{static_cast<int>(area_light->shape), task.to_local.params(), {params.begin(), params.end()}};
    if (!taken_.insert(std::move(place)).second) return;
    area_light->surface = *task.surface;
    area_light->material = surfaces_[*task.surface].material;
    area_lights_.push_back(*area_light);
  }

  const Graph& graph_;
  const std::span<const Surface> surfaces_;
  const std::span<const Material> materials_;
  std::vector<std::array<bool, 2>> holds_;  // [node][1 below a glowing Paint] true if it holds area lights
  std::vector<bool> shared_;                // [node] true if several nodes use it
  std::vector<Task> tasks_;
  std::set<Visited> visited_;
  std::set<LampPlace> taken_;
  std::vector<AreaLight> area_lights_;
};

}  // namespace

std::vector<AreaLight> find_area_lights(const Scene& scene, std::span<const Surface> surfaces,
                                        std::span<const Material> materials) {
  return Finder(scene, surfaces, materials).take();
}

}  // namespace fathom::compiler
