#include "codegen/driver/outputs/CppOutput.h"

#include "codegen/cpp/EmitCpp.h"
#include "codegen/cpp/HitErrors.h"
#include "codegen/cpp/states/States.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/errors/DeriveHitErrors.h"
#include "codegen/passes/restructure/Restructure.h"

namespace rtsl::driver {

namespace {

/// Prints C++ with the states of methods that trace.
std::optional<std::string> printStates(const Compilation &linked, const cpp::Options &printing,
                                       Diagnostics &diagnostics) {
  const typed::Module &module = *linked.input.module;
  CompileInput input = linked.input;
  const bool raises = printing.exceptions && printing.checkIndices;
  input.cpp.features &= RTSL_FEATURE_PRINT | (raises ? RTSL_FEATURE_EXCEPTIONS : 0u);
  CompileOptions options = linked.options;
  options.checkIndices = false; // the C++ code checks indices itself
  SourceTable source = cpp::makeSourceTable(module, raises);
  Compilation states(input, options, diagnostics);
  states.context = linked.context;
  states.source = &source;
  if (!reachStructured(states))
    return std::nullopt;
  const cpp::StateProgram program = {*states.ir, source};
  return cpp::print(module, *linked.moduleFacts, printing, diagnostics, &program);
}

/// Keeps the error bounds of t of a linked module's primitives as functions.
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

cpp::Options printingOptions(const CppRequest &request, const CompileOptions &options) {
  cpp::Options printing;
  printing.prints = request.features & RTSL_FEATURE_PRINT;
  printing.exceptions = request.features & RTSL_FEATURE_EXCEPTIONS;
  printing.undefined = options.undefined;
  printing.sampler = options.sampler.value_or(0);
  printing.checkIndices = options.checkIndices;
  printing.fast = options.floatingPoint == FloatingPoint::Fast;
  printing.name = request.name;
  printing.colorComponents = options.colorComponents;
  printing.lineDirectives = request.lineDirectives;
  return printing;
}

} // namespace

bool printCpp(Compilation &compilation) {
  const typed::Module &module = *compilation.input.module;
  const CppRequest &request = compilation.input.cpp;
  Diagnostics &diagnostics = compilation.diagnostics;
  keepHitErrors(*compilation.ir);
  const cpp::HitErrorFunctions hitErrors = {*compilation.ir};
  cpp::Options printing = printingOptions(request, compilation.options);
  printing.hitErrors = &hitErrors;

  std::optional<std::string> text;
  const bool isSplit = request.trace != TraceMode::Recurse && mayTrace(module);
  if (isSplit && request.trace == TraceMode::Split) {
    text = printStates(compilation, printing, diagnostics);
  } else {
    Diagnostics refusals(diagnostics.sources());
    if (isSplit)
      text = printStates(compilation, printing, refusals);
    if (!text && !refusals.all().empty())
      printing.whyCalls = refusals.all().front().message;
    if (!text)
      text = cpp::print(module, *compilation.moduleFacts, printing, diagnostics);
  }
  if (text)
    compilation.text = std::move(*text);
  return text.has_value();
}

} // namespace rtsl::driver
