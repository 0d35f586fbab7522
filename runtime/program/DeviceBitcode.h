//===- DeviceBitcode.h - the device runtime as LLVM bitcode ---------------===//
//
// runtime/device compiled twice, for the host (x86-64-v3) and for GPUs (nvptx64), to be linked into
// compiled shaders. The slots of Slots.def and the functions of split programs stay open.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <string_view>

namespace rtsl::runtime {

/// What Abi.h calls "defined by the runtime" but rtsl_traverse, which the host defines
/// (runtime/embree/HostScene.h), and the elementary functions.
std::string_view deviceBitcode();
std::string_view gpuDeviceBitcode();

/// rtsl_traverse and what runs lanes: for programs that need nobody else
/// (runtime/device/engines/Megakernel.h).
std::string_view megakernelBitcode();
std::string_view gpuMegakernelBitcode();

/// memcpy and the like, for machine code of the host that runs without a C library.
std::string_view hostMemoryBitcode();

} // namespace rtsl::runtime
