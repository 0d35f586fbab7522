//===- Parallel.h - the same work for many numbers, on all cores ----------===//
#pragma once

#include <cstddef>
#include <functional>

namespace rtsl {

/// Calls `work(0)` ... `work(count - 1)`, in any order, on up to this number of threads of TBB; 0:
/// one per core. Each call computes with the floating-point settings of the caller. While this
/// thread waits it runs no other work, so the caller may hold a lock. If calls of `work` throw, one
/// of their exceptions is rethrown.
///
/// Calls of `work` must not wait for each other: they may run one after the other. What must run at
/// the same time, or needs a large stack, runs on WorkerThreads.h.
void forEachInParallel(unsigned threads, std::size_t count,
                       const std::function<void(std::size_t)> &work);

/// The same for ranges of up to `atOnce` numbers below `count`: calls work(first, end).
void forRangesInParallel(unsigned threads, std::size_t count, std::size_t atOnce,
                         const std::function<void(std::size_t, std::size_t)> &work);

/// The same for work that takes less time than a call through std::function: calls work(i) for all
/// i below `count`, and `atOnce` of them one after the other, where `work` can be inlined.
template <typename Work>
void forEachInParallel(unsigned threads, std::size_t count, std::size_t atOnce, const Work &work) {
  forRangesInParallel(threads, count, atOnce, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      work(i);
  });
}

} // namespace rtsl
