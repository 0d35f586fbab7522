//===- TriangleBlocks.h - the triangles of a scene in blocks --------------===//
#pragma once

#include "runtime/accel/TriangleBlock.h"
#include "support/LargeArray.h"

#include <embree3/rtcore.h>

namespace rtsl::runtime {

/// All triangles of the launch in blocks of neighbouring ones, by Embree's builder. Errors of
/// Embree are reported through the device; throws std::bad_alloc.
LargeArray<TriangleBlock> makeTriangleBlocks(RTCDevice device, const RtslLaunch &launch,
                                             unsigned threads);

} // namespace rtsl::runtime
