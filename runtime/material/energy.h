// What a rough boundary makes of the light that falls on it, by direction, when light meets one microfacet and no
// more: its albedo, and what is lost behind other facets. Materials give that back (Kulla and Conty, "Revisiting
// Physically Based Shading at Imageworks", 2017).
//
//     const AlbedoRow lost = conductor_loss(alpha);
//     lost.at(cos_o), lost.average()
//
// The numbers come from tables made by quadrature, a row of one roughness (and index) when it is first asked for, by
// whatever thread; a new material takes some milliseconds, rough glass some forty. Indices go up to kMostEta. Against
// the integrals rows err by at most 5e-3 and 1e-3 in the mean, most of it at the horizon of nearly smooth surfaces.
// Tested by: tests/runtime/material/energy_test.cpp
#pragma once

#include <array>

namespace fathom::runtime {

// An index further from 1 than this, or than its inverse, is taken as this.
inline constexpr float kMostEta = 4;

// A function of the cosine in [0,1], by its values where cos^(1/4) = 0, 1/23 ... 1, with cubics between them.
// (Near the horizon of a smooth surface it changes within cosines of a few alpha.)
struct AlbedoRow {
  static constexpr int kNodes = 24;
  std::array<float, kNodes> node;

  static AlbedoRow constant(float value);
  static float node_cos(int i) {
    const float x = static_cast<float>(i) / (kNodes - 1);
    return x * x * (x * x);
  }
  float at(float cos) const;
  // Over the hemisphere by cosine, 2 int f mu dmu: of the function that at() gives, so that what is divided by it is
  // normalised.
  float average() const;
  float greatest() const;
};

// What is lost where facets reflect everything.
AlbedoRow conductor_loss(float alpha);
// The part that a rough dielectric reflects; eta >= 1, index of the far side relative to this one.
AlbedoRow reflection_albedo(float alpha, float eta);
// What is neither reflected by a rough dielectric nor let through; any eta.
AlbedoRow dielectric_loss(float alpha, float eta);
// The part that a smooth dielectric reflects; eta >= 1.
AlbedoRow smooth_albedo(float eta);

// What a coat over a rough boundary takes of the reflected light because that leaves lower than it came, where light
// counts by what the coat passes of it on the way in or out, whichever is less: the mean of
// max(0, coat(cos_i) - coat(cos_o)). `coat` is the part that the coat reflects, which must fall as the cosine rises:
// where it does not the result is too small. eta >= 1. One row is kept for each thread and material.
AlbedoRow coat_loss_of_conductor(float alpha, const AlbedoRow& coat);
AlbedoRow coat_loss_of_reflection(float alpha, float eta, const AlbedoRow& coat);

// The integrals themselves, over the visible normals on a Fibonacci lattice of so many points: a pair of neighbours
// in Fibonacci's sequence. `cos` in [0,1].
struct Lattice {
  int points, step;
};
struct BoundaryAlbedo {
  float reflected, lost;  // the rest passes
};
float integrate_conductor_loss(float cos, float alpha, Lattice lattice);
BoundaryAlbedo integrate_dielectric(float cos, float alpha, float eta, Lattice lattice);

}  // namespace fathom::runtime
