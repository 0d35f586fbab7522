//===- Findings.h - what went wrong with programs --------------------------===//
#pragma once

#include <cstddef>
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
  bool hit = false;    // some ray met something, so that a material ran
  std::string refused; // why a path could not take the program yet, though it is valid
};

/// Do the findings of a batch of `count` programs say nothing of the single ones? Then each half of
/// it is to run on its own: no program is known to be rejected as long as others stand beside it,
/// for together they may be more than the language allows.
bool areOfBatch(const std::vector<Finding> &findings, std::size_t count);

} // namespace rtsl::random
