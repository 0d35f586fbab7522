//===- PrintedCpp.h - a module as C++ that a compiler made a program of ---===//
#pragma once

#include "codegen/driver/Compiler.h"

#include <memory>
#include <string>

namespace rtsl::random {

/// What becomes of programs that are printed.
struct CppOptions {
  std::string compiler = "g++ -O1"; // a command with its options; empty: they are only printed
  std::string keep; // the file that is left of the last one that was compiled; empty: none is
};

/// Prints the module with these RTSL_FEATURE_* as one file of C++, has a compiler make a shared
/// object of it and loads that. Null if it cannot be printed, which is reported; an empty program
/// if there is no compiler. Throws CompilerRefuses.
std::shared_ptr<const runtime::Program> compilePrinted(const typed::Module &module, TraceMode trace,
                                                       bool checkIndices, std::uint32_t features,
                                                       unsigned colorComponents,
                                                       const CppOptions &cpp,
                                                       Diagnostics &diagnostics);

/// The errors of a compiler for invalid C++.
struct CompilerRefuses {
  std::string message;
};

} // namespace rtsl::random
