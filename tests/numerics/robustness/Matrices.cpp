//===- Matrices.cpp - inverses and determinants ---------------------------===//
#include "CompiledShaders.h"
#include "Generators.h"
#include "HighPrecision.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::numerics {

namespace {

/// Columns one after the other, as in memory.
template <int size>
using Matrix = std::array<float, size * size>;

/// The inverse and the determinant, which come three numbers a look.
template <int size>
class Inverses {
public:
  explicit Inverses(Path path)
      : shaders({"tests/numerics/robustness/shaders/Inverses.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Inverse3", "Inverse4", "Probe"}, {}, path),
        object(shaders.scene().addObject(size == 3 ? "Inverse3" : "Inverse4")) {
    shaders.scene().setCamera(shaders.scene().addObject("Probe"));
    shaders.scene().setBackground(object);
    shaders.finish();
  }

  Matrix<size> inverse(const Matrix<size> &m) const {
    place(m);
    Matrix<size> result;
    for (int column = 0; column < size; ++column) {
      const std::array<float, 3> upper = part(column);
      std::copy_n(upper.begin(), 3, &result[size * column]);
    }
    if constexpr (size == 4) {
      const std::array<float, 3> last = part(4);
      for (int column = 0; column < 3; ++column)
        result[size * column + 3] = last[column];
      result[15] = part(5)[0];
    }
    return result;
  }
  float determinant(const Matrix<size> &m) const {
    place(m);
    return size == 3 ? part(3)[0] : part(5)[1];
  }

private:
  void place(const Matrix<size> &m) const {
    std::copy(m.begin(), m.end(), shaders.member(object, "m"));
  }
  std::array<float, 3> part(int number) const {
    shaders.set(object, "part", {float(number)});
    return shaders.look();
  }

  CompiledShaders shaders;
  RtslRef object;
};

template <int size>
const Inverses<size> &inverses(Path path) {
  static const Inverses<size> only(path);
  return only;
}

template <int size>
std::string show(const Matrix<size> &m) {
  std::string text;
  for (float value : m)
    text += fmt::format("{}{:a}", text.empty() ? "" : ", ", value);
  return text;
}

/// The largest element of A X - I, in rounding units of the largest element of |A| |X| in its row:
/// how far the product is from what arithmetic of this precision can give, whatever the matrix's
/// condition, and the scale of its columns.
template <int size>
double residual(const Matrix<size> &a, const Matrix<size> &x) {
  double worst = 0;
  for (int row = 0; row < size; ++row) {
    Precise error = 0, largest = 1;
    for (int column = 0; column < size; ++column) {
      Precise sum = row == column ? -1 : 0, magnitudes = 0;
      for (int k = 0; k < size; ++k) {
        if (!std::isfinite(x[size * column + k]))
          return std::numeric_limits<double>::infinity();
        const Precise product = Precise(a[size * k + row]) * Precise(x[size * column + k]);
        sum += product;
        magnitudes += abs(product);
      }
      error = std::max(error, Precise(abs(sum)));
      largest = std::max(largest, magnitudes);
    }
    worst = std::max(worst, static_cast<double>(error / (largest * Precise(0x1p-24))));
  }
  return worst;
}

template <int size>
Precise determinantOf(const Matrix<size> &m, Precise &magnitudes) {
  // By permutations: exact.
  std::array<int, size> order;
  for (int i = 0; i < size; ++i)
    order[i] = i;
  Precise sum = 0;
  magnitudes = 0;
  do {
    int inversions = 0;
    for (int i = 0; i < size; ++i)
      for (int j = i + 1; j < size; ++j)
        inversions += order[i] > order[j];
    Precise product = inversions % 2 ? -1 : 1;
    for (int i = 0; i < size; ++i)
      product *= Precise(m[size * i + order[i]]);
    sum += product;
    magnitudes += abs(product);
  } while (std::next_permutation(order.begin(), order.end()));
  return sum;
}

template <int size>
Matrix<size> randomMatrix(Random &random) {
  Matrix<size> m;
  for (float &value : m)
    value = random.between(-1, 1);
  return m;
}

/// Each column times a power of ten: what scale(1, 1, 1e-7) does to a transform.
template <int size>
void scaleColumns(Random &random, Matrix<size> &m, float most) {
  for (int column = 0; column < size; ++column) {
    const float scale = std::pow(10.0f, random.between(-most, most));
    for (int row = 0; row < size; ++row)
      m[size * column + row] *= scale;
  }
}

/// Hilbert's matrix times a power of two, its columns in any order.
Outcome runHilbert(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Matrix<4> m;
    std::array<int, 4> order = {0, 1, 2, 3};
    if (i != 0)
      for (int k = 3; k > 0; --k)
        std::swap(order[k], order[random.integer(0, k)]);
    const float scale = i == 0 ? 1 : std::ldexp(1.0f, random.integer(-30, 30));
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        m[4 * column + row] = scale / float(order[column] + row + 1);
    worst.add(residual<4>(m, inverses<4>(path).inverse(m)), [&] { return show<4>(m); });
  }
  return worst.outcome();
}

/// A transform as scenes have them: a rotation, or any matrix, scaled by (1, 1, 1e-7) or worse, and
/// moved.
Outcome runScaled(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Matrix<4> m = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e-7f, 0, 0, 0, 0, 1};
    if (i != 0) {
      const Matrix<3> upper = randomMatrix<3>(random);
      Matrix<3> scaled = upper;
      scaleColumns<3>(random, scaled, 7);
      for (int column = 0; column < 3; ++column)
        std::copy_n(&scaled[3 * column], 3, &m[4 * column]);
      for (int row = 0; row < 3; ++row)
        m[12 + row] = random.between(-100, 100);
    }
    worst.add(residual<4>(m, inverses<4>(path).inverse(m)), [&] { return show<4>(m); });
  }
  return worst.outcome();
}

/// 3 x 3 matrices of any scale whose determinant keeps at least a hundredth of its terms. (The
/// adjugate shares the determinant's relative error.)
Outcome runThree(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Matrix<3> m = randomMatrix<3>(random);
    scaleColumns<3>(random, m, 12);
    Precise magnitudes;
    const Precise determinant = determinantOf<3>(m, magnitudes);
    if (abs(determinant) < magnitudes / 100)
      continue;
    worst.add(residual<3>(m, inverses<3>(path).inverse(m)), [&] { return show<3>(m); });
  }
  return worst.outcome();
}

/// Determinants, in rounding units of the sum of the magnitudes of their terms.
Outcome runDeterminants(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const auto judge = [&](float value, const Precise &exact, const Precise &magnitudes,
                         auto describe) {
    worst.add(static_cast<double>(abs(Precise(value) - exact) / (magnitudes * Precise(0x1p-24))),
              describe);
  };
  for (std::uint64_t i = 0; i < cases; ++i) {
    Precise magnitudes;
    if (i % 2) {
      Matrix<4> m = randomMatrix<4>(random);
      scaleColumns<4>(random, m, 4);
      const Precise exact = determinantOf<4>(m, magnitudes);
      judge(inverses<4>(path).determinant(m), exact, magnitudes, [&] { return show<4>(m); });
    } else {
      Matrix<3> m = randomMatrix<3>(random);
      scaleColumns<3>(random, m, 4);
      const Precise exact = determinantOf<3>(m, magnitudes);
      judge(inverses<3>(path).determinant(m), exact, magnitudes, [&] { return show<3>(m); });
    }
  }
  return worst.outcome();
}

double nanosecondsAnInverse(Path path) {
  constexpr int count = 100'000;
  Random random(1);
  const Matrix<4> m = randomMatrix<4>(random);
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += inverses<4>(path).determinant(m);
    return sum;
  });
}

} // namespace

std::vector<Row> matrixRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAnInverse);
  const char *unit = "of A X - I, rounding units of the row of abs(A) abs(X)";
  return {
      row("matrices.hilbert", "the inverse of Hilbert's 4 x 4 matrix, its columns in any order",
          unit, 10'000, runHilbert),
      row("matrices.scaled",
          "inverses of scale(1, 1, 1e-7), and of random transforms with columns from 1e-7 to 1e7",
          unit, 200'000, runScaled),
      row("matrices.three", "inverses of 3 x 3 matrices with columns from 1e-12 to 1e12", unit,
          200'000, runThree),
      row("matrices.determinants",
          "determinants of 3 x 3 and 4 x 4 matrices with columns from 1e-4 to 1e4",
          "rounding units of the terms' magnitudes", 200'000, runDeterminants),
  };
}

} // namespace rtsl::numerics
