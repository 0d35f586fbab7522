//===- Linked.h - RTSL text, linked for a scene ---------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"
#include "codegen/link/Link.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/Pipeline.h"
#include "frontend/syntax/Parser.h"
#include "runtime/device/ray/Abi.h"
#include "sema/Sema.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/MLIRContext.h"

#include <gtest/gtest.h>

namespace rtsl {

/// RTSL text, lowered and linked for a scene.
class Linked {
public:
  Linked(std::string source, LinkRequest request) : request(std::move(request)) {
    const FileId file = sources.add("test.rtsl", std::move(source));
    unit = parse(file, diagnostics);
    module =
        check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    EXPECT_FALSE(diagnostics.hasErrors()) << renderText(diagnostics, false);
    if (diagnostics.hasErrors())
      return;
    context.loadAllAvailableDialects();
    LowerOptions options;
    options.diagnostics = &diagnostics;
    options.raisesExceptions = this->request.features & RTSL_FEATURE_EXCEPTIONS;
    ir = lower(*module, options, context);
    EXPECT_TRUE(ir) << renderText(diagnostics, false);
    if (ir)
      succeeded = link(*ir, *module, this->request, 3, diagnostics, program);
  }

  mlir::func::FuncOp function(const std::string &name) {
    return ir->lookupSymbol<mlir::func::FuncOp>(name);
  }

  template <typename Op>
  std::size_t count(const std::string &name) {
    std::size_t number = 0;
    function(name).walk([&](Op) { ++number; });
    return number;
  }

  /// The functions that one calls, in order.
  std::vector<std::string> callees(const std::string &name) {
    std::vector<std::string> names;
    function(name).walk([&](mlir::func::CallOp call) { names.push_back(call.getCallee().str()); });
    return names;
  }

  const runtime::ClassInfo &classInfo(const std::string &name) {
    const runtime::ClassInfo *info = program.find(name);
    EXPECT_NE(info, nullptr) << name;
    static const runtime::ClassInfo none;
    return info ? *info : none;
  }

  /// Those that linking's passes work on.
  static mlir::DialectRegistry dialects() {
    mlir::DialectRegistry registry;
    registry.insert<ir::RtslDialect>();
    codegen::registerPassDependencies(registry);
    return registry;
  }

  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  LinkRequest request;
  mlir::MLIRContext context{dialects()};
  mlir::OwningOpRef<mlir::ModuleOp> ir;
  runtime::Program program;
  bool succeeded = false;
};

} // namespace rtsl
