//===- HandOver.h - commands that rtslc-render runs -----------------------===//
//
// Scenes need Embree, assimp and the image libraries. Loading these takes longer than `rtslc check`
// may take as a whole, so the commands that use them, and what `check`, `compile` and `explain` do
// with a scene, are in `rtslc-render`, beside `rtslc`, which becomes that program for them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <CLI/CLI.hpp>

namespace rtsl::tool {

/// Lists the commands of rtslc-render, for --help.
void addHandedOverCommands(CLI::App &app);

/// Becomes rtslc-render for one of its commands and for a scene; otherwise returns. Throws
/// std::runtime_error if that program is missing.
void handOver(char **argv);

} // namespace rtsl::tool
