//===- KeyFrames.h - values that change from frame to frame ----------------===//
#pragma once

#include "scenefile/json/JsonValue.h"
#include "support/ErrorCollector.h"

#include <cstddef>
#include <set>
#include <vector>

namespace rtsl::scene {

/// Where a frame is among keys: at one, or at a share of the way from one to the next.
struct FramePlace {
  std::size_t key;
  std::size_t next; // the same key: there is none to interpolate with
  double share;
};

/// `frames` of the keys, which ascend. Before the first and after the last it is at that.
FramePlace placeAmong(const std::vector<double> &frames, double frame);

/// The number at a share of the way to `next`.
inline double between(double number, double next, double share) {
  return number + share * (next - number);
}

/// Replaces each {"frames": {"0": ..., "24": ...}} in a scene by its value at the frame: that of a
/// key, interpolated linearly between two, or that of the first or last key outside of them. With
/// "interpolate": "step" it is that of the last key so far. All key frames of the scene are
/// checked, whatever the frame is; where there are errors, the value is that of a key. Gives the
/// frames that have keys.
std::set<double> resolveKeyFrames(JsonValue &root, double frame, ErrorCollector &errors);

/// An error about a value, which may be the fault of its key frames: with a note if it was meant to
/// have some, or is between two of them.
Error aboutKeyFrames(Error error, const JsonValue &value);

} // namespace rtsl::scene
