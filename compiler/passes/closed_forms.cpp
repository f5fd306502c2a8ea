#include "compiler/passes/closed_forms.h"

#include <algorithm>
#include <array>
#include <glm/matrix.hpp>
#include <span>

#include "compiler/geometry/affine.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

using Shape = ClosedForm::Shape;

// Returns a primitive's solid.
std::vector<ClosedForm> primitive_form(Kind kind, Params p) {
  const auto form = [](Shape shape, std::array<double, 4> size) {
    return std::vector{ClosedForm{.shape = shape, .size = size}};
  };
  switch (kind) {
    case Kind::Sphere:
      return form(Shape::Ball, {p[0]});
    case Kind::Box:
      return form(Shape::Box, {p[0], p[1], p[2]});
    case Kind::RoundBox:
      return form(Shape::RoundBox, {p[0], p[1], p[2], p[3]});
    case Kind::Cylinder:
      return form(Shape::Cylinder, {p[0], p[1]});
    case Kind::RoundedCylinder:
      return form(Shape::RoundedCylinder, {p[0], p[1], p[2]});
    case Kind::Capsule:
      return form(Shape::Capsule, {p[0], p[1]});
    case Kind::Plane: {
      const Code code = spec(Kind::Plane).code(p);
      const std::vector<double>& k = code.after[0].immediates;
      return form(Shape::HalfSpace, {k[0], k[1], k[2], k[3]});
    }
    default:
      return {};
  }
}

void move_forms(const Affine& map, std::vector<ClosedForm>& forms) {
  const glm::dmat3 linear = glm::transpose(glm::dmat3(map.rows[0], map.rows[1], map.rows[2]));
  for (ClosedForm& form : forms) {
    form.translation += form.linear * map.translation;
    form.linear = form.linear * linear;
  }
}

// Returns the forms of all operands, those after the first `kept` cut from the others.
std::vector<ClosedForm> joined_forms(const Graph& graph, std::span<const NodeId> operands, std::size_t kept) {
  std::vector<ClosedForm> all;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const bool united = i >= kept && graph.kind(operands[i]) == Kind::Union;  // a - (b | c) = a - b - c
    const std::vector<ClosedForm> own =
        united ? joined_forms(graph, graph.children(operands[i]), 0) : closed_forms(graph, operands[i]);
    const bool one = own.size() == 1 && !own[0].cut;
    if (own.empty() || (i >= kept && !united && !one)) return {};
    for (ClosedForm form : own) {
      form.cut = form.cut || i >= kept;
      all.push_back(form);
    }
  }
  return all;
}

}  // namespace

std::vector<ClosedForm> closed_forms(const Graph& graph, NodeId id) {
  std::vector<ClosedForm> forms;
  switch (graph.kind(id)) {
    case Kind::Paint:
    case Kind::Scaled:
      return closed_forms(graph, graph.children(id)[0]);
    case Kind::Transform:
      forms = closed_forms(graph, graph.children(id)[0]);
      move_forms(Affine::from_params(graph.params(id)), forms);
      return forms;
    case Kind::Subtraction:
      forms = joined_forms(graph, graph.children(id), 1);
      break;
    case Kind::Intersection:
      forms = joined_forms(graph, graph.children(id), graph.children(id).size());
      break;
    default:
      return primitive_form(graph.kind(id), graph.params(id));
  }
  // The exit of a ray from a rounded solid is not known.
  const auto rounded = [](const ClosedForm& form) {
    return form.shape == Shape::RoundBox || form.shape == Shape::RoundedCylinder;
  };
  if (forms.size() > kMostForms || std::ranges::any_of(forms, rounded)) return {};
  return forms;
}

}  // namespace fathom::compiler
