//===- AlignMembers.h - members and elements of buffers on a GPU ----------===//
//
// The lanes of a warp load members of different objects, and each load takes as long as they have
// cache lines. LLVM joins loads and stores of neighbouring words to one of up to 16 bytes where it
// knows their alignment: records begin at multiples of 16 (runtime/scene/Objects.cpp), and the
// elements of buffers at multiples of 64 (runtime/accel/Flatten.cpp, runtime/package/Buffers.cpp).
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Declares the alignment of members and elements, in a module that has just been translated from
/// MLIR, where their addresses are as MemoryPatterns.cpp writes them:
///
///   %record = getelementptr inbounds [1 x i8], ptr %records, i64 %reference
///   %member = getelementptr inbounds nuw i8, ptr %record, i32 16
///   load float, ptr %member, align 4
///   =>
///   load float, ptr %member, align 16
///
/// An element of 32 bytes is at `getelementptr inbounds [32 x i8], ptr %elements, i64 %index`,
/// where %elements is loaded from a record.
void alignMembers(llvm::Module &module);

} // namespace rtsl::codegen
