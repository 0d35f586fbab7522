//===- IntegerBuiltinsTest.cpp - bits, carries, comparisons, packing ------===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace rtsl::test {
namespace {

const std::uint32_t words[] = {0,          1,          2,          3,
                               0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe,
                               0x55555555, 0x00010000, 0x12345678, 0xdeadbeef};

/// `void run(inout uint u[16])`, compiled once.
class WordFunction {
public:
  explicit WordFunction(const std::string &body)
      : shader("void run(inout uint u[16]) {\n" + body + "\n}\n") {}
  std::array<std::uint32_t, 16> operator()(std::initializer_list<std::uint32_t> inputs) {
    std::array<std::uint32_t, 16> values{};
    std::copy(inputs.begin(), inputs.end(), values.begin());
    shader.call("run", values.data());
    return values;
  }

private:
  Shader shader;
};

TEST(IntegerBuiltins, Counting) {
  WordFunction run(
      "u[1] = uint(bitCount(u[0])); u[2] = uint(findLSB(u[0])); u[3] = uint(findMSB(u[0]));\n"
      "u[4] = uint(findMSB(int(u[0]))); u[5] = bitfieldReverse(u[0]); u[6] = "
      "uint(findLSB(int(u[0])));");
  for (std::uint32_t word : words) {
    auto result = run({word});
    EXPECT_EQ(result[1], static_cast<std::uint32_t>(__builtin_popcount(word)));
    EXPECT_EQ(static_cast<int>(result[2]), word ? __builtin_ctz(word) : -1);
    EXPECT_EQ(static_cast<int>(result[3]), word ? 31 - __builtin_clz(word) : -1);
    std::uint32_t magnitude = word >> 31 ? ~word : word;
    EXPECT_EQ(static_cast<int>(result[4]), magnitude ? 31 - __builtin_clz(magnitude) : -1);
    std::uint32_t reversed = 0;
    for (int i = 0; i < 32; ++i)
      reversed |= (word >> i & 1) << (31 - i);
    EXPECT_EQ(result[5], reversed);
    EXPECT_EQ(result[6], result[2]);
  }
}

TEST(IntegerBuiltins, Bitfields) {
  WordFunction run("u[4] = bitfieldExtract(u[0], int(u[2]), int(u[3]));\n"
                   "u[5] = uint(bitfieldExtract(int(u[0]), int(u[2]), int(u[3])));\n"
                   "u[6] = bitfieldInsert(u[0], u[1], int(u[2]), int(u[3]));");
  for (std::uint32_t word : words)
    for (std::uint32_t offset : {0u, 1u, 7u, 31u})
      for (std::uint32_t bits : {0u, 1u, 8u, 25u, 32u}) {
        if (offset + bits > 32)
          continue;
        std::uint32_t insert = 0xcafe1234;
        auto result = run({word, insert, offset, bits});
        std::uint64_t mask = (std::uint64_t(1) << bits) - 1;
        auto field = static_cast<std::uint32_t>(word >> offset & mask);
        EXPECT_EQ(result[4], field);
        std::uint32_t extended = field;
        if (bits != 0 && bits != 32 && field >> (bits - 1) & 1)
          extended |= ~static_cast<std::uint32_t>(mask);
        EXPECT_EQ(result[5], extended);
        EXPECT_EQ(result[6], static_cast<std::uint32_t>((word & ~(mask << offset)) |
                                                        ((insert & mask) << offset)));
      }
}

TEST(IntegerBuiltins, CarriesAndLongProducts) {
  WordFunction run(
      "uint carry, borrow, high, low; int ihigh, ilow;\n"
      "u[2] = uaddCarry(u[0], u[1], carry); u[3] = carry; u[4] = usubBorrow(u[0], u[1], borrow); "
      "u[5] = borrow;\n"
      "umulExtended(u[0], u[1], high, low); u[6] = high; u[7] = low;\n"
      "imulExtended(int(u[0]), int(u[1]), ihigh, ilow); u[8] = uint(ihigh); u[9] = uint(ilow);");
  for (std::uint32_t a : words)
    for (std::uint32_t b : words) {
      auto result = run({a, b});
      EXPECT_EQ(result[2], a + b);
      EXPECT_EQ(result[3], std::uint64_t(a) + b > 0xffffffff ? 1u : 0u);
      EXPECT_EQ(result[4], a - b);
      EXPECT_EQ(result[5], a < b ? 1u : 0u);
      std::uint64_t product = std::uint64_t(a) * b;
      EXPECT_EQ(result[6], static_cast<std::uint32_t>(product >> 32));
      EXPECT_EQ(result[7], static_cast<std::uint32_t>(product));
      auto signedProduct = static_cast<std::uint64_t>(std::int64_t(static_cast<std::int32_t>(a)) *
                                                      static_cast<std::int32_t>(b));
      EXPECT_EQ(result[8], static_cast<std::uint32_t>(signedProduct >> 32));
      EXPECT_EQ(result[9], static_cast<std::uint32_t>(signedProduct));
    }
}

TEST(IntegerBuiltins, VectorsGoByComponent) {
  WordFunction run("uvec2 carry; uvec2 s = uaddCarry(uvec2(u[0], u[1]), uvec2(1u), carry); u[0] = "
                   "s.x; u[1] = s.y; u[2] = carry.x; u[3] = carry.y;\n"
                   "ivec3 c = bitCount(uvec3(u[4], 3u, 7u)); u[4] = uint(c.x); u[5] = uint(c.y); "
                   "u[6] = uint(c.z);");
  auto result = run({0xffffffff, 5, 0, 0, 0xff});
  EXPECT_EQ(result[0], 0u);
  EXPECT_EQ(result[1], 6u);
  EXPECT_EQ(result[2], 1u);
  EXPECT_EQ(result[3], 0u);
  EXPECT_EQ(result[4], 8u);
  EXPECT_EQ(result[5], 2u);
  EXPECT_EQ(result[6], 3u);
}

TEST(IntegerBuiltins, ComparisonsOfVectors) {
  Outcome run(
      "bvec3 a = lessThan(vec3(1, 2, 3), vec3(2)); n[0] = int(a.x) + 2 * int(a.y) + 4 * int(a.z);\n"
      "bvec3 b = greaterThanEqual(ivec3(-1, 2, 3), ivec3(2)); n[1] = int(b.x) + 2 * int(b.y) + 4 * "
      "int(b.z);\n"
      "bvec2 c = lessThan(uvec2(4294967295u, 1u), uvec2(2u)); n[2] = int(c.x) + 2 * int(c.y);\n"
      "bvec2 d = lessThanEqual(vec2(x[0], 1), vec2(1)); n[3] = int(d.x) + 2 * int(d.y);\n"
      "bvec2 e = equal(vec2(x[0], 1), vec2(x[0], 1)); n[4] = int(e.x) + 2 * int(e.y);\n"
      "bvec2 f = notEqual(vec2(x[0], 1), vec2(x[0], 1)); n[5] = int(f.x) + 2 * int(f.y);\n"
      "n[6] = int(any(c)) + 2 * int(all(c)) + 4 * int(all(not(bvec2(false)))) + 8 * "
      "int(any(bvec2(false)));\n"
      "bvec2 g = greaterThan(uvec2(4294967295u, 1u), uvec2(2u)); n[7] = int(g.x) + 2 * int(g.y);\n"
      "bvec2 h = equal(bvec2(true, false), bvec2(false)); n[8] = int(h.x) + 2 * int(h.y);",
      {NAN});
  const int expected[] = {1, 6, 2, 2, 2, 1, 5, 1, 2};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.n[i], expected[i]) << i;
}

//===----------------------------------------------------------------------===//
// Packing
//===----------------------------------------------------------------------===//

TEST(PackingBuiltins, Normalised) {
  Outcome run(
      "u[0] = packUnorm4x8(vec4(0, 1, 0.5, 2)); u[1] = packSnorm4x8(vec4(-1, 1, 0, -0.5));\n"
      "u[2] = packUnorm2x16(vec2(x[0], -3)); u[3] = packSnorm2x16(vec2(-2, 1));\n"
      "vec4 a = unpackUnorm4x8(u[0]); x[1] = a.y; x[2] = a.z; vec4 b = "
      "unpackSnorm4x8(4286611585u); x[3] = b.x; x[4] = b.y; x[5] = b.w;\n"
      "vec2 c = unpackUnorm2x16(4294901760u); x[6] = c.x; x[7] = c.y; vec2 d = "
      "unpackSnorm2x16(2147549183u); x[8] = d.x; x[9] = d.y;",
      {0.25F});
  EXPECT_EQ(run.u[0], 0xff80ff00u); // 127.5 goes to even
  EXPECT_EQ(run.u[1], 0xc0007f81u);
  EXPECT_EQ(run.u[2], 0x00004000u);
  EXPECT_EQ(run.u[3], 0x7fff8001u);
  EXPECT_EQ(run.x[1], 1.0F);
  EXPECT_EQ(run.x[2], 128.0F / 255.0F);
  EXPECT_EQ(run.x[3], -127.0F / 127.0F); // 0xff80_8081: 0x81
  EXPECT_EQ(run.x[4], -1.0F) << "-128 is clamped";
  EXPECT_EQ(run.x[5], -1.0F / 127.0F);
  EXPECT_EQ(run.x[6], 0.0F);
  EXPECT_EQ(run.x[7], 1.0F);
  EXPECT_EQ(run.x[8], -1.0F / 32767.0F); // 0x8000ffff
  EXPECT_EQ(run.x[9], -1.0F);
}

TEST(PackingBuiltins, HalvesRoundToEven) {
  Shader shader(
      "void pack(inout float x[2], inout uint u[1]) { u[0] = packHalf2x16(vec2(x[0], x[1])); }\n"
      "void unpack(inout float x[2], inout uint u[1]) { vec2 v = unpackHalf2x16(u[0]); x[0] = v.x; "
      "x[1] = v.y; }");
  auto pack = [&](float value) {
    float x[2] = {value, -value};
    std::uint32_t u[1] = {0};
    shader.call("pack", x, u);
    EXPECT_EQ(u[0] >> 16, (u[0] & 0xffff) ^ 0x8000) << value;
    return u[0] & 0xffff;
  };
  // Every half is the half of itself, and of all floats up to the middles around it.
  for (std::uint32_t half = 0; half < 0x7c00; ++half) {
    float x[2];
    std::uint32_t u[1] = {half};
    shader.call("unpack", x, u);
    std::uint32_t exponent = half >> 10, fraction = half & 0x3ff;
    float exact = exponent ? std::ldexp(1024.0F + static_cast<float>(fraction),
                                        static_cast<int>(exponent) - 25)
                           : std::ldexp(static_cast<float>(fraction), -24);
    ASSERT_EQ(x[0], exact) << half;
    if (half % 7 != 0 && half > 0x20 && half < 0x7bf0)
      continue; // packing is slower to test
    ASSERT_EQ(pack(exact), half);
    float step = std::ldexp(1.0F, std::max(static_cast<int>(exponent), 1) - 25);
    float middle = exact + step / 2;
    ASSERT_EQ(pack(middle), half + (half & 1)) << "ties go to even";
    ASSERT_EQ(pack(std::nextafter(middle, 0.0F)), half);
    ASSERT_EQ(pack(std::nextafter(middle, 1e9F)), half + 1);
  }
  EXPECT_EQ(pack(65520.0F), 0x7c00u);
  EXPECT_EQ(pack(1e30F), 0x7c00u);
  EXPECT_EQ(pack(INFINITY), 0x7c00u);
  float x[2] = {NAN, -NAN};
  std::uint32_t u[1] = {0};
  shader.call("pack", x, u);
  EXPECT_EQ(u[0], 0x7e007e00U) << "of a NaN no sign is seen";
  u[0] = 0x7e00fc00;
  shader.call("unpack", x, u);
  EXPECT_EQ(x[0], -INFINITY);
  EXPECT_TRUE(std::isnan(x[1]));
}

} // namespace
} // namespace rtsl::test
