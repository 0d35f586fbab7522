//===- Versions.h - the libraries that the runtime was built with ---------===//
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rtsl::runtime {

/// Libraries that affect speed or pictures, as (name, version).
std::vector<std::pair<std::string, std::string>> libraryVersions();

} // namespace rtsl::runtime
