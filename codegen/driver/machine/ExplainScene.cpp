//===- ExplainScene.cpp - what a scene's program contains and omits -------===//
#include "codegen/driver/machine/LlvmSteps.h"
#include "codegen/driver/machine/MachineStages.h"
#include "codegen/ir/Rtsl.h"
#include "frontend/source/Expansion.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Walk.h"

#include "llvm/IR/Module.h"
#include "llvm/IR/StructuralHash.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

namespace rtsl {

using namespace driver;

void keep(ItemSet items, LinkRequest &request, CompileOptions &options) {
  request.keep.add(items);
  if (!items.has(Item::Events))
    return;
  options.checkIndices = true;
  if (!(request.features & RTSL_FEATURE_EXCEPTIONS))
    request.features |= RTSL_FEATURE_EXCEPTIONS | RTSL_FEATURE_UNHEEDED;
}

namespace {

/// The first `print` in the classes that the scene uses.
SourceRange firstPrint(const typed::Module &module, const LinkRequest &request) {
  SourceRange range;
  for (const auto &one : module.classes)
    for (const auto &function : one->functions)
      if (function->body && std::count(request.classes.begin(), request.classes.end(), one->name))
        forEachExpr(*function->body, [&](const typed::Expr &expr) {
          const auto *call = dynCast<typed::BuiltinExpr>(&expr);
          if (call && has(call->builtin, typed::effect::Prints) && !range.isValid())
            range = call->range;
        });
  return range;
}

/// `hasChecks`: whether an index in the program could be out of range and is checked.
void describeEvents(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, bool hasChecks, const runtime::Program &program,
                    const SourceManager &sources, Findings &findings) {
  const bool hasExceptions =
      (request.features & RTSL_FEATURE_EXCEPTIONS) && !(request.features & RTSL_FEATURE_UNHEEDED);
  Finding exceptions = {Item::Events, "exceptions", hasExceptions, {}, {}};
  exceptions.reason = hasExceptions ? "enabled by the scene's `exception` or --exceptions"
                                    : "the scene has no `exception`, and --exceptions is not given";
  findings.push_back(std::move(exceptions));

  const bool prints = !program.prints.empty();
  const SourceRange print = firstPrint(module, request);
  Finding printing = {Item::Events, "print", prints, prints ? "--print" : "no `print` runs", {}};
  if (print.isValid()) {
    const ShownPlace place = shownBegin(sources, print);
    printing.place = {std::string(place.file), place.at.line, place.at.column};
    if (!(request.features & RTSL_FEATURE_PRINT))
      printing.reason = "--print is not given";
  }
  findings.push_back(std::move(printing));

  findings.push_back({Item::Events,
                      "index checks",
                      hasChecks,
                      !options.checkIndices ? "--unchecked"
                      : hasChecks           ? "an index is not known to be in range"
                                            : "every index is known to be in range",
                      {}});
}

/// A hash of the structure of a program in LLVM IR.
llvm::stable_hash fingerprint(const LlvmCode &code) {
  return llvm::StructuralHash(*code.module, /*DetailedHash=*/true);
}

/// The same once it is optimised, as text.
std::string optimizedFingerprint(LlvmCode &code, const CompileOptions &options) {
  return madeOf(code, "fingerprint", options, [&] {
    optimize(code);
    return fmt::format("{}", fingerprint(code));
  });
}

/// Whether index checks change the program of a scene with these objects: the GPU's program, or, in
/// double, the program for this host.
bool hasIndexChecks(const CompileInput &input, const CompileOptions &options,
                    const SourceManager &sources, const runtime::SceneFacts &facts) {
  if (!options.checkIndices)
    return false;
  CompileOptions withoutChecks = options;
  withoutChecks.checkIndices = false;
  Diagnostics unheard(sources);
  const auto code = [&](const CompileOptions &compile) {
    Compilation compilation(input, compile, unheard);
    compilation.facts = &facts;
    reachMachine(compilation);
    return megakernel(*compilation.ir, compilation.options, *compilation.program,
                      options.floatingPoint != FloatingPoint::Double);
  };
  LlvmCode checked = code(options), unchecked = code(withoutChecks);
  // Optimisation takes most of the time, and most scenes have no index that needs a check.
  return fingerprint(checked) != fingerprint(unchecked) &&
         optimizedFingerprint(checked, options) != optimizedFingerprint(unchecked, options);
}

/// The size of a scene's bound program on a GPU. Nothing if it cannot be linked.
std::optional<ProgramSize> measure(Compilation &compilation) {
  if (!reachMachine(compilation))
    return std::nullopt;
  ProgramSize size;
  size.frameBytes = compilation.report.frameSize();
  size.states = compilation.report.stateCount();
  LlvmCode code = megakernel(*compilation.ir, compilation.options, *compilation.program,
                             /*forGpu=*/false);
  const std::string text = madeOf(code, "size", compilation.options, [&] {
    optimize(code);
    std::uint64_t instructions = 0, constantBytes = 0;
    for (const llvm::Function &function : *code.module)
      instructions += function.getInstructionCount();
    for (const llvm::GlobalVariable &global : code.module->globals())
      if (global.isConstant() && global.hasInitializer())
        constantBytes += code.module->getDataLayout().getTypeAllocSize(global.getValueType());
    return fmt::format("{} {}", instructions, constantBytes);
  });
  const auto [instructions, constantBytes] = llvm::StringRef(text).split(' ');
  instructions.getAsInteger(10, size.instructions);
  constantBytes.getAsInteger(10, size.constantBytes);
  return size;
}

/// The size with `item` kept. Nothing if that is not possible: a class that the scene does not use
/// may be incomplete.
std::optional<ProgramSize> measureKeeping(Item item, const CompileInput &input,
                                          const CompileOptions &options,
                                          const SourceManager &sources,
                                          const runtime::SceneFacts &facts) {
  LinkRequest request = *input.scene;
  CompileOptions keeping = options;
  keep(ItemSet::only(item), request, keeping);
  CompileInput kept = input;
  kept.scene = &request;
  Diagnostics unheard(sources);
  Compilation compilation(kept, keeping, unheard);
  compilation.facts = &facts;
  return measure(compilation);
}

/// A member counts as read if some function reads it. With the numbers of the scene that code may
/// turn out never to run: such members are left out, too.
void dropReadsThatNeverRun(const CompileInput &input, const CompileOptions &options,
                           const SourceManager &sources, const runtime::SceneFacts &facts,
                           Findings &findings) {
  Diagnostics unheard(sources);
  Compilation compilation(input, options, unheard);
  compilation.facts = &facts;
  if (!reachSsa(compilation))
    return;
  std::set<std::string> read;
  compilation.ir->walk([&](ir::MemberOp op) {
    const auto object = llvm::cast<ir::RefType>(op.getObject().getType()).getClassName();
    read.insert((object + "." + op.getMember()).str());
  });
  for (Finding &finding : findings)
    if (ItemSet::ofMembers().has(finding.item) && finding.isNeeded &&
        !read.count(finding.subject)) {
      finding.isNeeded = false;
      finding.reason = "read only by code that never runs with the numbers of the scene";
    }
}

bool leavesOut(Item item, const Findings &findings) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding &finding) {
    return finding.item == item && !finding.isNeeded;
  });
}

} // namespace

std::optional<SceneExplanation>
explainScene(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
             Diagnostics &diagnostics, const MakeObjects &makeObjects, bool withSavings) {
  const SourceManager &sources = diagnostics.sources();
  SceneExplanation explanation;
  explanation.hasSavings = withSavings;
  runtime::SceneFacts facts; // made once: omitting items from a program changes no object
  CompileInput input;
  input.module = &module;
  input.scene = &request;
  input.machineCode = &machineCode();
  input.makeObjects = [&](const auto &constructors) { return facts = makeObjects(constructors); };
  {
    Compilation compilation(input, options, diagnostics);
    compilation.findings = &explanation.findings;
    if (!reachIr(compilation))
      return std::nullopt;
    describeEvents(module, request, options, hasIndexChecks(input, options, sources, facts),
                   *compilation.program, sources, explanation.findings);
    explanation.size = *measure(compilation);
    explanation.program = compilation.program;
  }
  if (!request.keep.has(Item::Parameters))
    dropReadsThatNeverRun(input, options, sources, facts, explanation.findings);
  for (Item item : allItems) {
    if (request.keep.has(item))
      continue;
    if (!withSavings || item == Item::Meshes || !leavesOut(item, explanation.findings))
      explanation.sizeKeeping[item] = explanation.size; // the program is the same
    else if (const auto size = measureKeeping(item, input, options, sources, facts))
      explanation.sizeKeeping[item] = *size;
  }
  return explanation;
}

} // namespace rtsl
