//===- LlvmErrors.h - handling of LLVM's own failures ---------------------===//
#pragma once

namespace rtsl {

/// If LLVM runs out of memory it calls `end`, which must not return, instead of aborting.
void onLlvmOutOfMemory(void (*end)());

} // namespace rtsl
