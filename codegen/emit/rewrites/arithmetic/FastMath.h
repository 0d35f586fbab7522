//===- FastMath.h - arithmetic for --fp=fast ------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Lets LLVM reassociate and fuse the arithmetic of the functions that the module defines, replace
/// a quotient by a product with a reciprocal and ignore the sign of a zero; elementary functions
/// become those of math/Fast.h. Infinities and NaNs keep their meaning. Must run while the module
/// contains only shader code: device code that is linked later, above all traversal, stays strict.
void relaxArithmetic(llvm::Module &module);

} // namespace rtsl::codegen
