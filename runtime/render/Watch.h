//===- Watch.h - progress and cancellation of a rendering -----------------===//
#pragma once

#include "runtime/render/RenderOptions.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace rtsl::runtime {

/// Connects the caller of one rendering with the threads that render. Threads that can call back
/// use isStopped and advance; programs that cannot are polled.
class Watch {
public:
  /// Watches a part of what `whole` watches; null: a whole rendering.
  explicit Watch(const RenderOptions &options, const Watch *whole = nullptr)
      : options(options), whole(whole) {}

  /// Whether the caller cancelled, or stop() was called. Cheap; callable from any thread.
  bool isStopped() const {
    return stopped.load(std::memory_order_relaxed) ||
           (options.cancel && options.cancel->load(std::memory_order_relaxed)) ||
           (whole && whole->isStopped());
  }
  void stop() { stopped = true; }

  /// Reports the share that is done, in [0, 1]. One thread at a time calls it.
  void report(double share) const {
    if (options.progress)
      options.progress(share);
  }
  /// Reports that one more of `all` pieces is done. Callable from any thread.
  void advance(std::uint64_t all);

  /// During its lifetime a thread calls `share` every 10 ms and reports its result, the share that
  /// is done, in [0, 1]; it calls `stop` once, after the caller cancelled or after `seconds`.
  /// Without any of these there is no thread. An Error from `share` or `stop` ends only this
  /// thread.
  class Poll {
  public:
    Poll(const Watch &watch, double seconds, std::function<double()> share,
         std::function<void()> stop);
    ~Poll();
    Poll(const Poll &) = delete;
    Poll &operator=(const Poll &) = delete;

  private:
    void run();

    const Watch &watch;
    const double seconds;
    const std::function<double()> share;
    const std::function<void()> stop;
    std::mutex mutex;
    std::condition_variable ended;
    bool isOver = false;
    std::thread thread;
  };

private:
  const RenderOptions &options;
  const Watch *const whole;
  std::atomic<bool> stopped{false};
  std::mutex mutex;
  std::uint64_t done = 0;
};

} // namespace rtsl::runtime
