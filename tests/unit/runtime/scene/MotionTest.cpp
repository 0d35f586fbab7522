#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/device/traverse/Instance.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/embree/HostScene.h"
#include "runtime/scene/InstanceTransform.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using device::Vec3;

namespace {

using Real = long double;
struct Point {
  Real x, y, z;
};

Scene unlitScene() {
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  return scene;
}

MovingTransform turningBy(const std::array<double, 3> &axis, double degrees) {
  return MovingTransform(MotionFactor{{0, 1}, {}, {turnAbout(axis, 0, degrees)}});
}

Transform randomAffine(std::mt19937 &random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Transform result;
  for (auto &column : result.columns)
    for (double &x : column)
      x = unit(random);
  for (int i = 0; i < 3; ++i)
    result.columns[i][i] += 2.5;
  return result;
}

/// Several factors of all kinds.
MovingTransform randomFactors(std::mt19937 &random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  MovingTransform result;
  const int count = 1 + int(random() % 4);
  for (int i = 0; i < count; ++i) {
    const float middle = 0.25f + 0.5f * float(random()) * 0x1p-32f;
    const double x = unit(random), y = unit(random);
    if (random() % 2) {
      const double degrees = 400 * unit(random);
      result = result.then(MovingTransform(MotionFactor{
          {0, middle, 1},
          {},
          {turnAbout({x, y, 1}, 400 * unit(random), degrees),
           turnBetween(axisRotation({x, y, 1}, degrees), axisRotation({1, x, y}, 180 * y))}}));
    } else {
      result = result.then(MovingTransform(
          MotionFactor{{0.125f, middle, 0.875f},
                       {randomAffine(random), randomAffine(random), randomAffine(random)},
                       {}}));
    }
    if (random() % 3 == 0)
      result = result.then(randomAffine(random));
  }
  return result;
}

std::array<double, 3> mapped(const Transform &map, const double p[3]) {
  std::array<double, 3> result;
  for (std::size_t row = 0; row < 3; ++row)
    result[row] = map.columns[3][row] + map.columns[0][row] * p[0] + map.columns[1][row] * p[1] +
                  map.columns[2][row] * p[2];
  return result;
}

} // namespace

TEST(Motion, TurnsSteadily) {
  const MovingTransform motion = turningBy({0, 0, 2}, 720);
  for (const double share : {0.0, 0.0625, 0.125, 0.5, 0.8, 1.0}) {
    const Transform at = motion.at(share);
    EXPECT_NEAR(at.columns[0][0], std::cos(4 * M_PI * share), 1e-14);
    EXPECT_NEAR(at.columns[0][1], std::sin(4 * M_PI * share), 1e-14);
  }
  // The shortest turn between two orientations, the second of which has the other sign.
  Quaternion to = axisRotation({1, 0, 0}, 100);
  for (double &x : to)
    x = -x;
  const MovingTransform between(
      MotionFactor{{0.5f, 1}, {}, {turnBetween(axisRotation({1, 0, 0}, 20), to)}});
  for (const auto &[time, degrees] : {std::pair(0.0, 20), {0.5, 20}, {0.75, 60}, {1.0, 100}})
    EXPECT_NEAR(between.at(time).columns[1][1], std::cos(degrees * M_PI / 180), 1e-14) << time;
}

TEST(Motion, ConstantsAreMergedIntoNeighbours) {
  const Transform turn = Transform::rotate({0, 1, 0}, 30), move = Transform::translate(1, 2, 3);
  const MovingTransform keys(MotionFactor{{0, 1}, {move, turn}, {}});
  EXPECT_EQ(MovingTransform(turn).then(keys).then(move).then(turn).factors().size(), 1u);
  EXPECT_EQ(MovingTransform(turn).then(turningBy({1, 0, 0}, 9)).then(move).factors().size(), 3u);
  EXPECT_FALSE(MovingTransform(turn).then(move).moves());
}

TEST(Motion, IsTheSameOnDevicesButForRounding) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    Scene scene = unlitScene();
    const RtslRef material = scene.addObject("Normal", members({}));
    Placement placement;
    placement.transform = randomFactors(random);
    try {
      scene.addPrimitive(scene.addObject("Sphere", {vector(0, 0, 0), 1.0}), material, placement);
    } catch (const Error &) {
      continue; // it flattens at some time
    }
    const RtslLaunch launch = scene.launch();
    for (int sample = 0; sample < 20; ++sample) {
      const float time = sample == 0 ? 1 : float(random()) * 0x1p-32f;
      const device::TransformAt atTime(launch, launch.instances[0], time);
      const RtslTransform &transform = atTime;
      const Transform exact = placement.transform.at(time);
      double size = 0;
      for (int column = 0; column < 3; ++column)
        for (double x : exact.columns[column])
          size = std::max(size, std::fabs(x));
      for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
          EXPECT_NEAR(transform.linear[3 * column + row], exact.columns[column][row],
                      size * 0x1p-23);
          double sum = 0;
          for (int k = 0; k < 3; ++k) // some are inverted before they are rounded
            sum += (transform.squaredScale > 0 ? exact.columns[k][row]
                                               : double(transform.linear[3 * k + row])) *
                   transform.inverse[3 * column + k];
          EXPECT_NEAR(sum, row == column, 1e-11);
        }
      for (std::size_t row = 0; row < 3; ++row)
        EXPECT_NEAR(transform.translation[row], exact.columns[3][row],
                    std::fabs(exact.columns[3][row]) * 0x1p-23 + 1e-12);
    }
  }
}

// There and back again: to object space within the rounding of the result, and to world space.
TEST(Motion, UniformScalesAreInvertedByTheirTransposes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 400; ++i) {
    const double size = i % 4 == 0 ? 1 : std::pow(10, 6 * unit(random));
    const Transform turn(
        rotationOf(axisRotation({unit(random), unit(random), 1}, 360 * unit(random))));
    const Transform sized = Transform::scale(size, size, size);
    MovingTransform transform = MovingTransform(sized).then(turn);
    if (i % 3 == 0)
      transform = transform.then(turningBy({unit(random), 1, 0}, 300)).then(sized);
    transform = transform.then(Transform::translate(1e3 * unit(random), unit(random), 0));
    const double square = squaredScale(transform);
    ASSERT_GT(square, 0);
    EXPECT_EQ(square == 1, i % 4 == 0);
    Scene scene = unlitScene();
    Placement placement;
    placement.transform = transform;
    scene.addPrimitive(scene.addObject("Sphere", {vector(0, 0, 0), 1.0}),
                       scene.addObject("Normal", members({})), placement);
    const RtslLaunch launch = scene.launch();
    EXPECT_EQ(launch.needs & RTSL_HAS_STRETCH, 0u);
    const float time = float(random()) * 0x1p-32f;
    const device::TransformAt atTime(launch, launch.instances[0], time);
    const RtslTransform &stored = atTime;
    EXPECT_EQ(stored.squaredScale, square);
    const Vec3 v{float(unit(random)), float(unit(random)), float(unit(random))};
    const Vec3 world = device::vectorToWorld(launch, stored, v),
               back = device::vectorToObject(launch, stored, world);
    const Transform exact = transform.at(time);
    for (std::size_t row = 0; row < 3; ++row) {
      Real sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += Real(exact.columns[k][row]) * Real(v[int(k)]);
      EXPECT_NEAR(world[int(row)], double(sum), std::sqrt(3 * square) * 0x1p-24);
      EXPECT_NEAR(back[int(row)], v[int(row)], 3 * 0x1p-24);
    }
  }
  EXPECT_EQ(squaredScale(Transform::scale(-2, 2, 2)), 0);
  const MotionFactor growing{{0, 1}, {Transform::scale(1, 1, 1), Transform::scale(2, 2, 2)}, {}};
  EXPECT_EQ(squaredScale(MovingTransform(growing)), 0);
  EXPECT_EQ(squaredScale(Transform::scale(2, 2, 2.00001)), 0);
}

// The bounds are proven, so a random point at a random time must never be outside.
TEST(Motion, StaysInItsBounds) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const MovingTransform motion = randomFactors(random);
    const float lower[3] = {-1, float(unit(random)) - 1, 0.25f},
                upper[3] = {1, 1, 1 + float(std::exp(3 * unit(random)))};
    const SweptBox box = sweptBox(motion, lower, upper);
    std::array<double, 3> low = box.upper, high = box.lower;
    for (int sample = 0; sample < 4000; ++sample) {
      double p[3];
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = random() % 2 ? lower[axis] : upper[axis];
      const auto at = mapped(motion.at(double(random()) * 0x1p-32), p);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_GE(at[axis], box.lower[axis]);
        ASSERT_LE(at[axis], box.upper[axis]);
        low[axis] = std::min(low[axis], at[axis]);
        high[axis] = std::max(high[axis], at[axis]);
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) // and they are not much larger than necessary
      EXPECT_LT(box.upper[axis] - box.lower[axis], 1.6 * (high[axis] - low[axis])) << i;
  }
}

// In long double: whether a ray meets a triangle, and where. The vertices are on a circle about the
// z axis, turned by `angle` radians.
namespace {

struct ExactHit {
  Real t, least; // the smallest of the weights of the vertices
};

ExactHit exactHit(const Vec3 vertices[3], Real angle, Vec3 o, Vec3 d) {
  Real v[3][3];
  const Real c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < 3; ++i) {
    v[i][0] = c * vertices[i].x - s * vertices[i].y - o.x;
    v[i][1] = s * vertices[i].x + c * vertices[i].y - o.y;
    v[i][2] = Real(vertices[i].z) - o.z;
  }
  const auto volume = [&](const Real a[3], const Real b[3]) {
    return (a[1] * b[2] - a[2] * b[1]) * d.x + (a[2] * b[0] - a[0] * b[2]) * d.y +
           (a[0] * b[1] - a[1] * b[0]) * d.z;
  };
  const Real w0 = volume(v[1], v[2]), w1 = volume(v[2], v[0]), w2 = volume(v[0], v[1]);
  const Real sum = w0 + w1 + w2;
  Real n[3], along = 0, at = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    n[i] = (v[1][j] - v[0][j]) * (v[2][k] - v[0][k]) - (v[1][k] - v[0][k]) * (v[2][j] - v[0][j]);
    at += n[i] * v[0][i];
  }
  along = n[0] * d.x + n[1] * d.y + n[2] * d.z;
  return {at / along, std::min({w0 / sum, w1 / sum, w2 / sum})};
}

} // namespace

TEST(Motion, OfATriangleAgreesWithExactArithmetic) {
  const Vec3 vertices[3] = {{1.5f, -0.5f, -0.3f}, {1.5f, 0.75f, 0.1f}, {2.5f, 0.25f, 0.6f}};
  constexpr double degrees = 170;
  Scene scene = unlitScene();
  Mesh mesh;
  for (const Vec3 &p : vertices)
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
  mesh.indices = {0, 1, 2};
  Placement placement;
  placement.transform = turningBy({0, 0, 1}, degrees);
  scene.addMeshInstance(scene.addMesh(mesh), scene.addObject("Normal", members({})), placement);
  const HostScene embree(scene, true, 1), own(scene, false, 1);
  RtslLaunch launch = scene.launch();
  launch.host = &embree;

  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  int hits = 0;
  for (int i = 0; i < 200000; ++i) {
    const float time = float(random()) * 0x1p-32f;
    const Real angle = Real(time) * degrees / 180 * 3.14159265358979323846L;
    // Towards a point near the triangle.
    const float x = 2 + unit(random), y = unit(random), z = unit(random);
    const Vec3 target = {float(std::cos(angle) * x - std::sin(angle) * y),
                         float(std::sin(angle) * x + std::cos(angle) * y), z};
    const Vec3 o = {4 * unit(random), 4 * unit(random), 4 + unit(random)};
    const Vec3 d = target - o;
    const ExactHit exact = exactHit(vertices, angle, o, d);
    RtslState state = makeState(own.deviceLaunch(), o, d);
    state.Time = time;
    RtslState ofEmbree = state;
    ofEmbree.launch = &launch;
    const bool isHit = own.traverse(state, 0) == RTSL_HIT;
    EXPECT_EQ(embree.traverse(ofEmbree, 0) == RTSL_HIT, isHit);
    expectSame(state, ofEmbree, i);
    constexpr Real edge = 1e-5L; // within it rounding decides
    if (std::fabs(exact.least) > edge && exact.t > 1e-3L)
      ASSERT_EQ(isHit, exact.least > 0) << i;
    if (!isHit || !(exact.least > edge))
      continue;
    ++hits;
    EXPECT_NEAR(double(state.HitDistance), double(exact.t), 4e-6 * double(exact.t)) << i;
  }
  EXPECT_GT(hits, 20000);
}

TEST(Motion, IsRefusedWhereItFlattens) {
  const auto message = [](const MovingTransform &motion) -> std::string {
    try {
      roundedTransform(motion, "ball", std::nullopt);
    } catch (const Error &error) {
      return error.what();
    }
    return "";
  };
  const Transform none, turned = Transform::rotate({0, 0, 1}, 180);
  EXPECT_EQ(message(MovingTransform(MotionFactor{{0, 1}, {none, turned}, {}})),
            "the transform of `ball` at time 0.5 flattens it");
  EXPECT_EQ(message(turningBy({0, 0, 1}, 180)), "");
  EXPECT_EQ(
      message(MovingTransform(MotionFactor{{0, 1}, {none, Transform::translate(1e30, 0, 0)}, {}})),
      "the transform of `ball` at time 0.125 is out of range: row 0 of column 3 is 1.25e+29");
}

TEST(Motion, KeysOfAMeshMustFit) {
  Mesh triangle;
  triangle.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  triangle.indices = {0, 1, 2};
  Mesh turned = triangle, larger = triangle;
  turned.indices = {0, 2, 1};
  larger.positions.insert(larger.positions.end(), {2, 2, 2});
  const auto message = [&](const Mesh &other) -> std::string {
    try {
      movingMesh({triangle, other}, {0, 1}, {"a.obj", "b.obj"});
    } catch (const Error &error) {
      EXPECT_EQ(error.place->file, "b.obj");
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(triangle), "");
  EXPECT_EQ(message(turned),
            "mesh `b.obj` does not have the triangles of the first key of its object, `a.obj`");
  EXPECT_EQ(message(larger), "mesh `b.obj` has 4 vertices, but the first key of its object, "
                             "`a.obj`, has 3");
}
