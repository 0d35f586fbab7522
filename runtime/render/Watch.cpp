#include "runtime/render/Watch.h"

#include "support/Error.h"

#include <algorithm>
#include <chrono>

namespace rtsl::runtime {

void Watch::advance(std::uint64_t all) {
  std::lock_guard<std::mutex> lock(mutex);
  ++done;
  if (options.progress)
    options.progress(double(done) / double(all));
}

Watch::Poll::Poll(const Watch &watch, std::function<double()> share, std::function<void()> stop)
    : watch(watch), share(std::move(share)), stop(std::move(stop)) {
  if (watch.options.progress || watch.options.cancel)
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
  try {
    std::unique_lock<std::mutex> lock(mutex);
    while (!isOver) {
      lock.unlock();
      if (!hasStopped && watch.isStopped()) {
        stop();
        hasStopped = true;
      }
      if (watch.options.progress)
        watch.options.progress(std::min(1.0, share()));
      lock.lock();
      ended.wait_for(lock, pause, [this] { return isOver; });
    }
  } catch (const Error &) { // a failure of the device is reported by the wait for its program
  }
}

} // namespace rtsl::runtime
