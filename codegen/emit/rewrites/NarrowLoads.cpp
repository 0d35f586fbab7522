//===- NarrowLoads.cpp - functions that load fields one by one ------------===//
#include "codegen/emit/rewrites/NarrowLoads.h"

#include "llvm/IR/Module.h"

namespace rtsl::codegen {

constexpr llvm::StringLiteral mark = "rtsl-narrow-loads";

/// NarrowLoadsTest.cpp looks for these names in the device code.
static bool testsPrimitives(llvm::StringRef name) {
  return name == "rtsl_traverse" || name.contains("findHit") || name.contains("testPrimitive") ||
         name.contains("intersect");
}

void markNarrowLoads(llvm::Module &module) {
  const llvm::Function *payloads = module.getFunction("rtsl_trace_payload");
  const bool hasPayloads = payloads && !payloads->isDeclaration();
  for (llvm::Function &function : module)
    if (!function.isDeclaration() && (hasPayloads || testsPrimitives(function.getName())))
      function.addFnAttr(mark);
}

bool hasNarrowLoads(const llvm::Function &function) {
  return function.hasFnAttribute(mark);
}

void unmarkNarrowLoads(llvm::Module &module) {
  for (llvm::Function &function : module)
    function.removeFnAttr(mark);
}

} // namespace rtsl::codegen
