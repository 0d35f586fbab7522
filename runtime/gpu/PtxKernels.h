//===- PtxKernels.h - the kernels of a program's PTX ----------------------===//
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
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

/// The largest number of registers that a kernel states for itself; 0: none does.
inline unsigned mostRegistersStated(const std::string &ptx) {
  constexpr std::string_view directive = ".maxnreg ";
  unsigned most = 0;
  for (std::size_t at = ptx.find(directive); at != std::string::npos;
       at = ptx.find(directive, at + 1))
    most = std::max(most, unsigned(std::atoi(ptx.c_str() + at + directive.size())));
  return most;
}

} // namespace rtsl::runtime
