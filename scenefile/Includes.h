//===- Includes.h - scene files that are parts of others ------------------===//
#pragma once

#include "scenefile/json/JsonValue.h"
#include "support/ErrorCollector.h"

#include <string>
#include <vector>

namespace rtsl::scene {

/// Throws MissingKey or NotSupported unless a scene file begins with the version of the format.
void checkVersion(const JsonValue &root);

/// Adds what the scene files of `include` have to a scene, and those that they include in turn;
/// each file once. Sections of names are united, lists joined, those of included files first; of
/// all else, and of the keys of `render`, the including file decides. Returns the files that were
/// read.
std::vector<std::string> expandIncludes(JsonValue &root, const std::string &file,
                                        ErrorCollector &errors);

} // namespace rtsl::scene
