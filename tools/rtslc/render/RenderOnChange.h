//===- RenderOnChange.h - rtslc render --watch ----------------------------===//
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace rtsl::tool {

/// One rendering of a command.
struct Rendering {
  bool isDone = false;            // there is a new picture
  std::vector<std::string> files; // that it depends on, as far as they are known
};

/// Renders, and again whenever a file changes that the last rendering depended on, until SIGINT or
/// SIGTERM. A rendering that is overtaken by a change is stopped by the flag; it then writes
/// nothing. Throws Error with FileUnreadable if the system cannot watch files.
void renderOnChange(const std::function<Rendering(const std::atomic<bool> &stop)> &render,
                    const std::string &output, bool isQuiet);

} // namespace rtsl::tool
