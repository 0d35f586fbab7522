//===- CalledMethods.h - methods that trace, called through references ----===//
//
//   struct FilterRef : rtsl::Reference {
//     struct Follow { ... };                   // the arguments and the result of `follow`
//   };
//   return rtsl::callThen(rt, frame, Step::Tint_shadeAfterCall1, inner, FilterRef::Follow{o, d});
//
// The caller's state ends there, and another runs when the method has returned. The method's frame
// begins with that struct, whatever class has it (include/rtsl/shader/Calls.h,
// codegen/passes/continuation/calls/OpenCalls.cpp).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/states/StateMachines.h"

namespace rtsl::cpp {

/// The structs of arguments, as members of the type of references to a class.
Declarations callStructures(Context &context, const std::string &className);
/// The method of an object's class begins, or runs at once if that does not trace.
Statements runCalledMethod(Context &context, const StateEntries &entries,
                           const CalledMethod &called);

} // namespace rtsl::cpp
