// Made by rtslc --emit=cpp. Compiled with any options but -ffast-math it computes what rtslc's own
// machine code computes, to the last bit.
#include <rtsl/shader.h>

namespace Dielectric {

using State = rtsl::State<3>;
using Color = rtsl::Color<3>;

namespace {

enum class Id : std::uint32_t { Dielectric = 1 };

// The states: methods begin at `shade`, the others run after a ray.
enum class Step : rtsl::Next { shade = 1, Dielectric_shadeAfterTrace1 };

// Glass with the exact reflectance (Fresnel's equations for unpolarised light). Chance decides
// whether the reflected or the refracted ray is followed, so there is one ray a hit.
struct Dielectric : rtsl::Material {
  float index = 1.5f;
  Color tint = Color(1.0f); // the fraction of white light left after one unit of length inside

  // The share that is reflected; 1 for total internal reflection. `ratio` is the index on the side
  // of the ray over that on the other.
  float reflectance(float cosine, float ratio) const {
    float sineSquared = ratio * ratio * (1.0f - cosine * cosine);
    if (sineSquared >= 1.0f)
      return 1.0f;
    float other = rtsl::sqrt(1.0f - sineSquared);
    float parallel = (cosine - ratio * other) / (cosine + ratio * other);
    float perpendicular = (ratio * cosine - other) / (ratio * cosine + other);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
  }

  // What `shade` keeps across its traces.
  struct ShadeFrame {
    Color attenuation; // needed by line 32: `color attenuation = color(1.0)`
  };

  rtsl::Next shade(State &rt, ShadeFrame &frame) const {
    glm::vec3 direction = rtsl::normalize(rt.RayDirection);
    bool entering = rtsl::dot(direction, rt.GeometricNormal) < 0.0f;
    glm::vec3 normal = entering ? rt.ShadingNormal : -rt.ShadingNormal;
    float ratio = entering ? 1.0f / index : index;
    float cosine = rtsl::clamp(-rtsl::dot(direction, normal), 0.0f, 1.0f);

    glm::vec3 next = rtsl::rand(rt) < reflectance(cosine, ratio)
                         ? rtsl::reflect(direction, normal)
                         : rtsl::refract(direction, normal, ratio);
    Color attenuation = Color(1.0f);
    if (!entering)
      attenuation = rtsl::pow(tint, rt.HitDistance * rtsl::length(rt.RayDirection));
    frame.attenuation = attenuation;
    return rtsl::traceThen(rt, Step::Dielectric_shadeAfterTrace1, rt.HitPoint, next);
  }

  // After the ray of line 32.
  rtsl::Next shadeAfterTrace1(State &rt, const ShadeFrame &frame) const {
    rt.SampleColor = frame.attenuation * rtsl::traced(rt);
    return rtsl::done;
  }
};

} // namespace

//===----------------------------------------------------------------------===//
// Functions that the runtime calls
//===----------------------------------------------------------------------===//

namespace slots {

inline rtsl::Next runState(RtslState *ray, rtsl::Next step, RtslRef object, void *frame) {
  State &rt = rtsl::stateOf<3>(ray);
  switch (static_cast<Step>(step)) {
  case Step::shade:
    return rtsl::object<Dielectric>(rt, object)
        .shade(rt, rtsl::frameAt<Dielectric::ShadeFrame>(frame));
  case Step::Dielectric_shadeAfterTrace1:
    return rtsl::object<Dielectric>(rt, object)
        .shadeAfterTrace1(rt, rtsl::frameAt<Dielectric::ShadeFrame>(frame));
  }
  return rtsl::done;
}

} // namespace slots

static RtslShaders describe() {
  rtsl::Program<3> program;
  program
      .add<Dielectric>(static_cast<std::uint32_t>(Id::Dielectric), "Dielectric", "rt_Material",
                       "rt_Material")
      .member("index", &Dielectric::index, rtsl::Access::Public, rtsl::Default::Given)
      .member("tint", &Dielectric::tint, rtsl::Access::Public, rtsl::Default::Given)
      .methods({"reflectance", "shade"})
      .needs(RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS);
  program.needs(RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS);
  program.states<Dielectric::ShadeFrame>(&slots::runState);
  program.slots().states.shadeFirst = static_cast<rtsl::Next>(Step::shade);
  return program.finish();
}

} // namespace Dielectric

/// For rtsl::program in C++, and rtslSceneCreate in C.
extern "C" const RtslShaders *Dielectric_shaders();
const RtslShaders *Dielectric_shaders() {
  static const RtslShaders shaders = Dielectric::describe();
  return &shaders;
}
