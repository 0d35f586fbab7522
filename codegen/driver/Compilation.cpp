//===- Compilation.cpp - a compilation in progress ------------------------===//
#include "codegen/driver/Compilation.h"

#include "codegen/driver/Places.h"
#include "codegen/driver/Steps.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/link/BindScene.h"
#include "codegen/link/Link.h"
#include "codegen/link/UnrollRecursion.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/calls/Steps.h"

#include <stdexcept>

namespace rtsl::driver {

const MachineCode &Compilation::machineCode() const {
  if (!input.machineCode)
    throw std::logic_error("this program has no generator of machine code");
  return *input.machineCode;
}

static bool linkForScene(Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  LinkRequest request = *compilation.input.scene;
  request.features |= options.undefined;
  if (options.sampler)
    request.features = (request.features & ~RTSL_FEATURE_SAMPLERS) | *options.sampler;
  return link(*compilation.ir, *compilation.input.module, request, options.colorComponents,
              compilation.diagnostics, *compilation.program, compilation.findings,
              options.floatingPoint);
}

/// Keeps only the code that renders this scene.
static void bindToScene(Compilation &compilation) {
  LinkRequest request = *compilation.input.scene;
  // With arithmetic in double, members of the scene stay variables: a constant index would change
  // which values are in memory, and so where a number is rounded.
  if (compilation.options.floatingPoint == FloatingPoint::Double) {
    request.keep.add(ItemSet::ofMembers());
    request.keep.add(Item::Lights);
  }
  const runtime::SceneFacts facts =
      compilation.facts ? *compilation.facts : compilation.machineCode().makeObjects(compilation);
  compilation.program->sceneNeeds = graphNeeds(facts, request, compilation.findings);
  bindScene(*compilation.ir, facts, request, compilation.findings);
}

bool reachIr(Compilation &compilation) {
  if (compilation.ir)
    return true;
  const LinkRequest *scene = compilation.input.scene;
  LinkRequest noScene;
  noScene.features = compilation.input.cpp.features;
  if (!compilation.context)
    compilation.context = makeContext(compilation.input.machineCode);
  compilation.ir =
      lowerModule(*compilation.input.module, compilation.options, scene ? *scene : noScene,
                  compilation.source, compilation.diagnostics, *compilation.context);
  if (!compilation.ir)
    return false;
  if (compilation.source) // whose states of called methods have frames of their own
    continuation::callThroughFrames(*compilation.ir);
  if (scene && !linkForScene(compilation)) {
    compilation.ir = nullptr;
    return false;
  }
  if (compilation.usesThreads)
    allowThreads(*compilation.ir, compilation.options);
  if (compilation.isBound())
    bindToScene(compilation);
  return true;
}

/// Recursion that is too deep for copies is an error on a GPU.
static bool requireNoRecursion(Compilation &compilation) {
  mlir::func::FuncOp function =
      compilation.isBound() ? recursiveFunction(*compilation.ir) : mlir::func::FuncOp();
  if (!function)
    return true;
  const std::string method = function.getSymName().rsplit('.').second.str();
  const SourceRange range =
      rangeAt(ir::placeOf(function->getLoc()), method, compilation.diagnostics);
  compilation.diagnostics.report(Code::recursionTooDeep, range, method, mostRecursionLevels)
      .note("on the CPU, `--target=host` renders it");
  return false;
}

/// Level 2 without states, if no ray waits for another one and there is one place for traversal, so
/// that calls can be inlined (runtime/device/organisations/WholeSamples.h).
static mlir::OwningOpRef<mlir::ModuleOp> withoutStates(const Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  const runtime::Program &program = *compilation.program;
  const bool mayBe =
      compilation.input.scene && program.engine == runtime::Engine::Programs &&
      program.paths == runtime::Paths::Single && !program.raysLeaveHits &&
      options.organisation.value_or(Organisation::Megakernel) == Organisation::Megakernel &&
      !options.schedule && !options.countsSteps;
  if (!mayBe)
    return nullptr;
  mlir::OwningOpRef<mlir::ModuleOp> whole = mlir::ModuleOp(*compilation.ir).clone();
  run(*whole, codegen::buildSsaPipeline);
  std::size_t places = 0;
  bool looksForLamps = false;
  whole->walk([&](mlir::Operation *op) {
    places += ir::isTrace(op);
    looksForLamps |= ir::sendsRays(op) && !ir::isTrace(op);
  });
  if (places > 1 || looksForLamps)
    return nullptr;
  return whole;
}

bool reachGpuMachine(Compilation &compilation) {
  if (!reachIr(compilation) || !requireNoRecursion(compilation))
    return false;
  compilation.whole = withoutStates(compilation);
  return reachMachine(compilation);
}

} // namespace rtsl::driver
