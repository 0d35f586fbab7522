//===- WorkerThreads.h - threads with a stack of the required size --------===//
#pragma once

#include <cstddef>
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

/// Calls `work(0)` ... `work(count - 1)`, in any order, on up to this number of threads; 0: one per
/// core. Exceptions of `work` are rethrown.
void forEachOnThreads(unsigned threads, std::size_t count,
                      const std::function<void(std::size_t)> &work);

} // namespace rtsl
