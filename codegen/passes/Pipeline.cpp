//===- Pipeline.cpp - from level 1 to level 2, in order -------------------===//
#include "codegen/passes/Pipeline.h"

#include "codegen/ir/dialect/RtslDialect.h"
#include "codegen/passes/BindMembers.h"
#include "codegen/passes/ForgetArguments.h"
#include "codegen/passes/ForwardPayloads.h"
#include "codegen/passes/InlineFunctions.h"
#include "codegen/passes/PropagateConstants.h"
#include "codegen/passes/ShareExpressions.h"
#include "codegen/passes/Simplify.h"
#include "codegen/passes/ToControlFlow.h"
#include "codegen/passes/calls/ShareCalls.h"
#include "codegen/passes/variables/ExpandCopies.h"
#include "codegen/passes/variables/HoistVariables.h"
#include "codegen/passes/variables/LocalizeLookups.h"
#include "codegen/passes/variables/PromoteVariables.h"

#include "mlir/Dialect/Func/Extensions/InlinerExtension.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Pass/PassManager.h"
#include "mlir/Pass/PassRegistry.h"
#include "mlir/Transforms/Passes.h"

namespace rtsl::codegen {

static void addOnePromotion(mlir::OpPassManager &function) {
  function.addPass(mlir::createSROA());
  function.addPass(createPromoteVariablesPass());
  function.addPass(mlir::createMem2Reg());
}

/// Splits variables into parts, promotes them to values and cleans up. Twice: an index that was in
/// a variable is a constant only after the first time. With `endsLoops`, loops that end before
/// their first iteration are removed.
static void addPromotion(mlir::OpPassManager &function, bool endsLoops = false) {
  function.addPass(createHoistVariablesPass());
  addOnePromotion(function);
  function.addPass(createSimplifyPass());
  addOnePromotion(function);
  if (endsLoops)
    function.addPass(createPropagateConstantsPass(/*inLoops=*/true));
  function.addPass(createSimplifyPass());
}

void buildSsaPipeline(mlir::OpPassManager &module) {
  // Each function by itself first, so that inlined functions are small.
  auto &functions = module.nest<mlir::func::FuncOp>();
  functions.addPass(createBindMembersPass());
  functions.addPass(createToControlFlowPass());
  addPromotion(functions, /*endsLoops=*/true);

  // Arguments and results that are aggregates stay in memory until their function is inlined. What
  // nothing calls would count as a caller.
  module.addPass(mlir::createSymbolDCEPass());
  module.addPass(createInlineFunctionsPass());
  module.addPass(createLocalizeLookupsPass());
  auto &promoted = module.nest<mlir::func::FuncOp>();
  addPromotion(promoted);
  promoted.addPass(createPropagateConstantsPass());
  module.addPass(createShareCallsPass());
  auto &inlined = module.nest<mlir::func::FuncOp>();
  inlined.addPass(createExpandCopiesPass());
  inlined.addPass(createBindMembersPass()); // for members that copies have hidden
  inlined.addPass(createSimplifyPass());

  module.addPass(createForgetArgumentsPass());
  module.addPass(mlir::createSymbolDCEPass());
}

void buildPlainPipeline(mlir::OpPassManager &module) {
  auto &functions = module.nest<mlir::func::FuncOp>();
  functions.addPass(createToControlFlowPass());
  addPromotion(functions);
  module.addPass(createInlineFunctionsPass(/*inlinesAll=*/true));
  auto &inlined = module.nest<mlir::func::FuncOp>();
  addPromotion(inlined);
  inlined.addPass(createPropagateConstantsPass());
  inlined.addPass(createExpandCopiesPass());
  addPromotion(inlined);
}

void registerPassDependencies(mlir::DialectRegistry &registry) {
  registry.insert<ir::RtslDialect>();
  mlir::func::registerInlinerExtension(registry);
}

void registerPasses() {
  mlir::registerPass(createBindMembersPass);
  mlir::registerPass(createToControlFlowPass);
  mlir::registerPass(createHoistVariablesPass);
  mlir::registerPass(createExpandCopiesPass);
  mlir::registerPass(createForgetArgumentsPass);
  mlir::registerPass(createForwardPayloadsPass);
  mlir::registerPass(createLocalizeLookupsPass);
  mlir::registerPass([] { return createInlineFunctionsPass(); });
  mlir::registerPass(createShareCallsPass);
  mlir::registerPass(createShareExpressionsPass);
  mlir::registerPass([] { return createPromoteVariablesPass(/*fewest=*/0); });
  mlir::registerPass([] { return createPropagateConstantsPass(); });
  mlir::registerPass(createSimplifyPass);
  mlir::PassPipelineRegistration<>("rtsl-ssa", "level 1 to level 2, optimised", buildSsaPipeline);
}

} // namespace rtsl::codegen
