//===- PreprocessorCommandLine.h - -I, -D, -U, -MD and what they do -------===//
#pragma once

#include "frontend/preprocessor/Preprocessor.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace rtsl::tool {

/// -MD, -MF and -MT.
struct DependencyOptions {
  bool isAsked = false;
  std::string file;   // empty: the output's, or else the first source's, with the suffix .d
  std::string target; // empty: the output, or else the dependency file
};

/// Adds -I, -D and -U.
void addPreprocessorOptions(CLI::App &command, PreprocessorOptions &options);
/// Adds -MD, -MF and -MT.
void addDependencyOptions(CLI::App &command, DependencyOptions &options);

/// Spells the options of two letters behind one dash (`-MD`) as the command line library expects
/// them (`--MD`).
std::vector<std::string> withLongDashes(int argc, char **argv);

/// The rule `target: files` for make and ninja.
std::string dependencyRule(const std::string &target, const std::vector<std::string> &files);

/// Where the rule is written. `sources` are the files of the command line.
std::string dependencyFile(const DependencyOptions &options, const std::string &output,
                           const std::vector<std::string> &sources);

/// Throws FileUnwritable if `output` (empty: there is none) or the dependency file cannot be
/// written, and OverwritesInput if one of them is a file of the command line or one that was read.
/// Before work begins, and again when all inputs are known.
void checkOutputs(const std::string &output, const DependencyOptions &dependencies,
                  const std::vector<std::string> &sources,
                  const std::vector<std::string> &filesRead = {});

/// Writes the dependency file if requested: what `output` (empty or "-": no file) was made
/// of. `sources` are the files of the command line, `files` all that were read. Throws Error with
/// FileUnwritable.
void writeDependencies(const DependencyOptions &options, const std::string &output,
                       const std::vector<std::string> &sources,
                       const std::vector<std::string> &files);

} // namespace rtsl::tool
