//===- DeviceBitcode.h - the device runtime as LLVM bitcode ---------------===//
//
// runtime/device compiled twice, for the host (x86-64-v3) and for GPUs (nvptx64), to be linked into
// compiled shaders. The slots of Slots.def and the functions of split programs remain undefined.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <string_view>

namespace rtsl::runtime {

/// The functions that Abi.h declares as "defined by the runtime", except rtsl_traverse, which the
/// host defines (runtime/embree/HostScene.h), and the elementary functions.
std::string_view deviceBitcode();
std::string_view gpuDeviceBitcode();

/// rtsl_traverse of the host in scenes of a few primitives
/// (runtime/device/engines/ListTraversal.cpp).
std::string_view listTraversalBitcode();

/// rtsl_traverse and the functions that run lanes: for self-contained programs
/// (runtime/device/organisations/Megakernel.h).
std::string_view megakernelBitcode();
std::string_view gpuMegakernelBitcode();

/// The functions that run a wavefront (runtime/device/organisations/Wavefront.h).
std::string_view wavefrontBitcode();
std::string_view gpuWavefrontBitcode();

/// The functions that run persistent blocks (runtime/device/organisations/Persistent.h).
std::string_view persistentBitcode();
std::string_view gpuPersistentBitcode();

/// memcpy and similar functions, for host machine code that runs without a C library.
std::string_view hostMemoryBitcode();

} // namespace rtsl::runtime
