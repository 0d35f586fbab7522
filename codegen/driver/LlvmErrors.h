//===- LlvmErrors.h - what becomes of LLVM's own failures ------------------===//
#pragma once

namespace rtsl {

/// Where LLVM has no memory it calls `end`, which must not return, in place of aborting.
void onLlvmOutOfMemory(void (*end)());

} // namespace rtsl
