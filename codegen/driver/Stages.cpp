//===- Stages.cpp - the stages of the pipeline ----------------------------===//
#include "codegen/driver/Stages.h"

#include "codegen/driver/Compilation.h"
#include "codegen/driver/Footprints.h"
#include "codegen/driver/outputs/CppOutput.h"
#include "codegen/driver/outputs/Reflection.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/link/Link.h"
#include "codegen/link/LinkModule.h"
#include "codegen/lower/KnownConditions.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/restructure/Restructure.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"

#include <set>
#include <stdexcept>

namespace rtsl {

namespace driver {

static std::string showText(Compilation &compilation) {
  return std::move(compilation.text);
}

static std::string showIr(Compilation &compilation) {
  return print(*compilation.ir);
}

//===----------------------------------------------------------------------===//
// Stages of the source
//===----------------------------------------------------------------------===//

static bool reachPreprocessed(Compilation &compilation) {
  for (const PreprocessedFile &file : compilation.input.texts)
    compilation.text += printPreprocessed(file.text, compilation.diagnostics.sources());
  return true;
}

static bool reachAst(Compilation &compilation) {
  for (const ast::TranslationUnit *unit : compilation.input.units)
    compilation.text += dump(*unit);
  return true;
}

static bool reachTypedAst(Compilation &compilation) {
  compilation.text = typed::dump(*compilation.input.module);
  return true;
}

//===----------------------------------------------------------------------===//
// MLIR. reachIr() is in Compilation.cpp
//===----------------------------------------------------------------------===//

bool reachModuleFacts(Compilation &compilation) {
  if (!reachIr(compilation))
    return false;
  compilation.moduleFacts = linkModule(*compilation.ir, *compilation.input.module,
                                       compilation.diagnostics, compilation.options.floatingPoint);
  return compilation.moduleFacts.has_value();
}

bool reachSsa(Compilation &compilation) {
  if (!reachIr(compilation))
    return false;
  run(*compilation.ir, codegen::buildSsaPipeline);
  leaveOutFootprints(compilation);
  return true;
}

static bool split(Compilation &compilation, bool dispatch) {
  if (!reachIr(compilation))
    return false;
  SplitOptions how = splitOptions(compilation.options);
  how.dispatch = dispatch;
  if (const SourceTable *source = compilation.source)
    how.isKnown = [source](mlir::Value condition) { return knownCondition(condition, *source); };
  how.explain = compilation.explains;
  compilation.report = runToStates(*compilation.ir, how);
  leaveOutFootprints(compilation);
  return true;
}

bool reachStates(Compilation &compilation) {
  return split(compilation, /*dispatch=*/false);
}

bool reachStructured(Compilation &compilation) {
  if (!reachStates(compilation))
    return false;
  for (auto function : compilation.ir->getOps<mlir::func::FuncOp>())
    if (!compilation.source || ir::attr::state.isOn(function))
      expectSuccess(*compilation.ir, [&] { return mlir::succeeded(restructure(function)); });
  return true;
}

/// The names of the states, from number 1 on.
static std::vector<std::string> stateNames(mlir::ModuleOp ir) {
  std::vector<std::string> names;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (const mlir::ArrayAttr all = ir::attr::runsStates.of(function))
      for (const mlir::Attribute name : all)
        names.push_back(llvm::cast<mlir::StringAttr>(name).str());
  return names;
}

bool reachMachine(Compilation &compilation) {
  if (!split(compilation, /*dispatch=*/true))
    return false;
  if (compilation.program)
    compilation.program->stateNames = stateNames(*compilation.ir);
  return true;
}

//===----------------------------------------------------------------------===//
// LLVM IR and PTX: driver/machine
//===----------------------------------------------------------------------===//

static bool reachLlvm(Compilation &compilation) {
  return compilation.machineCode().reachLlvm(compilation);
}

static std::string showLlvm(Compilation &compilation) {
  return compilation.machineCode().printLlvm(compilation);
}

static bool reachPtx(Compilation &compilation) {
  return compilation.machineCode().reachPtx(compilation);
}

//===----------------------------------------------------------------------===//
// Descriptions of a module
//===----------------------------------------------------------------------===//

static bool reachCpp(Compilation &compilation) {
  return reachModuleFacts(compilation) && printCpp(compilation);
}

static bool reachReflection(Compilation &compilation) {
  if (!reachIr(compilation))
    return false;
  Reflection reflection(compilation);
  compilation.explains = true;
  if (!reachStates(compilation))
    return false;
  reflection.addStates(compilation.report);
  compilation.text = reflection.text();
  return true;
}

} // namespace driver

//===----------------------------------------------------------------------===//
// The table
//===----------------------------------------------------------------------===//

static constexpr const char *noText =
    "a scene has no text and no syntax tree; give one of its RTSL files";
static constexpr const char *noCpp = "C++ is generated from RTSL files, without a scene; the "
                                     "program that it is linked to builds one";
static constexpr const char *noReflection =
    "reflection describes RTSL files; give those of the scene";

const std::vector<Stage> &stages() {
  using namespace driver;
  using Needs = Stage::Needs;
  constexpr bool yes = true, no = false;
  // clang-format off
  static const std::vector<Stage> table = {
      // name          needs              no scene      events, double, LLVM; function, text
      {"preprocessed", Needs::Text,       noText,       no,  yes, no,  reachPreprocessed, showText},
      {"ast",          Needs::SyntaxTree, noText,       no,  yes, no,  reachAst,          showText},
      {"typed-ast",    Needs::Module,     noText,       no,  yes, no,  reachTypedAst,     showText},
      {"ir",           Needs::Module,     nullptr,      no,  yes, no,  reachIr,           showIr},
      {"ssa",          Needs::Module,     nullptr,      no,  yes, no,  reachSsa,          showIr},
      {"split",        Needs::Module,     nullptr,      no,  yes, no,  reachStates,       showIr},
      {"structured",   Needs::Module,     nullptr,      no,  yes, no,  reachStructured,   showIr},
      {"llvm",         Needs::Module,     nullptr,      no,  yes, yes, reachLlvm,         showLlvm},
      {"ptx",          Needs::Module,     nullptr,      no,  no,  yes, reachPtx,          showText},
      {"cpp",          Needs::Module,     noCpp,        yes, no,  no,  reachCpp,          showText},
      {"reflection",   Needs::Module,     noReflection, no,  yes, no,  reachReflection,   showText},
  };
  // clang-format on
  return table;
}

const Stage &stage(std::string_view name) {
  for (const Stage &one : stages())
    if (one.name == name)
      return one;
  throw std::logic_error("no stage has the name " + std::string(name));
}

std::optional<std::string> emit(const Stage &stage, const CompileInput &input,
                                const CompileOptions &options, Diagnostics &diagnostics) {
  driver::Compilation compilation(input, options, diagnostics);
  if (!stage.reach(compilation))
    return std::nullopt;
  return stage.show(compilation);
}

} // namespace rtsl
