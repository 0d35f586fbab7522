//===- StateMachines.h - methods that trace, as functions for states ------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/tree/Declaration.h"

#include <map>
#include <set>
#include <string>

namespace rtsl::cpp {

struct FrameField;
struct Machine;
struct MethodPrinter;

/// `shadeAfterTrace1(rt, frame)`, on an object.
struct MethodCall {
  std::string method;
  std::vector<Code> arguments;
  Code on(const Code &object) const { return callMember(object, method, arguments); }
};

/// A state that runs after a ray.
struct Step {
  std::string name; // its number in C++
  const typed::Class *definition = nullptr;
  const typed::Function *method = nullptr;
  MethodCall call;
};

/// How the runtime reaches the states that have been made.
struct StateEntries {
  std::vector<Step> steps;
  std::map<std::pair<const typed::Class *, std::string>, MethodCall>
      firstCalls;                                // by class and method
  std::vector<std::string> frames, calledFrames; // the structs

  bool empty() const { return firstCalls.empty(); }
};

class StateMachines {
public:
  explicit StateMachines(Context &context) : context(context) {}

  /// The frame and the states of a method, as members of a class.
  Declarations of(const typed::Class &definition, const typed::Function &method);
  /// The frames and states of inherited methods whose states differ in this class.
  Declarations inherited(const typed::Class &definition);

  StateEntries entries;

private:
  Machine machineOf(const typed::Class &definition, const typed::Function &method,
                    std::set<std::string> &taken);
  std::optional<Declaration> frameStructure(Machine &machine, std::set<std::string> &taken);
  void nameArguments(const Machine &machine, Statements &body);
  Declaration stateFunction(const Machine &machine, MethodPrinter &printer, std::size_t number);
  bool differsIn(const typed::Class &derived, const typed::Function &method) const;
  std::string meaningOf(const typed::Function &method, const FrameField &field);

  Context &context;
  // Of each class: an inherited method and one of its own may have the same name.
  std::map<const typed::Class *, std::set<std::string>> frameStructs;
};

} // namespace rtsl::cpp
