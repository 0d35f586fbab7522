//===- Classes.h - the author's functions and classes ---------------------===//
#pragma once

#include "codegen/cpp/Variables.h"
#include "codegen/cpp/states/StateMachines.h"

namespace rtsl::cpp {

/// Prototypes and definitions.
Declarations freeFunctions(Context &context);

class Classes {
public:
  Classes(Context &context, Variables &variables, StateMachines &machines)
      : context(context), variables(variables), machines(machines) {}

  Declaration definition(const typed::Class &definition);

private:
  Declarations members(const typed::Class &definition);
  std::optional<Declaration> scratchStructure(const typed::Class &definition);
  Declarations methodsOfBases(const typed::Class &definition) const;

  Context &context;
  Variables &variables;
  StateMachines &machines;
};

} // namespace rtsl::cpp
