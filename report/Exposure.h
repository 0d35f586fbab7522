//===- Exposure.h - how bright pictures are shown -------------------------===//
#pragma once

#include "runtime/image/Image.h"

namespace rtsl::report {

/// The exposure in stops at which an RGB picture in linear light can be looked at on a screen: 0
/// where it can be as it is; or else half a stop or less from the one that brings the brightest but
/// 2 % of its pixels to 0.9.
double stopsFor(const runtime::Image &rgb);

/// The share of pixels of which some channel is brighter than a screen.
double shareBeyondScreen(const runtime::Image &rgb);

/// The picture with that exposure.
runtime::Image exposed(runtime::Image rgb, double stops);

} // namespace rtsl::report
