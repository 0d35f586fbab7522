//===- FileSearch.h - the file that a name denotes ------------------------===//
//
// `#include "name"` and `import "name";` search the folder of the file that contains them, then the
// folders of -I, in order. `#include <name>` searches only the latter.
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

/// The path of the first of these folders that holds a file of this name; an absolute name is its
/// own path.
std::optional<std::string> findFile(const std::string &name,
                                    const std::vector<std::string> &folders);

/// Adds to a message about a file that was not found the folders that were searched and a file name
/// that may have been meant. `place` is the range of the name itself, for a fix; not valid: no fix.
void explainSearch(Diagnostic &diagnostic, const std::string &name,
                   const std::vector<std::string> &folders, SourceRange place);

} // namespace rtsl
