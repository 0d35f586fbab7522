//===- PassLaunches.h - functions that read only the launch ---------------===//
//
// Code that reads members or texels, and nothing of the ray, gets the ray's state only to load the
// address of the launch from it. It gets this address instead:
//
//   define internal float @"Coated.value"(ptr %state, ...)     (ptr %launch, ...)
//     %launch = load ptr, ptr %state                      ==>
//     ... %launch ...                                            ... %launch ...
//
// and the ray's state need not be in memory where it is called.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Argument;
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Does the argument have the address of the launch since passLaunches?
bool isLaunch(const llvm::Argument &argument);

/// Passes the address of the launch to all functions of which that is so.
void passLaunches(llvm::Module &module);

} // namespace rtsl::codegen
