//===- SplitMethods.h - which methods are printed as states ---------------===//
#pragma once

#include "codegen/cpp/Names.h"
#include "codegen/cpp/states/States.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <map>
#include <tuple>

namespace rtsl::cpp {

/// A method that traces and is called through references: it runs on a frame of its own, which
/// begins with a struct of its arguments and its result.
struct CalledMethod {
  std::string symbol;                        // of its declaration in the IR
  std::string slot;                          // its name in the IR, the same in every class
  const typed::Class *definition = nullptr;  // the first that has it
  const typed::Function *function = nullptr; // and what it has
  std::string step;                          // of its first state: `Filter_follow`
  std::string structure; // of the arguments, in the type of references to the class: `Follow`
  // in the order of the IR; null: the address for a result that stays whole
  std::vector<const typed::Variable *> arguments;
  std::vector<std::string> fields;   // of the arguments
  std::vector<std::int32_t> offsets; // in the IR
  std::string returned;              // the field of the result; empty: there is none
};

class SplitMethods {
public:
  /// `program` may be null: then traces are calls, and nothing is split.
  SplitMethods(const typed::Module &module, const Names &names, const StateProgram *program);

  /// Is the method printed as its states in this class?
  bool isSplit(const typed::Class &definition, const typed::Function &method) const;
  /// Has the function become part of the states of others?
  bool isPartOfStates(const typed::Function &function) const;
  /// Is it printed as one function?
  bool isWhole(const typed::Function &function) const;
  /// Is a function that is printed as one virtual in C++?
  bool isVirtual(const typed::Function &function) const;
  /// Does the method, printed as one function or not, override such a function?
  bool overridesVirtual(const typed::Function &function) const;
  /// The states of a method of a class, by its name in the IR. `isCalled`: on a frame of its own.
  const std::vector<mlir::func::FuncOp> &statesOf(const typed::Class &definition,
                                                  const std::string &slot, bool isCalled) const;
  /// The name in C++ of the first state of a method that rays start, or others call.
  std::string nameOfMachine(const typed::Class &definition, const typed::Function &method) const;
  /// A new name for the number of a state.
  std::string stepName(const typed::Class &definition, const std::string &function);

  /// The method that a declaration in the IR stands for; null: there is none.
  const CalledMethod *calledMethod(const std::string &symbol) const;
  const CalledMethod *calledMethod(const typed::Class &definition,
                                   const typed::Function &method) const;
  /// The struct of its arguments: `FilterRef::Follow`.
  std::string structureOf(const CalledMethod &called) const;
  /// The author's structs and classes.
  const std::set<std::string> &typeNames() const { return fileTypes; }

  const StateProgram *const program;
  std::vector<CalledMethod> calledMethods;

private:
  void findStates();
  void findCalledMethods();

  const typed::Module &module;
  const Names &names;
  std::set<std::string> fileTypes, stepNames;
  /// The states by class, name of the method in the IR, and whether it has a frame of its own.
  std::map<std::tuple<std::string, std::string, bool>, std::vector<mlir::func::FuncOp>> states;
};

} // namespace rtsl::cpp
