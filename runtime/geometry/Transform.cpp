#include "runtime/geometry/Transform.h"

#include <cmath>
#include <limits>

namespace rtsl::runtime {

Transform Transform::translate(double x, double y, double z) {
  Transform result;
  result.columns[3] = {x, y, z};
  return result;
}

Transform Transform::scale(double x, double y, double z) {
  Transform result;
  result.columns[0][0] = x;
  result.columns[1][1] = y;
  result.columns[2][2] = z;
  return result;
}

// Rodrigues' formula. Quarter turns are exact, because they are frequent in scenes.
Transform Transform::rotate(const std::array<double, 3> &axis, double degrees) {
  double length = std::hypot(axis[0], axis[1], axis[2]);
  double x = axis[0] / length, y = axis[1] / length, z = axis[2] / length;
  double turn = std::remainder(degrees, 360.0), radians = turn * (3.14159265358979323846 / 180);
  double c = std::cos(radians), s = std::sin(radians);
  if (turn == 90 || turn == -90)
    c = 0;
  if (std::fabs(turn) == 180)
    s = 0;
  Transform result;
  result.columns[0] = {c + x * x * (1 - c), y * x * (1 - c) + z * s, z * x * (1 - c) - y * s};
  result.columns[1] = {x * y * (1 - c) - z * s, c + y * y * (1 - c), z * y * (1 - c) + x * s};
  result.columns[2] = {x * z * (1 - c) + y * s, y * z * (1 - c) - x * s, c + z * z * (1 - c)};
  return result;
}

Transform Transform::then(const Transform &next) const {
  Transform result;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) {
      double sum = column == 3 ? next.columns[3][row] : 0;
      for (int k = 0; k < 3; ++k)
        sum += next.columns[k][row] * columns[column][k];
      result.columns[column][row] = sum;
    }
  return result;
}

double Transform::determinant() const {
  const auto &c = columns;
  return c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) -
         c[1][0] * (c[0][1] * c[2][2] - c[0][2] * c[2][1]) +
         c[2][0] * (c[0][1] * c[1][2] - c[0][2] * c[1][1]);
}

// Scaled by powers of two, so that neither products nor the determinant leave the range of a double
// for any matrix of floats.
LinearInverse invertLinear(const Transform &transform) {
  LinearInverse result{};
  result.condition = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (int column = 0; column < 3; ++column)
    for (double x : transform.columns[column])
      largest = std::fmax(largest, std::fabs(x));
  if (!(largest > 0 && std::isfinite(largest)))
    return result;
  const int exponent = std::ilogb(largest);
  double m[3][3]; // [column][row]
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      m[column][row] = std::ldexp(transform.columns[column][row], -exponent);
  double cofactors[3][3]; // [column][row] of the adjugate
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double back = m[i2][j1] * m[i1][j2];
      // Kahan's difference of products: exact to some units, even where the products cancel.
      cofactors[j][i] =
          std::fma(m[i1][j1], m[i2][j2], -back) + std::fma(-m[i2][j1], m[i1][j2], back);
    }
  const double determinant =
      m[0][0] * cofactors[0][0] + m[0][1] * cofactors[1][0] + m[0][2] * cofactors[2][0];
  if (determinant == 0)
    return result;
  double squares = 0, squaresOfInverse = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      const double inverse = cofactors[column][row] / determinant;
      squares += m[column][row] * m[column][row];
      squaresOfInverse += inverse * inverse;
      result.columns[column][row] = std::ldexp(inverse, -exponent);
    }
  result.condition = std::sqrt(squares) * std::sqrt(squaresOfInverse);
  return result;
}

std::array<std::array<double, 3>, 3> normalTransform(const Transform &transform) {
  const auto &c = transform.columns;
  const double sign = transform.determinant() < 0 ? -1 : 1;
  std::array<std::array<double, 3>, 3> cofactors;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactors[i][j] = sign * (c[i1][j1] * c[i2][j2] - c[i1][j2] * c[i2][j1]);
    }
  return cofactors;
}

} // namespace rtsl::runtime
