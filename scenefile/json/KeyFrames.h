//===- KeyFrames.h - values that change from frame to frame ----------------===//
#pragma once

#include "scenefile/json/JsonValue.h"
#include "support/ErrorCollector.h"

namespace rtsl::scene {

/// Replaces each {"frames": {"0": ..., "24": ...}} in a scene by its value at the frame: that of a
/// key, interpolated linearly between two, or that of the first or last key outside of them. With
/// "interpolate": "step" it is that of the last key so far. All key frames of the scene are
/// checked, whatever the frame is.
void resolveKeyFrames(JsonValue &root, double frame, ErrorCollector &errors);

} // namespace rtsl::scene
