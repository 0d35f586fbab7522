//===- WorkerThreads.h - threads with a stack of the required size --------===//
//
// For rendering, which needs a stack for the frames of shaders, and for what must run at the same
// time. All other parallel work is in Parallel.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <functional>

namespace rtsl {

/// The stack of our own code and Embree, in addition to the frames of shaders; a generous bound.
constexpr std::uint64_t stackMargin = std::uint64_t(1) << 20;

/// Runs `work(0)` ... `work(count - 1)` at the same time, each on a thread with at least
/// `stackBytes` of stack beside stackMargin; this thread runs one of them if its own is large
/// enough. If threads or memory for their stacks are scarce, some are left out, but `work(0)`
/// always runs: throws OutOfMemory, with the number of bytes, if there is no stack for it.
/// Exceptions of `work` are rethrown.
void runOnThreads(unsigned count, std::uint64_t stackBytes,
                  const std::function<void(unsigned)> &work);

} // namespace rtsl
