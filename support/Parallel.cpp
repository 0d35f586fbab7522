//===- Parallel.cpp -------------------------------------------------------===//
#include "support/Parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace rtsl {

namespace {

void forEachInArena(std::size_t count, const std::function<void(std::size_t)> &work) {
  using Range = tbb::blocked_range<std::size_t>;
  // TBB's threads have the settings of the call that started them. That may be Embree's, which
  // flushes denormal numbers to zero while it builds a tree.
  using Context = tbb::task_group_context;
  Context callersSettings(Context::isolated, Context::default_traits | Context::fp_settings);
  const auto some = [&](const Range &range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      work(i);
  };
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(Range(0, count), some, tbb::simple_partitioner(), callersSettings);
  });
}

} // namespace

void forEachInParallel(unsigned threads, std::size_t count,
                       const std::function<void(std::size_t)> &work) {
  if (threads == 1 || count <= 1) { // TBB need not start
    for (std::size_t i = 0; i < count; ++i)
      work(i);
    return;
  }
  // More threads than cores: TBB would print a warning.
  if (threads == 0 || threads >= unsigned(tbb::this_task_arena::max_concurrency()))
    return forEachInArena(count, work);
  tbb::task_arena(int(threads)).execute([&] { forEachInArena(count, work); });
}

void forRangesInParallel(unsigned threads, std::size_t count, std::size_t atOnce,
                         const std::function<void(std::size_t, std::size_t)> &work) {
  forEachInParallel(threads, (count + atOnce - 1) / atOnce, [&](std::size_t range) {
    work(range * atOnce, std::min(count, (range + 1) * atOnce));
  });
}

} // namespace rtsl
