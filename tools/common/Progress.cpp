//===- Progress.cpp - a progress line on the terminal -------------------===//
#include "Progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>
#include <utility>

namespace rtsl::tool {

Progress::Progress(std::string what)
    : what(std::move(what)), enabled(isatty(STDERR_FILENO)), start(Clock::now()), last(start) {}

bool Progress::isTime() {
  const Clock::time_point now = Clock::now();
  if (!enabled || now - last < std::chrono::milliseconds(100))
    return false;
  last = now;
  drawn = true;
  return true;
}

void Progress::update(const std::string &state) {
  if (!isTime())
    return;
  fmt::print(stderr, "\r\033[K{}: {}", what, state);
  std::fflush(stderr);
}

void Progress::update(double share) {
  if (!isTime())
    return;
  constexpr int width = 30;
  const int filled = static_cast<int>(share * width);
  const double elapsed = std::chrono::duration<double>(last - start).count();
  const std::string left =
      share > 0.01 ? fmt::format("{:.0f} s left", elapsed / share - elapsed) : "";
  fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} %  {}", what, std::string(filled, '#'),
             std::string(width - filled, '.'), share * 100, left);
  std::fflush(stderr);
}

void Progress::finish() {
  if (drawn)
    fmt::print(stderr, "\r\033[K");
  drawn = false;
}

PhaseProgress::PhaseProgress(std::string what) : what(std::move(what)) {
  if (isatty(STDERR_FILENO))
    thread = std::thread([this] { run(); });
}

PhaseProgress::~PhaseProgress() {
  if (!thread.joinable())
    return;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    isOver = true;
  }
  changed.notify_one();
  thread.join();
  fmt::print(stderr, "\r\033[K");
}

void PhaseProgress::run() {
  const auto start = Clock::now();
  std::unique_lock<std::mutex> lock(mutex);
  do {
    const std::chrono::duration<double> seconds = Clock::now() - start;
    fmt::print(stderr, "\r\033[K{}: {:.1f} s", what, seconds.count());
    std::fflush(stderr);
  } while (!changed.wait_for(lock, std::chrono::milliseconds(100), [this] { return isOver; }));
}

} // namespace rtsl::tool
