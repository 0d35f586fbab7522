//===- SceneArguments.h - scenes on the command line ----------------------===//
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace rtsl::tool {

/// Whether a file is a scene, or a glTF file, and no shaders.
bool isScene(const std::string &file);

/// Adds --set.
void addSetOption(CLI::App &command, std::vector<std::string> &overrides);

} // namespace rtsl::tool
