//===- NativeImage.h - machine code that runs wherever it lies ------------===//
//
// Code that was compiled ahead, as one block of bytes: linked, so that nothing is left to be done
// but to make it executable. It refers to nothing outside, and to itself by distances alone.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/ADT/ArrayRef.h"
#include "llvm/Support/Error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace llvm {
class Module;
class TargetMachine;
} // namespace llvm

namespace rtsl::codegen {

struct NativeImage {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint64_t> entries; // where the functions that were asked for begin
  std::uint64_t stackBytes = 0;       // of the calling thread, at most
};

/// Compiles an optimised module for the host. An error if it calls what it does not define, has
/// data that it writes, or lacks an entry.
llvm::Expected<NativeImage> makeNativeImage(llvm::Module &module, llvm::TargetMachine &machine,
                                            llvm::ArrayRef<std::string> entries);

} // namespace rtsl::codegen
