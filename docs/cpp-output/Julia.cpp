// Made by rtslc --emit=cpp. Compiled with any options but -ffast-math it computes what rtslc's own
// machine code computes, to the last bit.
#include <rtsl/shader.h>

namespace Julia {

using State = rtsl::State<3>;
using Color = rtsl::Color<3>;

namespace {

enum class Id : std::uint32_t { Julia = 1 };

// A quaternion Julia set, found by walking along the ray as far as a bound of the distance allows
// (Hart, Sandin, Kauffman, "Ray Tracing Deterministic 3-D Fractals", 1989).
struct Julia : rtsl::Primitive {
  glm::vec3 center{};
  glm::vec4 constant = glm::vec4(-0.2f, 0.6f, 0.2f, 0.2f);
  int iterations = 10;
  float tolerance = 1e-3f;

  static constexpr float radius = 1.8f; // of a sphere around the set

  struct Scratch : rtsl::Scratch {
    glm::vec3 gradient{};

    template <typename Visit>
    void visit(Visit at) {
      at(0, gradient);
    }
  };

  glm::vec4 square(glm::vec4 q) const {
    return glm::vec4(q.x * q.x - rtsl::dot(glm::vec3(q.y, q.z, q.w), glm::vec3(q.y, q.z, q.w)),
                     2.0f * q.x * glm::vec3(q.y, q.z, q.w));
  }

  // A lower bound of the distance from p to the set.
  float distanceBound(glm::vec3 p) const {
    glm::vec4 z = glm::vec4(p, 0.0f);
    float derivative = 1.0f;
    for (int i = 0; i < iterations; ++i) {
      derivative = 2.0f * rtsl::length(z) * derivative;
      z = square(z) + constant;
      if (rtsl::dot(z, z) > 16.0f)
        break;
    }
    float size = rtsl::length(z);
    return 0.5f * size * rtsl::log(size) / derivative;
  }

  glm::vec3 gradientAt(glm::vec3 p) const {
    float e = 1e-4f;
    glm::vec3 result{};
    result.x =
        distanceBound(p + glm::vec3(e, 0.0f, 0.0f)) - distanceBound(p - glm::vec3(e, 0.0f, 0.0f));
    result.y =
        distanceBound(p + glm::vec3(0.0f, e, 0.0f)) - distanceBound(p - glm::vec3(0.0f, e, 0.0f));
    result.z =
        distanceBound(p + glm::vec3(0.0f, 0.0f, e)) - distanceBound(p - glm::vec3(0.0f, 0.0f, e));
    return result;
  }

  void intersect(State &rt, Scratch &scratch) const {
    float speed = rtsl::length(rt.RayDirection);
    glm::vec3 direction = rt.RayDirection / speed;
    glm::vec3 origin = rt.RayOrigin - center;

    // Where the ray is inside of the sphere.
    float b = -rtsl::dot(origin, direction);
    glm::vec3 nearest = origin + b * direction;
    float discriminant = radius * radius - rtsl::dot(nearest, nearest);
    if (discriminant < 0.0f)
      return;
    float root = rtsl::sqrt(discriminant);
    float t = rtsl::max(b - root, rt.Epsilon * speed);
    float end = rtsl::min(b + root, rt.HitDistance * speed);

    while (t < end) {
      glm::vec3 p = origin + t * direction;
      float step = distanceBound(p);
      if (step < tolerance) {
        scratch.gradient = gradientAt(p);
        rtsl::hit(rt, scratch, t / speed);
        return;
      }
      t += step;
    }
  }

  void computeBounds(State &rt) const {
    rt.BoundMin = center - radius;
    rt.BoundMax = center + radius;
  }

  void computeNormal(State &rt, const Scratch &scratch) const {
    rt.GeometricNormal = rtsl::normalize(scratch.gradient);
  }
};

} // namespace

//===----------------------------------------------------------------------===//
// Functions that the runtime calls
//===----------------------------------------------------------------------===//

namespace slots {

inline void intersect(RtslState *ray, RtslRef object) {
  State &rt = rtsl::stateOf<3>(ray);
  rtsl::intersect(rt, rtsl::object<Julia>(rt, object));
}

inline void computeBounds(RtslState *ray, RtslRef object) {
  State &rt = rtsl::stateOf<3>(ray);
  rtsl::object<Julia>(rt, object).computeBounds(rt);
}

inline void computeNormal(RtslState *ray, RtslRef object) {
  State &rt = rtsl::stateOf<3>(ray);
  rtsl::object<Julia>(rt, object).computeNormal(rt, rtsl::loadScratch<Julia::Scratch>(rt));
}

} // namespace slots

static RtslShaders describe() {
  rtsl::Program<3> program;
  program.add<Julia>(static_cast<std::uint32_t>(Id::Julia), "Julia", "rt_Primitive", "rt_Primitive")
      .member("center", &Julia::center, rtsl::Access::Public, rtsl::Default::Required)
      .member("constant", &Julia::constant, rtsl::Access::Public, rtsl::Default::Given)
      .member("iterations", &Julia::iterations, rtsl::Access::Public, rtsl::Default::Given)
      .member("tolerance", &Julia::tolerance, rtsl::Access::Public, rtsl::Default::Given)
      .methods(
          {"computeBounds", "computeNormal", "distanceBound", "gradientAt", "intersect", "square"})
      .needs(RTSL_NEEDS_ATTRIBUTES);
  program.needs(RTSL_NEEDS_ATTRIBUTES);
  program.slots().rt_Primitive_intersect = &slots::intersect;
  program.slots().rt_Primitive_computeBounds = &slots::computeBounds;
  program.slots().rt_Primitive_computeNormal = &slots::computeNormal;
  return program.finish();
}

} // namespace Julia

/// For rtsl::program in C++, and rtslSceneCreate in C.
extern "C" const RtslShaders *Julia_shaders();
const RtslShaders *Julia_shaders() {
  static const RtslShaders shaders = Julia::describe();
  return &shaders;
}
