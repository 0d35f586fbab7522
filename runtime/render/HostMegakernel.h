//===- HostMegakernel.h - the GPU's whole program on the CPU --------------===//
//
// A lane a thread, on a flat scene: nothing runs that does not run on a GPU. It is there to be
// compared with: the same bits, without the GPU.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/FlatScene.h"
#include "runtime/image/Image.h"
#include "runtime/program/Program.h"
#include "runtime/render/RenderOptions.h"

namespace rtsl::runtime {

/// Renders a scene that was not relocated yet. Throws OutOfRange, OutOfMemory, Cancelled.
Image renderOnHost(const MegakernelCode &code, FlatScene scene, const RenderOptions &options,
                   RenderStatistics *statistics = nullptr);

/// Makes `scene` a launch of the given size, depth and seed.
void setOptions(FlatScene &scene, const RenderOptions &options, RtslStatus *status);

/// What a job's status says of its rendering. Throws Cancelled if it was stopped and is not to be
/// kept as far as it is, Internal if lanes had too little memory.
void readStatus(const RtslStatus &status, const RenderOptions &options,
                RenderStatistics &statistics);

} // namespace rtsl::runtime
