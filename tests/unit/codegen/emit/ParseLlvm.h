//===- ParseLlvm.h - LLVM IR of tests -------------------------------------===//
#pragma once

#include "llvm/AsmParser/Parser.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/SourceMgr.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace rtsl::codegen {

/// The module of this text. A mistake in it fails the test.
inline std::unique_ptr<llvm::Module> parseLlvm(const std::string &text,
                                               llvm::LLVMContext &context) {
  llvm::SMDiagnostic diagnostic;
  std::unique_ptr<llvm::Module> module = llvm::parseAssemblyString(text, diagnostic, context);
  EXPECT_TRUE(module) << diagnostic.getMessage().str();
  return module;
}

} // namespace rtsl::codegen
