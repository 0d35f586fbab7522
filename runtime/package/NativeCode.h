//===- NativeCode.h - machine code of a package in this process -----------===//
#pragma once

#include "runtime/package/Package.h"
#include "runtime/program/Program.h"

namespace rtsl::runtime {

/// Holds a copy of an image in memory that may be executed, as long as it lives.
class NativeCode {
public:
  /// Throws OutOfMemory, or NotSupported where the system allows no such memory.
  explicit NativeCode(const NativeImage &image);
  ~NativeCode();
  NativeCode(const NativeCode &) = delete;
  NativeCode &operator=(const NativeCode &) = delete;

  MegakernelCode entries() const;

private:
  void *memory = nullptr;
  std::size_t size = 0;
  std::uint64_t laneBytes, runLane, stackBytes;
};

} // namespace rtsl::runtime
