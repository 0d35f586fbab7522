//===- Color.cpp - colors of as many components as the target chooses -----===//
#include "codegen/formulas/Color.h"

#include "language/ColorBasis.h"

namespace rtsl::lowering {

// Each component a constant of its own.
static Num constantVector(Emitter &emitter, const std::vector<double> &values) {
  llvm::SmallVector<float, 16> floats(values.begin(), values.end());
  auto type =
      mlir::VectorType::get({static_cast<std::int64_t>(floats.size())}, emitter.getF32Type());
  return {emitter, emitter.make<mlir::arith::ConstantOp>(
                       mlir::DenseElementsAttr::get(type, llvm::ArrayRef<float>(floats)))};
}

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
    return constantVector(emitter, values);
  };
  Num redPart = red * band(0), greenPart = green * band(1), bluePart = blue * band(2);
  return (redPart + greenPart) + bluePart;
}

Num luminance(Num color) {
  ColorBasis basis = makeColorBasis(color.count());
  std::vector<double> weights(color.count(), 0.0);
  for (unsigned i = 0; i < color.count(); ++i)
    for (unsigned j = 0; j < 3; ++j)
      weights[i] += luminanceWeights[j] * basis.toRgb[j][i];
  if (color.count() == 1)
    return color[0]; // the one component is it
  Num products = color * constantVector(color.at(), weights);
  Num sum = products[0];
  for (unsigned i = 1; i < color.count(); ++i)
    sum = sum + products[i];
  return sum;
}

} // namespace rtsl::lowering
