// A ray is made in lanes, and enters an instance in lanes, beside device::makeTriangleRay,
// device::enterInstance and the test of the box: the same answer, and the same ray to the bit.
#include "runtime/embree/EnterSpace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace rtsl;
using device::InstanceRay;
using device::Vec3;

namespace {

/// Which transforms there are, as RtslLaunch::needs states it.
enum class Form { Translation, Scale, Any };

struct Case {
  RtslInstance instance{};
  RtslTransform transforms[2]{}; // the second is that of the instance
  RtslBox bounds{};
  device::TriangleRay ray{};
  float limit = 0, epsilon = 0;
  std::uint32_t needs = RTSL_HAS_TRANSFORMS;

  RtslLaunch launch() const {
    RtslLaunch launch{};
    launch.instances = &instance;
    launch.instanceCount = 1;
    launch.transforms = transforms;
    launch.needs = needs;
    return launch;
  }
};

class Cases {
public:
  explicit Cases(unsigned seed) : random(seed) {}

  Case make(Form form) {
    Case one;
    one.instance.transform = 1;
    one.bounds = box(below(8) == 0 ? 0x1p-40f : 1);
    one.transforms[1] = transform(form);
    one.needs |= form == Form::Translation ? 0u : RTSL_HAS_LINEAR | RTSL_HAS_SCALE;
    one.needs |= form == Form::Any ? RTSL_HAS_TURNS | RTSL_HAS_STRETCH : 0u;
    // Around the translation, or much too large.
    const float reach = below(6) == 0 ? device::infinity : 2 * largestOf(one.transforms[1].linear);
    for (int axis = 0; axis < 3; ++axis) {
      one.instance.lower[axis] = one.transforms[1].translation[axis] - reach;
      one.instance.upper[axis] = one.transforms[1].translation[axis] + reach;
    }
    const Vec3 target =
        device::load(one.transforms[1].translation) + vector(reach > 1e30f ? 1 : reach);
    const float far = std::ldexp(1.0f, int(below(20)) - 4);
    const Vec3 origin = below(10) == 0 ? target : target + vector(far);
    Vec3 direction = target - origin;
    if (below(3) == 0 || device::isZero(direction))
      direction = vector(1);
    if (device::isZero(direction))
      direction = {0, 0, 1};
    if (below(8) == 0)
      direction = direction * std::ldexp(1.0f, int(below(160)) - 80);
    if (device::isZero(direction))
      direction = {0, -1, 0};
    one.ray = device::makeTriangleRay(origin, direction);
    one.limit = below(3) == 0 ? std::abs(number()) * 4 : device::infinity;
    one.epsilon = below(4) == 0 ? std::abs(number()) * 0.5f : 0;
    return one;
  }

private:
  unsigned below(unsigned n) { return unsigned(random() % n); }
  /// Often a special number.
  float number() {
    switch (below(12)) {
    case 0:
      return 0;
    case 1:
      return -0.0f;
    case 2:
      return 1;
    default:
      return std::uniform_real_distribution<float>(-1, 1)(random);
    }
  }
  Vec3 vector(float scale) { return {scale * number(), scale * number(), scale * number()}; }
  RtslBox box(float scale) {
    RtslBox box;
    for (int axis = 0; axis < 3; ++axis) {
      const float a = scale * number(), b = scale * number();
      box.lower[axis] = std::min(a, b);
      box.upper[axis] = std::max(a, b);
    }
    return box;
  }
  static float largestOf(const float linear[9]) {
    float largest = 0;
    for (int i = 0; i < 9; ++i)
      largest = std::max(largest, std::fabs(linear[i]));
    return largest;
  }
  /// `inverse` need not be one: the same numbers go into both functions.
  RtslTransform transform(Form form) {
    RtslTransform transform{};
    const float size = form == Form::Translation ? 1 : std::ldexp(1.0f, int(below(40)) - 20);
    for (int i = 0; i < 9; ++i) {
      const bool isDiagonal = i % 4 == 0;
      if (form == Form::Any)
        transform.linear[i] = size * number();
      else if (isDiagonal)
        transform.linear[i] = form == Form::Scale ? size * (number() + 2) : 1;
      if (form == Form::Any)
        transform.inverse[i] = (double(number()) + 1e-9 * double(number())) / double(size);
      else if (isDiagonal)
        transform.inverse[i] = 1 / double(transform.linear[i]);
    }
    if (form == Form::Any && below(20) == 0) // no direction left
      for (double &number : transform.inverse)
        number *= below(2) == 0 ? 0 : 1e-60;
    for (float &number : transform.translation)
      number = std::ldexp(this->number(), int(below(12))) + 0.0f; // never -0
    return transform;
  }

  std::mt19937 random;
};

bool sameBits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
bool sameBits(Vec3 a, Vec3 b) {
  return sameBits(a.x, b.x) && sameBits(a.y, b.y) && sameBits(a.z, b.z);
}
bool sameBits(const device::TriangleRay &a, const device::TriangleRay &b) {
  return sameBits(a.origin, b.origin) && sameBits(a.direction, b.direction) &&
         sameBits(a.inverse, b.inverse) && a.kx == b.kx && a.ky == b.ky && a.kz == b.kz &&
         sameBits(a.turned, b.turned) && sameBits(a.sx, b.sx) && sameBits(a.sy, b.sy) &&
         sameBits(a.sz, b.sz) && a.directionExponent == b.directionExponent;
}
bool sameBits(const InstanceRay &a, const InstanceRay &b) {
  return sameBits(static_cast<const device::TriangleRay &>(a),
                  static_cast<const device::TriangleRay &>(b)) &&
         a.instance == b.instance && a.range.near == b.range.near && a.range.far == b.range.far;
}

/// How often rays enter.
unsigned compare(Form form, unsigned count) {
  Cases cases(7);
  unsigned entries = 0;
  for (unsigned i = 0; i < count; ++i) {
    const Case one = cases.make(form);
    device::TriangleRay made;
    runtime::makeRay(&one.ray.origin.x, &one.ray.direction.x, made);
    EXPECT_TRUE(sameBits(made, one.ray)) << "case " << i;
    const RtslLaunch launch = one.launch();
    InstanceRay lanes, each;
    runtime::EmbreeSpace inside;
    inside.bounds = one.bounds;
    const runtime::EmbreeInstance entry(launch, 0, &inside);
    device::Range inBox;
    const bool enters =
        runtime::reachBox(one.ray, entry, one.epsilon, one.limit, inBox) &&
        runtime::enterSpace(launch, one.ray, entry, inBox, 0, one.epsilon, one.limit, lanes);
    EXPECT_EQ(enters, runtime::enterAnySpace(launch, one.ray, 0, one.bounds, 0, one.epsilon,
                                             one.limit, each))
        << "case " << i;
    if (enters) {
      ++entries;
      EXPECT_TRUE(sameBits(lanes, each)) << "case " << i;
    }
    if (testing::Test::HasFailure())
      break;
  }
  return entries;
}

TEST(EnterSpace, HasTheBitsOfEnterInstance) {
  EXPECT_GT(compare(Form::Any, 100000), 10000u);
}

TEST(EnterSpace, HasTheBitsOfScales) {
  EXPECT_GT(compare(Form::Scale, 50000), 1000u);
}

TEST(EnterSpace, HasTheBitsOfTranslations) {
  EXPECT_GT(compare(Form::Translation, 50000), 1000u);
}

} // namespace
