//===- Context.h - what all parts of the C++ printer share ----------------===//
#pragma once

#include "codegen/cpp/EmitCpp.h"
#include "codegen/cpp/Names.h"
#include "codegen/cpp/Requirements.h"
#include "codegen/cpp/ScratchMembers.h"
#include "codegen/cpp/Signatures.h"
#include "codegen/cpp/SourceNotes.h"
#include "codegen/cpp/Types.h"
#include "codegen/cpp/states/SplitMethods.h"
#include "codegen/link/ModuleFacts.h"
#include "sema/typed/Effects.h"

namespace rtsl::cpp {

/// A module that is being printed. Facts do not change; `required` grows with each function.
class Context {
public:
  /// `states`: methods that trace, split; null: traces are calls.
  Context(const typed::Module &module, const ModuleFacts &facts, const Options &options,
          Diagnostics &diagnostics, const StateProgram *states);

  /// Reports that something cannot be printed.
  void unsupported(SourceRange range, const std::string &what);
  /// Printing fails: for a reason that has been reported, or one that only a fault of the compiler
  /// can cause.
  void fail() { failed = true; }
  bool hasFailed() const { return failed; }

  /// The place of the range in the source, for `#line`; nothing if `#line` is not to be printed.
  std::optional<SourcePlace> lineDirective(SourceRange range) const;
  std::optional<SourcePlace> lineDirective(SourceRange ofFile, unsigned line) const;
  /// The C++ names that mean something in every method of a class: those at file level, and those
  /// of the class.
  const std::set<std::string> &namesInFile() const { return fileNames; }
  std::set<std::string> namesInClass(const typed::Class &definition) const;

  const typed::Module &module;
  const ModuleFacts &facts;
  const Options &options;
  const Names names;
  const SourceNotes notes;
  typed::EffectsOf effects;
  Requirements required;
  Types types;
  ScratchMembers scratch;
  SplitMethods split;
  Signatures signatures;

private:
  Diagnostics &diagnostics;
  std::set<std::string> fileNames;
  bool failed = false;
};

} // namespace rtsl::cpp
