//===- Steps.h - where it is saved ----------------------------------------===//
//
// Each step lies in the file that is named here; Split.cpp calls them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::continuation {

/// FrameObjects.cpp: variables that are still in memory and live across a trace move to the frame.
void moveVariablesToFrame(FuncOp function);

/// IdleClears.cpp: of a program that is printed for people, no variable is cleared that is written
/// before it is read.
void removeIdleClears(FuncOp function);

/// A place in the frame.
struct FrameSlot {
  std::string name;
  std::uint32_t offset = 0; // bytes
  std::uint32_t size = 0;   // bytes; a bool's is that of the word which it is in
  int bit = -1;             // of a bool
  bool isObject = false;
};

struct FrameLayout {
  std::vector<FrameSlot> slots; // by offset, then bit, then first use
  std::uint32_t size = 0;       // bytes
  /// If no two values or objects shared words, nor bools.
  std::uint32_t unshared = 0;
  /// No frame is smaller: the most that is alive at one trace.
  std::uint32_t lowerBound = 0;
};

/// FrameLayout.cpp: gives each saved value and each frame object its place, and turns what suspends
/// pass into loads and stores. The function gets `rtsl.frame_size` in bytes.
FrameLayout layoutFrame(FuncOp function);

} // namespace rtsl::continuation
