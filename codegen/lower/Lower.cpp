//===- Lower.cpp - from the typed tree to level 1 -------------------------===//
#include "codegen/lower/Lower.h"
#include "codegen/ir/Attributes.h"

#include "codegen/lower/HideConstants.h"
#include "codegen/lower/Lowering.h"
#include "runtime/device/ray/Launch.h"

namespace rtsl {

mlir::OwningOpRef<mlir::ModuleOp> lower(const typed::Module &module, const LowerOptions &options,
                                        mlir::MLIRContext &context) {
  assert(options.diagnostics && "lowering needs diagnostics");
  assert(options.colorComponents >= 1 && options.colorComponents <= RTSL_MAX_COLOR);
  context.loadDialect<ir::RtslDialect>();
  std::size_t errorsBefore = options.diagnostics->errorCount();
  mlir::OwningOpRef<mlir::ModuleOp> target =
      mlir::ModuleOp::create(mlir::UnknownLoc::get(&context));
  if (options.source) // passes leave variables whole then
    ir::attr::source.set(*target);
  if (options.isWidenedLater)
    ir::attr::inDouble.set(*target);
  if (options.hidesConstants)
    ir::attr::hidesConstants.set(*target);
  lowering::ModuleLowering(module, options, *target).run();
  if (options.diagnostics->errorCount() != errorsBefore)
    return nullptr;
  if (options.hidesConstants)
    lowering::hideConstants(*target);
  return target;
}

} // namespace rtsl
