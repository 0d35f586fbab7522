//===- Payloads.h - rays that carry a struct ------------------------------===//
//
// A struct that rays carry has a number, and flags for how hits of its rays are searched: both come
// from linking (codegen/link/steps/RayTypes.cpp). Methods that take a payload are reached through
// slots that test which it is.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/states/StateMachines.h"
#include "codegen/cpp/tree/Declaration.h"

namespace rtsl::cpp {

/// The constant `rayType` of a struct that rays carry.
std::optional<Declaration> rayType(const ModuleFacts &facts, const typed::Struct &structure);

/// Methods of a name that take a payload, one for each type of it, inherited ones too.
std::vector<const typed::Function *> payloadMethods(const typed::Class &definition,
                                                    const std::string &name);

/// The functions `closestHitWithPayload` and others, but those that `runState` stands for.
Declarations payloadSlots(Context &context, const StateEntries &entries);
/// Assigns them to the program's slots.
Statements describePayloads(const Context &context, const StateEntries &entries);

} // namespace rtsl::cpp
