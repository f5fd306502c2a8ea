#include "runtime/material/bsdf.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

bool is_lambert(MaterialType type) { return type == MaterialType::Diffuse || type == MaterialType::Emissive; }

bool black(glm::vec3 v) { return v == glm::vec3(0); }

}  // namespace

Bsdf::Bsdf(const MaterialPoint& m, glm::vec3 normal, glm::vec3 wo, float eta, bool inside)
    : type_(m.type), color_(m.base_color), normal_(normal), wo_(wo), eta_(eta) {
  if (type_ != MaterialType::Principled) return;
  const Frame frame(normal);
  layers_.emplace(Layers{frame, Principled(m, frame.to_local(wo), eta, inside)});
}

bool Bsdf::is_delta() const { return layers_ ? layers_->principled.is_delta() : !is_lambert(type_); }

bool Bsdf::has_lobes() const { return type_ == MaterialType::Principled || type_ == MaterialType::Transparent; }

BsdfSample Bsdf::sample(float lobe, glm::vec2 u) const {
  switch (type_) {
    case MaterialType::Diffuse:
    case MaterialType::Emissive: {
      const glm::vec3 local = square_to_cosine_hemisphere(u);
      const glm::vec3 wi = to_frame(normal_, local);
      return {.wi = wi, .weight = color_, .pdf = evaluate(wi).pdf};
    }
    case MaterialType::Specular:
      return {.wi = reflect_about(wo_, normal_), .weight = color_};
    case MaterialType::Transparent:
      return sample_transparent(lobe);
    case MaterialType::Principled:
      return sample_layers(lobe, u);
  }
  return {};
}

// Reflects with the probability given by Fresnel's equations, otherwise refracts.
BsdfSample Bsdf::sample_transparent(float lobe) const {
  const float cos_o = std::clamp(glm::dot(wo_, normal_), 0.0f, 1.0f);
  if (lobe < fresnel(cos_o, eta_)) return {.wi = reflect_about(wo_, normal_), .weight = glm::vec3(1)};
  return {.wi = refract_through(wo_, normal_, eta_),
          .weight = color_ / (eta_ * eta_),
          .is_transmission = true,
          .eta_scale = eta_ * eta_};
}

BsdfSample Bsdf::sample_layers(float lobe, glm::vec2 u) const {
  const Principled::Sample local_sample = layers_->principled.sample(lobe, u);
  BsdfSample sample{.wi = layers_->frame.to_world(local_sample.wi),
                    .is_transmission = local_sample.is_transmission,
                    .is_null = local_sample.keeps_medium && local_sample.delta};
  if (local_sample.is_transmission && !local_sample.keeps_medium)
    sample.eta_scale = layers_->principled.eta() * layers_->principled.eta();
  if (local_sample.delta) {
    if (local_sample.keeps_medium) sample.wi = -wo_;  // bit for bit
    sample.weight = local_sample.weight;
    return sample;
  }
  // A facet may send light to the wrong side of the surface, which absorbs this light.
  if ((local_sample.wi.z < 0) != local_sample.is_transmission) return sample;
  const BsdfValue value = evaluate(sample.wi);
  if (value.pdf > 0 && !black(value.f)) {
    sample.weight = value.f / value.pdf;
    sample.pdf = value.pdf;
  }
  return sample;
}

glm::vec3 Bsdf::null_transmission() const { return layers_ ? layers_->principled.null_transmission() : glm::vec3(0); }

BsdfValue Bsdf::evaluate(glm::vec3 wi) const {
  if (layers_) return layers_->principled.evaluate(layers_->frame.to_local(wi));
  if (!is_lambert(type_)) return {};
  const float pdf = square_to_cosine_hemisphere_pdf({0, 0, glm::dot(wi, normal_)});
  return {color_ * pdf, pdf};
}

}  // namespace fathom::runtime
