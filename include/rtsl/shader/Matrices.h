//===- Matrices.h - products, determinant, inverse ------------------------===//
//
// GLM sums in another order and inverts less accurately, so only its types are used.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Geometry.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

template <int C, int R>
using Matrix = glm::mat<C, R, float, glm::defaultp>;

/// Matrix times vector; sums begin with the first column.
template <int C, int R>
inline glm::vec<R, float> mul(const Matrix<C, R> &m, const glm::vec<C, float> &v) {
  glm::vec<R, float> sum = m[0] * v[0];
  for (int i = 1; i < C; ++i)
    sum = sum + m[i] * v[i];
  return sum;
}
/// Row vector times matrix.
template <int C, int R>
inline glm::vec<C, float> mul(const glm::vec<R, float> &v, const Matrix<C, R> &m) {
  glm::vec<C, float> result;
  for (int i = 0; i < C; ++i)
    result[i] = rtsl::dot(v, m[i]);
  return result;
}
template <int K, int R, int C>
inline Matrix<C, R> mul(const Matrix<K, R> &a, const Matrix<C, K> &b) {
  Matrix<C, R> result;
  for (int i = 0; i < C; ++i)
    result[i] = mul(a, b[i]);
  return result;
}

/// `function` of the columns of two matrices, or of a matrix and a number.
#define RTSL_MATRIX_OPERATION(name, op)                                                            \
  template <int C, int R>                                                                          \
  inline Matrix<C, R> name(const Matrix<C, R> &a, const Matrix<C, R> &b) {                         \
    Matrix<C, R> result;                                                                           \
    for (int i = 0; i < C; ++i)                                                                    \
      result[i] = a[i] op b[i];                                                                    \
    return result;                                                                                 \
  }                                                                                                \
  template <int C, int R>                                                                          \
  inline Matrix<C, R> name(const Matrix<C, R> &a, float b) {                                       \
    Matrix<C, R> result;                                                                           \
    for (int i = 0; i < C; ++i)                                                                    \
      result[i] = a[i] op b;                                                                       \
    return result;                                                                                 \
  }                                                                                                \
  template <int C, int R>                                                                          \
  inline Matrix<C, R> name(float a, const Matrix<C, R> &b) {                                       \
    Matrix<C, R> result;                                                                           \
    for (int i = 0; i < C; ++i)                                                                    \
      result[i] = a op b[i];                                                                       \
    return result;                                                                                 \
  }
RTSL_MATRIX_OPERATION(addByComponent, +)
RTSL_MATRIX_OPERATION(subtractByComponent, -)
RTSL_MATRIX_OPERATION(matrixCompMult, *)
RTSL_MATRIX_OPERATION(divideByComponent, /)
#undef RTSL_MATRIX_OPERATION

template <int C, int R>
inline Matrix<R, C> transpose(const Matrix<C, R> &m) {
  Matrix<R, C> result;
  for (int column = 0; column < C; ++column)
    for (int row = 0; row < R; ++row)
      result[row][column] = m[column][row];
  return result;
}
template <int R, int C>
inline Matrix<C, R> outerProduct(const glm::vec<R, float> &column, const glm::vec<C, float> &row) {
  Matrix<C, R> result;
  for (int i = 0; i < C; ++i)
    result[i] = column * row[i];
  return result;
}

/// The overlap of a matrix with one of another shape; the rest is that of the identity.
template <typename To, int C, int R>
inline To resize(const Matrix<C, R> &m) {
  To result(1.0f);
  for (int column = 0; column < To::length() && column < C; ++column)
    for (int row = 0; row < To::col_type::length() && row < R; ++row)
      result[column][row] = m[column][row];
  return result;
}

namespace detail {
template <typename Add, typename T>
inline void scalarsOf(Add add, const T &value) {
  if constexpr (width<T> == 0)
    add(value);
  else
    for (int i = 0; i < width<T>; ++i)
      add(value[i]);
}
template <typename Add, int C, int R>
inline void scalarsOf(Add add, const Matrix<C, R> &value) {
  for (int i = 0; i < C; ++i)
    scalarsOf(add, value[i]);
}
} // namespace detail

/// A vector from the scalars of its pieces in order; excess scalars are ignored.
template <typename Vector, typename... Piece>
inline Vector vectorOf(const Piece &...pieces) {
  Vector result(0);
  int next = 0;
  auto add = [&](auto scalar) {
    if (next < Vector::length())
      result[next++] = scalar;
  };
  (detail::scalarsOf(add, pieces), ...);
  return result;
}
/// A matrix, by columns, from the scalars of its pieces in order.
template <typename To, typename... Piece>
inline To matrixOf(const Piece &...pieces) {
  To result(0.0f);
  int next = 0;
  auto add = [&](float scalar) {
    result[next / To::col_type::length()][next % To::col_type::length()] = scalar;
    ++next;
  };
  (detail::scalarsOf(add, pieces), ...);
  return result;
}

//===----------------------------------------------------------------------===//
// Determinant: by minors of two rows, each within 1.5 ulp
//===----------------------------------------------------------------------===//

namespace detail {
template <typename Column>
inline float minorOf(const Column &a, const Column &b, int i, int j) {
  return differenceOfProducts(a[i], b[j], b[i], a[j]);
}
} // namespace detail

inline float determinant(const glm::mat2 &m) {
  return detail::minorOf(m[0], m[1], 0, 1);
}
inline float determinant(const glm::mat3 &m) {
  return dot(m[0], cross(m[1], m[2]));
}
/// Laplace's expansion along two columns.
inline float determinant(const glm::mat4 &m) {
  constexpr int rows[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  float upper[6], lower[6];
  for (int i = 0; i < 6; ++i) {
    upper[i] = detail::minorOf(m[0], m[1], rows[i][0], rows[i][1]);
    lower[i] = detail::minorOf(m[2], m[3], rows[5 - i][0], rows[5 - i][1]);
  }
  return (differenceOfProducts(upper[0], lower[0], upper[1], lower[1]) +
          differenceOfProducts(upper[5], lower[5], upper[4], lower[4])) +
         std::fma(upper[2], lower[2], upper[3] * lower[3]);
}

//===----------------------------------------------------------------------===//
// Inverse. Each column is scaled by a power of two to a largest component in [1, 2), which is
// undone on the rows of the result: neither determinant nor pivots can overflow. 2x2 and 3x3 by the
// adjugate; 4x4 by elimination with partial pivoting (Wilkinson 1961). A singular matrix gives
// infinities or NaN.
//===----------------------------------------------------------------------===//

namespace detail {

/// 2^-floor(log2(largest magnitude)), within the normal numbers.
template <typename Column>
inline float scaleOf(const Column &column) {
  const int exponent = rtsl::clamp(
      static_cast<int>(bitsAs<uint>(rtsl::maxComponent(rtsl::abs(column))) >> 23), 1, 253);
  return bitsAs<float>(static_cast<uint>(254 - exponent) << 23);
}

inline glm::mat2 inverseOfScaled(const glm::mat2 &m) {
  const float determinant = rtsl::determinant(m);
  return {glm::vec2(m[1][1], -m[0][1]) / determinant, glm::vec2(-m[1][0], m[0][0]) / determinant};
}

inline glm::mat3 inverseOfScaled(const glm::mat3 &m) {
  const glm::vec3 first = rtsl::cross(m[1], m[2]);
  const float determinant = rtsl::dot(m[0], first);
  return rtsl::transpose(glm::mat3(first / determinant, rtsl::cross(m[2], m[0]) / determinant,
                                   rtsl::cross(m[0], m[1]) / determinant));
}

/// Works on the transpose, whose rows are the columns of the argument: the rows of its inverse are
/// the columns of the result.
inline glm::mat4 inverseOfScaled(glm::mat4 rows) {
  glm::mat4 result(1.0f);
  for (int pivot = 0; pivot < 4; ++pivot) {
    for (int i = pivot + 1; i < 4; ++i)
      if (std::fabs(rows[pivot][pivot]) < std::fabs(rows[i][pivot])) {
        std::swap(rows[i], rows[pivot]);
        std::swap(result[i], result[pivot]);
      }
    const float divisor = rows[pivot][pivot];
    rows[pivot] = rows[pivot] / divisor;
    result[pivot] = result[pivot] / divisor;
    for (int i = 0; i < 4; ++i) {
      if (i == pivot)
        continue;
      const float factor = -rows[i][pivot];
      rows[i] = rtsl::fma(factor, rows[pivot], rows[i]);
      result[i] = rtsl::fma(factor, result[pivot], result[i]);
    }
  }
  return result;
}

} // namespace detail

template <int N>
inline Matrix<N, N> inverse(Matrix<N, N> m) {
  glm::vec<N, float> scale(0.0f);
  for (int i = 0; i < N; ++i) {
    scale[i] = detail::scaleOf(m[i]);
    m[i] = m[i] * scale[i];
  }
  Matrix<N, N> result = detail::inverseOfScaled(m);
  for (int i = 0; i < N; ++i)
    result[i] = result[i] * scale;
  return result;
}

} // namespace RTSL_VARIANT
} // namespace rtsl
