//===- Progress.cpp - a progress line on the terminal -------------------===//
#include "Progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace rtsl::tool {

Progress::Progress(std::string what)
    : what(std::move(what)), enabled(isatty(STDERR_FILENO)), start(Clock::now()), last(start) {}

void Progress::update(double share) {
  const Clock::time_point now = Clock::now();
  if (!enabled || now - last < std::chrono::milliseconds(100))
    return;
  last = now;
  drawn = true;
  constexpr int width = 30;
  const int filled = static_cast<int>(share * width);
  const double elapsed = std::chrono::duration<double>(now - start).count();
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
