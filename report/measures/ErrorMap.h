//===- ErrorMap.h - the errors of a picture, in false colours -------------===//
#pragma once

#include "report/measures/Flip.h"
#include "runtime/image/Image.h"

#include <string>

namespace rtsl::report {

/// FLIP's errors from 0 (black) through violet and orange to 1 (pale yellow), in linear light.
runtime::Image colorFlipMap(const FlipMap &map);

/// A map of one channel on a logarithmic scale from `low` (black) to `high` (pale yellow).
runtime::Image colorLogMap(const runtime::Image &map, double low, double high);

/// "data:image/png;base64,...": a picture embedded in a page.
std::string dataUrl(const runtime::Image &rgb);

} // namespace rtsl::report
