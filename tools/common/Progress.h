//===- Progress.h - a progress line on the terminal ---------------------===//
#pragma once

#include <chrono>
#include <string>

namespace rtsl::tool {

/// Shows nothing unless standard error is a terminal.
class Progress {
public:
  explicit Progress(std::string what);
  ~Progress() { finish(); }
  /// `share` in [0, 1]; drawn at most ten times a second.
  void update(double share);
  /// Of a rendering without a known end. `state` is shown.
  void update(const std::string &state);
  /// Wipes the line.
  void finish();

private:
  using Clock = std::chrono::steady_clock;
  bool isTime();

  std::string what;
  bool enabled, drawn = false;
  Clock::time_point start, last;
};

} // namespace rtsl::tool
