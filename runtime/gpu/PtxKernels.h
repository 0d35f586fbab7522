//===- PtxKernels.h - the kernels of a program's PTX ----------------------===//
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rtsl::runtime {

/// Where the kernel of this name begins in PTX; npos: there is none.
inline std::size_t findKernel(const std::string &ptx, std::string_view name) {
  return ptx.find(".entry " + std::string(name) + "(");
}

inline bool hasKernel(const std::string &ptx, std::string_view name) {
  return findKernel(ptx, name) != std::string::npos;
}

} // namespace rtsl::runtime
