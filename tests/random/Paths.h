//===- Paths.h - the ways to run a program, which all agree ---------------===//
#pragma once

#include "Program.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::random {

/// What went wrong with a program.
enum class Failure : std::uint8_t {
  None,
  Rejected, // the front end or the linker does not take it, though it is valid
  Fault,    // the compiler found a fault of its own
  Crash,    // a signal
  Hang,
  Mismatch, // two paths disagree
};
const char *name(Failure failure);

struct Finding {
  Failure failure = Failure::None;
  std::string detail;
  bool hit = false; // some ray met something, so that a material ran
};

/// Runs the programs, compiled together, on every path whose name is in `wanted` and that can run
/// them, and compares with the first path. `wanted` empty: with the one that differs most. One
/// finding a program; a Rejected or Fault of the whole stands at all of them.
std::vector<Finding> compare(const std::vector<const Program *> &programs,
                             const std::vector<std::string> &wanted);

std::vector<std::string> pathNames();

} // namespace rtsl::random
