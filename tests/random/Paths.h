//===- Paths.h - the ways to run a program, which all agree ---------------===//
#pragma once

#include "Findings.h"
#include "PrintedCpp.h"
#include "Program.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::random {

/// How programs are run.
struct PathOptions {
  std::vector<std::string> wanted; // names; empty: the path that differs most
  std::vector<std::string> also;   // names of more
  CppOptions cpp;
};

/// Runs the programs, compiled together, on every wanted path that can run them, and compares with
/// the first path. One finding a program; a Rejected or Fault of the whole stands at all of them,
/// but those that an earlier path has failed.
std::vector<Finding> compare(const std::vector<const Program *> &programs,
                             const PathOptions &options);

/// The names of the paths on which the program of a seed runs: those that share them can be
/// compiled together.
std::vector<std::string> pathsOf(std::uint32_t seed, const PathOptions &options);

std::vector<std::string> pathNames();

} // namespace rtsl::random
