//===- Color.h - colors of as many components as the target chooses -------===//
#pragma once

#include "codegen/formulas/Emitter.h"

namespace rtsl::lowering {

/// `color(x)`: x in each component.
Num colorOfGrey(Num x, unsigned components);
/// `color(r, g, b)`, by language/ColorBasis.h: a sum of r, g and b times a constant each, red
/// first.
Num colorOfRgb(Num red, Num green, Num blue, unsigned components);

} // namespace rtsl::lowering
