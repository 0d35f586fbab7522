//===- RaysTest.cpp - who traces, in sema and in the IR -------------------===//
//
// sema says which functions may trace (typed::Function::sends), and all that prints or splits them
// relies on it. Whatever traces in the IR of random programs, linked with all their classes, must
// be among them.
//
//===----------------------------------------------------------------------===//
#include "Program.h"

#include "codegen/driver/Steps.h"
#include "codegen/ir/Attributes.h"
#include "codegen/link/LinkModule.h"
#include "codegen/link/LinkRequest.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"
#include "sema/typed/Analysis.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::random;

namespace {

/// The methods of the class that functions of the IR with this name come from.
bool mayTrace(const typed::Module &module, const typed::Class &info, const std::string &slot) {
  for (const typed::Class *at = &info; at; at = at->base)
    for (const auto &method : at->functions)
      if (typed::slotName(module, *method) == slot)
        return method->sends.traced;
  return false;
}

TEST(Random, WhatTracesInTheIrMayTrace) {
  unsigned tracing = 0;
  for (std::uint32_t seed = 0; seed != 150; ++seed) {
    SourceManager sources;
    Diagnostics diagnostics(sources);
    std::string text = generate(seed).text();
    text = prelude(text) + text;
    const auto unit = parse(sources.add("random.rtsl", text), diagnostics);
    const auto module =
        check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    ASSERT_FALSE(diagnostics.hasErrors()) << "seed " << seed;

    CompileOptions options;
    options.colorComponents = colorComponents(seed);
    const auto context = driver::makeContext();
    const auto ir = driver::lowerModule(*module, options, {}, nullptr, diagnostics, *context);
    ASSERT_TRUE(linkModule(*ir, *module, diagnostics, FloatingPoint::Strict)) << "seed " << seed;
    for (mlir::func::FuncOp function : continuation::tracingFunctions(*ir)) {
      const auto owner = ir::attr::className.of(function);
      const auto slot = ir::attr::methodName.of(function);
      if (!owner || !slot)
        continue;
      ++tracing;
      for (const auto &info : module->classes) {
        if (info->name != owner.str())
          continue;
        EXPECT_TRUE(mayTrace(*module, *info, slot.str()))
            << "seed " << seed << ": " << function.getSymName().str();
      }
    }
  }
  EXPECT_GE(tracing, 40u);
}

} // namespace
