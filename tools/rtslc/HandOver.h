//===- HandOver.h - commands that rtslc-render runs -----------------------===//
//
// Scenes need Embree, the image libraries and LLVM's code generators. Loading these takes longer
// than `rtslc check` may take as a whole, so the commands that use them, what `check`, `compile`
// and `explain` do with a scene, and the stages `llvm` and `ptx` are in `rtslc-render`, beside
// `rtslc`, which becomes that program for them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <CLI/CLI.hpp>

namespace rtsl::tool {

/// Lists the commands of rtslc-render, for --help.
void addHandedOverCommands(CLI::App &app);

/// Becomes rtslc-render for one of its commands, a scene and machine code; otherwise returns.
/// Throws std::runtime_error if that program is missing.
void handOver(char **argv);

} // namespace rtsl::tool
