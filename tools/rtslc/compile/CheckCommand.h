//===- CheckCommand.h - the options of rtslc check -----------------------===//
#pragma once

#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"

#include <string>
#include <vector>

namespace rtsl::tool {

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> files, overrides;
  bool fix = false;
  bool errorsOnly = false; // not the warnings about a scene
};

/// Everything that happens to a scene before it is rendered, through any of its cameras.
void checkScene(const std::string &file, const CheckOptions &options, Messages &messages,
                std::vector<std::string> &filesRead);

} // namespace rtsl::tool
