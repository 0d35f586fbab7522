//===- Color.cpp - colors of as many components as the target chooses -----===//
#include "codegen/formulas/Color.h"

#include "language/ColorBasis.h"

namespace rtsl::lowering {

Num colorOfGrey(Num x, unsigned components) {
  return x.splat(components);
}

Num colorOfRgb(Num red, Num green, Num blue, unsigned components) {
  Emitter &emitter = red.at();
  if (components == 3)
    return {emitter, emitter.vector({red, green, blue})};
  ColorBasis basis = makeColorBasis(components);
  auto band = [&](unsigned index) {
    std::vector<double> values;
    for (const std::vector<double> &row : basis.toColor)
      values.push_back(row[index]);
    return red.constants(values);
  };
  Num redPart = red * band(0), greenPart = green * band(1), bluePart = blue * band(2);
  return (redPart + greenPart) + bluePart;
}

} // namespace rtsl::lowering
