//===- Gloss.h - metal and plastic under a clear coat ---------------------===//
//
// The material of library/std/materials/Principled.rtsl (glTF's), for surfaces of index 1.5 that
// let no light through and have no fibres. Directions have length 1 and are in the surface's frame,
// z is the normal, and the eye is above the surface.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "PathSampling.h"

namespace handwritten {

/// Of a boundary of index 1.5, with light that is not polarised.
inline float fresnel(float cosine) {
  constexpr float index = 1.5f;
  const float far = std::sqrt(1 - (1 - cosine) * (1 + cosine) / (index * index));
  const float parallel = (index * cosine - far) / (index * cosine + far),
              perpendicular = (cosine - index * far) / (cosine + index * far);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

inline float luminance(vec3 c) {
  return glm::dot(c, vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Microfacets of Trowbridge and Reitz, with masking and shadowing that depend on each other
/// (Heitz 2014).
class Facets {
public:
  explicit Facets(float roughness) : alpha(std::max(roughness * roughness, 0.001f)) {}

  /// D G2 / (4 cosine cosine).
  float reflection(vec3 light, vec3 eye) const {
    return distribution(light + eye) / (2 * (hidden(eye) * light.z + hidden(light) * eye.z));
  }
  /// The density of directions that `mirrored` gives.
  float density(vec3 light, vec3 eye) const {
    return distribution(light + eye) / (2 * (eye.z + hidden(eye)));
  }
  /// The eye's direction mirrored at a normal that is seen from there (Dupuy and Benyoub 2023).
  vec3 mirrored(vec3 eye, float u, float v) const {
    const vec3 stretched = glm::normalize(vec3(alpha * eye.x, alpha * eye.y, eye.z));
    const float drop = v * (1 + stretched.z), sine = std::sqrt(std::max(drop * (2 - drop), 0.0f)),
                turn = 2 * pi * u;
    const vec3 h = vec3(sine * std::cos(turn), sine * std::sin(turn), 1 - drop) + stretched;
    const vec3 normal = glm::normalize(vec3(alpha * h.x, alpha * h.y, std::max(h.z, 0.0f)));
    return glm::normalize(2 * glm::dot(eye, normal) * normal - eye);
  }

private:
  float distribution(vec3 h) const {
    const vec3 stretched(h.x / alpha, h.y / alpha, h.z);
    const float root = glm::dot(h, h) / glm::dot(stretched, stretched);
    return root * root / (pi * alpha * alpha);
  }
  float hidden(vec3 v) const { return glm::length(vec3(alpha * v.x, alpha * v.y, v.z)); }

  float alpha;
};

class Gloss {
public:
  explicit Gloss(const GlossyMesh &of)
      : of(of), facets(of.roughness), coatFacets(of.coatRoughness) {}

  vec3 value(vec3 light, vec3 eye) const {
    if (!(light.z > 0))
      return vec3(0);
    const float half = std::min(0.5f * glm::length(light + eye), 1.0f), reflected = fresnel(half);
    const float layers = (1 - of.coat * fresnel(light.z)) * (1 - of.coat * fresnel(eye.z));
    const float entered = (1 - fresnel(light.z)) * (1 - fresnel(eye.z)) / (1 - ofDiffuse);
    const float away = 1 - half, fifth = away * away * away * away * away;
    const vec3 metal = of.base + (vec3(1) - of.base) * fifth;
    const vec3 diffuse = (1 - of.metallic) * entered / pi * of.base,
               mirrors =
                   facets.reflection(light, eye) * glm::mix(vec3(reflected), metal, of.metallic);
    vec3 sum = layers * (diffuse + mirrors);
    if (of.coat > 0)
      sum += of.coat * reflected * coatFacets.reflection(light, eye);
    return sum;
  }

  float density(vec3 light, vec3 eye) const {
    if (!(light.z > 0))
      return 0;
    const vec3 p = probabilities(eye);
    return p.x * light.z / pi + p.y * facets.density(light, eye) +
           (of.coat > 0 ? p.z * coatFacets.density(light, eye) : 0);
  }

  /// A direction; below the surface: the light is absorbed.
  vec3 draw(vec3 eye, float u, float v) const {
    const vec3 p = probabilities(eye);
    if (u < p.x)
      return sampleCosine(u / p.x, v);
    u -= p.x;
    return u < p.z ? coatFacets.mirrored(eye, u / p.z, v)
                   : facets.mirrored(eye, std::min((u - p.z) / p.y, 1.0f), v);
  }

private:
  static constexpr float ofDiffuse = 0.0917743f; // the share of diffuse light that it reflects

  /// Of the diffuse part, the facets and the coat's.
  vec3 probabilities(vec3 eye) const {
    const float f = fresnel(eye.z), reflected = glm::mix(f, luminance(of.base), of.metallic);
    const vec3 weights((1 - of.metallic) * (1 - reflected) * std::max(luminance(of.base), 0.05f),
                       std::max(reflected, 0.05f), of.coat * f);
    return weights / (weights.x + weights.y + weights.z);
  }

  const GlossyMesh &of;
  Facets facets, coatFacets;
};

} // namespace handwritten
