//===- ProgramFolder.h - where the running program is ---------------------===//
#pragma once

#include <filesystem>
#include <system_error>

namespace rtsl {

/// The folder of the running program, links to it resolved; empty if it cannot be determined.
inline std::filesystem::path programFolder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

} // namespace rtsl
