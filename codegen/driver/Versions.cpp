//===- Versions.cpp -------------------------------------------------------===//
#include "codegen/driver/Versions.h"

#include <llvm/Config/llvm-config.h>

namespace rtsl {

std::string llvmVersion() {
  return LLVM_VERSION_STRING;
}

} // namespace rtsl
