//===- GeometryBuiltinsTest.cpp - dot, normalize, cross, refract, ... -----===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <random>

namespace rtsl::test {
namespace {

using Vec = std::array<double, 3>;

double dot(const Vec &a, const Vec &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Vec &v) {
  return std::hypot(v[0], v[1], v[2]);
}

/// Directions with components of very different size, times `scale`.
std::vector<Vec> directions(double scale) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec> result;
  for (int i = 0; i < 200; ++i) {
    Vec v;
    for (double &component : v)
      component = static_cast<float>(scale * unit(random) *
                                     std::exp2(-std::floor(12 * std::abs(unit(random)))));
    result.push_back(v);
  }
  for (double a : {0.0, 1.0, -1.0})
    for (double b : {0.0, 1.0, 1e-4})
      for (double c : {0.0, -1.0, 1e-7})
        if (a != 0 || b != 0 || c != 0)
          result.push_back({static_cast<float>(scale * a), static_cast<float>(scale * b),
                            static_cast<float>(scale * c)});
  return result;
}

std::vector<float> inputs(std::initializer_list<Vec> vectors) {
  std::vector<float> result;
  for (const Vec &v : vectors)
    for (double component : v)
      result.push_back(static_cast<float>(component));
  return result;
}

TEST(GeometryBuiltins, DotRoundsEachOperation) {
  FloatFunction run("x[0] = dot(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));");
  for (const Vec &a : directions(3))
    for (const Vec &b : {Vec{1.25, -3.7, 0.001}, Vec{1e-3, 99, 7}}) {
      auto f = [](double value) { return static_cast<float>(value); };
      float x = f(a[0]) * f(b[0]), y = f(a[1]) * f(b[1]), z = f(a[2]) * f(b[2]);
      EXPECT_EQ(run(inputs({a, b}))[0], (x + y) + z);
    }
  FloatFunction four(
      "x[0] = dot(vec4(1, 2, 3, x[0]), vec4(4)); x[1] = dot(vec2(x[1], 2), vec2(3)); "
      "x[2] = dot(x[2], 5.0);");
  auto result = four({4.0F, 1.0F, 2.0F});
  EXPECT_EQ(result[0], 40.0F);
  EXPECT_EQ(result[1], 9.0F);
  EXPECT_EQ(result[2], 10.0F);
}

TEST(GeometryBuiltins, LengthOfAllMagnitudes) {
  FloatFunction run("x[0] = length(vec3(x[0], x[1], x[2]));");
  for (double scale :
       {1e-42, 1e-40, 1e-38, 1e-30, 1e-20, 1e-15, 1e-14, 1.0, 1e10, 1e18, 1e19, 1e20, 1e30, 1.7e38})
    for (const Vec &v : directions(scale))
      EXPECT_ULPS(run(inputs({v}))[0], length(v), 2.0) << "at scale " << scale;
  EXPECT_EQ(run({0.0F, -0.0F, 0.0F})[0], 0.0F);
  EXPECT_TRUE(std::isinf(run({INFINITY, 0.0F, 1.0F})[0]));
  EXPECT_TRUE(std::isinf(run({3e38F, 3e38F, 0.0F})[0])) << "the length itself is too large";
  FloatFunction scalar(
      "x[0] = length(x[0]); x[1] = distance(x[1], x[2]); x[3] = length(vec2(3, x[3]));");
  auto result = scalar({-2.5F, 3.0F, 7.0F, 4.0F});
  EXPECT_EQ(result[0], 2.5F);
  EXPECT_EQ(result[1], 4.0F);
  EXPECT_EQ(result[3], 5.0F);
}

TEST(GeometryBuiltins, DistanceOfAllMagnitudes) {
  FloatFunction run("x[0] = distance(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));");
  for (double scale : {1e-40, 1e-20, 1.0, 1e20, 1e38}) {
    float s = static_cast<float>(scale);
    EXPECT_ULPS(run({3 * s, 0, 0, 0, -4 * s, 0})[0], std::hypot(double(3 * s), double(4 * s)), 2.0);
  }
}

TEST(GeometryBuiltins, NormalizeOfAllMagnitudes) {
  FloatFunction run(
      "vec3 v = normalize(vec3(x[0], x[1], x[2])); x[0] = v.x; x[1] = v.y; x[2] = v.z;");
  for (double scale :
       {1e-42, 1e-40, 1e-38, 1e-30, 1e-20, 1e-15, 1e-14, 1.0, 1e10, 1e18, 1e19, 1e20, 1e30, 1.7e38})
    for (const Vec &v : directions(scale)) {
      double exact = length(v);
      if (exact == 0)
        continue; // rounded away by the scale
      auto result = run(inputs({v}));
      for (int i = 0; i < 3; ++i)
        EXPECT_ULPS(result[i], v[i] / exact, 2.5) << "at scale " << scale;
    }
}

TEST(GeometryBuiltins, NormalizeOfZeroIsZero) {
  FloatFunction run(
      "vec3 v = normalize(vec3(x[0], x[1], x[2])); x[0] = v.x; x[1] = v.y; x[2] = v.z;\n"
      "x[3] = normalize(x[3]); x[4] = normalize(x[4]); x[5] = normalize(x[5]);");
  auto result = run({0.0F, -0.0F, 0.0F, 0.0F, -1e-44F, 3e38F});
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(result[i], 0.0F);
  EXPECT_EQ(result[4], -1.0F);
  EXPECT_EQ(result[5], 1.0F);
}

TEST(GeometryBuiltins, CrossHasNoCancellation) {
  FloatFunction run("vec3 v = cross(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));\n"
                    "x[0] = v.x; x[1] = v.y; x[2] = v.z;");
  for (const Vec &a : directions(1)) {
    // Nearly parallel.
    Vec b = a;
    b[0] = static_cast<float>(b[0] * (1 + 3e-7));
    b[1] = static_cast<float>(b[1] * (1 - 2e-7));
    auto result = run(inputs({a, b}));
    // Products of floats are exact in double, their difference nearly so.
    EXPECT_ULPS(result[0], a[1] * b[2] - a[2] * b[1], 1.5);
    EXPECT_ULPS(result[1], a[2] * b[0] - a[0] * b[2], 1.5);
    EXPECT_ULPS(result[2], a[0] * b[1] - a[1] * b[0], 1.5);
    auto zero = run(inputs({a, a}));
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(zero[i], 0.0F);
  }
}

TEST(GeometryBuiltins, ReflectAndFaceforward) {
  FloatFunction run("vec3 r = reflect(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]));\n"
                    "vec3 f = faceforward(vec3(x[3], x[4], x[5]), vec3(x[0], x[1], x[2]), "
                    "vec3(x[6], x[7], x[8]));\n"
                    "x[0] = r.x; x[1] = r.y; x[2] = r.z; x[3] = f.x; x[4] = f.y; x[5] = f.z;");
  Vec i{0.6, -0.8, 0.1}, n{0, 1, 0};
  auto result = run(inputs({i, n, {0, 1, 0}}));
  EXPECT_EQ(result[0], 0.6F);
  EXPECT_EQ(result[1], 0.8F);
  EXPECT_EQ(result[2], 0.1F);
  EXPECT_EQ(result[4], 1.0F) << "the reference is against the incident direction";
  EXPECT_EQ(run(inputs({i, n, {0, -1, 0}}))[4], -1.0F);
}

TEST(GeometryBuiltins, OppositesOfZeroHaveTheOtherSign) {
  FloatFunction run("vec4 v = -vec4(x[0]); mat2x4 m = -mat2x4(x[0]);\n"
                    "vec4 f = faceforward(vec4(x[0]), vec4(1.0), vec4(1.0));\n"
                    "x[1] = v.w; x[2] = m[1].w; x[3] = f.x;");
  auto result = run(inputs({{0, 0, 0}}));
  for (int i = 1; i < 4; ++i)
    EXPECT_TRUE(std::signbit(result[i])) << i;
}

TEST(GeometryBuiltins, RefractFollowsSnell) {
  FloatFunction run("vec3 r = refract(vec3(x[0], x[1], x[2]), vec3(x[3], x[4], x[5]), x[6]);\n"
                    "x[0] = r.x; x[1] = r.y; x[2] = r.z;");
  for (float eta : {0.4F, 1.0F / 1.5F, 1.0F, 1.33F, 1.5F, 2.4F})
    for (float angle = 0.0F; angle < 1.57F; angle += 0.05F) {
      float s = std::sin(angle), c = -std::cos(angle);
      auto result = run({s, c, 0.0F, 0.0F, 1.0F, 0.0F, eta});
      double d = c, k = 1 - double(eta) * eta * (1 - d * d);
      if (std::abs(k) < 1e-3)
        continue; // the last digit of the input decides
      if (k < 0) {
        EXPECT_EQ(result[0], 0.0F);
        EXPECT_EQ(result[1], 0.0F);
        continue;
      }
      EXPECT_NEAR(result[0], double(eta) * s, 3e-7 * eta);
      EXPECT_NEAR(result[1], eta * d - (eta * d + std::sqrt(k)), 1e-6 * (eta + 1 / std::sqrt(k)));
      EXPECT_EQ(result[2], 0.0F);
    }
}

TEST(GeometryBuiltins, PerpendicularToIsAUnitVectorAcross) {
  FloatFunction run(
      "vec3 p = perpendicularTo(vec3(x[0], x[1], x[2])); x[0] = p.x; x[1] = p.y; x[2] = p.z;");
  for (double scale : {1e-40, 1e-20, 1.0, 1e20, 1e38})
    for (const Vec &v : directions(scale)) {
      if (length(v) == 0)
        continue;
      auto result = run(inputs({v}));
      Vec p{result[0], result[1], result[2]};
      EXPECT_NEAR(length(p), 1, 3e-7);
      EXPECT_LE(std::abs(dot(p, v)), 2e-7 * length(v)) << "at scale " << scale;
    }
  EXPECT_EQ(run({0.0F, 0.0F, 0.0F})[0], 1.0F);
}

TEST(GeometryBuiltins, DominantAxis) {
  FloatFunction run("x[0] = float(dominantAxis(vec3(x[0], x[1], x[2]))); x[1] = "
                    "float(dominantAxis(vec2(x[3], x[4])));"
                    "x[2] = float(dominantAxis(vec4(x[5], x[6], x[7], x[8])));");
  auto result = run({1.0F, -3.0F, 2.0F, 1.0F, 1.0F, 0.0F, 1.0F, 2.0F, -9.0F});
  EXPECT_EQ(result[0], 1.0F);
  EXPECT_EQ(result[1], 0.0F) << "the lowest index on a tie";
  EXPECT_EQ(result[2], 3.0F);
  EXPECT_EQ(run({-2.0F, 2.0F, 2.0F})[0], 0.0F);
  EXPECT_EQ(run({0.0F, 2.0F, -2.0F})[0], 1.0F);
  EXPECT_EQ(run({0.0F, 0.0F, -1e-44F})[0], 2.0F);
}

TEST(GeometryBuiltins, InsideAndHorizontalMinMax) {
  FloatFunction run(
      "x[3] = inside(vec3(x[0], x[1], x[2]), vec3(0), vec3(1, 2, 3)) ? 1.0 : 0.0;\n"
      "x[4] = inside(x[0], 0.0, 1.0) ? 1.0 : 0.0; x[5] = min(vec3(x[0], x[1], x[2]));\n"
      "x[6] = max(vec3(x[0], x[1], x[2])); x[7] = inside(vec2(x[0], x[1]), 0.0, 2.0) ? 1.0 : 0.0;");
  auto result = run({1.0F, 2.0F, 3.0F});
  EXPECT_EQ(result[3], 1.0F) << "bounds belong to the range";
  EXPECT_EQ(result[4], 1.0F);
  EXPECT_EQ(result[5], 1.0F);
  EXPECT_EQ(result[6], 3.0F);
  EXPECT_EQ(result[7], 1.0F);
  EXPECT_EQ(run({1.0F, 2.5F, 3.0F})[3], 0.0F);
  EXPECT_EQ(run({1.0F, NAN, 3.0F})[3], 0.0F);
  Outcome integers(
      "n[0] = inside(n[0], -1, 4) ? 1 : 0; n[1] = inside(u[1], 3u, 4000000000u) ? 1 : 0;", {},
      {4, 3000000000LL});
  EXPECT_EQ(integers.n[0], 1);
  EXPECT_EQ(integers.n[1], 1);
}

} // namespace
} // namespace rtsl::test
