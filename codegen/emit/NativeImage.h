//===- NativeImage.h - position-independent machine code ------------------===//
//
// Code that was compiled ahead of time, as one block of bytes: already linked, so that it only has
// to be made executable. It refers to nothing outside, and to itself only by relative addresses.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/ADT/ArrayRef.h"
#include "llvm/Support/Error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::codegen {

struct NativeImage {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint64_t> entries; // offsets of the requested functions
  std::uint64_t stackBytes = 0;       // of the calling thread, at most
};

struct ObjectCode;

/// Links code for the host. It is an error if it calls undefined functions, has writable data, or
/// lacks an entry point.
llvm::Expected<NativeImage> makeNativeImage(const ObjectCode &object,
                                            llvm::ArrayRef<std::string> entries);

} // namespace rtsl::codegen
