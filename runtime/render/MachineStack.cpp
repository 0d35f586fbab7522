//===- MachineStack.cpp - memory for rays in flight -----------------------===//
#include "runtime/render/MachineStack.h"

#include "runtime/device/ray/Abi.h"
#include "support/Fibers.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>

namespace {

std::atomic<std::uint64_t> failures{0}, largestFailure{0};

struct Free {
  void operator()(void *memory) const { std::free(memory); }
};

struct FiberMemory {
  std::unique_ptr<void, Free> memory;
  std::uint64_t size = 0;
};

} // namespace

extern "C" void *rtsl_machine_stack(std::uint64_t bytes) {
  thread_local std::array<FiberMemory, rtsl::Fibers::most> ofThread;
  FiberMemory &stack = ofThread[rtsl::Fibers::number()];
  if (bytes <= stack.size)
    return stack.memory.get();
  stack.memory.reset();
  stack.size = 0;
  constexpr std::uint64_t alignment = 64; // lines of the cache, so that threads share none
  std::uint64_t rounded = (bytes + alignment - 1) / alignment * alignment;
  stack.memory.reset(std::aligned_alloc(alignment, rounded));
  if (!stack.memory) {
    ++failures;
    std::uint64_t before = largestFailure;
    while (before < bytes && !largestFailure.compare_exchange_weak(before, bytes))
      ;
    return nullptr;
  }
  stack.size = rounded;
  return stack.memory.get();
}

namespace rtsl::runtime {

std::uint64_t failedMachineStacks(std::uint64_t *largest) {
  if (largest)
    *largest = largestFailure;
  return failures;
}

} // namespace rtsl::runtime
