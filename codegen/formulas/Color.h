//===- Color.h - colors of as many components as the target chooses -------===//
#pragma once

#include "codegen/formulas/Emitter.h"

namespace rtsl::lowering {

/// `color(x)`: x in each component.
Num colorOfGrey(Num x, unsigned components);
/// `color(r, g, b)`, by language/ColorBasis.h: a sum of r, g and b times a constant each, red
/// first.
Num colorOfRgb(Num red, Num green, Num blue, unsigned components);
/// `luminance(c)`: the components times constant weights, summed from the first on. Equal to the
/// luminance of r, g and b for a color made of these, but for rounding (at most 4e-7 of the largest
/// of them).
Num luminance(Num color);

} // namespace rtsl::lowering
