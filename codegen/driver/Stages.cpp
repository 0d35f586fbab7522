//===- Stages.cpp - the stages of the pipeline ----------------------------===//
#include "codegen/driver/Stages.h"

#include "codegen/driver/Compilation.h"
#include "codegen/driver/HostCode.h"
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

#include "mlir/IR/Verifier.h"
#include "llvm/IR/Module.h"

#include <stdexcept>

namespace rtsl {

namespace driver {

static std::string showText(Compilation &compilation) {
  return std::move(compilation.text);
}

static std::string showIr(Compilation &compilation) {
  return print(*compilation.ir);
}

static std::string showLlvm(Compilation &compilation) {
  return codegen::printLlvm(*compilation.llvm->module);
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

/// Lookups that need the footprint of a ray may be in code that never runs with the numbers of the
/// scene: with the filter of an image, above all. Then rays have no cones.
static void leaveOutFootprints(Compilation &compilation) {
  const LinkRequest *scene = compilation.input.scene;
  if (!scene || scene->keep.has(Item::Outputs) || ir::readsFootprints(*compilation.ir))
    return;
  compilation.program->needs &= ~RTSL_NEEDS_FOOTPRINT;
  if (!compilation.findings)
    return;
  for (Finding &finding : *compilation.findings)
    if (finding.item == Item::Outputs && finding.isNeeded && finding.subject == footprintSubject) {
      finding.isNeeded = false;
      finding.reason = "read only by code that never runs with the numbers of the scene";
    }
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

/// From number 1 on.
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
// LLVM IR, PTX and machine code
//===----------------------------------------------------------------------===//

bool reachLlvm(Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  if (compilation.input.scene) {
    if (!reachMachine(compilation))
      return false;
    compilation.llvm.emplace(
        megakernel(*compilation.ir, options, *compilation.program, /*forGpu=*/false));
  } else {
    if (!reachSsa(compilation))
      return false;
    declareSlots(*compilation.ir);
    compilation.llvm.emplace(
        translate(*compilation.ir, machineOptions(options, /*hostCpu=*/false)));
  }
  optimize(*compilation.llvm);
  return true;
}

/// Level 2 to level 1 and down again.
static void restructureAndBack(mlir::ModuleOp ir) {
  expectSuccess(
      ir, [&] { return mlir::succeeded(restructure(ir)) && mlir::succeeded(mlir::verify(ir)); });
  run(ir, codegen::buildSsaPipeline);
}

/// The PTX of a module without a scene: one function for each method, or for each state if it
/// traces. Slots and functions of runtime/device are only declared.
static std::string modulePtx(mlir::ModuleOp ir, const CompileOptions &options) {
  declareSlots(ir);
  std::vector<std::string> facts;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (ir::attr::factOfScene.isOn(function))
      facts.push_back(function.getSymName().str());
  LlvmCode code = translate(ir, gpuOptions(options));
  for (const std::string &fact : facts)
    code.module->getFunction(fact)->setLinkage(llvm::Function::InternalLinkage);
  for (llvm::Function &function : *code.module)
    if (!function.hasLocalLinkage())
      function.addFnAttr(llvm::Attribute::NoInline); // the switch over states calls them
  return toPtx(std::move(code));
}

/// For a scene: one kernel, `rtsl_render`, that takes an RtslJob (runtime/device/ray/Abi.h).
static bool reachPtx(Compilation &compilation) {
  if (!reachGpuMachine(compilation))
    return false;
  const CompileOptions &options = compilation.options;
  compilation.text =
      compilation.input.scene
          ? toPtx(megakernel(*compilation.ir, options, *compilation.program, /*forGpu=*/true))
          : modulePtx(*compilation.ir, options);
  return true;
}

bool reachProgram(Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  const bool isSplit =
      options.target == Target::HostMegakernel || options.trace == TraceMode::Split;
  if (!(isSplit ? reachMachine(compilation) : reachSsa(compilation)))
    return false;
  if (options.restructure)
    restructureAndBack(*compilation.ir);
  compileHostCode(compilation);
  return true;
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
  // clang-format off
  static const std::vector<Stage> table = {
      // name          needs              why no scene  events double  function           text
      {"preprocessed", Needs::Text,       noText,       false, true,   reachPreprocessed, showText},
      {"ast",          Needs::SyntaxTree, noText,       false, true,   reachAst,          showText},
      {"typed-ast",    Needs::Module,     noText,       false, true,   reachTypedAst,     showText},
      {"ir",           Needs::Module,     nullptr,      false, true,   reachIr,           showIr},
      {"ssa",          Needs::Module,     nullptr,      false, true,   reachSsa,          showIr},
      {"split",        Needs::Module,     nullptr,      false, true,   reachStates,       showIr},
      {"structured",   Needs::Module,     nullptr,      false, true,   reachStructured,   showIr},
      {"llvm",         Needs::Module,     nullptr,      false, true,   reachLlvm,         showLlvm},
      {"ptx",          Needs::Module,     nullptr,      false, false,  reachPtx,          showText},
      {"cpp",          Needs::Module,     noCpp,        true,  false,  reachCpp,          showText},
      {"reflection",   Needs::Module,     noReflection, false, true,   reachReflection,   showText},
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
