// Made by rtslc --emit=cpp. Compiled with any options but -ffast-math it computes what rtslc's own
// machine code computes, to the last bit.
#include <rtsl/shader.h>

namespace LensCamera {

using State = rtsl::State<3>;
using Color = rtsl::Color<3>;

namespace {

enum class Id : std::uint32_t { LensCamera = 1 };

// A camera with a thin lens: what lies at the distance of focus is sharp.
struct LensCamera : rtsl::Camera {
  float aperture = 0.1f; // diameter of the lens
  float focus = 5.0f;

  glm::vec3 eye{};
  glm::mat3 frame{};  // right, up, backwards
  glm::vec2 extent{}; // half the size of the picture at distance 1

  void constructor(glm::vec3 eye_, glm::vec3 target, glm::vec3 up, float fieldOfView,
                   float aspect) {
    eye = eye_;
    glm::vec3 backwards = rtsl::normalize(eye_ - target);
    glm::vec3 right = rtsl::normalize(rtsl::cross(up, backwards));
    frame = glm::mat3(right, rtsl::cross(backwards, right), backwards);
    float half = rtsl::tan(0.5f * rtsl::radians(fieldOfView));
    extent = glm::vec2(half * aspect, half);
  }

  // A point of the unit disk (Shirley and Chiu, "A Low Distortion Map Between Disk and Square",
  // 1997).
  glm::vec2 onDisk(glm::vec2 square) const {
    glm::vec2 p = 2.0f * square - 1.0f;
    if (p == glm::vec2(0.0f))
      return p;
    bool wide = rtsl::abs(p.x) > rtsl::abs(p.y);
    float r = wide ? p.x : p.y;
    float angle = 0.78539816f * (wide ? p.y / p.x : 2.0f - p.x / p.y);
    return r * glm::vec2(rtsl::cos(angle), rtsl::sin(angle));
  }

  void generateRay(State &rt) const {
    glm::vec2 window = (2.0f * rt.ScreenCoord - 1.0f) * extent;
    glm::vec3 target = focus * glm::vec3(window, -1.0f);
    glm::vec3 lens = glm::vec3(0.5f * aperture * onDisk(rt.LensCoord), 0.0f);
    rt.RayOrigin = eye + rtsl::mul(frame, lens);
    rt.RayDirection = rtsl::mul(frame, target - lens);
  }
};

} // namespace

//===----------------------------------------------------------------------===//
// Functions that the runtime calls
//===----------------------------------------------------------------------===//

namespace slots {

inline void generateRay(RtslState *ray, RtslRef object) {
  State &rt = rtsl::stateOf<3>(ray);
  rtsl::object<LensCamera>(rt, object).generateRay(rt);
}

} // namespace slots

static RtslShaders describe() {
  rtsl::Program<3> program;
  program
      .add<LensCamera>(static_cast<std::uint32_t>(Id::LensCamera), "LensCamera", "rt_Camera",
                       "rt_Camera")
      .member("aperture", &LensCamera::aperture, rtsl::Access::Public, rtsl::Default::Given)
      .member("focus", &LensCamera::focus, rtsl::Access::Public, rtsl::Default::Given)
      .member("eye", &LensCamera::eye, rtsl::Access::Private)
      .member("frame", &LensCamera::frame, rtsl::Access::Private)
      .member("extent", &LensCamera::extent, rtsl::Access::Private)
      .constructor<&LensCamera::constructor>({"eye_", "target", "up", "fieldOfView", "aspect"})
      .methods({"constructor", "generateRay", "onDisk"})
      .needs(RTSL_NEEDS_LENS);
  program.needs(RTSL_NEEDS_LENS);
  program.slots().rt_Camera_generateRay = &slots::generateRay;
  return program.finish();
}

} // namespace LensCamera

/// For rtsl::program in C++, and rtslSceneCreate in C.
extern "C" const RtslShaders *LensCamera_shaders();
const RtslShaders *LensCamera_shaders() {
  static const RtslShaders shaders = LensCamera::describe();
  return &shaders;
}
