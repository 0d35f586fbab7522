//===- Progress.cpp - a progress line on the terminal -------------------===//
#include "Progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

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

} // namespace rtsl::tool
