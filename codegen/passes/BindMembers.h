//===- BindMembers.h - members that are the same in all objects -----------===//
//
// When the objects of a scene are known, linking records on each member that has one value in all
// of them its words in their records, and on the module other facts about the scene:
//
//   rtsl.member_decl @index : f32 access "private" {rtsl.bound = array<i32: 1069547520>}   // 1.5
//   module attributes {rtsl.light_count = 2 : i32, rtsl.ambient = array<f32: 0.1, 0.1, 0.2>}
//
// This pass replaces the loads of such members by constants, so that computations on them fold.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-bind-members`, on a function. It must not run on constructors.
std::unique_ptr<mlir::Pass> createBindMembersPass();

} // namespace rtsl::codegen
