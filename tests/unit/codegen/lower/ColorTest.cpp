//===- ColorTest.cpp - colors of 1 to 16 components -----------------------===//
#include "language/ColorBasis.h"
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace rtsl::test {
namespace {

Options components(std::uint32_t count) {
  Options options;
  options.colorComponents = count;
  return options;
}

/// A color is an array of floats in memory: an `inout color` parameter shows its components.
class ColorFunction {
public:
  ColorFunction(const std::string &body, std::uint32_t count)
      : shader("void run(inout color c, inout color d, inout float x[4]) {\n" + body + "\n}\n",
               components(count)) {}
  void operator()() { shader.call("run", c.data(), d.data(), x.data()); }

  std::array<float, 16> c{}, d{};
  std::array<float, 4> x{};

private:
  Shader shader;
};

TEST(ColorBasis, ProjectsBackToWhatItWasMadeOf) {
  for (std::size_t count : {3, 4, 5, 8, 16}) {
    ColorBasis basis = makeColorBasis(count);
    for (int from = 0; from < 3; ++from)
      for (int to = 0; to < 3; ++to) {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i)
          sum += basis.toRgb[to][i] * basis.toColor[i][from];
        EXPECT_NEAR(sum, from == to ? 1 : 0, 1e-12) << count;
      }
    for (const auto &row : basis.toColor) {
      EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-12) << "white is flat";
      for (double weight : row)
        EXPECT_GE(weight, count == 3 ? 0 : -1e-12);
    }
  }
}

/// docs/language.md, `color.bands`, once more.
TEST(ColorBasis, MatchesTheLanguageDefinition) {
  const auto step = [](double a, double b, double x) {
    const double t = std::min(std::max((x - a) / (b - a), 0.0), 1.0);
    return 3 * t * t - 2 * t * t * t;
  };
  for (std::uint32_t count : {4u, 5u, 16u}) {
    ColorFunction run("c = color(x[0], x[1], x[2]);", count);
    run.x = {0.9F, 0.2F, 0.4F, 0};
    run();
    for (std::uint32_t i = 0; i < count; ++i) {
      double red = 0, blue = 0;
      for (unsigned part = 0; part < 64; ++part) {
        const double wavelength = 380 + (720.0 - 380) * (i + (part + 0.5) / 64) / count;
        red += step(550, 610, wavelength) / 64;
        blue += (1 - step(460, 520, wavelength)) / 64;
      }
      const double green = 1 - red - blue;
      EXPECT_NEAR(run.c[i], 0.9F * red + 0.2F * green + 0.4F * blue, 1e-7) << count << " " << i;
    }
  }
}

TEST(Color, GreyIsTheSameInEachComponent) {
  for (std::uint32_t count : {1u, 3u, 4u, 16u}) {
    ColorFunction run("c = color(x[0]); x[1] = luminance(c);", count);
    run.x[0] = 0.3F;
    run();
    for (std::uint32_t i = 0; i < count; ++i)
      EXPECT_EQ(run.c[i], 0.3F);
    EXPECT_NEAR(run.x[1], 0.3F, 1e-7);
  }
}

TEST(Color, LuminanceOfRgbDoesNotDependOnTheComponents) {
  for (std::uint32_t count : {1u, 2u, 3u, 4u, 5u, 8u, 16u}) {
    ColorFunction run("c = color(x[0], x[1], x[2]); x[3] = luminance(c);", count);
    for (auto [r, g, b] :
         {std::array<float, 3>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0.9F, 0.2F, 0.4F}}) {
      run.x = {r, g, b, 0};
      run();
      EXPECT_NEAR(run.x[3], 0.2126 * r + 0.7152 * g + 0.0722 * b, 4e-7) << count;
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_GE(run.c[i], 0.0F);
        EXPECT_LE(run.c[i], 1.0000002F);
      }
    }
  }
}

TEST(Color, RgbIsKeptAsItIs) {
  ColorFunction run("c = color(x[0], x[1], x[2]);", 3);
  run.x = {0.1F, 1e-30F, 7.0F, 0};
  run();
  EXPECT_EQ(run.c[0], 0.1F);
  EXPECT_EQ(run.c[1], 1e-30F);
  EXPECT_EQ(run.c[2], 7.0F);
}

TEST(Color, OperatorsGoByComponent) {
  for (std::uint32_t count : {1u, 3u, 4u, 16u}) {
    ColorFunction run("color a = c; c = a * d + a / 2.0 - x[0] * d; d = -a; c *= 2.0; c += d;",
                      count);
    for (std::uint32_t i = 0; i < count; ++i) {
      run.c[i] = 0.5F + static_cast<float>(i);
      run.d[i] = 3.0F - static_cast<float>(i);
    }
    run.x[0] = 0.25F;
    auto c = run.c, d = run.d;
    run();
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(run.d[i], -c[i]);
      EXPECT_EQ(run.c[i], ((c[i] * d[i] + c[i] / 2.0F) - 0.25F * d[i]) * 2.0F - c[i]);
    }
  }
}

TEST(Color, Functions) {
  for (std::uint32_t count : {1u, 3u, 5u}) {
    ColorFunction run("color a = c; c = pow(a, 2.5) + exp(a) + sqrt(a) + min(a, d) + max(a, 0.7); "
                      "d = mix(a, d, 0.25) + mix(a, d, a) + pow(a, d);",
                      count);
    for (std::uint32_t i = 0; i < count; ++i) {
      run.c[i] = 0.25F + 0.3F * static_cast<float>(i);
      run.d[i] = 0.5F;
    }
    auto c = run.c;
    run();
    for (std::uint32_t i = 0; i < count; ++i) {
      double a = c[i];
      EXPECT_NEAR(run.c[i],
                  std::pow(a, 2.5) + std::exp(a) + std::sqrt(a) + std::min(a, 0.5) +
                      std::max(a, double(0.7F)),
                  2e-6);
      EXPECT_NEAR(run.d[i], a * 0.75 + 0.125 + a * (1 - a) + 0.5 * a + std::sqrt(a), 2e-6);
    }
  }
}

TEST(Color, ConstantsOfTheFileSuitTheTarget) {
  for (std::uint32_t count : {1u, 3u, 8u}) {
    Shader shader(
        "const color green = color(0, 1, 0); const color both[2] = {color(0.5), color(0, 1, 0)};\n"
        "void run(inout float x[4], inout int n[1]) { x[0] = luminance(green); x[1] = "
        "luminance(both[n[0]]); }",
        components(count));
    float x[4] = {};
    int n[1] = {1};
    shader.call("run", x, n);
    EXPECT_NEAR(x[0], 0.7152, 4e-7);
    EXPECT_NEAR(x[1], 0.7152, 4e-7);
  }
}

} // namespace
} // namespace rtsl::test
