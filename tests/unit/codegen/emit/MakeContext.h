//===- MakeContext.h - MLIR for tests -------------------------------------===//
#pragma once

#include "codegen/emit/LlvmModule.h"
#include "codegen/passes/Pipeline.h"

#include "mlir/IR/DialectRegistry.h"
#include "mlir/IR/MLIRContext.h"

#include <memory>

namespace rtsl::codegen {

/// With all dialects, up to the translation to LLVM IR.
inline std::unique_ptr<mlir::MLIRContext> makeContext() {
  mlir::DialectRegistry registry;
  registerPassDependencies(registry);
  registerLlvmTranslation(registry);
  auto context =
      std::make_unique<mlir::MLIRContext>(registry, mlir::MLIRContext::Threading::DISABLED);
  context->loadAllAvailableDialects();
  return context;
}

} // namespace rtsl::codegen
