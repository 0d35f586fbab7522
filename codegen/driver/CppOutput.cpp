//===- CppOutput.cpp - C++ of a module -------------------------------------===//
#include "codegen/driver/Compiler.h"

#include "codegen/cpp/EmitCpp.h"
#include "codegen/cpp/HitErrors.h"
#include "codegen/cpp/states/States.h"
#include "codegen/driver/Steps.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/link/Link.h"
#include "codegen/link/LinkModule.h"
#include "codegen/lower/KnownConditions.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/errors/DeriveHitErrors.h"
#include "codegen/passes/restructure/Restructure.h"

namespace rtsl {

using namespace driver;

namespace {

/// Prints C++ with the states of methods that trace.
std::optional<std::string> printSplitCpp(const typed::Module &module, const ModuleFacts &facts,
                                         const cpp::Options &printing,
                                         const CompileOptions &options, mlir::MLIRContext &context,
                                         Diagnostics &diagnostics) {
  SourceTable source = cpp::makeSourceTable(module);
  LowerOptions lowering;
  lowering.diagnostics = &diagnostics;
  lowering.colorComponents = options.colorComponents;
  lowering.checkIndices = false; // the C++ code checks indices itself
  lowering.prints = printing.prints;
  lowering.source = &source;
  const mlir::OwningOpRef<mlir::ModuleOp> ir = lower(module, lowering, context);
  if (!ir)
    return std::nullopt;
  continuation::callThroughFrames(*ir);
  SplitOptions split = splitOptions(options);
  split.dispatch = false;
  split.isKnown = [&source](mlir::Value condition) { return knownCondition(condition, source); };
  runToStates(*ir, split);
  mlir::ModuleOp program = *ir;
  for (auto function : program.getOps<mlir::func::FuncOp>())
    if (ir::attr::state.isOn(function))
      expectSuccess(*ir, [&] { return mlir::succeeded(restructure(function)); });
  const cpp::StateProgram states = {program, source};
  return cpp::print(module, facts, printing, diagnostics, &states);
}

/// Keeps the error bounds of t of a linked module's primitives as functions, for C++ output.
void keepHitErrors(mlir::ModuleOp module) {
  for (auto function : llvm::make_early_inc_range(module.getOps<mlir::func::FuncOp>()))
    if (!ir::attr::hitError.isOn(function))
      function.erase();
    else
      expectSuccess(module, [&] { return mlir::succeeded(restructure(function)); });
}

bool mayTrace(const typed::Module &module) {
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      if (function->sends.traced)
        return true;
  return false;
}

} // namespace

std::optional<std::string> emitCpp(const typed::Module &module, const std::string &name,
                                   bool lineDirectives, std::optional<TraceMode> trace,
                                   std::uint32_t features, const CompileOptions &options,
                                   Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  LinkRequest request;
  request.features = features;
  const mlir::OwningOpRef<mlir::ModuleOp> ir =
      lowerModule(module, options, request, diagnostics, *context);
  if (!ir)
    return std::nullopt;
  const std::optional<ModuleFacts> facts =
      linkModule(*ir, module, diagnostics, options.floatingPoint);
  if (!facts)
    return std::nullopt;
  keepHitErrors(*ir);
  const cpp::HitErrorFunctions hitErrors = {*ir};

  cpp::Options printing;
  printing.prints = features & RTSL_FEATURE_PRINT;
  printing.exceptions = features & RTSL_FEATURE_EXCEPTIONS;
  printing.undefined = options.undefined;
  printing.checkIndices = options.checkIndices;
  printing.fast = options.floatingPoint == FloatingPoint::Fast;
  printing.name = name;
  printing.colorComponents = options.colorComponents;
  printing.lineDirectives = lineDirectives;
  printing.hitErrors = &hitErrors;
  if (trace == TraceMode::Recurse || !mayTrace(module))
    return cpp::print(module, *facts, printing, diagnostics);
  const auto printStates = [&](Diagnostics &refusals) {
    return printSplitCpp(module, *facts, printing, options, *context, refusals);
  };
  if (trace == TraceMode::Split)
    return printStates(diagnostics);
  Diagnostics refusals(diagnostics.sources());
  if (std::optional<std::string> text = printStates(refusals))
    return text;
  if (!refusals.all().empty()) {
    const std::string &message = refusals.all().front().message;
    printing.whyCalls = message.substr(0, message.find(" (")); // without the advice in parentheses
  }
  return cpp::print(module, *facts, printing, diagnostics);
}

} // namespace rtsl
