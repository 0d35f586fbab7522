//===- Versions.h - versions of the libraries -----------------------------===//
#pragma once

#include <string>

namespace rtsl {

/// The version of LLVM and MLIR, such as "22.1.0".
std::string llvmVersion();

} // namespace rtsl
