//===- RunState.h - all states of a program, by number --------------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/states/StateMachines.h"
#include "codegen/cpp/tree/Declaration.h"

namespace rtsl::cpp {

class RunState {
public:
  RunState(Context &context, const StateEntries &entries) : context(context), entries(entries) {}

  /// The enumeration `Step`.
  Declarations stepNumbers() const;
  /// The function `runState`, which runs the state of a number.
  Declarations function();
  Statements describe() const;

private:
  Statements begin(const typed::Class &definition, const typed::Function &method,
                   const typed::Struct *payload);

  Context &context;
  const StateEntries &entries;
};

/// Does `runState` stand for the slot, because some method traces?
bool isRunBySteps(const StateEntries &entries, const std::string &slot);

} // namespace rtsl::cpp
