//===- ObjectValues.h - an object's values, checked against its class -----===//
//
// Converts the values of an object to the packed arguments of its constructor and the bytes of its
// members. Errors name the value and list what the class declares.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/SceneData.h"
#include "runtime/scene/ValueStore.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// The arguments of the class's constructor, packed as it reads them, in words; empty if one of
/// them is refused. Throws BadArguments if the class has no constructor, or if a parameter has no
/// argument or two, or an argument no parameter; all errors of values at once: WrongType,
/// OutOfRange, WrongClass.
std::vector<std::uint32_t> packArguments(const ClassInfo &classInfo, const ObjectValues &values,
                                         const StoreContext &context);

/// Writes the given public members to the object's record. `name` is the object's, for messages.
/// Throws all their errors at once: UnknownMember, NotSettable, WrongType,
/// OutOfRange, WrongClass. `lacksArguments`: the constructor has reported those that are missing,
/// and nothing is said of members that have the names of parameters alone.
void storeMembers(const ClassInfo &classInfo, const std::string &name, const ObjectValues &values,
                  std::uint8_t *record, const StoreContext &context, bool lacksArguments = false);

/// Checks the members that are not given: throws OutOfRange for all whose default, or the value
/// that the constructor gave them, is not in their range.
void checkOwnValues(const ClassInfo &classInfo, const std::string &name, const ObjectValues &values,
                    const std::uint8_t *record, std::uint32_t colorComponents);

/// Checks the public members that have no default and are not given, after the object is complete,
/// of those that are required, and of references that are empty: throws MissingMember.
void checkUnset(const ClassInfo &classInfo, const std::string &name, const ObjectValues &values,
                const std::uint8_t *record);

} // namespace rtsl::runtime
