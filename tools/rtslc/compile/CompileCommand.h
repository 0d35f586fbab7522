//===- CompileCommand.h - the options of rtslc compile -------------------===//
#pragma once

#include "codegen/driver/Stages.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"

#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

struct CompileCommandOptions {
  CommonOptions common;
  std::vector<std::string> files;
  const Stage *stage = nullptr;
  std::vector<std::string> overrides;
  std::string output = "-";
  bool lineDirectives = false;
  bool prints = false, exceptions = false;
  std::optional<TraceMode> trace; // if it was given
};

/// The text of the requested stage of a whole scene; nothing if there were errors.
std::optional<std::string> translateScene(const CompileCommandOptions &options, Messages &messages,
                                          std::vector<std::string> &filesRead);

} // namespace rtsl::tool
