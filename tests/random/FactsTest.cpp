//===- FactsTest.cpp - facts about functions, in sema and in the IR -------===//
//
// Two facts are found on typed trees, for the author's expressions, and again in the IR, which
// passes have changed: which functions may trace (typed::Function::sends), and which state they
// read and write (typed::EffectsOf). Here both are found for random programs, linked with all their
// classes, before any pass: sema must know whatever a function does in the IR.
//
//===----------------------------------------------------------------------===//
#include "Program.h"

#include "codegen/driver/Steps.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/MemoryAccesses.h"
#include "codegen/link/LinkModule.h"
#include "codegen/link/LinkRequest.h"
#include "codegen/passes/continuation/common/Recompute.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Effects.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::random;
using mlir::func::FuncOp;

namespace {

/// A random program, and its IR.
struct Lowered {
  explicit Lowered(std::uint32_t seed) {
    std::string text = generate(seed).text();
    text = prelude(text) + text;
    unit = parse(sources.add("random.rtsl", text), diagnostics);
    module =
        check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    EXPECT_FALSE(diagnostics.hasErrors());
    CompileOptions options;
    options.colorComponents = colorComponents(seed);
    ir = driver::lowerModule(*module, options, {}, nullptr, diagnostics, *context);
    EXPECT_TRUE(linkModule(*ir, *module, diagnostics, FloatingPoint::Strict));
  }

  /// Calls visit(function, method) for all functions of the IR that come from a method.
  template <typename Visit>
  void forEachMethod(Visit visit) {
    for (FuncOp function : ir->getOps<FuncOp>()) {
      const auto owner = ir::attr::className.of(function);
      const auto slot = ir::attr::methodName.of(function);
      if (owner && slot)
        for (const auto &info : module->classes)
          if (info->name == owner.str())
            if (const typed::Function *method = methodOf(*info, slot.str()))
              visit(function, *method);
    }
  }

  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  std::unique_ptr<mlir::MLIRContext> context = driver::makeContext(nullptr);
  mlir::OwningOpRef<mlir::ModuleOp> ir;

private:
  const typed::Function *methodOf(const typed::Class &info, const std::string &slot) const {
    for (const typed::Class *at = &info; at; at = at->base)
      for (const auto &method : at->functions)
        if (typed::slotName(*module, *method) == slot)
          return method.get();
    return nullptr;
  }
};

TEST(Random, WhatTracesInTheIrMayTrace) {
  unsigned tracing = 0;
  for (std::uint32_t seed = 0; seed != 150; ++seed) {
    SCOPED_TRACE(seed);
    Lowered program(seed);
    const auto traced = continuation::tracingFunctions(*program.ir);
    program.forEachMethod([&](FuncOp function, const typed::Function &method) {
      if (!llvm::is_contained(traced, function))
        return;
      ++tracing;
      EXPECT_TRUE(method.sends.traced) << function.getSymName().str();
    });
  }
  EXPECT_GE(tracing, 40u);
}

/// The names of the state variables among places of typed effects.
std::set<std::string> stateNames(const std::set<const void *> &places) {
  std::set<std::string> names;
#define RTSL_STATE_VARIABLE(variable, ...)                                                         \
  if (places.count(typed::EffectsOf::place(typed::StateVariable::variable)))                       \
    names.insert(#variable);
#include "language/StateVariables.def"
  return names;
}

/// Texture::lookup returns its result in these. On the typed tree it is the value of the call, so
/// that a caller reads none of them.
bool isResultOfLookup(const std::string &variable) {
  return variable == "TextureColor" || variable == "FloatTextureValue";
}

TEST(Random, WhatTheIrReadsAndWritesIsAnEffect) {
  unsigned reads = 0, writes = 0, draws = 0;
  for (std::uint32_t seed = 0; seed != 100; ++seed) {
    SCOPED_TRACE(seed);
    Lowered program(seed);
    const continuation::WriteSummary summary(*program.ir);
    typed::EffectsOf effectsOf(*program.module);
    program.forEachMethod([&](FuncOp function, const typed::Function &method) {
      SCOPED_TRACE(function.getSymName().str());
      const typed::Effects &effects = effectsOf.function(method);
      const std::set<std::string> known = stateNames(effects.writes);
      for (const auto &entry : summary.ofFunction(function).names) {
        const std::string name = entry.getKey().str();
        if (name == "payload") // a parameter on the typed tree
          continue;
        ++writes;
        EXPECT_TRUE(known.count(name)) << "writes " << name;
      }
      const ir::MemoryAccesses own = ir::accessesOf(function);
      const std::set<std::string> knownReads = stateNames(effects.reads);
      for (const ir::MemoryLocation &location : own.reads)
        if (location.kind == ir::MemoryLocation::Kind::State && !isResultOfLookup(location.name)) {
          ++reads;
          EXPECT_TRUE(knownReads.count(location.name)) << "reads " << location.name;
        }
      if (own.writes.count({ir::MemoryLocation::Kind::Random, {}})) {
        ++draws;
        EXPECT_TRUE(effects.random);
      }
    });
  }
  EXPECT_GE(reads, 2000u);
  EXPECT_GE(writes, 500u);
  EXPECT_GE(draws, 20u);
}

} // namespace
