//===- DeviceBitcode.h - the device runtime as LLVM bitcode ---------------===//
#pragma once

#include <string_view>

namespace rtsl::runtime {

/// runtime/device compiled for the host (x86-64-v3), to be linked into compiled shaders. It defines
/// what Abi.h calls "defined by the runtime" but rtsl_traverse, which the host defines
/// (runtime/HostTraversal.h), and leaves the slots open.
std::string_view deviceBitcode();

} // namespace rtsl::runtime
