//===- Dispatch.h - calls of methods of the object's class ----------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/tree/Declaration.h"

#include <functional>

namespace rtsl::cpp {

/// The author's classes that are this class, of the author's or of the language, or derive from it.
std::vector<const typed::Class *> classesBelow(const typed::Module &module,
                                               const std::string &className);

/// A switch over the classes of the object, or the statements alone if there is one class. `run`
/// gives nothing for a class that has no such method. `mayBeNone`: nothing happens if there is no
/// object.
Statements dispatch(const Names &names, const std::vector<const typed::Class *> &classes,
                    const std::function<Statements(const typed::Class &)> &run,
                    bool mayBeNone = false);

/// The object that the runtime names, as one of this class.
Code objectOf(const Names &names, const typed::Class &definition);
/// The scratch members of a class that the hit so far has stored.
Code storedScratch(const Names &names, const typed::Class &definition);
/// The ray's payload.
Code payloadAt(const Names &names, const typed::Struct &payload);
/// Whether the ray's payload is of that type.
Code carries(const Names &names, const typed::Struct &payload);

/// `inline void name(RtslState *ray, RtslRef object)`, which the runtime calls.
Function slotFunction(const std::string &name, Statements body);
/// The statements, with a variable for the ray's state above them.
Statements withState(const Options &options, Statements body);

/// The method of a class that `like` is, or that overrides it; null: none.
const typed::Function *findMethod(const typed::Class &definition, const typed::Function &like);
/// The method that a class has for a slot of language/Slots.def or SamplingSlots.def; null: none.
const typed::Function *slotMethod(const typed::Class &definition, const std::string &name);

bool endsInReturn(const Statements &statements);

} // namespace rtsl::cpp
