//===- AlignMembers.h - loads of members on a GPU -------------------------===//
//
// The lanes of a warp load members of different objects, and each load takes as long as they have
// cache lines. LLVM joins loads of neighbouring members to one of up to 16 bytes where it knows
// their alignment: records begin at multiples of 16 (runtime/scene/Objects.cpp).
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Declares the alignment of loads of members, in a module that has just been translated from MLIR,
/// where their addresses are as MemoryPatterns.cpp writes them:
///
///   %record = getelementptr inbounds [1 x i8], ptr %records, i64 %reference
///   %member = getelementptr inbounds nuw i8, ptr %record, i32 16
///   load float, ptr %member, align 4
///   =>
///   load float, ptr %member, align 16
void alignMembers(llvm::Module &module);

} // namespace rtsl::codegen
