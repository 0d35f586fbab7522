#include "runtime/device/traverse/Triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rtsl::device;

namespace {

struct Exact {
  long double t, u, v, w, facing; // facing: cosine between direction and normal
};

/// The same question in long double, by another method: t and barycentrics from signed volumes.
Exact oracle(Vec3 o, Vec3 d, Vec3 v0, Vec3 v1, Vec3 v2) {
  using L = long double;
  L e1[3] = {L(v1.x) - v0.x, L(v1.y) - v0.y, L(v1.z) - v0.z},
    e2[3] = {L(v2.x) - v0.x, L(v2.y) - v0.y, L(v2.z) - v0.z};
  L s[3] = {L(o.x) - v0.x, L(o.y) - v0.y, L(o.z) - v0.z}, dir[3] = {d.x, d.y, d.z};
  auto cross = [](const L *a, const L *b, L *c) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
  };
  auto dot = [](const L *a, const L *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  L p[3], q[3], n[3];
  cross(dir, e2, p);
  cross(s, e1, q);
  cross(e1, e2, n);
  L determinant = dot(e1, p);
  L u = dot(s, p) / determinant, v = dot(dir, q) / determinant;
  return {dot(e2, q) / determinant, u, v, 1 - u - v,
          std::fabs(dot(dir, n)) / std::sqrt(dot(dir, dir) * dot(n, n))};
}

/// A float's exponent is uniform, its mantissa too.
float wild(std::mt19937 &random, int lowest, int highest) {
  std::uniform_int_distribution<int> exponent(lowest, highest);
  std::uniform_real_distribution<float> mantissa(-2, 2);
  return std::ldexp(mantissa(random), exponent(random));
}

Vec3 wildVector(std::mt19937 &random, int lowest, int highest) {
  return {wild(random, lowest, highest), wild(random, lowest, highest),
          wild(random, lowest, highest)};
}

Vec3 mix(Vec3 a, Vec3 b, Vec3 c, float u, float v) {
  return a * (1 - u - v) + b * u + c * v;
}

} // namespace

TEST(Triangle, AgreesWithLongDoubleAwayFromEdges) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1), around(-0.5f, 1.5f);
  int hits = 0, misses = 0;
  for (int i = 0; i < 300000; ++i) {
    Vec3 v0 = wildVector(random, -2, 2), v1 = wildVector(random, -2, 2),
         v2 = wildVector(random, -2, 2);
    Vec3 o = wildVector(random, -1, 4), target = mix(v0, v1, v2, around(random), around(random));
    Vec3 d = (target - o) * std::ldexp(1.0f, int(random() % 20) - 10);
    Exact exact = oracle(o, d, v0, v1, v2);
    // Rounding of the vertices moves an edge by rounding units of their distance, in units of the
    // triangle's height seen by the ray.
    Vec3 normal = cross(v1 - v0, v2 - v0);
    float side = largest(v1 - v0) + largest(v2 - v0);
    float height = std::sqrt(dot(normal, normal)) / side;
    float away = largest(v0 - o) + side;
    long double slack = 16 * roundingUnit * away / (height * exact.facing);
    if (!(slack < 0.05L))
      continue;
    long double least = std::min({exact.u, exact.v, exact.w});
    TriangleHit hit;
    bool found = intersectTriangle(makeTriangleRay(o, d), v0, v1, v2, hit);
    if (least > slack) {
      ASSERT_TRUE(found) << i;
      ++hits;
      EXPECT_NEAR(double(hit.u), double(exact.u), double(slack)) << i;
      EXPECT_NEAR(double(hit.v), double(exact.v), double(slack)) << i;
      long double tSlack = 16 * roundingUnit * away / (largest(d) * exact.facing);
      EXPECT_NEAR(double(hit.t), double(exact.t), double(tSlack)) << i;
    } else if (least < -slack) {
      ASSERT_FALSE(found) << i;
      ++misses;
    }
  }
  EXPECT_GT(hits, 30000);
  EXPECT_GT(misses, 30000);
}

// Each ray goes through the closed fan round a vertex. Aimed at edges and at the vertex, it must
// hit at least one triangle.
TEST(Triangle, NoRaySlipsThroughEdgesOrVertices) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  int edgeHits = 0;
  for (int i = 0; i < 20000; ++i) {
    int scale = int(random() % 80) - 40;
    auto point = [&](float x, float y, float z) {
      return Vec3{std::ldexp(x, scale), std::ldexp(y, scale), std::ldexp(z, scale)};
    };
    constexpr int spokes = 6;
    Vec3 centre = point(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f), rim[spokes];
    for (int k = 0; k < spokes; ++k) {
      float angle = (float(k) + 0.6f * unit(random)) * 6.2831853f / spokes;
      rim[k] = point(3 * std::cos(angle), 3 * std::sin(angle), unit(random) - 0.5f);
    }
    Vec3 o =
        point(4 * unit(random) - 2, 4 * unit(random) - 2, 5 + 100 * unit(random) * unit(random));
    // On an edge, on the vertex, or somewhere close to them.
    Vec3 spoke = rim[random() % spokes];
    Vec3 target = mix(centre, spoke, spoke, 0, 0);
    if (i % 4)
      target = centre + (spoke - centre) * (0.9f * unit(random));
    Vec3 d = target - o;
    if (i % 3 == 0)
      d = d * std::ldexp(1.0f, int(random() % 60) - 30);
    TriangleRay ray = makeTriangleRay(o, d);
    int found = 0;
    for (int k = 0; k < spokes; ++k) {
      TriangleHit hit;
      // Either orientation, and each triangle starts at another vertex.
      Vec3 a = rim[k], b = rim[(k + 1) % spokes];
      found += k % 3 == 0   ? intersectTriangle(ray, centre, a, b, hit)
               : k % 3 == 1 ? intersectTriangle(ray, b, centre, a, hit)
                            : intersectTriangle(ray, b, a, centre, hit);
    }
    ASSERT_GE(found, 1) << "ray " << i << " slips through";
    edgeHits += found > 1;
  }
  EXPECT_GT(edgeHits, 100); // some rays did meet an edge exactly
}

TEST(Triangle, RaysAlongAxesThroughVertices) {
  // Zero components of the direction, and a grid whose vertices the rays meet exactly.
  for (int axis = 0; axis < 3; ++axis)
    for (int sign : {-1, 1}) {
      auto turn = [&](float x, float y, float z) {
        return axis == 0 ? Vec3{z, x, y} : axis == 1 ? Vec3{y, z, x} : Vec3{x, y, z};
      };
      TriangleRay ray =
          makeTriangleRay(turn(0.5f, 0.5f, float(-3 * sign)), turn(0, 0, float(sign)));
      TriangleHit hit;
      EXPECT_TRUE(intersectTriangle(ray, turn(0, 0, 0), turn(1, 0, 0), turn(0, 1, 0),
                                    hit)); // on the diagonal
      EXPECT_EQ(hit.t, 3);
      EXPECT_EQ(hit.u, 0.5f);
      EXPECT_EQ(hit.v, 0.5f);
      EXPECT_TRUE(intersectTriangle(ray, turn(1, 1, 0), turn(0, 1, 0), turn(1, 0, 0), hit));
      EXPECT_FALSE(intersectTriangle(ray, turn(0, 0, 0), turn(1, 0, 0), turn(0, 0.9f, 0), hit));
      // Seen edge on, and without area.
      EXPECT_FALSE(intersectTriangle(ray, turn(0.5f, 0.5f, 0), turn(0.5f, 0.5f, 1),
                                     turn(0.5f, 0.5f, 2), hit));
      EXPECT_FALSE(intersectTriangle(ray, turn(0.5f, 0.5f, 0), turn(0.5f, 0.5f, 0),
                                     turn(0.5f, 0.5f, 0), hit));
    }
}

TEST(Triangle, PowersOfTwoChangeNothingButT) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    Vec3 v0 = wildVector(random, -1, 1), v1 = wildVector(random, -1, 1),
         v2 = wildVector(random, -1, 1);
    Vec3 o = wildVector(random, 1, 2), d = mix(v0, v1, v2, 0.3f, 0.3f) - o;
    TriangleHit hit;
    if (!intersectTriangle(makeTriangleRay(o, d), v0, v1, v2, hit))
      continue;
    for (int exponent : {-120, -60, -31, 31, 60, 100}) {
      float s = std::ldexp(1.0f, exponent);
      TriangleHit other;
      // A longer or shorter direction.
      Vec3 e = d * s;
      if (largest(e) < INFINITY && std::fabs(e.x) > 1e-30f && std::fabs(e.y) > 1e-30f &&
          std::fabs(e.z) > 1e-30f) {
        ASSERT_TRUE(intersectTriangle(makeTriangleRay(o, e), v0, v1, v2, other)) << exponent;
        EXPECT_EQ(other.t, hit.t / s);
        EXPECT_EQ(other.u, hit.u);
        EXPECT_EQ(other.v, hit.v);
      }
      // A larger or smaller world. Far down, differences become denormal and lose bits.
      ASSERT_TRUE(intersectTriangle(makeTriangleRay(o * s, d * s), v0 * s, v1 * s, v2 * s, other))
          << exponent;
      if (exponent > -100) {
        EXPECT_EQ(other.t, hit.t);
        EXPECT_EQ(other.u, hit.u);
      } else {
        EXPECT_NEAR(other.t, hit.t, 1e-3f * hit.t);
      }
    }
  }
}

TEST(Triangle, TheLongestDirectionWorks) {
  TriangleHit hit;
  EXPECT_TRUE(intersectTriangle(makeTriangleRay({0, 0, 0}, {0, 0, 3.4e38f}), {-1, -1, 7},
                                {1, -1, 7}, {0, 1, 7}, hit));
  EXPECT_FLOAT_EQ(hit.t, 7 / 3.4e38f);
  EXPECT_TRUE(intersectTriangle(makeTriangleRay({0, 0, 0}, {0, 0, 1e-44f}), {-1, -1, 1e-10f},
                                {1, -1, 1e-10f}, {0, 1, 1e-10f}, hit));
  EXPECT_NEAR(hit.t, 1e-10f / 1e-44f, 1e-2f * 1e34f);
}

TEST(DifferenceOfProducts, SignIsExact) {
  std::mt19937 random(4);
  for (int i = 0; i < 100000; ++i) {
    // Close to cancellation: b/a and d/c almost equal.
    float a = wild(random, -10, 10), b = wild(random, -10, 10), k = wild(random, -2, 2);
    float c = a * k, d = b * k;
    float result = differenceOfProducts(a, d, b, c);
    long double exact = (long double)a * d -
                        (long double)b * c; // products of floats are exact in 64 bits of mantissa
    EXPECT_EQ(result > 0, exact > 0);
    EXPECT_EQ(result < 0, exact < 0);
    EXPECT_NEAR(double(result), double(exact), 1.6 * double(std::fabs(exact)) * 0x1p-23);
  }
}

TEST(Vector, NormalizedWorksForAnyLength) {
  for (float s : {1e-45f, 1e-40f, 1e-30f, 1e-3f, 1.0f, 1e10f, 1e30f, 1e38f}) {
    Vec3 n = normalized({s, -s, s});
    EXPECT_NEAR(dot(n, n), 1, 1e-6) << s;
    EXPECT_LT(n.y, 0);
  }
  EXPECT_TRUE(isZero(normalized({0, 0, 0})));
}
