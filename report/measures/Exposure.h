//===- Exposure.h - the exposure for showing a picture --------------------===//
#pragma once

#include "runtime/image/Image.h"

namespace rtsl::report {

/// The exposure in stops for viewing an RGB picture in linear light on a screen: 0 if it can be
/// shown unchanged; otherwise within half a stop of the one that maps the brightest pixels, except
/// for 2 %, to 0.9.
double stopsFor(const runtime::Image &rgb);

/// The share of pixels with a channel brighter than a screen.
double shareBeyondScreen(const runtime::Image &rgb);

/// The picture with that exposure.
runtime::Image exposed(runtime::Image rgb, double stops);

} // namespace rtsl::report
