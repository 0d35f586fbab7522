//===- HitErrorsTest.cpp - how exact the hits of primitives are -----------===//
#include "Linked.h"

namespace rtsl {
namespace {

const std::string materials = R"(
class Matte : rt_Material {
  void shade() { rt_SampleColor = color(1.0); }
};
class Mirror : rt_Material {
  void shade() { rt_SampleColor = trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal)); }
};
class Lit : rt_Material {
  void shade() { illuminance (rt_HitPoint) rt_SampleColor = rt_LightColor; }
};
)";

std::string primitive(const std::string &statements) {
  return materials + R"(
class Ball : rt_Primitive {
  public vec3 center;
  public float heights[];
  void intersect() {)" +
         statements + R"(}
  void computeBounds() { rt_BoundMin = vec3(-1.0); rt_BoundMax = vec3(1.0); }
};
)";
}

const std::string plane = "hit((center.z - rt_RayOrigin.z) / rt_RayDirection.z);";
const std::string boundOfBall = "Ball.rt_boundHitError";

/// A scene of a Ball with a material.
LinkRequest ballOf(const std::string &material) {
  LinkRequest request;
  request.classes = {"Ball", material};
  request.surfaces.emplace_back("Ball", material);
  return request;
}

/// What the warning points at; empty: there is none.
std::string unbound(Linked &linked, std::string *message = nullptr) {
  for (const Diagnostic &diagnostic : linked.diagnostics.all())
    if (diagnostic.code == Code::hitErrorUnknown) {
      if (message)
        *message = diagnostic.message;
      return std::string(linked.diagnostics.sources().text(diagnostic.range));
    }
  return {};
}

TEST(HitErrors, AreDerivedWhereRaysLeave) {
  for (const char *material : {"Mirror", "Lit"}) {
    Linked linked(primitive(plane), ballOf(material));
    EXPECT_TRUE(linked.function(boundOfBall)) << material;
    EXPECT_TRUE(linked.classInfo(material).needs & RTSL_NEEDS_HIT_ERRORS) << material;
    EXPECT_EQ(unbound(linked), "") << material;
  }
}

TEST(HitErrors, AreLeftOutWhereNoRayLeaves) {
  Linked matte(primitive(plane), ballOf("Matte"));
  EXPECT_FALSE(matte.function(boundOfBall));
  EXPECT_FALSE(matte.program.needs & RTSL_NEEDS_HIT_ERRORS);
  // A mirror is there, but on a mesh.
  LinkRequest request = ballOf("Matte");
  request.classes.emplace_back("Mirror");
  request.surfaces.emplace_back("", "Mirror");
  Linked elsewhere(primitive(plane), request);
  EXPECT_FALSE(elsewhere.function(boundOfBall));
}

/// Is a primitive with this `intersect` seen to be a plane, which a ray does not meet again?
bool isPlane(const std::string &statements) {
  Linked linked(primitive(statements), ballOf("Mirror"));
  return linked.program.raysLeavePlanes;
}

TEST(HitErrors, PlanesAreMetOnce) {
  EXPECT_TRUE(isPlane(plane));
  const std::string n = "vec3 n = center, o = rt_RayOrigin, d = rt_RayDirection;";
  EXPECT_TRUE(isPlane(n + "hit((center.x - dot(n, o)) / dot(n, d));"));
  EXPECT_TRUE(isPlane(n + "hit(dot(n, vec3(1.0) - o) / dot(d, center));"));
  EXPECT_TRUE(isPlane(n + "hit(dot(o - n, n) / -dot(d, n));"));
  EXPECT_TRUE(isPlane(n + "n = cross(n, vec3(1.0, 2.0, 3.0));"
                          "hit(-(dot(n, o) - 2.0 * center.y) / dot(n, d));"));
  EXPECT_TRUE(isPlane(n + "float slope = dot(n, d); if (slope == 0.0) return;"
                          "float t = dot(n - o, n) / slope; if (length(o + t * d) < 1.0) hit(t);"));
}

TEST(HitErrors, OtherSurfacesMayBeMetAgain) {
  const std::string n = "vec3 n = center, o = rt_RayOrigin, d = rt_RayDirection;";
  EXPECT_FALSE(isPlane(n + "float b = dot(o, d); hit(-b - sqrt(b * b - dot(o, o) + 1.0));"));
  EXPECT_FALSE(isPlane(n + "hit((1.0 - o.x) / d.x); hit((2.0 - o.x) / d.x);")) << "two planes";
  EXPECT_FALSE(isPlane("for (int i = 0; i < 3; ++i)"
                       "  hit((heights[i] - rt_RayOrigin.x) / rt_RayDirection.x);"));
  EXPECT_FALSE(isPlane(n + "float h = 0.0; for (int i = 0; i < 3; ++i) { h = heights[i];"
                           "  if (h > o.y) break; } hit((h - o.x) / d.x);"));
  EXPECT_FALSE(isPlane(n + "float h = o.y > 0.0 ? 1.0 : 2.0; hit((h - o.x) / d.x);"));
  EXPECT_FALSE(isPlane(n + "hit((n.x - o.x) / d.y);"));
  EXPECT_FALSE(isPlane(n + "hit((n.x + o.x) / d.x);"));
  EXPECT_FALSE(isPlane(n + "hit((n.x - 2.0 * o.x) / d.x);"));
  EXPECT_FALSE(isPlane(n + "hit((n.x - o.x) / (d.x + 1.0));"));
  EXPECT_FALSE(isPlane(n + "hit((n.x - o.x) / (d.x + d.y));"));
  EXPECT_FALSE(isPlane(n + "hit((n.x - o.x * d.x) / d.x);"));
  EXPECT_FALSE(isPlane(n + "hit((dot(n, vec3(1.0)) - dot(n, o)) / dot(vec3(heights[0]), d));"));
  EXPECT_FALSE(isPlane(n + "hit((rand() - o.x) / d.x);"));
  std::string doubled = n + "float x = o.x;";
  for (int i = 0; i < 100; ++i)
    doubled += "x += x;"; // as many times as there are ways to x in the expression
  EXPECT_FALSE(isPlane(doubled + "hit((1.0 - x) / d.x);"));
}

TEST(HitErrors, AreNotDerivedWhereTheyAreStated) {
  Linked linked(primitive("hit(center.x, 0.5);"), ballOf("Mirror"));
  EXPECT_FALSE(linked.function(boundOfBall));
  EXPECT_EQ(unbound(linked), "");
}

TEST(HitErrors, WhatNothingBoundsIsAWarning) {
  const struct {
    const char *statements, *hit, *why;
  } cases[] = {
      {"float t = 1.0; for (int i = 0; i < 9; ++i) t -= (t * t - center.x) / (2.0 * t); hit(t);",
       "hit(t)", "a loop computes it"},
      {"float t[4]; t[int(center.x)] = center.y / 3.0; hit(t[int(center.z)]);",
       "hit(t[int(center.z)])", "an array"},
      {"hit(1.0 + rand());", "hit(1.0 + rand())", "`rand`"},
      {"hit(floor(center.x / 3.0));", "hit(floor(center.x / 3.0))", "changes in steps"},
      {"hit(float(int(center.x / 3.0)));", "hit(float(int(center.x / 3.0)))", "changes in steps"},
      {"hit(pow(center.x, center.y / 3.0));", "hit(pow(center.x, center.y / 3.0))", "exponent"},
  };
  for (const auto &one : cases) {
    Linked linked(primitive(one.statements), ballOf("Mirror"));
    std::string message;
    EXPECT_EQ(unbound(linked, &message), one.hit);
    EXPECT_NE(message.find(one.why), std::string::npos) << message;
    EXPECT_FALSE(linked.function(boundOfBall)) << one.hit;
    Linked unneeded(primitive(one.statements), ballOf("Matte"));
    EXPECT_EQ(unbound(unneeded), "") << one.hit;
  }
}

TEST(HitErrors, AreDerivedThroughWhatAuthorsWrite) {
  for (const char *statements : {
           "vec3 n = normalize(center); hit(dot(n, center - rt_RayOrigin) / dot(n, "
           "rt_RayDirection));",
           "mat3 m = mat3(center, center.yzx, center.zxy); hit((m * rt_RayOrigin).z / (m * "
           "rt_RayDirection).z);",
           "float b = dot(center, rt_RayDirection); float d = b * b - dot(center, center); if (d < "
           "0.0) return; "
           "float t = b - sqrt(d); if (t < rt_Epsilon) t = b + sqrt(d); if (t < rt_HitDistance) "
           "hit(t);",
           "float least = 1e30; for (int i = 0; i < heights.length(); ++i) least = min(least, "
           "(heights[i] - rt_RayOrigin.z) / rt_RayDirection.z); hit(least);",
           "hit(pow(center.x / 3.0, 0.33333) + acos(center.y / 3.0) + cos(center.z / 3.0) + "
           "tan(center.z / 7.0) + exp(center.x * center.y) + log(1.0 + center.x * center.x));",
           "hit(center.x);",
       }) {
    Linked linked(primitive(statements), ballOf("Mirror"));
    EXPECT_TRUE(linked.function(boundOfBall)) << statements;
    EXPECT_EQ(unbound(linked), "") << statements;
  }
}

} // namespace
} // namespace rtsl
