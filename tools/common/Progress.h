//===- Progress.h - a progress line on the terminal ---------------------===//
#pragma once

#include "support/Clock.h"

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace rtsl::tool {

/// Shows nothing unless standard error is a terminal.
class Progress {
public:
  explicit Progress(std::string what);
  ~Progress() { finish(); }
  /// `share` in [0, 1]; drawn at most ten times a second.
  void update(double share);
  /// For a rendering without a known end: shows `state`.
  void update(const std::string &state);
  /// Wipes the line.
  void finish();

private:
  bool isTime();

  std::string what;
  bool enabled, drawn = false;
  Clock::time_point start, last;
};

/// While it exists, the name of a phase whose end is not known, such as reading files, and the
/// seconds that it takes.
class PhaseProgress {
public:
  explicit PhaseProgress(std::string what);
  ~PhaseProgress();

private:
  void run();

  const std::string what;
  std::mutex mutex; // for isOver
  std::condition_variable changed;
  bool isOver = false;
  std::thread thread; // none unless standard error is a terminal
};

} // namespace rtsl::tool
