//===- Matrices.h - products, determinant, inverse ------------------------===//
#pragma once

#include "language/formulas/Geometry.h"

namespace rtsl::formulas {

template <typename Number>
Columns<Number> transpose(const Columns<Number> &m) {
  Columns<Number> result;
  for (unsigned row = 0; row < m.front().width(); ++row) {
    std::vector<Number> components;
    for (Number column : m)
      components.push_back(column[row]);
    result.push_back(Number::vector(components));
  }
  return result;
}

template <typename Number>
Columns<Number> outerProduct(Number column, Number row) {
  Columns<Number> result;
  for (unsigned i = 0; i < row.width(); ++i)
    result.push_back(column * row[i]);
  return result;
}

template <typename Number>
Columns<Number> matrixCompMult(const Columns<Number> &a, const Columns<Number> &b) {
  Columns<Number> result;
  for (std::size_t i = 0; i < a.size(); ++i)
    result.push_back(a[i] * b[i]);
  return result;
}

/// m * v: sums from the first column on.
template <typename Number>
Number multiply(const Columns<Number> &m, Number v) {
  Number sum = m[0] * v[0];
  for (unsigned i = 1; i < m.size(); ++i)
    sum = sum + m[i] * v[i];
  return sum;
}
/// v * m: dot(v, column).
template <typename Number>
Number multiply(Number v, const Columns<Number> &m) {
  std::vector<Number> components;
  for (Number column : m)
    components.push_back(dot(v, column));
  return Number::vector(components);
}
template <typename Number>
Columns<Number> multiply(const Columns<Number> &a, const Columns<Number> &b) {
  Columns<Number> result;
  for (Number column : b)
    result.push_back(multiply(a, column));
  return result;
}

//===----------------------------------------------------------------------===//
// Determinant: by minors of two rows, each within 1.5 ulp (differenceOfProducts).
//===----------------------------------------------------------------------===//

template <typename Number>
Number minorOf(Number a, Number b, unsigned i, unsigned j) {
  return differenceOfProducts(a[i], b[j], b[i], a[j]);
}

template <typename Number>
Number expandDeterminant(const Columns<Number> &m) {
  if (m.size() == 2)
    return minorOf(m[0], m[1], 0, 1);
  if (m.size() == 3)
    return dot(m[0], cross(m[1], m[2]));
  // Laplace expansion along two columns.
  Number upper[6], lower[6];
  static const unsigned rows[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (unsigned i = 0; i < 6; ++i) {
    upper[i] = minorOf(m[0], m[1], rows[i][0], rows[i][1]);
    lower[i] = minorOf(m[2], m[3], rows[5 - i][0], rows[5 - i][1]);
  }
  return (differenceOfProducts(upper[0], lower[0], upper[1], lower[1]) +
          differenceOfProducts(upper[5], lower[5], upper[4], lower[4])) +
         fma(upper[2], lower[2], upper[3] * lower[3]);
}

template <typename Number>
Number determinant(const Columns<Number> &m) {
  return m.size() == 2 ? expandDeterminant(m)
                       : outline("determinant", expandDeterminant<Number>, m);
}

//===----------------------------------------------------------------------===//
// Inverse. Each column is scaled by a power of two to a largest component in [1, 2): inverse(M S) =
// S^-1 inverse(M) is undone on the rows of the result, and neither determinant nor pivots can
// overflow for a matrix of extreme scale.
//
// 2x2 and 3x3: the adjugate, its elements within 1.5 ulp, divided by the determinant. The elements
// share the error e of the determinant, so |A X - I| <= |e| + 4 ulp, where |e| <= 4 ulp * (sum of
// the magnitudes of its terms) / |determinant|. 4x4: elimination with partial pivoting (Wilkinson
// 1961), |A X - I| <= 40 ulp |A| |X|. A singular matrix gives infinities or NaN.
//===----------------------------------------------------------------------===//

/// 2^-floor(log2(largest magnitude)), within the normal numbers.
template <typename Number>
Number scaleOf(Number column) {
  Number exponent = shiftRight(maxComponent(abs(column)).bits(), 23);
  exponent = clamp(exponent, exponent.like(1), exponent.like(253));
  return shiftLeft(254.0 - exponent, 23).asFloat();
}

template <typename Number>
Columns<Number> adjugateInverse(const Columns<Number> &m) {
  if (m.size() == 2) {
    Number determinant = expandDeterminant(m);
    Number first = Number::vector({m[1][1], -m[0][1]});
    Number second = Number::vector({-m[1][0], m[0][0]});
    return {first / determinant, second / determinant};
  }
  Number first = cross(m[1], m[2]);
  Number determinant = dot(m[0], first);
  return transpose(Columns<Number>{first / determinant, cross(m[2], m[0]) / determinant,
                                   cross(m[0], m[1]) / determinant});
}

/// Works on the transpose, whose rows are the columns at hand: the rows of its inverse are the
/// columns of the result.
template <typename Number>
Columns<Number> eliminationInverse(Columns<Number> rows) {
  auto size = static_cast<unsigned>(rows.size());
  Columns<Number> result;
  for (unsigned i = 0; i < size; ++i) {
    std::vector<Number> unit;
    for (unsigned j = 0; j < size; ++j)
      unit.push_back(rows[0].real(i == j ? 1.0 : 0.0));
    result.push_back(Number::vector(unit));
  }
  for (unsigned pivot = 0; pivot < size; ++pivot) {
    for (unsigned i = pivot + 1; i < size; ++i) {
      Number isLarger = less(abs(rows[pivot][pivot]), abs(rows[i][pivot]));
      auto exchange = [&](Columns<Number> &m) {
        Number upper = select(isLarger, m[i], m[pivot]);
        m[i] = select(isLarger, m[pivot], m[i]);
        m[pivot] = upper;
      };
      exchange(rows);
      exchange(result);
    }
    Number divisor = rows[pivot][pivot];
    rows[pivot] = rows[pivot] / divisor;
    result[pivot] = result[pivot] / divisor;
    for (unsigned i = 0; i < size; ++i) {
      if (i == pivot)
        continue;
      Number factor = -rows[i][pivot];
      rows[i] = fma(factor, rows[pivot], rows[i]);
      result[i] = fma(factor, result[pivot], result[i]);
    }
  }
  return result;
}

template <typename Number>
Columns<Number> inverse(const Columns<Number> &m) {
  return outline(
      "inverse",
      [](const Columns<Number> &m) {
        Columns<Number> scaled;
        std::vector<Number> scales;
        for (Number column : m) {
          Number scale = scaleOf(column);
          scales.push_back(scale);
          scaled.push_back(column * scale);
        }
        Number scale = Number::vector(scales);
        Columns<Number> result =
            m.size() == 4 ? eliminationInverse(scaled) : adjugateInverse(scaled);
        for (Number &column : result)
          column = column * scale;
        return result;
      },
      m);
}

} // namespace rtsl::formulas
