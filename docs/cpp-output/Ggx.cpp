// Made by rtslc --emit=cpp. Compiled with any options but -ffast-math it computes what rtslc's own
// machine code computes, to the last bit.
#include <rtsl/shader.h>

namespace Ggx {

using State = rtsl::State<3>;
using Color = rtsl::Color<3>;

namespace {

enum class Id : std::uint32_t { Ggx = 1 };

// A rough conductor: microfacets with the distribution GGX (Walter et al., "Microfacet Models for
// Refraction through Rough Surfaces", 2007).
struct Ggx : rtsl::Material {
  float roughness = 0.3f;
  Color reflectance = Color(0.9f, 0.6f, 0.3f); // at normal incidence

  static constexpr float pi = 3.14159265f;

  // Density of normals. With sine and cosine apart, because 1 - cosine^2 would cancel near the
  // mirror direction, where a smooth surface has all of its light.
  float distribution(float cosine, float sineSquared, float alpha) const {
    float denominator = sineSquared + alpha * alpha * cosine * cosine;
    return alpha * alpha / (pi * denominator * denominator);
  }

  // Smith's shadowing for one direction, over its cosine.
  float visibility(float cosine, float alpha) const {
    return 1.0f / (cosine + rtsl::sqrt(alpha * alpha + (1.0f - alpha * alpha) * cosine * cosine));
  }

  void shade(State &rt) const {
    glm::vec3 view = -rtsl::normalize(rt.RayDirection);
    glm::vec3 normal = rtsl::faceforward(rt.ShadingNormal, rt.RayDirection, rt.GeometricNormal);
    float alpha = rtsl::max(roughness * roughness, 1e-4f);
    float viewCosine = rtsl::max(rtsl::dot(normal, view), 1e-4f);
    Color sum = reflectance * rtsl::ambient(rt);

    for (rtsl::Lights lights(rt, rt.HitPoint, normal, 1.5707963f, /*cosine=*/7.54979e-08f);
         lights.next();) {
      glm::vec3 light = rtsl::normalize(rt.LightDirection);
      glm::vec3 halfway = rtsl::normalize(view + light);
      float lightCosine = rtsl::dot(normal, light);
      if (lightCosine <= 0.0f)
        continue;
      glm::vec3 across = rtsl::cross(normal, halfway);
      float d = distribution(rtsl::dot(normal, halfway), rtsl::dot(across, across), alpha);
      float v = visibility(lightCosine, alpha) * visibility(viewCosine, alpha);
      Color fresnel =
          rtsl::mix(reflectance, Color(1.0f), rtsl::powi(1.0f - rtsl::dot(view, halfway), 5));
      sum += fresnel * (d * v * lightCosine) * rt.LightColor;
    }
    rt.SampleColor = sum;
  }
};

} // namespace

//===----------------------------------------------------------------------===//
// Functions that the runtime calls
//===----------------------------------------------------------------------===//

namespace slots {

inline void shade(RtslState *ray, RtslRef object) {
  State &rt = rtsl::stateOf<3>(ray);
  rtsl::object<Ggx>(rt, object).shade(rt);
}

} // namespace slots

static RtslShaders describe() {
  rtsl::Program<3> program;
  program.add<Ggx>(static_cast<std::uint32_t>(Id::Ggx), "Ggx", "rt_Material", "rt_Material")
      .member("roughness", &Ggx::roughness, rtsl::Access::Public, rtsl::Default::Given)
      .member("reflectance", &Ggx::reflectance, rtsl::Access::Public, rtsl::Default::Given)
      .methods({"distribution", "shade", "visibility"})
      .needs(RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS);
  program.needs(RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS);
  program.slots().rt_Material_shade = &slots::shade;
  return program.finish();
}

} // namespace Ggx

/// For rtsl::program in C++, and rtslSceneCreate in C.
extern "C" const RtslShaders *Ggx_shaders();
const RtslShaders *Ggx_shaders() {
  static const RtslShaders shaders = Ggx::describe();
  return &shaders;
}
