//===- LibraryMatrix.cpp - products, determinant, inverse -----------------===//
#include "codegen/formulas/Library.h"

namespace rtsl::lowering {

Columns transpose(const Columns &m) {
  Emitter &emitter = m.front().at();
  Columns result;
  for (unsigned row = 0; row < m.front().width(); ++row) {
    llvm::SmallVector<Value, 4> components;
    for (Num column : m)
      components.push_back(column[row]);
    result.push_back({emitter, emitter.vector(components)});
  }
  return result;
}

Columns outerProduct(Num column, Num row) {
  Columns result;
  for (unsigned i = 0; i < row.width(); ++i)
    result.push_back(column * row[i]);
  return result;
}

Num multiply(const Columns &m, Num v) {
  Num sum = m[0] * v[0];
  for (unsigned i = 1; i < m.size(); ++i)
    sum = sum + m[i] * v[i];
  return sum;
}

Num multiply(Num v, const Columns &m) {
  llvm::SmallVector<Value, 4> components;
  for (Num column : m)
    components.push_back(dot(v, column));
  return {v.at(), v.at().vector(components)};
}

Columns multiply(const Columns &a, const Columns &b) {
  Columns result;
  for (Num column : b)
    result.push_back(multiply(a, column));
  return result;
}

//===----------------------------------------------------------------------===//
// Determinant: by minors of two rows, each within 1.5 ulp (differenceOfProducts).
//===----------------------------------------------------------------------===//

static Num minor(Num a, Num b, unsigned i, unsigned j) {
  return differenceOfProducts(a[i], b[j], b[i], a[j]);
}

static Num determinantOf(const Columns &m) {
  if (m.size() == 2)
    return minor(m[0], m[1], 0, 1);
  if (m.size() == 3)
    return dot(m[0], cross(m[1], m[2]));
  // Laplace expansion along two columns.
  Num upper[6], lower[6];
  static const unsigned rows[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (unsigned i = 0; i < 6; ++i) {
    upper[i] = minor(m[0], m[1], rows[i][0], rows[i][1]);
    lower[i] = minor(m[2], m[3], rows[5 - i][0], rows[5 - i][1]);
  }
  return (differenceOfProducts(upper[0], lower[0], upper[1], lower[1]) +
          differenceOfProducts(upper[5], lower[5], upper[4], lower[4])) +
         fma(upper[2], lower[2], upper[3] * lower[3]);
}

Num Library::determinant(const Columns &m) {
  return m.size() == 2 ? determinantOf(m) : callMatrixToScalar("determinant", m, determinantOf);
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

// 2^-floor(log2(largest magnitude)), within the normal numbers.
static Num scaleOf(Num column) {
  Num exponent = shiftRight(maxComponent(abs(column)).bits(), 23);
  exponent = clamp(exponent, exponent.like(1), exponent.like(253));
  return shiftLeft(254.0 - exponent, 23).asFloat();
}

static Columns adjugateInverse(const Columns &m) {
  Emitter &emitter = m.front().at();
  if (m.size() == 2) {
    Num determinant = determinantOf(m);
    Num first(emitter, emitter.vector({m[1][1], -m[0][1]}));
    Num second(emitter, emitter.vector({-m[1][0], m[0][0]}));
    return {first / determinant, second / determinant};
  }
  Num first = cross(m[1], m[2]);
  Num determinant = dot(m[0], first);
  return transpose(
      {first / determinant, cross(m[2], m[0]) / determinant, cross(m[0], m[1]) / determinant});
}

// Works on the transpose, whose rows are the columns at hand: the rows of its inverse are the
// columns of the result.
static Columns eliminationInverse(Columns rows) {
  Emitter &emitter = rows.front().at();
  auto size = static_cast<unsigned>(rows.size());
  Columns result;
  for (unsigned i = 0; i < size; ++i) {
    llvm::SmallVector<Value, 4> unit;
    for (unsigned j = 0; j < size; ++j)
      unit.push_back(emitter.floatConstant(i == j ? 1.0F : 0.0F));
    result.push_back({emitter, emitter.vector(unit)});
  }
  for (unsigned pivot = 0; pivot < size; ++pivot) {
    for (unsigned i = pivot + 1; i < size; ++i) {
      Num isLarger = less(abs(rows[pivot][pivot]), abs(rows[i][pivot]));
      auto exchange = [&](Columns &m) {
        Num upper = select(isLarger, m[i], m[pivot]);
        m[i] = select(isLarger, m[pivot], m[i]);
        m[pivot] = upper;
      };
      exchange(rows);
      exchange(result);
    }
    Num divisor = rows[pivot][pivot];
    rows[pivot] = rows[pivot] / divisor;
    result[pivot] = result[pivot] / divisor;
    for (unsigned i = 0; i < size; ++i) {
      if (i == pivot)
        continue;
      Num factor = -rows[i][pivot];
      rows[i] = fma(factor, rows[pivot], rows[i]);
      result[i] = fma(factor, result[pivot], result[i]);
    }
  }
  return result;
}

Columns Library::inverse(const Columns &m) {
  return callMatrix("inverse", m, [](const Columns &m) {
    Emitter &emitter = m.front().at();
    Columns scaled;
    llvm::SmallVector<Value, 4> scales;
    for (Num column : m) {
      Num scale = scaleOf(column);
      scales.push_back(scale);
      scaled.push_back(column * scale);
    }
    Num scale(emitter, emitter.vector(scales));
    Columns result = m.size() == 4 ? eliminationInverse(scaled) : adjugateInverse(scaled);
    for (Num &column : result)
      column = column * scale;
    return result;
  });
}

} // namespace rtsl::lowering
