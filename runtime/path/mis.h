// Weights of multiple importance sampling (MIS): light that both next-event estimation and BSDF sampling find counts
// with weights whose sum is 1.
// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2.
// Tested by: tests/runtime/path/stages_test.cpp
#pragma once

#include "runtime/path/options.h"

namespace fathom::runtime {

// The power heuristic.
inline float power_heuristic(float this_pdf, float other_pdf) {
  const float ratio = other_pdf / this_pdf;
  return 1 / (1 + ratio * ratio);
}

// Returns the weight of light that a ray sampled with density `bsdf_pdf` hits, and that next-event estimation samples
// with density `light_pdf`. A density of 0 means that the other method alone finds the light.
inline float bsdf_mis_weight(LightSampling sampling, float bsdf_pdf, float light_pdf) {
  if (bsdf_pdf == 0 || light_pdf == 0) return 1;
  switch (sampling) {
    case LightSampling::Mis:
      return power_heuristic(bsdf_pdf, light_pdf);
    case LightSampling::Bsdf:
      return 1;
    case LightSampling::Nee:
      return 0;
  }
  return 1;
}

}  // namespace fathom::runtime
