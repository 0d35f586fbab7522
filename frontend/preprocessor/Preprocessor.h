//===- Preprocessor.h - directives and macros -----------------------------===//
//
// The preprocessor is clang's, which is made for compilers that have to say where every word came
// from. It runs on a file and gives a text of its own (frontend/source/Expansion.h), which all
// later stages read. docs/preprocessor.md tells why, and what is ours: what the language has and
// has not, all messages, the limits, and the way back to what the author wrote.
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
  std::vector<MacroOption> macros;         // in order: the last one of a name counts
};

/// Limits, so that a few lines cannot fill the memory.
constexpr std::size_t maxMacroWords = std::size_t{1} << 21; // made by the macros of one file
constexpr std::size_t maxConditionWords = 1000;             // made by the macros of one #if
constexpr std::size_t maxConditionOperators = 1000; // parentheses and signs written in one #if
constexpr std::size_t maxMacroDepth = 1000;         // macros in the bodies of macros
constexpr std::size_t maxArgumentDepth = 200;       // macros in the arguments of macros
constexpr std::size_t maxIncludeDepth = 100;        // files in files
constexpr std::size_t maxIncludes = 10000;          // for one file
constexpr std::size_t maxIncludedBytes = std::size_t{256} << 20; // for one file

/// `__LINE__`, `__FILE__`, `__VERSION__` and `__RTSL__`.
bool isOfTheLanguage(std::string_view macro);

struct PreprocessedFile {
  FileId text = 0; // what to parse; the file itself if there is nothing to do
  /// False after a mistake behind which nothing can be understood, such as a file that was not
  /// found.
  bool isUsable = true;
  std::vector<std::string> includes; // files that were read, each once
};

/// Runs the preprocessor on a file of `sources`, those of `diagnostics`. Costs nothing but a look
/// at the text where no directive and no macro can be.
PreprocessedFile preprocess(FileId file, SourceManager &sources, const PreprocessorOptions &options,
                            Diagnostics &diagnostics);

/// The text for people and for another run: with `#line` directives that say where it is from.
/// `--emit=preprocessed`.
std::string printPreprocessed(FileId text, const SourceManager &sources);

} // namespace rtsl
