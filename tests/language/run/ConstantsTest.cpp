//===- ConstantsTest.cpp - folding agrees with running --------------------===//
//
// Random expressions, each written twice: with constants, so that the compiler computes it, and
// with values that are known when it runs. Both have the same bits. RTSL_CONSTANT_ROUNDS=N tries N
// programs, not one.
//
//===----------------------------------------------------------------------===//
#include "Program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace rtsl::test {
namespace {

enum class Kind : unsigned { Float, Int, UInt, Bool };
constexpr const char *keywords[] = {"float", "int", "uint", "bool"};

/// The same expression in both forms.
struct Twin {
  std::string constant, hidden;
};

// Patterns of floats with operands of type float: one, two and three.
const std::vector<std::string> floatsOfOne = {"-({})",
                                              "abs({})",
                                              "sign({})",
                                              "floor({})",
                                              "ceil({})",
                                              "trunc({})",
                                              "round({})",
                                              "fract({})",
                                              "sqrt({})",
                                              "inversesqrt({})",
                                              "sin({})",
                                              "cos({})",
                                              "tan({})",
                                              "asin({})",
                                              "acos({})",
                                              "atan({})",
                                              "exp({})",
                                              "log({})",
                                              "exp2({})",
                                              "log2({})",
                                              "sinh({})",
                                              "cosh({})",
                                              "tanh({})",
                                              "asinh({})",
                                              "acosh({})",
                                              "atanh({})",
                                              "radians({})",
                                              "degrees({})",
                                              "sinpi({})",
                                              "cospi({})",
                                              "expm1({})",
                                              "log1p({})",
                                              "refract({}, 1.0, 0.75)",
                                              "reflect({}, 0.75)",
                                              "normalize({})",
                                              "length({})",
                                              "ldexp({}, -30)",
                                              "pow({}, 5)",
                                              "pow({}, -7)",
                                              "pow({}, 100)",
                                              "unpackHalf2x16(packHalf2x16(vec2({}))).y",
                                              "unpackSnorm4x8(packSnorm4x8(vec4({}))).z",
                                              "unpackSnorm2x16(packSnorm2x16(vec2({}))).y",
                                              "unpackUnorm2x16(packUnorm2x16(vec2({}))).x",
                                              "unpackUnorm4x8(packUnorm4x8(vec4({}))).w"};
const std::vector<std::string> floatsOfTwo = {"({} + {})",
                                              "({} - {})",
                                              "({} * {})",
                                              "({} / {})",
                                              "min({}, {})",
                                              "max({}, {})",
                                              "mod({}, {})",
                                              "step({}, {})",
                                              "pow({}, {})",
                                              "atan({}, {})",
                                              "dot(vec2({}), vec2(0.5, {}))",
                                              "length(vec2({}, {}))",
                                              "distance({}, {})",
                                              "reflect(vec2({}, 1.0), vec2(0.6, {})).x",
                                              "faceforward(1.0, {}, {})",
                                              "determinant(mat2({}, 0.5, {}, 3.0))",
                                              "inverse(mat2({}, 0.5, {}, 3.0))[0].y",
                                              "outerProduct(vec2({}, 2.0), vec2(3.0, {}))[1].x",
                                              "(mat2({}, 0.5, 2.0, {}) * vec2(0.7, -1.5)).x",
                                              "mix({}, {}, bvec2(true, false).x)"};
const std::vector<std::string> floatsOfThree = {
    "clamp({}, {}, {})",
    "mix({}, {}, {})",
    "fma({}, {}, {})",
    "smoothstep({}, {}, {})",
    "vec3({}, {}, {}).y",
    "normalize(vec3({}, {}, {})).z",
    "cross(vec3({}, {}, 1.0), vec3(0.5, {}, 2.0)).z",
    "perpendicularTo(vec3({}, {}, {})).y",
    "determinant(mat3({}, 1, 2, {}, 3, 5, 8, 1, {}))",
    "inverse(mat3({}, 1, 2, {}, 3, 5, 8, 1, {}))[1].z",
    "inverse(mat4({}, 1, 2, 3, 5, {}, 7, 1, 1, 0, {}, 2, 1, 1, 4, 1))[2].y",
    "max(vec3({}, {}, {}))",
    "refract(vec2({}, {}), vec2(0.6, -0.8), {}).x"};

class Generator {
public:
  explicit Generator(unsigned seed) : random(seed) {}

  Twin make(Kind kind, unsigned depth) {
    if (depth == 0 || pick(8) == 0)
      return leaf(kind);
    switch (kind) {
    case Kind::Float:
      return makeFloat(depth - 1);
    case Kind::Int:
      return makeInteger(Kind::Int, depth - 1);
    case Kind::UInt:
      return makeInteger(Kind::UInt, depth - 1);
    case Kind::Bool:
      break;
    }
    return makeBool(depth - 1);
  }

  unsigned pick(unsigned count) { return static_cast<unsigned>(random() % count); }

private:
  /// `{}` in the pattern is replaced by expressions of these types, in order.
  Twin fill(const std::string &pattern, const std::vector<Kind> &kinds, unsigned depth) {
    Twin twin;
    std::size_t next = 0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      if (pattern.compare(i, 2, "{}") == 0) {
        const Twin part = make(kinds[next++], depth);
        twin.constant += part.constant;
        twin.hidden += part.hidden;
        ++i;
      } else {
        twin.constant += pattern[i];
        twin.hidden += pattern[i];
      }
    }
    return twin;
  }

  /// Bits of all kinds of numbers: small and large ones, powers of two and their neighbours,
  /// infinities, NaN.
  std::uint32_t bits(Kind kind) {
    static constexpr std::uint32_t floats[] = {
        0x00000000, 0x80000000, 0x3f800000, 0xbf800000, 0x3f000000, 0x40000000,
        0x7f800000, 0xff800000, 0x7fc00000, 0x00000001, 0x007fffff, 0x00800000,
        0x7f7fffff, 0x4f000000, 0xcf000000, 0x4effffff, 0x4f800000, 0x40490fdb};
    static constexpr std::uint32_t integers[] = {
        0, 1, 2, 3, 7, 31, 32, 33, 0x7fffffff, 0x80000000, 0x80000001, 0xffffffff};
    if (kind == Kind::Float) {
      if (pick(3) == 0)
        return floats[pick(std::size(floats))];
      const std::uint32_t exponent = pick(4) == 0 ? pick(256) : 120 + pick(16); // mostly near one
      return (pick(2) << 31) | (exponent << 23) | static_cast<std::uint32_t>(random() & 0x7fffff);
    }
    return pick(2) ? integers[pick(std::size(integers))]
                   : static_cast<std::uint32_t>(random()) >> pick(32);
  }

  Twin leaf(Kind kind) {
    const std::string value = fmt::format("0x{:08x}u", bits(kind)), sum = value + " + uint(zero)";
    switch (kind) {
    case Kind::Float:
      return {"uintBitsToFloat(" + value + ")", "uintBitsToFloat(" + sum + ")"};
    case Kind::Int:
      return {"int(" + value + ")", "int(" + sum + ")"};
    case Kind::UInt:
      return {value, "(" + sum + ")"};
    case Kind::Bool:
      break;
    }
    return pick(2) ? Twin{"true", "(zero == 0)"} : Twin{"false", "(zero != 0)"};
  }

  Twin makeFloat(unsigned depth) {
    const Kind f = Kind::Float;
    switch (pick(8)) {
    case 0:
      return fill("float({})", {Kind::Int}, depth);
    case 1:
      return fill(pick(2) ? "float({})" : "uintBitsToFloat({})", {Kind::UInt}, depth);
    case 2:
      return fill("({} ? {} : {})", {Kind::Bool, f, f}, depth);
    case 3:
      return fill(floatsOfThree[pick(static_cast<unsigned>(floatsOfThree.size()))], {f, f, f},
                  depth);
    case 4:
    case 5:
      return fill(floatsOfOne[pick(static_cast<unsigned>(floatsOfOne.size()))], {f}, depth);
    default:
      return fill(floatsOfTwo[pick(static_cast<unsigned>(floatsOfTwo.size()))], {f, f}, depth);
    }
  }

  Twin makeInteger(Kind kind, unsigned depth) {
    static const std::vector<std::string> two = {
        "({} + {})",  "({} - {})", "({} * {})", "({} / {})", "({} % {})",   "({} << {})",
        "({} >> {})", "({} & {})", "({} | {})", "({} ^ {})", "min({}, {})", "max({}, {})"};
    const std::vector<std::string> one = {
        "-({})", "~({})", "bitfieldReverse({})", "bitfieldExtract({}, 3, 17)",
        "bitfieldInsert({}, " + std::string(kind == Kind::Int ? "42" : "42u") + ", 5, 9)"};
    static constexpr const char *counts[] = {"bitCount", "findLSB", "findMSB"};
    const std::string keyword = keywords[static_cast<unsigned>(kind)];
    switch (pick(8)) {
    case 0:
      return fill(keyword + "({})", {Kind::Float}, depth);
    case 1:
      return fill(keyword + "({})", {kind == Kind::Int ? Kind::UInt : Kind::Int}, depth);
    case 2:
      return fill("({} ? {} : {})", {Kind::Bool, kind, kind}, depth);
    case 3:
      return fill(one[pick(static_cast<unsigned>(one.size()))], {kind}, depth);
    case 4:
      if (pick(2))
        return fill(keyword + "(" + counts[pick(3)] + "({}))", {pick(2) ? Kind::Int : Kind::UInt},
                    depth);
      return kind == Kind::Int ? fill("floatBitsToInt({})", {Kind::Float}, depth)
                               : fill("floatBitsToUint({})", {Kind::Float}, depth);
    default:
      return fill(two[pick(static_cast<unsigned>(two.size()))], {kind, kind}, depth);
    }
  }

  Twin makeBool(unsigned depth) {
    static const std::vector<std::string> comparisons = {"({} < {})",  "({} <= {})", "({} > {})",
                                                         "({} >= {})", "({} == {})", "({} != {})"};
    const Kind kind = static_cast<Kind>(pick(3));
    switch (pick(5)) {
    case 0:
      return fill("!({})", {Kind::Bool}, depth);
    case 1:
      return fill(pick(2)   ? "({} && {})"
                  : pick(2) ? "({} || {})"
                            : "({} ^^ {})",
                  {Kind::Bool, Kind::Bool}, depth);
    case 2:
      return fill(pick(2) ? "isnan({})" : "isinf({})", {Kind::Float}, depth);
    default:
      return fill(comparisons[pick(static_cast<unsigned>(comparisons.size()))], {kind, kind},
                  depth);
    }
  }

  std::mt19937 random;
};

/// Functions of five expressions each; one gives the number of the first that differs.
std::string randomProgram(unsigned seed, unsigned functions) {
  Generator generator(seed);
  std::string text;
  for (unsigned f = 0; f != functions; ++f) {
    text += fmt::format("int seed{}function{}(int zero) {{\n", seed, f);
    for (unsigned n = 1; n <= 5; ++n) {
      const Kind kind = static_cast<Kind>(generator.pick(4));
      const Twin twin = generator.make(kind, 1 + generator.pick(4));
      const char *keyword = keywords[static_cast<unsigned>(kind)];
      text += fmt::format("  const {0} c{1} = {2};\n  {0} r{1} = {3};\n", keyword, n, twin.constant,
                          twin.hidden);
      text += kind == Kind::Float
                  ? fmt::format(
                        "  if (floatBitsToUint(c{0}) != floatBitsToUint(r{0})) return {0};\n", n)
                  : fmt::format("  if (c{0} != r{0}) return {0};\n", n);
    }
    text += "  return 0;\n}\n";
  }
  return text;
}

class Constants : public testing::TestWithParam<Configuration> {};

TEST_P(Constants, FoldToWhatTheyAreWhenRun) {
  const char *asked = std::getenv("RTSL_CONSTANT_ROUNDS");
  const unsigned rounds = asked ? static_cast<unsigned>(std::atoi(asked)) : 1;
  for (unsigned seed = 1; seed <= rounds; ++seed) {
    const std::string text = randomProgram(seed, 40);
    std::size_t count = 0;
    const std::string wrong =
        runProgram({{"seed " + std::to_string(seed), text}}, GetParam(), count);
    EXPECT_EQ(wrong, "") << text;
    EXPECT_EQ(count, 40u);
    if (HasFailure())
      break;
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Constants, testing::ValuesIn(configurations()),
                         [](const testing::TestParamInfo<Configuration> &param) {
                           return param.param.name;
                         });

// What is folded with arithmetic in double is computed in double.
INSTANTIATE_TEST_SUITE_P(DoublePaths, Constants, testing::ValuesIn(doubleConfigurations()),
                         [](const testing::TestParamInfo<Configuration> &param) {
                           return param.param.name;
                         });

} // namespace
} // namespace rtsl::test
