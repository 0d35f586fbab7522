//===- Report.cpp - costs and savings of splitting ------------------------===//
#include "codegen/passes/continuation/Report.h"

#include "runtime/device/engines/Machine.h"

#include <algorithm>

namespace rtsl {

std::uint32_t SplitReport::stateCount() const {
  std::size_t count = 0;
  for (const FunctionReport &function : functions)
    count += function.states.size();
  return static_cast<std::uint32_t>(count);
}

std::uint32_t SplitReport::frameSize() const {
  std::uint32_t size = 0;
  for (const FunctionReport &function : functions)
    size = std::max(size, function.frame.size);
  return frameAreas.empty() ? size : std::max(size, frameAreas.front());
}

std::uint32_t SplitReport::frameGrowth() const {
  return frameAreas.size() < 2 ? 0 : frameAreas.back() - frameAreas[frameAreas.size() - 2];
}

std::uint64_t SplitReport::levelBytes() const {
  return device::levelSize(std::uint64_t(frameSize()), keptWords);
}

} // namespace rtsl
