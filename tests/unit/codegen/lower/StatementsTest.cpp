//===- StatementsTest.cpp - control flow, calls, order of evaluation ------===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

namespace rtsl::test {
namespace {

TEST(ControlFlow, IfAndElse) {
  Shader shader("void run(inout int n[4]) {\n"
                "  if (n[0] > 10) n[1] = 1; else if (n[0] > 5) { n[1] = 2; } else n[1] = 3;\n"
                "  if (n[0] == 7) return;\n"
                "  n[2] = 1;\n"
                "}");
  auto run = [&](int input) {
    std::array<int, 4> n{input, 0, 0, 0};
    shader.call("run", n.data());
    return n;
  };
  EXPECT_EQ(run(11), (std::array<int, 4>{11, 1, 1, 0}));
  EXPECT_EQ(run(7), (std::array<int, 4>{7, 2, 0, 0}));
  EXPECT_EQ(run(5), (std::array<int, 4>{5, 3, 1, 0}));
}

TEST(ControlFlow, LoopsWithBreakAndContinue) {
  Outcome run(
      "for (int i = 0; i < 10; ++i) { if (i == 3) continue; if (i == 6) break; n[0] += i; }\n"
      "int k = 0; while (k < 5) { k++; if (k == 2) continue; n[1] += k; }\n"
      "k = 0; do { k += 3; if (k == 6) continue; n[2] += k; } while (k < 9);\n"
      "k = 0; for (;;) { if (++k > 4) break; } n[3] = k;\n"
      "for (int i = 0, j = 10; i < j; i += 2, j--) n[4]++;\n"
      "do n[5]++; while (false); while (false) n[6]++;\n"
      "for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) { if (j > i) break; n[7] += 10 "
      "* i + j; }\n"
      "int last = 0; for (int i = 0; i < 4; ++i) { int fresh = 0; fresh += i; last = fresh; } n[8] "
      "= last;");
  const int expected[] = {
      0 + 1 + 2 + 4 + 5, 1 + 3 + 4 + 5, 3 + 9, 5, 4, 1, 0, 0 + 10 + 11 + 20 + 21 + 22, 3};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.n[i], expected[i]) << i;
}

TEST(ControlFlow, ReturnsFromInsideLoops) {
  Outcome run = Outcome::with(
      "int firstFactor(int x) { for (int i = 2; i < x; ++i) { if (x % i == 0) return i; } return "
      "x; }\n"
      "int nothing(int x) { if (x > 0) { return 1; } else { return 2; } }\n"
      "vec3 grid(int x) { while (true) { if (x > 3) return vec3(x); x++; } return vec3(0); }",
      "n[0] = firstFactor(91); n[1] = firstFactor(13); n[2] = nothing(1) * 10 + nothing(-1); x[0] "
      "= grid(1).y;");
  EXPECT_EQ(run.n[0], 7);
  EXPECT_EQ(run.n[1], 13);
  EXPECT_EQ(run.n[2], 12);
  EXPECT_EQ(run.x[0], 4.0F);
}

TEST(ControlFlow, Switch) {
  Shader shader("void run(inout int n[4]) {\n"
                "  for (int i = 0; i < 2; ++i) {\n"
                "    switch (n[0]) {\n"
                "    case 1: n[1] += 1; break;\n"
                "    case 2: case 3: n[1] += 2;\n" // falls
                "    case 4: { n[1] += 4; break; }\n"
                "    case -5: n[1] += 8; continue;\n"
                "    case 6: return;\n"
                "    default: n[1] += 16;\n"
                "    }\n"
                "    n[2]++;\n"
                "  }\n"
                "}");
  auto run = [&](int input) {
    std::array<int, 4> n{input, 0, 0, 0};
    shader.call("run", n.data());
    return std::make_pair(n[1], n[2]);
  };
  EXPECT_EQ(run(1), std::make_pair(2, 2));
  EXPECT_EQ(run(2), std::make_pair(12, 2));
  EXPECT_EQ(run(3), std::make_pair(12, 2));
  EXPECT_EQ(run(4), std::make_pair(8, 2));
  EXPECT_EQ(run(-5), std::make_pair(16, 0));
  EXPECT_EQ(run(6), std::make_pair(0, 0));
  EXPECT_EQ(run(7), std::make_pair(32, 2));
}

TEST(ControlFlow, SwitchOnUnsignedWithoutDefaultAndSharedScope) {
  Outcome run(
      "switch (u[0]) { case 4294967295u: int k = 5; n[0] = k; break; case 7u: k = 6; n[0] = k; }\n"
      "switch (u[1]) { case 4294967295u: int k = 5; n[1] = k; break; case 7u: k = 6; n[1] = k; }\n"
      "switch (n[2]) { case 0: n[3] = 1; }\n"
      "switch (n[4]) { default: n[5] = 3; case 1: n[5] += 1; }",
      {}, {4294967295LL, 7, 9, 0, 2});
  EXPECT_EQ(run.n[0], 5);
  EXPECT_EQ(run.n[1], 6);
  EXPECT_EQ(run.n[3], 0);
  EXPECT_EQ(run.n[5], 4);
}

TEST(Calls, DirectionsOfParameters) {
  Outcome run = Outcome::with(
      "void swap(inout float a, inout float b) { float t = a; a = b; b = t; }\n"
      "void split(in vec3 v, out float x, out vec2 yz) { x = v.x; yz = v.yz; v = vec3(0); }\n"
      "float consume(float a) { a *= 2.0; return a; }",
      "swap(x[0], x[1]); vec3 v = vec3(1, 2, 3); vec2 w; split(v, x[2], w); x[3] = w.y; x[4] = "
      "v.x; x[5] = consume(x[5]) + x[5];\n"
      "split(v, v.z, v.xy); x[6] = v.x; x[7] = v.y; x[8] = v.z;",
      {1.0F, 2.0F, 0.0F, 0.0F, 0.0F, 3.0F});
  const float expected[] = {2, 1, 1, 3, 1, 9, 2, 3, 1};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
}

TEST(Calls, CopyInCopyOutOfWhatOverlaps) {
  Outcome run = Outcome::with("void both(inout int a, inout int b) { a += 10; b += 100; }\n"
                              "void later(out int a, in int b) { a = 5; a += b; }",
                              // Each works on its own copy; copies go back from left to right.
                              "n[0] = 1; both(n[0], n[0]); n[1] = 7; later(n[1], n[1]);\n"
                              // The place is found once, before the call.
                              "int i = 2; both(n[i], i); n[4] = i;");
  EXPECT_EQ(run.n[0], 101);
  EXPECT_EQ(run.n[1], 12);
  EXPECT_EQ(run.n[2], 10);
  EXPECT_EQ(run.n[4], 102);
}

TEST(Calls, StructsArraysAndMatrices) {
  Outcome run =
      Outcome::with("struct Item { float a; int k[3]; mat2 m; };\n"
                    "Item make(float a) { Item r; r.a = a; for (int i = 0; i < 3; ++i) r.k[i] = "
                    "i * i; r.m = mat2(a); return r; }\n"
                    "float sum(Item r) { r.a += 1.0; return r.a + float(r.k[2]) + r.m[1][1]; }\n"
                    "void change(inout Item r) { r.k[1] = 50; r.m[0].y = 7.0; }\n"
                    "int[3] reversed(int v[3]) { return int[3](v[2], v[1], v[0]); }\n"
                    "mat2 twice(mat2 m) { m *= 2.0; return m; }",
                    "Item r = make(2.5); x[0] = sum(r); x[1] = r.a; change(r); n[0] = r.k[1]; "
                    "x[2] = r.m[0][1]; x[3] = sum(make(1.0));\n"
                    "int v[3] = reversed(r.k); n[1] = v[0]; n[2] = v[2]; v = reversed(v); n[3] = "
                    "v[0] * 100 + v[2]; mat2 m = mat2(3.0); x[4] = twice(m)[0][0] + m[0][0];\n"
                    "n[4] = make(0.0).k[2]; Item pair[2]; pair[n[5]] = r; change(pair[1 - "
                    "n[5]]); n[6] = pair[1].k[2]; n[7] = pair[0].k[1];\n"
                    "Item s = x[9] > 0.0 ? make(4.0) : r; x[5] = s.a; (s = r).a; x[6] = s.a;",
                    {}, {0, 0, 0, 0, 0, 1});
  EXPECT_EQ(run.x[0], 3.5F + 4 + 2.5F);
  EXPECT_EQ(run.x[1], 2.5F);
  EXPECT_EQ(run.n[0], 50);
  EXPECT_EQ(run.x[2], 7.0F);
  EXPECT_EQ(run.x[3], 2.0F + 4 + 1);
  EXPECT_EQ(run.n[1], 4);
  EXPECT_EQ(run.n[2], 0);
  EXPECT_EQ(run.n[3], 4);
  EXPECT_EQ(run.x[4], 9.0F);
  EXPECT_EQ(run.n[4], 4);
  EXPECT_EQ(run.n[6], 4);
  EXPECT_EQ(run.n[7], 50);
  EXPECT_EQ(run.x[5], 2.5F);
  EXPECT_EQ(run.x[6], 2.5F);
}

TEST(Calls, AggregatesAreCopiedOnlyIfModified) {
  Lowered lowered(
      "float read(float v[8]) { return v[3]; } float write(float v[8]) { v[3] = 1.0; return v[3]; "
      "}\n"
      "float change(inout float v[8]) { v[3] = 2.0; return 0.0; } float first(float v[8], float x) "
      "{ return v[3] + x; }\n"
      "float shares() { float a[8]; a[3] = 1.0; return read(a); }\n"
      "float copies() { float a[8]; a[3] = 1.0; return write(a) + first(a, change(a)); }");
  EXPECT_EQ(lowered.count("shares", "rtsl.copy"), 0u);
  EXPECT_EQ(lowered.count("copies", "rtsl.copy"), 4u) << "in, in, and inout there and back";
  Outcome run =
      Outcome::with("float change(inout float v[2]) { v[0] = 2.0; return 10.0; } float first(float "
                    "v[2], float x) { return v[0] + x; }",
                    "float a[2]; a[0] = 1.0; x[0] = first(a, change(a)); x[1] = first(a, 0.0);");
  EXPECT_EQ(run.x[0], 11.0F);
  EXPECT_EQ(run.x[1], 2.0F);
}

TEST(Calls, OverloadsAndBuiltinNamesOfTheAuthors) {
  Outcome run =
      Outcome::with("float f(float a) { return a; } float f(vec2 a) { return a.x + a.y; } float "
                    "f(int a, float b) { return float(a) * b; }\n"
                    "float area(float inside) { return inside * inside; }",
                    "x[0] = f(1.5); x[1] = f(vec2(2, 3)); x[2] = f(2, 4.0); x[3] = area(3.0);");
  EXPECT_EQ(run.x[0], 1.5F);
  EXPECT_EQ(run.x[1], 5.0F);
  EXPECT_EQ(run.x[2], 8.0F);
  EXPECT_EQ(run.x[3], 9.0F);
  Lowered lowered("float f(float a) { return a; } float f(vec2 a) { return a.x; } float g(mat2 "
                  "m[2]) { return m[0][0][0]; }");
  EXPECT_TRUE(lowered.hasFunction("f.float"));
  EXPECT_TRUE(lowered.hasFunction("f.vec2"));
  EXPECT_TRUE(lowered.hasFunction("g"));
}

TEST(Evaluation, GoesFromLeftToRight) {
  Outcome run = Outcome::with(
      "int next(inout int counter) { counter++; return counter; }\n"
      "int three(int a, int b, int c) { return a * 100 + b * 10 + c; }",
      "int c = 0; n[0] = three(next(c), next(c), next(c)); c = 0; n[1] = next(c) * 10 + next(c);\n"
      "c = 1; n[2] = c + (c = 5) * 10 + c * 100; c = 2; n[3] = (c += 3, c * 2); c = 1; n[c++] += 7 "
      "* c; n[4] = c;\n"
      "c = 4; n[5] = c++ * 10 + c; n[6] = --c * 10 + c--; n[7] = c; c = 8; n[c] = c = 3; n[9] = "
      "c;\n"
      "c = 1; c += next(c) * 10; n[10] = c; int i = 11; n[i++] = i; vec2 v = vec2(1, 2); v = v.yx "
      "+ (v = vec2(5)); x[0] = v.x; x[1] = v.y;");
  EXPECT_EQ(run.n[0], 123);
  EXPECT_EQ(run.n[2], 1 + 50 + 500);
  EXPECT_EQ(run.n[1], 12 + 14) << "and n[c++] += 7 * c, its place found once";
  EXPECT_EQ(run.n[3], 10);
  EXPECT_EQ(run.n[4], 2);
  EXPECT_EQ(run.n[5], 45);
  EXPECT_EQ(run.n[6], 44);
  EXPECT_EQ(run.n[7], 3);
  EXPECT_EQ(run.n[8], 3) << "the place is found before the value";
  EXPECT_EQ(run.n[9], 3);
  EXPECT_EQ(run.n[10], 1 + 20) << "the old value is read first";
  EXPECT_EQ(run.n[11], 12);
  EXPECT_EQ(run.x[0], 7.0F);
  EXPECT_EQ(run.x[1], 6.0F);
}

TEST(Evaluation, IncrementOfEveryShape) {
  Outcome run(
      "x[0]++; --x[1]; vec3 v = vec3(1, 2, 3); vec3 old = v++; x[2] = v.z; x[3] = old.z; "
      "v.y--; x[4] = v.y; (++v).x; x[5] = v.x; mat2 m = mat2(1); m++; x[6] = m[0][1]; u[0]--; "
      "x[7] = v.z++;",
      {1.0F, 1.0F});
  const float expected[] = {2, 0, 4, 3, 2, 3, 1, 5};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
  EXPECT_EQ(run.u[0], 4294967295u);
}

} // namespace
} // namespace rtsl::test
