//===- MachineStack.h - memory for rays in flight -------------------------===//
//
// Memory for the rays of the machine of split shaders (runtime/device/engines/Machine.h): one block
// per fiber of a thread, as large as the depth limit and the largest frame require, so it cannot
// overflow.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>

namespace rtsl::runtime {

/// How often, in this process, there was no memory for the stack of a thread; those samples
/// are black. The largest request in bytes is in `largest`, if given.
std::uint64_t failedMachineStacks(std::uint64_t *largest = nullptr);

} // namespace rtsl::runtime
