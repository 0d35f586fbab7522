//===- Preprocessor.h - directives and macros -----------------------------===//
//
// The preprocessor is clang's, which records where every token came from. It runs on a file and
// produces a new text (frontend/source/Expansion.h), which all later stages read.
// docs/preprocessor.md explains why, and what is ours: the features that the language has or lacks,
// all messages, the limits, and the mapping back to what the author wrote.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"

#include <string>
#include <string_view>
#include <vector>

namespace rtsl {

/// -D and -U.
struct MacroOption {
  std::string name, value;
  bool isUndefined = false;
};

struct PreprocessorOptions {
  std::vector<std::string> includeFolders; // -I, in order
  std::vector<MacroOption> macros;         // in order: the last one for a name counts
};

/// Limits, so that a few lines cannot exhaust memory.
constexpr std::size_t maxMacroWords = std::size_t{1} << 21; // made by the macros of one file
constexpr std::size_t maxConditionWords = 1000;             // made by the macros of one #if
constexpr std::size_t maxConditionOperators = 1000; // parentheses and signs written in one #if
constexpr std::size_t maxMacroDepth = 1000;         // macros in the bodies of macros
constexpr std::size_t maxArgumentDepth = 200;       // macros in the arguments of macros
constexpr std::size_t maxIncludeDepth = 100;        // files included within files
constexpr std::size_t maxIncludes = 10000;          // for one file
constexpr std::size_t maxIncludedBytes = std::size_t{256} << 20; // for one file

/// `__LINE__`, `__FILE__`, `__VERSION__` and `__RTSL__`.
bool isOfTheLanguage(std::string_view macro);

struct PreprocessedFile {
  FileId text = 0; // what to parse; the file itself if there is nothing to do
  /// False after a mistake from which later stages cannot recover, such as a file that was not
  /// found.
  bool isUsable = true;
  std::vector<std::string> includes; // files that were read, each once
};

/// Runs the preprocessor on a file of `sources`, those of `diagnostics`. If the text can contain no
/// directive or macro, it is only scanned.
PreprocessedFile preprocess(FileId file, SourceManager &sources, const PreprocessorOptions &options,
                            Diagnostics &diagnostics);

/// The text for people and for another run, with `#line` directives that give its origin:
/// `--emit=preprocessed`.
std::string printPreprocessed(FileId text, const SourceManager &sources);

} // namespace rtsl
