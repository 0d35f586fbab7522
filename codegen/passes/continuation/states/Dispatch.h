//===- Dispatch.h - from states to a machine ------------------------------===//
#pragma once

#include "llvm/ADT/StringRef.h"

namespace rtsl::continuation {

/// Marks the functions in which makeDispatch (Steps.h) tells the machine about the rays of a scene:
/// the state in which an entry point begins, and which rays send which. In a module without a scene
/// they have nothing to tell.
constexpr llvm::StringLiteral factOfScene = "rtsl.fact_of_scene";

} // namespace rtsl::continuation
