//===- Stages.h - what can be looked at on the way ------------------------===//
//
// `rtslc compile --emit=NAME`, and what the other commands are made of. The table is in Stages.cpp:
// a new stage is a function and a row there.
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
}

/// What a compilation begins with.
struct CompileInput {
  // One of these, as Stage::needs says:
  std::vector<PreprocessedFile> texts;
  std::vector<const ast::TranslationUnit *> units;
  const typed::Module *module = nullptr; // without errors

  /// Link the module for a scene. Null: a file alone, in which what is called through references
  /// stays a declared slot.
  const LinkRequest *scene = nullptr;
  /// Of a scene: bind the program to these objects, as a package is. Null: to none.
  MakeObjects makeObjects = nullptr;
  CppRequest cpp = {};
};

/// One of the texts that rtslc can write.
struct Stage {
  enum class Needs : std::uint8_t { Text, SyntaxTree, Module };

  std::string_view name; // of --emit
  Needs needs;
  /// Null: there is one of a scene's linked program too. From `split` on it is what GPUs run:
  /// without recursion, with the traversal of runtime/device.
  const char *whyNoScene;
  bool keepsEvents; // prints and raises exceptions without a scene, too
  bool hasDouble;   // arithmetic may be in double
  /// Takes the compilation to this stage. False: something is wrong, which was reported.
  bool (*reach)(driver::Compilation &);
  std::string (*show)(driver::Compilation &);
};

/// All of them, in order.
const std::vector<Stage> &stages();

/// The stage of that name. Throws std::logic_error if there is none.
const Stage &stage(std::string_view name);

/// The text of a stage; nothing if there were errors.
std::optional<std::string> emit(const Stage &stage, const CompileInput &input,
                                const CompileOptions &options, Diagnostics &diagnostics);

} // namespace rtsl
