//===- WorkerThreads.h - threads with the stack that they need --------------===//
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace rtsl {

/// What our own code and Embree take of a stack beside the frames of shaders, generously.
constexpr std::uint64_t stackMargin = std::uint64_t(1) << 20;

/// Runs `work(0)` ... `work(count - 1)` at once, each on a thread with at least `stackBytes` of
/// stack beside stackMargin; this thread takes one of them if its own is large enough. Where
/// threads or memory for their stacks are few, some are left out, but `work(0)` always runs: throws
/// OutOfMemory, with the number of bytes, if there is no stack for it. What `work` throws comes
/// out.
void runOnThreads(unsigned count, std::uint64_t stackBytes,
                  const std::function<void(unsigned)> &work);

/// Calls `work(0)` ... `work(count - 1)`, in any order, on up to so many threads; 0: one for each
/// core. What `work` throws comes out.
void forEachOnThreads(unsigned threads, std::size_t count,
                      const std::function<void(std::size_t)> &work);

} // namespace rtsl
