#include "runtime/render/HostThreads.h"

#include "support/WorkerThreads.h"

#include <algorithm>

namespace rtsl::runtime {

HostThreads::HostThreads(const RenderOptions &options, std::uint64_t pieces,
                         std::uint64_t stackBytes)
    : threads(unsigned(std::min<std::uint64_t>(threadCount(options), pieces))),
      stackBytes(stackBytes) {}

void HostThreads::run(const std::function<void(unsigned)> &work) const {
  runOnThreads(threads, stackBytes, work);
}

} // namespace rtsl::runtime
