//===- FastMath.h - what --fp=fast changes --------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Lets LLVM reassociate and fuse the arithmetic of what the module defines, take a quotient for a
/// product with a reciprocal and forget the sign of a zero; elementary functions become those of
/// math/Fast.h. Infinities and NaNs keep their meaning. Call it while shader code is
/// alone in the module: device code that is linked later stays strict, traversal above all.
void relaxArithmetic(llvm::Module &module);

} // namespace rtsl::codegen
