//===- ColorBasis.h - RGB and spectra of K components ---------------------===//
//
// A color of K > 3 components is a spectrum: the means over K equal bins of [380 nm, 720 nm]. An
// author's RGB triple becomes r R + g G + b B, where R, G and B are three smooth bands that sum to
// one at each wavelength:
//
//   B = 1 - s(460, 520), R = s(550, 610), G = 1 - B - R, s(a, b) the cubic step from 0 at a to 1 at
//   b.
//
// So no component is ever negative, white is flat, and a reflectance of at most 1 remains at most 1
// (the requirements of Smits, "An RGB-to-Spectrum Conversion for Reflectances", 1999). The inverse
// is the least-squares projection on the bands (their pseudo-inverse), which restores a triple
// exactly: in single precision the error is at most 4e-7 of its largest component. The luminance of
// a spectrum is that of its projection.
//
// K = 1 is luminance; K = 2 is luminance twice, because two bins cannot represent three numbers. K
// = 3 is RGB unchanged.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

namespace rtsl {

/// Luminance of linear RGB with the primaries of ITU-R BT.709 (Rec. 709, item 3.2).
constexpr double luminanceWeights[3] = {0.2126, 0.7152, 0.0722};

struct ColorBasis {
  /// Component i of the color of an RGB triple is the sum over j of toColor[i][j] * rgb[j].
  std::vector<std::vector<double>> toColor;
  /// RGB component j of a color is the sum over i of toRgb[j][i] * color[i].
  std::vector<std::vector<double>> toRgb;
};

namespace detail {
inline double cubicStep(double low, double high, double x) {
  double t = (x - low) / (high - low);
  t = t < 0 ? 0 : t > 1 ? 1 : t;
  return t * t * (3 - 2 * t);
}

/// Inverts a symmetric 3x3 matrix by its adjugate.
inline void invert3(const double (&m)[3][3], double (&inverse)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      inverse[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  const double determinant =
      m[0][0] * inverse[0][0] + m[0][1] * inverse[1][0] + m[0][2] * inverse[2][0];
  for (auto &row : inverse)
    for (double &element : row)
      element /= determinant;
}
} // namespace detail

/// The basis for colors of `components` components, 1 or more.
inline ColorBasis makeColorBasis(std::size_t components) {
  assert(components >= 1);
  ColorBasis basis;
  basis.toColor.assign(components, std::vector<double>(3, 0.0));
  basis.toRgb.assign(3, std::vector<double>(components, 0.0));
  if (components < 3) {
    for (std::size_t i = 0; i < components; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        basis.toColor[i][j] = luminanceWeights[j];
        basis.toRgb[j][i] = 1.0 / static_cast<double>(components);
      }
    return basis;
  }
  if (components == 3) {
    for (std::size_t i = 0; i < 3; ++i)
      basis.toColor[i][i] = basis.toRgb[i][i] = 1.0;
    return basis;
  }

  constexpr double shortest = 380, longest = 720;
  constexpr std::size_t samples = 64; // per bin
  const double step = (longest - shortest) / static_cast<double>(components * samples);
  for (std::size_t i = 0; i < components; ++i) {
    double red = 0, blue = 0;
    for (std::size_t j = 0; j < samples; ++j) {
      const double wavelength = shortest + (static_cast<double>(i * samples + j) + 0.5) * step;
      blue += 1 - detail::cubicStep(460, 520, wavelength);
      red += detail::cubicStep(550, 610, wavelength);
    }
    basis.toColor[i] = {red / samples, 1 - red / samples - blue / samples, blue / samples};
  }

  double gram[3][3] = {}, inverse[3][3];
  for (const std::vector<double> &row : basis.toColor)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        gram[i][j] += row[i] * row[j];
  detail::invert3(gram, inverse);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < components; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        basis.toRgb[i][k] += inverse[i][j] * basis.toColor[k][j];
  return basis;
}

} // namespace rtsl
