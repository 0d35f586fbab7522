//===- Color.h - luminance of colors of any number of components ----------===//
#pragma once

#include "language/ColorBasis.h"
#include "language/formulas/Operations.h"

namespace rtsl::formulas {

/// The components times constant weights, summed from the first on. Equal to the luminance of r, g
/// and b for a color made of these, but for rounding (at most 4e-7 of the largest of them).
template <typename Number>
Number luminance(Number color) {
  if (color.count() == 1)
    return color[0]; // the one component is it
  const ColorBasis basis = makeColorBasis(color.count());
  std::vector<double> weights(color.count(), 0.0);
  for (unsigned i = 0; i < color.count(); ++i)
    for (unsigned j = 0; j < 3; ++j)
      weights[i] += luminanceWeights[j] * basis.toRgb[j][i];
  Number products = color * color.constants(weights);
  Number sum = products[0];
  for (unsigned i = 1; i < color.count(); ++i)
    sum = sum + products[i];
  return sum;
}

} // namespace rtsl::formulas
