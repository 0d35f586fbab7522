//===- OperatorsTest.cpp - operators, conversions, constructors -----------===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rtsl::test {
namespace {

TEST(Operators, IntegerArithmeticWrapsAndIsTotal) {
  Outcome run(
      "n[0] = n[10] + 1; n[1] = n[11] - 1; n[2] = n[10] * 2; n[3] = n[12] / 0; n[4] = n[12] % 0;\n"
      "n[5] = n[11] / -1; n[6] = n[11] % -1; n[7] = -7 / 2 + n[13]; n[8] = n[14] / 2; n[9] = n[14] "
      "% 2;\n"
      "u[0] = u[13] - 1u; u[1] = u[11] / 3u; u[2] = u[11] % 7u; u[3] = u[12] / u[13]; u[4] = u[12] "
      "% u[13];",
      {}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2147483647, -2147483648LL, 5, 0, -7});
  EXPECT_EQ(run.n[0], std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(run.n[1], 2147483647);
  EXPECT_EQ(run.n[2], -2);
  EXPECT_EQ(run.n[3], 0);
  EXPECT_EQ(run.n[4], 0);
  EXPECT_EQ(run.n[5], std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(run.n[6], 0);
  EXPECT_EQ(run.n[7], -3);
  EXPECT_EQ(run.n[8], -3);
  EXPECT_EQ(run.n[9], -1);
  EXPECT_EQ(run.u[0], 4294967295u);
  EXPECT_EQ(run.u[1], 2147483648u / 3);
  EXPECT_EQ(run.u[2], 2147483648u % 7);
  EXPECT_EQ(run.u[3], 0u);
  EXPECT_EQ(run.u[4], 0u);
}

TEST(Operators, BitsAndShifts) {
  Outcome run(
      "n[0] = n[0] & 12 | 3 ^ 1; n[1] = ~n[1]; n[2] = n[2] >> 1; n[3] = 1 << (n[3] + 33); u[4] "
      "= u[4] >> 1u; u[5] = 1u << 31;\n"
      "ivec2 v = ivec2(1, 2) << ivec2(3, 4); n[6] = v.x; n[7] = v.y; v = ivec2(-8) >> 1; n[8] "
      "= v.x;",
      {}, {14, 5, -8, 0, 4294967294LL});
  EXPECT_EQ(run.n[0], (14 & 12) | (3 ^ 1));
  EXPECT_EQ(run.n[1], ~5);
  EXPECT_EQ(run.n[2], -4);
  EXPECT_EQ(run.n[3], 2) << "counts are taken modulo 32";
  EXPECT_EQ(run.u[4], 2147483647u);
  EXPECT_EQ(run.u[5], 2147483648u);
  EXPECT_EQ(run.n[6], 8);
  EXPECT_EQ(run.n[7], 32);
  EXPECT_EQ(run.n[8], -4);
}

TEST(Operators, ShapesOfFloatOperands) {
  Outcome run(
      "vec3 a = vec3(1, 2, 3), b = vec3(4, 5, 6);\n"
      "vec3 c = a + b * 2.0 - 1.0 / a; x[0] = c.x; x[1] = c.y; x[2] = c.z;\n"
      "mat2 m = mat2(1, 2, 3, 4); mat2 k = m * 2.0 + 1.0; x[3] = k[0].x; x[4] = k[1].y; k = "
      "1.0 / m; x[5] = k[0].y;\n"
      "m -= mat2(1); x[6] = m[0][0]; x[7] = m[1][0]; x[8] = (-m)[1][1]; a *= b; x[9] = a.z; a "
      "/= 2.0; x[10] = a.y;");
  const float expected[] = {
      1 + 8 - 1.0F, 2 + 10 - 0.5F, 3 + 12 - 1 / 3.0F, 3, 9, 0.5F, 0, 3, -3, 18, 5};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
}

TEST(Operators, ComparisonsWithNan) {
  Outcome run(
      "n[0] = int(x[0] < 1.0) + 2 * int(x[0] > 1.0) + 4 * int(x[0] <= x[0]) + 8 * int(x[0] >= "
      "x[0]) + 16 * int(x[0] == x[0]) + 32 * int(x[0] != x[0]);\n"
      "n[1] = int(u[0] < 1u) + 2 * int(u[0] > 1u) + 4 * int(u[0] <= u[0]) + 8 * int(u[0] >= 5u);\n"
      "n[2] = int(vec2(1, 2) == vec2(1, 2)) + 2 * int(vec2(1, x[0]) == vec2(1, x[0])) + 4 * "
      "int(vec2(1, 2) != vec2(1, 3));",
      {NAN}, {4294967295LL});
  EXPECT_EQ(run.n[0], 32);
  EXPECT_EQ(run.n[1], 2 + 4 + 8);
  EXPECT_EQ(run.n[2], 1 + 4);
}

TEST(Operators, LogicIsShortCircuited) {
  Outcome run = Outcome::with(
      "bool count(inout int counter, bool result) { counter = counter + 1; return result; }",
      "bool t = n[0] > 0, f = !t;\n"
      "n[1] = int(f && count(n[2], true)); n[3] = int(t && count(n[4], true)); n[5] = int(t || "
      "count(n[6], true));\n"
      "n[7] = int(f || count(n[8], true)); n[9] = int(t ^^ f) + 2 * int(t ^^ t); n[10] = int(f && "
      "f || t);\n"
      "n[11] = t ? 5 : int(count(n[12], true)); n[13] = int(x[0] != 0.0 && 1.0 / x[0] > 0.25);",
      {2.0F}, {1});
  const int expected[] = {1, 0, 0, 1, 1, 1, 0, 1, 1, 1, 1, 5, 0, 1};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.n[i], expected[i]) << i;
}

TEST(Operators, Conversions) {
  Outcome run(
      "n[0] = int(x[0]); n[1] = int(x[1]); n[2] = int(x[2]); n[3] = int(x[3]); n[4] = int(-2.9);\n"
      "u[0] = uint(x[0]); u[1] = uint(x[1]); u[2] = uint(x[2]); u[3] = uint(x[4]);\n"
      "x[5] = float(n[9]); x[6] = float(u[9]); x[7] = float(x[0] > 0.0); n[5] = int(bool(x[2])); "
      "n[6] = int(bool(0.0)); n[7] = int(uint(n[9]) >> 31);\n"
      "vec3 v = vec3(ivec3(1, -2, 3)); x[8] = v.y; ivec2 i = ivec2(vec2(1.9, -1.9)); n[8] = i.x * "
      "10 + i.y; bvec2 b = bvec2(vec2(0, 3)); n[10] = int(b.x) + 2 * int(b.y);",
      {1e10F, -1e10F, NAN, 3.99F, 4e9F}, {0, 0, 0, 0, 0, 0, 0, 0, 0, -1});
  EXPECT_EQ(run.n[0], 2147483647);
  EXPECT_EQ(run.n[1], std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(run.n[2], 0);
  EXPECT_EQ(run.n[3], 3);
  EXPECT_EQ(run.n[4], -2);
  EXPECT_EQ(run.u[0], 4294967295u);
  EXPECT_EQ(run.u[1], 0u);
  EXPECT_EQ(run.u[2], 0u);
  EXPECT_EQ(run.u[3], 4000000000u);
  EXPECT_EQ(run.x[5], -1.0F);
  EXPECT_EQ(run.x[6], 4294967296.0F);
  EXPECT_EQ(run.x[7], 1.0F);
  EXPECT_EQ(run.n[5], 1) << "NaN is not zero";
  EXPECT_EQ(run.n[6], 0);
  EXPECT_EQ(run.n[7], 1);
  EXPECT_EQ(run.x[8], -2.0F);
  EXPECT_EQ(run.n[8], 9);
  EXPECT_EQ(run.n[10], 2);
}

TEST(Operators, Constructors) {
  Outcome run = Outcome::with(
      "struct Ray { vec3 origin; float t[2]; };",
      "vec4 a = vec4(vec2(1, 2), 3, 4); vec3 b = vec3(a); vec2 c = vec2(b.z, a); vec3 d "
      "= vec3(7.0);\n"
      "x[0] = a.w; x[1] = b.z; x[2] = c.y; x[3] = d.z; x[4] = float(a);\n"
      "mat3 m = mat3(2.0); x[5] = m[1][1]; x[6] = m[1][0]; mat2 s = mat2(m); x[7] = "
      "s[1][1]; mat4 l = mat4(s); x[8] = l[1][1]; x[9] = l[3][3];\n"
      "mat2 k = mat2(vec2(1, 2), vec2(3, 4)); x[10] = k[1][0]; mat2 p = mat2(1, vec2(2, "
      "3), 4); x[11] = p[1][0];\n"
      "Ray r = Ray(vec3(1, 2, 3), float[2](4, 5)); x[12] = r.origin.y + r.t[1]; int e[3] "
      "= int[3](1, 2, 3); n[0] = e[2]; n[1] = e.length();\n"
      "Ray q = r; q.t[0] = 9.0; x[13] = r.t[0] + q.t[0]; n[2] = int(q == r); q.t[0] = "
      "4.0; n[3] = int(q == r); float list[2] = {6.0, 7.0}; x[14] = list[1];");
  const float expected[] = {4, 3, 1, 7, 1, 2, 0, 2, 2, 1, 3, 3, 7, 13, 7};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
  EXPECT_EQ(run.n[0], 3);
  EXPECT_EQ(run.n[1], 3);
  EXPECT_EQ(run.n[2], 0);
  EXPECT_EQ(run.n[3], 1);
}

TEST(Operators, Swizzles) {
  Outcome run(
      "vec4 v = vec4(1, 2, 3, 4); vec3 a = v.zyx; x[0] = a.x; v.xz = vec2(8, 9); x[1] = v.x; "
      "x[2] = v.z; v.wy = v.yw; x[3] = v.w; x[4] = v.y;\n"
      "v.zyx.x = 5.0; x[5] = v.z; v.x += 10.0; x[6] = v.x; v.yx *= vec2(2, 3); x[7] = v.y; "
      "x[8] = v.x; vec2 s = v.xx; x[9] = s.y; x[10] = v.rgb.b;\n"
      "v[1] = 6.0; x[11] = v.y; v[n[0]] = 7.0; x[12] = v[2]; x[13] = v[n[1]]; v.zw[n[2]] = "
      "1.0; x[14] = v.w;",
      {}, {2, 3, 1});
  const float expected[] = {3, 8, 9, 2, 4, 5, 18, 8, 54, 54, 5, 6, 7, 2, 1};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
}

TEST(Operators, IndicesAreClamped) {
  const std::string body =
      "int a[3] = int[3](10, 20, 30); n[4] = a[n[0]]; n[5] = a[n[1]]; n[6] = a[u[0]]; a[n[0]] = "
      "99; n[7] = a[2];\n"
      "vec3 v = vec3(1, 2, 3); x[0] = v[n[0]]; x[1] = v[n[1]]; v[n[1]] = 5.0; x[2] = v.x; mat2 m = "
      "mat2(1, 2, 3, 4); x[3] = m[n[0]][n[1]]; m[n[1]].y = 8.0; x[4] = m[0][1];";
  Outcome run(body, {}, {1000000, -5});
  EXPECT_EQ(run.n[4], 30);
  EXPECT_EQ(run.n[5], 10);
  EXPECT_EQ(run.n[6], 30);
  EXPECT_EQ(run.n[7], 99);
  EXPECT_EQ(run.x[0], 3.0F);
  EXPECT_EQ(run.x[1], 1.0F);
  EXPECT_EQ(run.x[2], 5.0F);
  EXPECT_EQ(run.x[3], 3.0F);
  EXPECT_EQ(run.x[4], 8.0F);
  Options unchecked;
  unchecked.checkIndices = false;
  Outcome inRange("int a[3] = int[3](10, 20, 30); n[4] = a[n[0]];", {}, {1}, unchecked);
  EXPECT_EQ(inRange.n[4], 20);
  Lowered without("float at(in float a[3], int i) { return a[i]; }", unchecked);
  EXPECT_EQ(without.count("at", "arith.cmpi"), 0u);
}

TEST(Operators, ConstantsOfTheFile) {
  Outcome run = Outcome::with(
      "const float table[4] = {1.0, 2.0, 4.0, 8.0}; const int count = 2 * 2; const vec2 "
      "direction = vec2(3, 4);\n"
      "const mat2 rotation = mat2(0, 1, -1, 0); struct Pair { int a; float b; }; const "
      "Pair pair = Pair(7, 0.5);",
      "x[0] = table[n[0]]; n[1] = count; x[1] = direction.y; vec2 r = rotation * "
      "direction; x[2] = r.x; x[3] = pair.b; n[2] = pair.a;\n"
      "float sum = 0.0; for (int i = 0; i < count; ++i) sum += table[i]; x[4] = sum;",
      {}, {3});
  EXPECT_EQ(run.x[0], 8.0F);
  EXPECT_EQ(run.n[1], 4);
  EXPECT_EQ(run.x[1], 4.0F);
  EXPECT_EQ(run.x[2], -4.0F);
  EXPECT_EQ(run.x[3], 0.5F);
  EXPECT_EQ(run.n[2], 7);
  EXPECT_EQ(run.x[4], 15.0F);
}

} // namespace
} // namespace rtsl::test
