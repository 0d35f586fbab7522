//===- LlvmErrors.cpp - handling of LLVM's own failures -------------------===//
#include "codegen/driver/LlvmErrors.h"

#include "llvm/Support/ErrorHandling.h"

namespace rtsl {

void onLlvmOutOfMemory(void (*end)()) {
  static void (*chosen)() = end;
  llvm::install_bad_alloc_error_handler([](void *, const char *, bool) { chosen(); });
}

} // namespace rtsl
