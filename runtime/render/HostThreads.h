//===- HostThreads.h - the threads of a rendering on the CPU --------------===//
#pragma once

#include "runtime/render/RenderOptions.h"

#include <cstdint>
#include <functional>

namespace rtsl::runtime {

class HostThreads {
public:
  /// The number of threads in the options, or one per core, but at most one per piece of work. Each
  /// has `stackBytes` of stack for the frames of shaders.
  HostThreads(const RenderOptions &options, std::uint64_t pieces, std::uint64_t stackBytes);

  unsigned count() const { return threads; }

  /// Runs `work(0)` ... `work(count() - 1)` in parallel, each on one thread. If memory is short
  /// some are skipped, but `work(0)` always runs: throws OutOfMemory if there is no stack for it.
  /// Rethrows exceptions of `work`.
  void run(const std::function<void(unsigned)> &work) const;

private:
  unsigned threads;
  std::uint64_t stackBytes;
};

} // namespace rtsl::runtime
