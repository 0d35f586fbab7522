#include "runtime/render/Watch.h"

#include "support/Clock.h"
#include "support/Error.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace rtsl::runtime {

static constexpr double infinite = std::numeric_limits<double>::infinity();

void Watch::advance(std::uint64_t all) {
  std::lock_guard<std::mutex> lock(mutex);
  ++done;
  report(double(done) / double(all));
}

Watch::Poll::Poll(const Watch &watch, double seconds, std::function<double()> share,
                  std::function<void()> stop)
    : watch(watch), seconds(seconds), share(std::move(share)), stop(std::move(stop)) {
  if (watch.options.progress || watch.options.cancel || watch.whole || seconds < infinite)
    thread = std::thread([this] { run(); });
}

Watch::Poll::~Poll() {
  {
    std::lock_guard<std::mutex> lock(mutex);
    isOver = true;
  }
  ended.notify_one();
  if (thread.joinable())
    thread.join();
}

void Watch::Poll::run() {
  constexpr std::chrono::milliseconds pause(10);
  bool hasStopped = false;
  const auto start = Clock::now();
  const auto isOverTime = [&] { return secondsSince(start) >= seconds; };
  try {
    std::unique_lock<std::mutex> lock(mutex);
    while (!isOver) {
      lock.unlock();
      if (!hasStopped && (watch.isStopped() || isOverTime())) {
        stop();
        hasStopped = true;
      }
      if (watch.options.progress)
        watch.report(std::min(1.0, share()));
      lock.lock();
      ended.wait_for(lock, pause, [this] { return isOver; });
    }
  } catch (const Error &) { // a failure of the device is reported by the wait for its program
  }
}

} // namespace rtsl::runtime
