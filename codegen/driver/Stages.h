//===- Stages.h - the stages of the pipeline ------------------------------===//
//
// The outputs of `rtslc compile --emit=NAME`, which other commands use too. The table is in
// Stages.cpp: a new stage is a function and a row there.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "frontend/preprocessor/Preprocessor.h"
#include "frontend/syntax/Ast.h"

#include <string_view>

namespace rtsl {

namespace driver {
struct Compilation;
struct MachineCode;
} // namespace driver

/// The input of a compilation.
struct CompileInput {
  // One of these, by Stage::needs:
  std::vector<PreprocessedFile> texts;
  std::vector<const ast::TranslationUnit *> units;
  const typed::Module *module = nullptr; // without errors

  /// Link the module for a scene. Null: a single file, in which slots remain declared functions.
  const LinkRequest *scene = nullptr;
  /// For a scene: bind the program to these objects, as for a package. Null: do not bind it.
  MakeObjects makeObjects = nullptr;
  /// Required for a scene, and for stages of machine code.
  const driver::MachineCode *machineCode = nullptr;
  CppRequest cpp = {};
};

/// One of the outputs of rtslc.
struct Stage {
  enum class Needs : std::uint8_t { Text, SyntaxTree, Module };

  std::string_view name; // of --emit
  Needs needs;
  /// The reason why the stage is not available for a scene's linked program; null if it is. From
  /// `split` on that program is the one for GPUs: without recursion, with the traversal of
  /// runtime/device.
  const char *whyNoScene;
  bool keepsEvents; // supports prints and exceptions without a scene, too
  bool hasDouble;   // arithmetic may be in double
  bool isMachine;   // needs CompileInput::machineCode
  /// Takes the compilation to this stage. False if an error was reported.
  bool (*reach)(driver::Compilation &);
  std::string (*show)(driver::Compilation &);
};

/// All stages, in order.
const std::vector<Stage> &stages();

/// The stage of that name. Throws std::logic_error if there is none.
const Stage &stage(std::string_view name);

/// The text of a stage; nothing if there were errors.
std::optional<std::string> emit(const Stage &stage, const CompileInput &input,
                                const CompileOptions &options, Diagnostics &diagnostics);

} // namespace rtsl
