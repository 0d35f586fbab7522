//===- FileSearch.h - which file a name means -----------------------------===//
//
// `#include "name"` and `import "name";` look beside the file that they stand in, then in the
// folders of -I, in order. `#include <name>` looks in the latter only.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"

#include <optional>
#include <string>
#include <vector>

namespace rtsl {

/// The folder of a file; "." for one of the working directory and for standard input.
std::string folderOf(std::string_view file);

/// The path of the first of these folders that holds a file of this name; an absolute name means
/// itself.
std::optional<std::string> findFile(const std::string &name,
                                    const std::vector<std::string> &folders);

/// Adds to a message about a file that was not found where it was looked for, and what may have
/// been meant. `place` is that of the name itself, for a fix; not valid: there is none.
void explainSearch(Diagnostic &diagnostic, const std::string &name,
                   const std::vector<std::string> &folders, SourceRange place);

} // namespace rtsl
