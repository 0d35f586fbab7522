//===- Lookups.h - what textures store ------------------------------------===//
#pragma once

#include "llvm/ADT/StringRef.h"

namespace rtsl::ir {

/// Is it one of the state variables in which a texture's `lookup` stores its results?
inline bool isLookupResult(llvm::StringRef state) {
  return state == "TextureColor" || state == "FloatTextureValue";
}

} // namespace rtsl::ir
