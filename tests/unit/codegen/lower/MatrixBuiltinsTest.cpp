//===- MatrixBuiltinsTest.cpp - products, determinant, inverse ------------===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rtsl::test {
namespace {

/// Square, by columns, in double.
struct Matrix {
  int size;
  std::vector<double> elements;
  explicit Matrix(int size) : size(size), elements(static_cast<std::size_t>(size * size)) {}
  double &at(int column, int row) {
    return elements[static_cast<std::size_t>(column * size + row)];
  }
  double at(int column, int row) const {
    return elements[static_cast<std::size_t>(column * size + row)];
  }
  std::vector<float> floats() const { return {elements.begin(), elements.end()}; }
};

Matrix multiply(const Matrix &a, const Matrix &b) {
  Matrix product(a.size);
  for (int column = 0; column < a.size; ++column)
    for (int row = 0; row < a.size; ++row)
      for (int k = 0; k < a.size; ++k)
        product.at(column, row) += a.at(k, row) * b.at(column, k);
  return product;
}

/// Largest sum of magnitudes of a row.
double norm(const Matrix &m) {
  double largest = 0;
  for (int row = 0; row < m.size; ++row) {
    double sum = 0;
    for (int column = 0; column < m.size; ++column)
      sum += std::abs(m.at(column, row));
    largest = std::max(largest, sum);
  }
  return largest;
}

/// By elimination in long double.
long double determinant(const Matrix &m) {
  std::vector<std::vector<long double>> a(static_cast<std::size_t>(m.size));
  for (int row = 0; row < m.size; ++row)
    for (int column = 0; column < m.size; ++column)
      a[static_cast<std::size_t>(row)].push_back(m.at(column, row));
  long double result = 1;
  for (std::size_t k = 0; k < a.size(); ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < a.size(); ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k]))
        pivot = i;
    if (pivot != k) {
      std::swap(a[pivot], a[k]);
      result = -result;
    }
    result *= a[k][k];
    for (std::size_t i = k + 1; i < a.size(); ++i)
      for (std::size_t j = a.size(); j-- > k;)
        a[i][j] -= a[i][k] / a[k][k] * a[k][j];
  }
  return result;
}

Matrix randomMatrix(int size, std::mt19937 &random, double scale) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Matrix m(size);
  for (double &element : m.elements)
    element = static_cast<float>(scale * unit(random));
  return m;
}

std::string construct(int size) {
  std::string text = "mat" + std::to_string(size) + "(";
  for (int i = 0; i < size * size; ++i)
    text += (i ? ", x[" : "x[") + std::to_string(i) + "]";
  return text + ")";
}

std::string copyBack(int size) {
  std::string text;
  for (int column = 0; column < size; ++column)
    for (int row = 0; row < size; ++row)
      text += "x[" + std::to_string(column * size + row) + "] = r[" + std::to_string(column) +
              "][" + std::to_string(row) + "]; ";
  return text;
}

FloatFunction inverseOf(int size) {
  return FloatFunction("mat" + std::to_string(size) + " r = inverse(" + construct(size) + "); " +
                       copyBack(size));
}

double residual(const Matrix &m, const std::array<float, 16> &inverse) {
  Matrix x(m.size);
  for (std::size_t i = 0; i < x.elements.size(); ++i)
    x.elements[i] = inverse[i];
  Matrix product = multiply(m, x);
  for (int i = 0; i < m.size; ++i)
    product.at(i, i) -= 1;
  return norm(product) / (norm(m) * norm(x));
}

TEST(MatrixBuiltins, InverseHasASmallResidual) {
  std::mt19937 random(11);
  for (int size : {2, 3, 4}) {
    FloatFunction inverse = inverseOf(size);
    for (double scale : {1e-30, 1e-12, 1.0, 1e12, 1e30})
      for (int i = 0; i < 40; ++i) {
        Matrix m = randomMatrix(size, random, scale);
        EXPECT_LE(residual(m, inverse(m.floats())), 40 * 6e-8) << size << " at scale " << scale;
      }
  }
}

TEST(MatrixBuiltins, InverseOfBadlyScaledColumnsAndOfPermutations) {
  for (int size : {3, 4}) {
    FloatFunction inverse = inverseOf(size);
    Matrix diagonal(size);
    for (int i = 0; i < size; ++i)
      diagonal.at(i, i) = std::exp2(-40.0 * i);
    auto result = inverse(diagonal.floats());
    for (int i = 0; i < size; ++i)
      EXPECT_EQ(result[static_cast<std::size_t>(i * size + i)], std::exp2(40.0 * i));
    // Zeros where elimination without pivoting would divide.
    Matrix cycle(size);
    for (int i = 0; i < size; ++i)
      cycle.at(i, (i + 1) % size) = 2;
    result = inverse(cycle.floats());
    for (int i = 0; i < size; ++i)
      EXPECT_EQ(result[static_cast<std::size_t>((i + 1) % size * size + i)], 0.5F);
  }
}

TEST(MatrixBuiltins, InverseOfATransform) {
  FloatFunction inverse = inverseOf(4);
  // Rotation by 30 degrees about z, then far away.
  float c = std::sqrt(0.75F), s = 0.5F;
  auto result = inverse({c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 1e6F, -2e6F, 3e6F, 1});
  EXPECT_NEAR(result[0], c, 1e-7);
  EXPECT_NEAR(result[1], -s, 1e-7);
  EXPECT_NEAR(result[12], -(c * 1e6 + s * -2e6), 0.5);
  EXPECT_NEAR(result[13], -(-s * 1e6 + c * -2e6), 0.5);
  EXPECT_EQ(result[14], -3e6F);
  EXPECT_EQ(result[15], 1.0F);
}

TEST(MatrixBuiltins, Determinant) {
  std::mt19937 random(5);
  for (int size : {2, 3, 4}) {
    FloatFunction run("x[0] = determinant(" + construct(size) + ");");
    for (int i = 0; i < 60; ++i) {
      Matrix m = randomMatrix(size, random, 2);
      double exact = static_cast<double>(determinant(m));
      // Hadamard's bound for the size of the terms.
      double terms = 1;
      for (int column = 0; column < size; ++column) {
        double square = 0;
        for (int row = 0; row < size; ++row)
          square += m.at(column, row) * m.at(column, row);
        terms *= std::sqrt(square);
      }
      EXPECT_NEAR(run(m.floats())[0], exact, 6e-7 * terms) << size;
    }
    Matrix exchange(size);
    for (int k = 0; k < size; ++k)
      exchange.at(k, size - 1 - k) = k + 2;
    EXPECT_EQ(run(exchange.floats())[0], static_cast<float>(determinant(exchange))) << "signs";
  }
}

TEST(MatrixBuiltins, ProductsAreThoseOfLinearAlgebra) {
  Outcome run(
      "mat2x3 a = mat2x3(1, 2, 3, 4, 5, 6);\n" // 2 columns of 3 rows
      "vec3 v = a * vec2(10, 100); x[0] = v.x; x[1] = v.y; x[2] = v.z;\n"
      "vec2 w = vec3(1, 10, 100) * a; x[3] = w.x; x[4] = w.y;\n"
      "mat2 p = mat3x2(1, 2, 3, 4, 5, 6) * a; x[5] = p[0][0]; x[6] = p[0][1]; x[7] = p[1][0]; x[8] "
      "= p[1][1];\n"
      "mat2x3 s = 2.0 * a + a; x[9] = s[1].z; mat2x3 d = matrixCompMult(a, a); x[10] = d[1][2];\n"
      "a *= 0.5; x[11] = a[0].y;");
  float expected[] = {410, 520, 630, 321, 654, 22, 28, 49, 64, 18, 36, 1};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
}

TEST(MatrixBuiltins, TransposeAndOuterProduct) {
  Outcome run(
      "mat3x2 t = transpose(mat2x3(1, 2, 3, 4, 5, 6)); x[0] = t[0][0]; x[1] = t[0][1]; x[2] = "
      "t[2][0]; x[3] = t[2][1];\n"
      "mat2x3 o = outerProduct(vec3(1, 2, 3), vec2(4, 5)); x[4] = o[0].z; x[5] = o[1].x;\n"
      "mat3 m = mat3(2.0); m = transpose(m) + mat3(1, 2, 3, 4, 5, 6, 7, 8, 9); x[6] = m[0][0]; "
      "x[7] = m[2][1];");
  float expected[] = {1, 4, 3, 6, 12, 5, 3, 8};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(run.x[i], expected[i]) << i;
}

TEST(MatrixBuiltins, EqualityComparesAllElements) {
  Outcome run(
      "mat2 a = mat2(1, 2, 3, 4), b = a; n[0] = a == b ? 1 : 0; b[1][0] = 5.0; n[1] = a == b ? "
      "1 : 0; n[2] = a != b ? 1 : 0;");
  EXPECT_EQ(run.n[0], 1);
  EXPECT_EQ(run.n[1], 0);
  EXPECT_EQ(run.n[2], 1);
}

} // namespace
} // namespace rtsl::test
