//===- StepCosts.h - what steps of the megakernel and tests cost ----------===//
#pragma once

#include <cstdint>
#include <optional>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// rtsl_step_costs_high and rtsl_step_costs_low (runtime/device/ray/Abi.h), estimated from the
/// instructions of the states in a module before it is linked with device code.
std::uint64_t stepCosts(const llvm::Module &module);

/// The instructions of `intersect` of the primitives of such a module, the most of all classes.
/// Nothing if it may loop, or if the module has none.
std::optional<std::uint64_t> intersectCost(const llvm::Module &module);

} // namespace rtsl::codegen
