// The albedo of a rough interface by direction, for light that meets one microfacet and no more: the part that it
// reflects, and the part that is lost behind other facets. Materials give the lost light back (Kulla and Conty,
// "Revisiting Physically Based Shading at Imageworks", 2017).
//
//     const DirectionalAlbedo lost = conductor_loss(alpha);
//     lost.at(cos_o), lost.average()
//
// The numbers come from tables made by quadrature. The first thread that asks for the row of a roughness (and index)
// makes the row. A new material takes some milliseconds, rough glass some fifty. Indices go up to kMaxEta. Compared
// with the integrals, rows err by at most 5e-3, and by 1e-3 in the mean, mostly at the horizon of nearly smooth
// surfaces.
// Tested by: tests/runtime/material/directional_albedo_test.cpp
#pragma once

#include <array>

namespace fathom::runtime {

// Maximum index: an index further from 1 than this, or than its inverse, is clamped to it.
inline constexpr float kMaxEta = 4;

// A function of the cosine in [0,1], by its values where (cos^(1/4) + cos) / 2 = 0, 1/31 ... 1, with cubics between
// them. Near the horizon of a smooth surface the function changes within cosines of a few alpha, and far from it near
// the critical angle.
struct DirectionalAlbedo {
  static constexpr int kNodes = 32;
  std::array<float, kNodes> node;

  static DirectionalAlbedo constant(float value);
  static float node_cos(int i);
  float at(float cos) const;
  // Returns the average over the hemisphere by cosine, 2 int f mu dmu, of the function that at() gives, so that
  // dividing by the average normalises this function.
  float average() const;
  float max_value() const;
};

// Returns the part that is lost if facets reflect all light.
DirectionalAlbedo conductor_loss(float alpha);
// Returns the part that a rough dielectric reflects. eta >= 1 is the index of the far side relative to this side.
DirectionalAlbedo reflection_albedo(float alpha, float eta);
// Returns the part that a rough dielectric neither reflects nor lets through, for any eta.
DirectionalAlbedo dielectric_loss(float alpha, float eta);
// Returns the part that a smooth dielectric reflects, for eta >= 1.
DirectionalAlbedo smooth_albedo(float eta);

// Return the part of the light reflected by a rough interface that a coat takes because the light leaves lower than
// it came: the mean of max(0, coat(cos_i) - coat(cos_o)). The coat passes light as on the way in or on the way out,
// whichever passes less. `coat` is the part that the coat reflects, which must fall as the cosine rises, otherwise
// the result is too small. eta >= 1. Each thread keeps one row per material.
DirectionalAlbedo coat_loss_of_conductor(float alpha, const DirectionalAlbedo& coat);
DirectionalAlbedo coat_loss_of_reflection(float alpha, float eta, const DirectionalAlbedo& coat);

// The integrals themselves, over the visible normals on a Fibonacci lattice. `points` and `step` are neighbours in
// Fibonacci's sequence. `cos` is in [0,1].
struct Lattice {
  int points, step;
};
struct InterfaceAlbedo {
  float reflected, lost;  // the rest passes
};
float integrate_conductor_loss(float cos, float alpha, Lattice lattice);
InterfaceAlbedo integrate_dielectric(float cos, float alpha, float eta, Lattice lattice);

}  // namespace fathom::runtime
