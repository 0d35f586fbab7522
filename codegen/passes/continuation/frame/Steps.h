//===- Steps.h - the layout of the frame ----------------------------------===//
//
// Steps with options or results, and their files; common/Steps.def has the others. Split.cpp calls
// them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/Steps.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::continuation {

/// A slot of the frame.
struct FrameSlot {
  std::string name;
  std::uint32_t offset = 0; // bytes
  std::uint32_t size = 0;   // bytes; for a bool, of its word
  int bit = -1;             // of a bool
  bool isObject = false;
};

struct FrameLayout {
  std::vector<FrameSlot> slots; // by offset, then bit, then first use
  std::uint32_t size = 0;       // bytes
  /// The size if values and objects shared no words, and bools no bits.
  std::uint32_t unshared = 0;
  /// A lower bound of the size: the most bytes that are live at one trace.
  std::uint32_t lowerBound = 0;
};

/// FrameLayout.cpp: assigns each saved value and each frame object its offset, and turns the
/// operands of suspends into loads and stores. The function gets `rtsl.frame_size` in bytes.
FrameLayout layoutFrame(FuncOp function);

} // namespace rtsl::continuation
