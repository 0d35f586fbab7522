#include "codegen/cpp/states/values/ValueNames.h"

#include "codegen/cpp/states/values/ValueTypes.h"
#include "codegen/passes/continuation/common/Names.h"
#include "sema/typed/Casting.h"

#include <cctype>

namespace rtsl::cpp {

ValueNames::ValueNames(Context &context, const SourceTable &source, const Machine &machine,
                       FunctionPrinter &functions)
    : context(context), source(source), machine(machine), functions(functions),
      reserved(context.namesInClass(*machine.definition)) {
  for (std::size_t at = 0; machine.called && at < machine.called->arguments.size(); ++at)
    reserved.insert(machine.addressName(context, at));
  reserved.insert({machine.frameName, machine.callName});
}

std::string spelling(const Machine &machine, llvm::StringRef name) {
  std::string spelled;
  for (std::size_t at = 0; at != name.size(); ++at)
    if (llvm::isAlnum(name[at]) || name[at] == '_')
      spelled += name[at];
    else if (name[at] != ']' && (at + 1 == name.size() || !llvm::isDigit(name[at + 1])))
      spelled += '_';
  const auto isAuthors = [&](const auto &variable) { return variable->name == name; };
  if (!isStateVariable(name) || llvm::any_of(machine.method->locals, isAuthors) ||
      llvm::any_of(machine.method->parameters, isAuthors))
    return spelled;
  spelled[0] = llvm::toLower(spelled[0]);
  return spelled;
}

std::string ValueNames::fresh(const std::string &wanted) {
  std::string clean = spelling(machine, wanted);
  while (clean.find("__") != std::string::npos)
    clean.erase(clean.find("__"), 1);
  if (clean.empty() || std::isdigit(static_cast<unsigned char>(clean.front())))
    clean = "value" + clean;
  std::string name = clean;
  for (unsigned i = 2; isReserved(name) || isReservedHere(name) ||
                       functions.temporaries.count(name) || !taken.insert(name).second;
       ++i)
    name =
        clean + (i == 2 && (isReserved(clean) || isReservedHere(clean)) ? "_" : std::to_string(i));
  functions.usedNames.insert(name);
  return name;
}

std::string nameFor(mlir::Value value) {
  if (std::string name = continuation::authorsName(value); !name.empty())
    return name.substr(0, name.find('.') == std::string::npos ? name.size() : name.find('.'));
  mlir::Operation *op = value.getDefiningOp();
  if (llvm::isa_and_nonnull<ir::RandOp>(op))
    return "random";
  if (llvm::isa_and_nonnull<ir::TraceResultOp>(op))
    return "traced";
  if (llvm::isa_and_nonnull<ir::CallReturnedOp>(op))
    return "returned";
  if (auto load = llvm::dyn_cast_or_null<ir::FrameLoadOp>(op))
    return load.getName().str();
  if (auto load = llvm::dyn_cast_or_null<ir::LoadOp>(op)) {
    std::string name = continuation::sourceName(value);
    name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
    return name;
  }
  return "value";
}

const std::string &ValueNames::of(ir::VarOp variable) {
  std::string &name = variables[variable];
  if (name.empty()) { // "sum.2": a second variable `sum`
    const auto [base, number] = variable.getName().rsplit('.');
    const bool isNumbered = !number.empty() && llvm::all_of(number, llvm::isDigit);
    name = fresh((isNumbered ? base : variable.getName()).str());
  }
  return name;
}

std::string ValueNames::ofValue(mlir::Value value) {
  if (auto whole = value.getDefiningOp<ir::ExpressionOp>();
      whole && source.entries[whole.getSource()].kind == SourceTable::Kind::AngleCosine)
    return "cosine";
  const std::string name = nameFor(value);
  if (auto load = value.getDefiningOp<ir::FrameLoadOp>())
    if (const FrameField *field = machine.savedField(load.getName()); field && field->isUnnamed)
      return field->name;
  auto call = value.getDefiningOp<ir::EvaluateOp>();
  if (!call || !continuation::authorsName(value).empty())
    return name;
  const typed::Expr *expr = source.entries[call.getSource()].expr;
  const typed::Function *callee = nullptr;
  if (auto *direct = dynCast<typed::CallExpr>(expr))
    callee = direct->function;
  else if (auto *method = dynCast<typed::MethodCallExpr>(expr))
    callee = method->function;
  if (!callee)
    return name;
  unsigned number = 1; // `bounce1`: the result of the first call of `bounce`
  while (taken.count(context.names.of(callee) + std::to_string(number)))
    ++number;
  return context.names.of(callee) + std::to_string(number);
}

std::string ValueNames::ofLights() {
  std::string name = "lights"; // nested loops over lights need different names
  for (unsigned i = 2; isReservedHere(name) || !taken.insert(name).second; ++i)
    name = "lights" + std::to_string(i);
  return name;
}

} // namespace rtsl::cpp
