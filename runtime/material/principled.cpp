#include "runtime/material/principled.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "runtime/sampling/warp.h"

namespace fathom::runtime {
namespace {

constexpr float kInversePi = 0.318309886183790672f;
constexpr float kUniformHemispherePdf = kInversePi / 2;  // uniform density over a hemisphere
// An interface of less roughness is a mirror: no image resolves a lobe a twentieth of a degree wide.
constexpr float kMinAlpha = 1e-3f;
// Indices nearer to each other count as equal, except for their reflectance (1/40000): light is not bent enough to
// blur anything.
constexpr float kMinBend = 0.01f;
constexpr float kMinCos = 1e-6f;
// Minimum probability of a lobe that light may take.
constexpr float kMinChance = 0.01f;
// Stands for an index: facets reflect all light.
constexpr float kReflectsAll = INFINITY;
constexpr float kBelowOne = 0x1.fffffep-1f;

float max_of(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

glm::vec3 mirrored(glm::vec3 w) { return {-w.x, -w.y, w.z}; }
glm::vec3 below(glm::vec3 w) { return {w.x, w.y, -w.z}; }

// Returns the cosine of wo, or wi, with the facet's normal between them. The bits are the same from both, because
// near total reflection the last bit counts.
float half_vector_cosine(glm::vec3 wo, glm::vec3 wi) { return std::min(glm::length(wo + wi) / 2, 1.0f); }

// Samples the hemisphere uniformly: light is lost near the horizon, where cosine-weighted directions are few.
glm::vec3 square_to_uniform_hemisphere(glm::vec2 u) {
  const float z = 1 - u.x, radius = std::sqrt(std::max(1 - z * z, 0.0f));
  const SinCos angle = sincos_turn(u.y);
  return {radius * angle.cos, radius * angle.sin, z};
}

// Returns the part of diffuse light that an interface lets through. The part is the same from both sides except for
// eta^2, as radiance is.
float average_transmittance(float eta) {
  return eta >= 1 ? 1 - smooth_albedo(eta).average() : (1 - smooth_albedo(1 / eta).average()) * (eta * eta);
}

// Returns the factor by which a coat darkens light that a base of this albedo reflects, because the coat's inner side
// sends the part `inner` of that light back to the base (OpenPBR 1.1, "Darkening"). A white base is not darkened.
glm::vec3 coat_darkening(glm::vec3 albedo, float inner) {
  if (!(inner < 1)) return glm::vec3(1);  // at grazing angles, where the coat's outer side lets nothing through
  return (1 - inner) / (1.0f - glm::min(albedo, glm::vec3(1)) * inner);
}

DirectionalAlbedo complement_of(DirectionalAlbedo row) {
  for (float& value : row.node) value = std::max(1 - value, 0.0f);
  return row;
}

// Returns the index after scaling by specular_weight, which multiplies the reflectance at normal incidence, the
// square of s (OpenPBR 1.1, "Dielectric base"). Computed in double, so that both sides find the same interface.
float weighted_eta(float eta, float weight) {
  if (weight == 1) return eta;
  const double wide = static_cast<double>(eta);
  const double s = std::clamp(std::sqrt(static_cast<double>(weight)) * (wide - 1) / (wide + 1), -0.99, 0.99);
  return static_cast<float>((1 + s) / (1 - s));
}

}  // namespace

Principled::Principled(const MaterialPoint& m, glm::vec3 wo, float eta, bool inside)
    : wo_(wo.x, wo.y, std::max(wo.z, kMinCos)),
      eta_(weighted_eta(m.thin_walled ? std::max(eta, 1 / eta) : eta, m.specular_weight)),
      opacity_(std::clamp(m.opacity, 0.0f, 1.0f)),
      inside_(inside),
      thin_(m.thin_walled),
      ggx_(std::min(m.roughness * m.roughness, 1.0f)) {
  smooth_metal_ = ggx_.alpha() < kMinAlpha;
  smooth_interface_ = smooth_metal_ || std::abs(eta_ - 1) < kMinBend;
  if (!smooth_interface_) eta_ = std::clamp(eta_, 1 / kMaxEta, kMaxEta);
  if (m.coat_weight > 0) add_coat(m, eta);
  if (m.metalness > 0) add_metal(m);
  if (m.metalness < 1) add_interface(m);
  set_lobe_probabilities();
}

// Adds the coat. If the coat is the thinner medium, the ratio of indices is inverted, as in OpenPBR: the coat has a
// base to shine on, so that total reflection would be wrong.
void Principled::add_coat(const MaterialPoint& m, float eta) {
  const float around = inside_ && m.has_interior() ? m.ior * eta : m.ior / eta;
  const float ratio = m.coat_ior / around;
  coat_eta_ = std::clamp(std::max(ratio, 1 / ratio), 1.0f, kMaxEta);
  coat_weight_ = m.coat_weight;
  coat_ggx_ = Ggx(std::min(m.coat_roughness * m.coat_roughness, 1.0f));
  smooth_coat_ = coat_ggx_.alpha() < kMinAlpha;
  coat_albedo_ = smooth_coat_ ? smooth_albedo(coat_eta_) : reflection_albedo(coat_ggx_.alpha(), coat_eta_);
  const glm::vec3 twice = glm::mix(glm::vec3(1), m.coat_color, coat_weight_);
  coat_darkens_ = coat_weight_ * m.coat_darkening;
  glm::vec3 darkening(1);
  if (coat_darkens_ > 0) {
    inner_diffuse_ = 1 - average_transmittance(1 / coat_eta_);
    inner_roughness_ = std::min(m.roughness, 1.0f);
    body_albedo_ = (1 - m.metalness) * glm::mix(m.base_color, glm::vec3(1), m.transmission);
    const glm::vec3 albedo = body_albedo_ + m.metalness * m.specular_weight * m.base_color;
    darkening = glm::mix(glm::vec3(1), coat_darkening(albedo, inner_diffuse_), coat_darkens_);
  }
  if (!inside_) {
    coat_transmittance_o_ = coat_transmittance(wo_.z);
    coat_color_ = twice;
    coat_tint_ = twice * darkening;
  }
  transmitted_coat_tint_ = glm::sqrt(twice) * darkening;
}

// Returns coat_tint_ for light that facets at this cosine reflect. The coat's inner side reflects light from a mirror
// as its outer side reflects what arrives, and light from a rough base as diffuse light, with more total reflection.
// The cosine of the facets is the same for wo and wi.
glm::vec3 Principled::glossy_coat_tint(float cos_m) const {
  if (inside_ || !(coat_darkens_ > 0)) return coat_tint_;
  const float inner = glm::mix(fresnel(cos_m, coat_eta_), inner_diffuse_, inner_roughness_);
  const glm::vec3 albedo = body_albedo_ + (metal_ > 0 ? metal_ * metal_tint_(cos_m) : glm::vec3(0));
  return coat_color_ * glm::mix(glm::vec3(1), coat_darkening(albedo, inner), coat_darkens_);
}

void Principled::add_metal(const MaterialPoint& m) {
  metal_ = m.metalness * m.specular_weight;
  metal_tint_ = F82Tint(m.base_color, m.specular_color);
  if (smooth_metal_) return;
  // Light meets facets again and again, and is coloured each time: Kulla and Conty's geometric series.
  const DirectionalAlbedo lost = conductor_loss(ggx_.alpha());
  const float once = 1 - lost.average();
  const glm::vec3 average = m.specular_weight * metal_tint_.average();
  const glm::vec3 color = average * average * once / (1.0f - average * (1 - once));
  metal_compensation_.row = inside_ ? lost : add_coat_loss(attenuate_by_coat(lost), kReflectsAll);
  const float norm = metal_compensation_.row.average();
  if (norm > 0)
    metal_compensation_.strength = coat_tint_ * m.metalness * color * (metal_compensation_.row.at(wo_.z) / norm);
}

void Principled::add_interface(const MaterialPoint& m) {
  const float part = 1 - m.metalness;
  const bool has_diffuse = m.transmission<1, has_glass = m.transmission> 0;
  glass_ = part * m.transmission;
  glass_tint_ = m.transmission_color;
  if (!inside_) tint_ = m.specular_color;
  if (has_diffuse) add_diffuse_base(m);
  if (has_glass && !smooth_interface_) add_glass_compensation(m);
}

// Adds the diffuse base, which lies bare if the surroundings are denser, as from inside, because total reflection
// would hide the diffuse base.
void Principled::add_diffuse_base(const MaterialPoint& m) {
  const float part = (1 - m.metalness) * (1 - m.transmission);
  DirectionalAlbedo passed = DirectionalAlbedo::constant(1);
  if (!inside_ && eta_ >= 1) {
    over_diffuse_ = part;
    const DirectionalAlbedo reflected =
        smooth_interface_ ? smooth_albedo(eta_) : reflection_albedo(ggx_.alpha(), eta_);
    interface_reflectance_o_ = reflected.at(wo_.z);
    passed = complement_of(reflected);
  }
  diffuse_base_.row = inside_ ? passed : attenuate_by_coat(passed);
  if (over_diffuse_ > 0 && !smooth_interface_) diffuse_base_.row = add_coat_loss(diffuse_base_.row, eta_);
  const float norm = glm::mix(diffuse_base_.row.average(), diffuse_base_.row.max_value(), m.diffuse_roughness);
  if (!(norm > 0)) return;
  const glm::vec3 strength = coat_tint_ * (part * diffuse_base_.row.at(wo_.z) / norm);
  rough_diffuse_ = m.diffuse_roughness > 0;
  if (rough_diffuse_) oren_nayar_ = OrenNayar(m.base_color, m.diffuse_roughness);
  diffuse_base_.strength = rough_diffuse_ ? strength : strength * m.base_color;
  diffuse_albedo_ = strength * m.base_color * diffuse_base_.row.average();
}

// Adds the light lost on both sides to both sides, so that each side gets back its loss and the two ways through are
// each other's reverse: Kulla and Conty's split, with the greater of the two averages as divisor of the light that
// passes.
void Principled::add_glass_compensation(const MaterialPoint& m) {
  DirectionalAlbedo here, beyond;
  float passed;
  if (thin_) {
    here = beyond = conductor_loss(ggx_.alpha());
    passed = 1 - slab_reflectance(1 - average_transmittance(eta_));
  } else {
    here = dielectric_loss(ggx_.alpha(), eta_);
    beyond = dielectric_loss(ggx_.alpha(), 1 / eta_);
    passed = average_transmittance(eta_);
  }
  DirectionalAlbedo& outside = inside_ ? beyond : here;
  outside = add_coat_loss(attenuate_by_coat(outside), inside_ && !thin_ ? 1 / eta_ : eta_);
  const float average_here = here.average(), average_beyond = beyond.average();
  if (!(average_here > 0 && average_beyond > 0)) return;
  const float at_o = here.at(wo_.z), part = (1 - m.metalness) * m.transmission;
  const float returned = 1 - passed * std::min(1.0f, average_beyond / average_here);
  glass_compensation_.row = here;
  glass_compensation_.strength = coat_tint_ * tint_ * (part * returned * at_o / average_here);
  const float scale = thin_ ? 1 : 1 / (eta_ * eta_);
  transmitted_compensation_.row = beyond;
  transmitted_compensation_.strength = transmitted_coat_tint_ * m.transmission_color *
                                       (part * passed * scale * at_o / std::max(average_here, average_beyond));
}

// Sets the probability of each lobe to about its part in the light that goes to wo.
void Principled::set_lobe_probabilities() {
  const float reflected = fresnel(std::min(wo_.z, 1.0f), eta_);
  const float over_diffuse = over_diffuse_ > 0 ? interface_reflectance_o_ : 0;
  const float slab = thin_ ? slab_reflectance(reflected) : reflected;
  const glm::vec3 glossy = tint_ * (over_diffuse_ * over_diffuse + glass_ * slab);
  const float away = thin_ ? 1 : eta_ * eta_;
  if (coat_weight_ > 0 && !inside_) lobe_probability_[kCoat] = 1 - coat_transmittance_o_;
  if (metal_ > 0)
    lobe_probability_[kMetal] = coat_transmittance_o_ * metal_ * max_of(coat_tint_ * metal_tint_(wo_.z));
  lobe_probability_[kInterface] =
      coat_transmittance_o_ * (max_of(coat_tint_ * glossy) + max_of(interface_transmittance(1 - reflected)));
  // Facets may let through light that the surface itself reflects totally.
  if (glass_ > 0 && !smooth_interface_)
    lobe_probability_[kInterface] = std::max(lobe_probability_[kInterface], kMinChance * glass_);
  lobe_probability_[kDiffuse] = max_of(diffuse_albedo_);
  lobe_probability_[kCompensation] = max_of(metal_compensation_.albedo() + glass_compensation_.albedo());
  lobe_probability_[kTransmittedCompensation] = away * max_of(transmitted_compensation_.albedo());
  float sum = 0;
  for (float probability : lobe_probability_) sum += probability;
  for (float& probability : lobe_probability_) probability = sum > 0 ? probability * opacity_ / sum : 0;
  lobe_probability_[kNullTransmission] = 1 - opacity_;
}

bool Principled::is_delta() const {
  const bool rough = (!smooth_coat_ && lobe_probability_[kCoat] > 0) ||
                     (!smooth_metal_ && lobe_probability_[kMetal] > 0) ||
                     (!smooth_interface_ && lobe_probability_[kInterface] > 0);
  return !rough && lobe_probability_[kDiffuse] + lobe_probability_[kCompensation] +
                           lobe_probability_[kTransmittedCompensation] ==
                       0;
}

float Principled::coat_transmittance(float cos) const {
  return coat_weight_ > 0 ? 1 - coat_weight_ * coat_albedo_.at(cos) : 1;
}

// Returns `row`, a function of directions outside, times the part of the light that the coat lets through.
DirectionalAlbedo Principled::attenuate_by_coat(DirectionalAlbedo row) const {
  if (coat_weight_ == 0) return row;
  for (std::size_t i = 0; i < DirectionalAlbedo::kNodes; ++i) row.node[i] *= 1 - coat_weight_ * coat_albedo_.node[i];
  return row;
}

// Returns `row`, a function of directions outside, plus the excess that the coat takes of light reflected by facets.
// eta: index from outside.
DirectionalAlbedo Principled::add_coat_loss(DirectionalAlbedo row, float eta) const {
  if (coat_weight_ == 0 || eta < 1) return row;
  const DirectionalAlbedo lost = eta == kReflectsAll ? coat_loss_of_conductor(ggx_.alpha(), coat_albedo_)
                                                     : coat_loss_of_reflection(ggx_.alpha(), eta, coat_albedo_);
  for (std::size_t i = 0; i < DirectionalAlbedo::kNodes; ++i) row.node[i] += coat_weight_ * lost.node[i];
  return row;
}

glm::vec3 Principled::interface_reflectance(float fresnel) const {
  return tint_ * (over_diffuse_ * fresnel + glass_ * (thin_ ? slab_reflectance(fresnel) : fresnel));
}

// `passed` is 1 - Fresnel's reflectance. For a slab the result is based on 1 - 2 R / (1 + R).
glm::vec3 Principled::interface_transmittance(float passed) const {
  return transmitted_coat_tint_ * glass_tint_ * (glass_ * (thin_ ? passed / (2 - passed) : passed));
}

float Principled::reflection_probability(float fresnel) const {
  const float back = max_of(coat_tint_ * interface_reflectance(fresnel)),
              through = max_of(interface_transmittance(1 - fresnel));
  return back + through > 0 ? back / (back + through) : 1;
}

Principled::Sample Principled::sample(float lobe, glm::vec2 u) const {
  int which = 0;
  while (which < kLobeCount && lobe >= lobe_probability_[static_cast<std::size_t>(which)]) {
    lobe -= lobe_probability_[static_cast<std::size_t>(which++)];
  }
  switch (which) {
    case kNullTransmission:
      return {-wo_, glm::vec3(1), true, true, true};
    case kCoat:
      if (!smooth_coat_) return {.wi = reflect_about(wo_, coat_ggx_.sample_visible_normal(wo_, u))};
      return {mirrored(wo_),
              glm::vec3(coat_weight_ * opacity_ * fresnel(wo_.z, coat_eta_) / lobe_probability_[kCoat]), true};
    case kMetal:
      if (!smooth_metal_) return {.wi = reflect_about(wo_, ggx_.sample_visible_normal(wo_, u))};
      return {mirrored(wo_),
              glossy_coat_tint(wo_.z) * metal_tint_(wo_.z) *
                  (metal_ * opacity_ * coat_transmittance_o_ / lobe_probability_[kMetal]),
              true};
    case kInterface:
      return sample_interface(std::min(lobe / lobe_probability_[kInterface], kBelowOne), u);
    case kDiffuse:
      return {.wi = square_to_cosine_hemisphere(u)};
    case kCompensation:
      return {.wi = square_to_uniform_hemisphere(u)};
    case kTransmittedCompensation:
      return {.wi = below(square_to_uniform_hemisphere(u)), .is_transmission = true, .keeps_medium = thin_};
    default:
      return {};
  }
}

// `lobe` in [0,1): the rest of the number that chose the lobe.
Principled::Sample Principled::sample_interface(float lobe, glm::vec2 u) const {
  const glm::vec3 m = smooth_interface_ ? glm::vec3(0, 0, 1) : ggx_.sample_visible_normal(wo_, u);
  const float reflected = fresnel(std::clamp(glm::dot(wo_, m), 0.0f, 1.0f), eta_);
  const float probability = reflection_probability(reflected);
  const float part = opacity_ * coat_transmittance_o_ / lobe_probability_[kInterface];
  if (lobe < probability) {
    Sample sample{.wi = reflect_about(wo_, m), .delta = smooth_interface_};
    sample.weight = glossy_coat_tint(wo_.z) * interface_reflectance(reflected) * (part / probability);
    return sample;
  }
  Sample sample{
      .wi = transmitted_direction(m), .delta = smooth_interface_, .is_transmission = true, .keeps_medium = thin_};
  const float seen = inside_ ? coat_transmittance(std::min(std::abs(sample.wi.z), 1.0f)) : 1;
  sample.weight =
      interface_transmittance(1 - reflected) * (seen * part / ((1 - probability) * (thin_ ? 1 : eta_ * eta_)));
  return sample;
}

// Returns the direction beyond the interface. A thin wall bends light back again, so that its facets act as in
// reflection, turned over.
glm::vec3 Principled::transmitted_direction(glm::vec3 m) const {
  if (!thin_) return refract_through(wo_, m, eta_);
  return below(reflect_about(wo_, m));
}

glm::vec3 Principled::null_transmission() const {
  const glm::vec3 holes(1 - opacity_);
  if (!thin_ || !smooth_interface_) return holes;
  const float cos = std::min(wo_.z, 1.0f), coat = inside_ ? coat_transmittance(cos) : coat_transmittance_o_;
  return holes + interface_transmittance(1 - fresnel(cos, eta_)) * (opacity_ * coat);
}

BsdfValue Principled::evaluate(glm::vec3 wi) const {
  BsdfValue value;
  if (wi.z > 0) {
    add_glossy(wi, value);
    add_diffuse(wi, value);
  } else if (wi.z < 0 && glass_ > 0) {
    if (!smooth_interface_) thin_ ? add_thin(wi, value) : add_refracted(wi, value);
    value.f += transmitted_compensation_(-wi.z) * (opacity_ * -wi.z * kInversePi);
    value.pdf += lobe_probability_[kTransmittedCompensation] * kUniformHemispherePdf;
  }
  return value;
}

void Principled::add_glossy(glm::vec3 wi, BsdfValue& value) const {
  const bool coat = !smooth_coat_ && lobe_probability_[kCoat] > 0;
  const bool metal = !smooth_metal_ && lobe_probability_[kMetal] > 0,
             interface = !smooth_interface_ && lobe_probability_[kInterface] > 0;
  if (!coat && !metal && !interface) return;
  const glm::vec3 m = glm::normalize(wo_ + wi);
  const float cos_m = half_vector_cosine(wo_, wi);
  if (coat) {
    const float facets = coat_ggx_.d(m) * coat_ggx_.g2_by_4_cos(wo_.z, wi.z) * wi.z;
    value.f += coat_weight_ * opacity_ * fresnel(cos_m, coat_eta_) * facets;
    value.pdf += lobe_probability_[kCoat] * coat_ggx_.reflection_pdf(wo_, m);
  }
  if (!metal && !interface) return;
  const float passes = inside_ ? 1 : std::min(coat_transmittance_o_, coat_transmittance(wi.z));
  glm::vec3 tint(0);
  float probability = 0;
  if (metal) {
    tint += metal_ * metal_tint_(cos_m);
    probability += lobe_probability_[kMetal];
  }
  if (interface) {
    const float reflected = fresnel(cos_m, eta_);
    tint += interface_reflectance(reflected);
    probability += lobe_probability_[kInterface] * reflection_probability(reflected);
  }
  value.f += glossy_coat_tint(cos_m) * tint * (opacity_ * passes * ggx_.d(m) * ggx_.g2_by_4_cos(wo_.z, wi.z) * wi.z);
  value.pdf += probability * ggx_.reflection_pdf(wo_, m);
}

void Principled::add_diffuse(glm::vec3 wi, BsdfValue& value) const {
  const float lambert = wi.z * kInversePi;
  if (lobe_probability_[kDiffuse] > 0) {
    glm::vec3 diffuse = diffuse_base_(wi.z);
    if (rough_diffuse_) diffuse *= oren_nayar_(wo_, wi);
    value.f += diffuse * (opacity_ * lambert);
    value.pdf += lobe_probability_[kDiffuse] * lambert;
  }
  if (lobe_probability_[kCompensation] > 0) {
    value.f += (metal_compensation_(wi.z) + glass_compensation_(wi.z)) * (opacity_ * lambert);
    value.pdf += lobe_probability_[kCompensation] * kUniformHemispherePdf;
  }
}

// Walter et al. 2007, equations 17 and 21, with the masking on one side taken to be independent of that on the other
// side. As radiance: the equation's eta^2 is gone. The facet's normal is computed in double, because wo + eta wi has
// few digits left.
void Principled::add_refracted(glm::vec3 wi, BsdfValue& value) const {
  const glm::dvec3 sum = glm::dvec3(wo_) + static_cast<double>(eta_) * glm::dvec3(wi);
  const double length2 = glm::dot(sum, sum);
  const glm::dvec3 m = sum * ((sum.z < 0 ? -1 : 1) / std::sqrt(length2));
  const float cos_o = static_cast<float>(glm::dot(glm::dvec3(wo_), m));
  const float cos_i = static_cast<float>(-glm::dot(glm::dvec3(wi), m));
  if (!(cos_o > 0 && cos_i > 0)) return;
  const float passed = fresnel_transmittance(cos_o, cos_i, eta_);
  const float visible = ggx_.g1_by_cos(wo_.z) * ggx_.d(glm::vec3(m)) * cos_o;
  const float turn = cos_i / static_cast<float>(length2);
  const float passes = inside_ ? coat_transmittance(std::min(-wi.z, 1.0f)) : coat_transmittance_o_;
  value.f += interface_transmittance(passed) * (opacity_ * passes * visible * ggx_.g1(-wi.z) * turn);
  value.pdf +=
      lobe_probability_[kInterface] * (1 - reflection_probability(1 - passed)) * visible * turn * (eta_ * eta_);
}

void Principled::add_thin(glm::vec3 wi, BsdfValue& value) const {
  const glm::vec3 up = below(wi), m = glm::normalize(wo_ + up);
  const float reflected = fresnel(half_vector_cosine(wo_, up), eta_);
  const float passes = inside_ ? coat_transmittance(up.z) : coat_transmittance_o_;
  value.f +=
      interface_transmittance(1 - reflected) * (opacity_ * passes * ggx_.d(m) * ggx_.g2_by_4_cos(wo_.z, up.z) * up.z);
  value.pdf += lobe_probability_[kInterface] * (1 - reflection_probability(reflected)) * ggx_.reflection_pdf(wo_, m);
}

}  // namespace fathom::runtime
