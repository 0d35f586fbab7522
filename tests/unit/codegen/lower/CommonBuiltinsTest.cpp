//===- CommonBuiltinsTest.cpp - what min, mod, frexp and the like compute -===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>

namespace rtsl::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan = std::numeric_limits<float>::quiet_NaN();

std::uint32_t bitsOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The same bits, where any NaN is as good as any other.
void expectSame(float value, float expected, float input) {
  if (std::isnan(expected))
    EXPECT_TRUE(std::isnan(value)) << "for " << input;
  else
    EXPECT_EQ(bitsOf(value), bitsOf(expected))
        << "for " << input << ": " << value << ", not " << expected;
}

/// Compares a function of one float with the same formula in C++, bit for bit.
template <typename Function>
void expectExactly(const std::string &expression, Function function) {
  FloatFunction run("x[0] = " + expression + ";");
  for (float input : interestingFloats())
    expectSame(run({input})[0], function(input), input);
}

template <typename Function>
void expectExactly2(const std::string &expression, Function function) {
  FloatFunction run("x[0] = " + expression + ";");
  std::vector<float> inputs = interestingFloats();
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (std::size_t j = i % 3; j < inputs.size(); j += 3)
      expectSame(run({inputs[i], inputs[j]})[0], function(inputs[i], inputs[j]), inputs[i]);
}

TEST(CommonBuiltins, RoundingFunctions) {
  expectExactly("floor(x[0])", [](float x) { return std::floor(x); });
  expectExactly("ceil(x[0])", [](float x) { return std::ceil(x); });
  expectExactly("trunc(x[0])", [](float x) { return std::trunc(x); });
  expectExactly("abs(x[0])", [](float x) { return std::fabs(x); });
  expectExactly("sqrt(x[0])", [](float x) { return std::sqrt(x); });
  expectExactly("fract(x[0])", [](float x) { return x - std::floor(x); });
}

TEST(CommonBuiltins, RoundTakesHalvesToEven) {
  expectExactly("round(x[0])", [](float x) { return std::nearbyint(x); });
  expectExactly("roundEven(x[0])", [](float x) { return std::nearbyint(x); });
  FloatFunction round("x[0] = round(x[0]);");
  EXPECT_EQ(round({0.5F})[0], 0.0F);
  EXPECT_EQ(round({1.5F})[0], 2.0F);
  EXPECT_EQ(round({2.5F})[0], 2.0F);
  EXPECT_EQ(round({-3.5F})[0], -4.0F);
  EXPECT_EQ(round({8388607.5F})[0], 8388608.0F);
  EXPECT_TRUE(std::signbit(round({-0.25F})[0]));
}

TEST(CommonBuiltins, SignKeepsZerosAndNan) {
  expectExactly("sign(x[0])", [](float x) { return x > 0 ? 1.0F : x < 0 ? -1.0F : x; });
  EXPECT_EQ(Outcome("n[0] = sign(n[0]); n[1] = sign(n[1]); n[2] = sign(n[2]);", {}, {-7, 0, 9}).n,
            (std::array<std::int32_t, 16>{-1, 0, 1}));
}

TEST(CommonBuiltins, MinAndMaxPreferTheFirstOperand) {
  expectExactly2("min(x[0], x[1])", [](float x, float y) { return y < x ? y : x; });
  expectExactly2("max(x[0], x[1])", [](float x, float y) { return x < y ? y : x; });
  FloatFunction least("x[0] = min(x[0], x[1]);");
  EXPECT_TRUE(std::isnan(least({nan, 1.0F})[0]));
  EXPECT_EQ(least({1.0F, nan})[0], 1.0F);
  EXPECT_TRUE(std::signbit(least({-0.0F, 0.0F})[0]));
  EXPECT_FALSE(std::signbit(least({0.0F, -0.0F})[0]));
}

TEST(CommonBuiltins, MinMaxClampOfIntegers) {
  Outcome run(
      "n[0] = min(n[0], n[1]); n[1] = max(n[2], n[3]); n[2] = clamp(-9, -3, 4);\n"
      "u[0] = min(u[0], u[1]); u[1] = max(4294967295u, 1u); u[2] = clamp(u[3], 5u, 4000000000u);\n"
      "ivec2 v = min(ivec2(3, -8), 0); n[4] = v.x; n[5] = v.y;\n"
      "n[6] = max(ivec3(2, 9, 4)); u[4] = min(uvec2(4294967295u, 7u)); u[5] = "
      "max(uvec2(4294967295u, 7u));\n"
      "n[7] = abs(-2147483648);",
      {}, {-5, 3, -2147483648LL, 2147483647});
  EXPECT_EQ(run.n[0], -5);
  EXPECT_EQ(run.n[1], 2147483647);
  EXPECT_EQ(run.n[2], -3);
  EXPECT_EQ(run.u[0], 3u);
  EXPECT_EQ(run.u[1], 4294967295u);
  EXPECT_EQ(run.u[2], 2147483647u);
  EXPECT_EQ(run.n[4], 0);
  EXPECT_EQ(run.n[5], -8);
  EXPECT_EQ(run.n[6], 9);
  EXPECT_EQ(run.u[4], 7u);
  EXPECT_EQ(run.u[5], 4294967295u);
  EXPECT_EQ(run.n[7], std::numeric_limits<std::int32_t>::min());
}

TEST(CommonBuiltins, ClampOfFloats) {
  expectExactly("clamp(x[0], -2.0, 3.0)", [](float x) {
    float y = x < -2 ? -2 : x;
    return 3 < y ? 3 : y;
  });
  FloatFunction vector("vec3 v = clamp(vec3(x[0], x[1], x[2]), vec3(0, 1, 2), vec3(5, 6, 7));\n"
                       "x[0] = v.x; x[1] = v.y; x[2] = v.z;");
  auto result = vector({-1.0F, 8.0F, 3.0F});
  EXPECT_EQ(result[0], 0.0F);
  EXPECT_EQ(result[1], 6.0F);
  EXPECT_EQ(result[2], 3.0F);
}

TEST(CommonBuiltins, ModMixStepSmoothstep) {
  expectExactly2("mod(x[0], x[1])", [](float x, float y) { return x - y * std::floor(x / y); });
  expectExactly2("mix(x[0], x[1], 0.3)",
                 [](float x, float y) { return x * (1.0F - 0.3F) + y * 0.3F; });
  expectExactly2("step(x[0], x[1])", [](float edge, float x) { return x < edge ? 0.0F : 1.0F; });
  expectExactly("smoothstep(-1.0, 2.5, x[0])", [](float x) {
    float t = (x - -1.0F) / (2.5F - -1.0F);
    t = t < 0 ? 0 : t;
    t = 1 < t ? 1 : t;
    return (t * t) * (3.0F - 2.0F * t);
  });
  FloatFunction scalarEdge("vec2 v = step(0.5, vec2(x[0], x[1])); x[0] = v.x; x[1] = v.y;");
  EXPECT_EQ(scalarEdge({0.25F, 0.5F})[0], 0.0F);
  EXPECT_EQ(scalarEdge({0.25F, 0.5F})[1], 1.0F);
}

TEST(CommonBuiltins, MixWithBoolsSelects) {
  FloatFunction run("vec3 v = mix(vec3(1, 2, 3), vec3(4, 5, 6), bvec3(true, x[0] > 0.0, false));\n"
                    "x[0] = v.x; x[1] = v.y; x[2] = v.z; x[3] = mix(7.0, 8.0, true);");
  auto result = run({1.0F});
  EXPECT_EQ(result[0], 4.0F);
  EXPECT_EQ(result[1], 5.0F);
  EXPECT_EQ(result[2], 3.0F);
  EXPECT_EQ(result[3], 8.0F);
  EXPECT_EQ(run({-1.0F})[1], 2.0F);
}

TEST(CommonBuiltins, Modf) {
  FloatFunction run("float whole; x[0] = modf(x[0], whole); x[1] = whole;");
  for (float input : interestingFloats()) {
    auto result = run({input});
    float whole, fraction = std::modf(input, &whole);
    expectSame(result[0], fraction, input);
    expectSame(result[1], whole, input);
  }
}

TEST(CommonBuiltins, FrexpAndLdexp) {
  FloatFunction split("int e; x[0] = frexp(x[0], e); x[1] = float(e);");
  for (float input : interestingFloats()) {
    auto result = split({input});
    int exponent = 0;
    float significand = std::frexp(input, &exponent);
    if (!std::isfinite(input))
      exponent = 0;
    expectSame(result[0], significand, input);
    EXPECT_EQ(result[1], static_cast<float>(exponent)) << "for " << input;
  }
  FloatFunction scale("x[0] = ldexp(x[0], int(x[1]));");
  for (float input : interestingFloats())
    for (int exponent :
         {-2147483647, -300, -280, -279, -200, -180, -152, -150, -149, -127, -126, -103, -24,
          -1,          0,    1,    23,   126,  127,  128,  150,  253,  254,  276,  277,  300})
      expectSame(scale({input, static_cast<float>(exponent)})[0], std::ldexp(input, exponent),
                 input);
}

TEST(CommonBuiltins, Predicates) {
  FloatFunction run("x[0] = isnan(x[0]) ? 1.0 : isinf(x[0]) ? 2.0 : 0.0;");
  EXPECT_EQ(run({nan})[0], 1.0F);
  EXPECT_EQ(run({infinity})[0], 2.0F);
  EXPECT_EQ(run({-infinity})[0], 2.0F);
  EXPECT_EQ(run({FLT_MAX})[0], 0.0F);
  FloatFunction vector(
      "bvec2 v = isnan(vec2(x[0], x[1])); x[0] = v.x ? 1.0 : 0.0; x[1] = v.y ? 1.0 : 0.0;");
  EXPECT_EQ(vector({nan, 0.0F})[0], 1.0F);
  EXPECT_EQ(vector({nan, 0.0F})[1], 0.0F);
}

TEST(CommonBuiltins, Bits) {
  Outcome run(
      "n[0] = floatBitsToInt(x[0]); u[0] = floatBitsToUint(x[1]); n[1] = floatBitsToInt(x[2]);\n"
      "x[0] = intBitsToFloat(n[2]); x[1] = uintBitsToFloat(u[3]);",
      {-1.5F, 3.25F, nan}, {0, 0, 0x40490fdb, 0x3f800000});
  EXPECT_EQ(static_cast<std::uint32_t>(run.n[0]), bitsOf(-1.5F));
  EXPECT_EQ(run.u[0], bitsOf(3.25F));
  EXPECT_EQ(run.n[1], 0x7fc00000);
  EXPECT_EQ(run.x[0], 3.14159274F);
  EXPECT_EQ(run.x[1], 1.0F);
}

TEST(CommonBuiltins, FmaRoundsOnce) {
  FloatFunction run("x[0] = fma(x[0], x[1], x[2]); x[3] = x[3] * x[4] + x[5];");
  float a = 1.0F + FLT_EPSILON, b = 1.0F - FLT_EPSILON;
  auto result = run({a, b, -1.0F, a, b, -1.0F});
  EXPECT_EQ(result[0], std::fma(a, b, -1.0F));
  volatile float product = a * b;
  EXPECT_EQ(result[3], product - 1.0F) << "an expression of the author's is never fused";
}

TEST(CommonBuiltins, Elementary) {
  struct {
    const char *name;
    double (*function)(double);
    float low, high;
  } const functions[] = {
      {"sin", std::sin, -50, 50},   {"cos", std::cos, -50, 50},
      {"tan", std::tan, -50, 50},   {"asin", std::asin, -1, 1},
      {"acos", std::acos, -1, 1},   {"atan", std::atan, -9, 9},
      {"sinh", std::sinh, -9, 9},   {"cosh", std::cosh, -9, 9},
      {"tanh", std::tanh, -9, 9},   {"asinh", std::asinh, -99, 99},
      {"acosh", std::acosh, 1, 99}, {"atanh", std::atanh, -.9F, .9F},
      {"exp", std::exp, -80, 80},   {"exp2", std::exp2, -99, 99},
      {"log", std::log, .01F, 99},  {"log2", std::log2, .01F, 99},
  };
  for (const auto &entry : functions) {
    FloatFunction run(std::string("x[0] = ") + entry.name + "(x[0]);");
    for (int i = 0; i <= 40; ++i) {
      float input = entry.low + (entry.high - entry.low) * static_cast<float>(i) / 40;
      EXPECT_ULPS(run({input})[0], entry.function(input), 0.5001) << entry.name << " " << input;
    }
  }
  FloatFunction others(
      "x[2] = pow(x[0], x[1]); x[3] = atan(x[0], x[1]); x[4] = inversesqrt(x[0]);\n"
      "x[5] = radians(x[0]); x[6] = degrees(x[0]);\n"
      "vec2 v = pow(vec2(x[0], x[1]), vec2(2.5, 0.5)); x[7] = v.x; x[8] = v.y;");
  auto result = others({3.7F, 1.3F});
  EXPECT_ULPS(result[2], std::pow(double(3.7F), double(1.3F)), 0.5001);
  EXPECT_ULPS(result[3], std::atan2(double(3.7F), double(1.3F)), 0.5001);
  EXPECT_ULPS(result[4], 1 / std::sqrt(double(3.7F)), 0.5001);
  EXPECT_ULPS(result[5], double(3.7F) * M_PI / 180, 1.5);
  EXPECT_ULPS(result[6], double(3.7F) * 180 / M_PI, 1.5);
  EXPECT_ULPS(result[7], std::pow(double(3.7F), 2.5), 0.5001);
  EXPECT_ULPS(result[8], std::sqrt(double(1.3F)), 0.5001);
}

TEST(CommonBuiltins, PowWithAnIntegerExponent) {
  auto byLoop = [](float x, int exponent) {
    float result = 1, base = x;
    for (unsigned n = static_cast<unsigned>(std::abs(exponent)); n != 0; n >>= 1) {
      if (n & 1)
        result *= base;
      base *= base;
    }
    return exponent < 0 ? 1 / result : result;
  };
  FloatFunction computed("x[0] = pow(x[0], int(x[1]));");
  for (int exponent : {-70, -13, -2, -1, 0, 1, 2, 3, 4, 5, 7, 15, 31, 63, 127}) {
    FloatFunction constant("x[0] = pow(x[0], " + std::to_string(exponent) + ");");
    for (float x : {-1.5F, -0.75F, 0.0F, 0.3F, 1.0F, 1.01F, 2.0F, 9.0F}) {
      expectSame(computed({x, static_cast<float>(exponent)})[0], byLoop(x, exponent), x);
      expectSame(constant({x})[0], byLoop(x, exponent), x);
    }
  }
  EXPECT_EQ(computed({nan, 0.0F})[0], 1.0F);
  FloatFunction vector(
      "vec3 v = pow(vec3(x[0], x[1], x[2]), 3); x[0] = v.x; x[1] = v.y; x[2] = v.z;");
  EXPECT_EQ(vector({1.0F, -2.0F, 3.0F})[2], 27.0F);
  EXPECT_EQ(vector({1.0F, -2.0F, 3.0F})[1], -8.0F);
}

} // namespace
} // namespace rtsl::test
