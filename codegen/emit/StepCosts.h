//===- StepCosts.h - what steps of the megakernel and tests cost ----------===//
#pragma once

#include <cstdint>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// rtsl_step_costs_high and rtsl_step_costs_low (runtime/device/ray/Abi.h), estimated from the
/// instructions of the states in a module before it is linked with device code.
std::uint64_t stepCosts(const llvm::Module &module);

/// rtsl_is_intersect_cheap, for such a module.
bool isIntersectCheap(const llvm::Module &module);

} // namespace rtsl::codegen
