//===- LowerDecls.cpp - classes, functions and their names ----------------===//
//
// Symbols: a free function keeps its name, `f`; an overloaded one is followed by its parameters'
// types, `f.vec3.float`, and one that is called like a function of the runtime is
// `function.rtsl_hit`. A method is `Class.method`, of the class whose objects run it;
// `Class.Base.method` is the definition of a base class that `Base::method()` calls. The second
// version of a function that `intersect` may need is `Class.helper.intersect` (LowerFunction.cpp
// explains why).
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/lower/Lowering.h"

#include "frontend/source/Expansion.h"
#include "sema/typed/Analysis.h"

#include <algorithm>

namespace rtsl::lowering {

ModuleLowering::ModuleLowering(const typed::Module &source, const LowerOptions &options,
                               mlir::ModuleOp target)
    : options(options), library(target), hitAnswers(source), source(source), target(target),
      emitter(target.getContext()) {
  emitter.setInsertionPointToEnd(target.getBody());
}

mlir::Location ModuleLowering::location(SourceRange range) {
  if (!range.isValid())
    return mlir::UnknownLoc::get(context());
  const auto [file, at] = shownBegin(options.diagnostics->sources(), range);
  return mlir::FileLineColLoc::get(context(), llvm::StringRef(file.data(), file.size()), at.line,
                                   at.column);
}

void ModuleLowering::reportUnsupported(SourceRange range, const std::string &what) {
  options.diagnostics->report(Code::notSupportedYet, range, what);
}

//===----------------------------------------------------------------------===//
// Names
//===----------------------------------------------------------------------===//

std::string ModuleLowering::slotName(const typed::Function &method) const {
  return typed::slotName(source, method);
}

std::string ModuleLowering::symbolOf(const FunctionKey &key) {
  const typed::Function &function = *key.function;
  std::string name;
  if (key.concrete) {
    name = key.concrete->name + "." + (key.isHidden ? function.owner->name + "." : "") +
           slotName(function);
  } else {
    auto overloads = std::count_if(source.functions.begin(), source.functions.end(),
                                   [&](const auto &other) { return other->name == function.name; });
    name = overloads > 1 ? function.name + parameterWords(function) : function.name;
    if (name.compare(0, 5, "rtsl_") == 0) // as the runtime's functions begin
      name = "function." + name;
  }
  if (key.isForIntersect())
    name += ".intersect";
  // Unlikely, but possible: a function whose name is spelled like that of a class and its method.
  std::string unique = name;
  for (unsigned i = 2; !symbols.insert(unique).second; ++i)
    unique = name + "." + std::to_string(i);
  return unique;
}

//===----------------------------------------------------------------------===//
// Functions
//===----------------------------------------------------------------------===//

std::vector<const typed::Member *>
ModuleLowering::scratchMembers(const typed::Class *concrete) const {
  std::vector<const typed::Member *> members;
  if (concrete->base)
    members = scratchMembers(concrete->base);
  for (const auto &member : concrete->members)
    if (member->access == ast::Access::Scratch)
      members.push_back(member.get());
  return members;
}

// The parameters: the object, the address of a struct, array or matrix that is returned, the
// declared parameters, and for `intersect` the scratch members and whether a hit was accepted.
mlir::FunctionType ModuleLowering::functionType(const FunctionKey &key) {
  const typed::Function &function = *key.function;
  llvm::SmallVector<mlir::Type> inputs, results;
  if (key.concrete)
    inputs.push_back(ir::RefType::get(context(), key.concrete->name));
  if (livesInMemory(function.returnType))
    inputs.push_back(pointer(function.returnType));
  else if (!function.returnType->is(TypeKind::Void))
    results.push_back(type(function.returnType));
  for (const auto &parameter : function.parameters) {
    if (key.takesPayload())
      break;
    bool byAddress = livesInMemory(parameter->type) || parameter->direction != ast::Direction::In;
    inputs.push_back(byAddress ? pointer(parameter->type) : type(parameter->type));
  }
  if (key.isForIntersect()) {
    if (key.concrete)
      for (const typed::Member *member : scratchMembers(key.concrete))
        inputs.push_back(pointer(member->type));
    inputs.push_back(ir::PtrType::get(emitter.getI1Type()));
  }
  return emitter.getFunctionType(inputs, results);
}

mlir::func::FuncOp ModuleLowering::function(const FunctionKey &key) {
  auto known = functions.find(key);
  if (known != functions.end())
    return known->second;
  const typed::Function &source = *key.function;
  emitter.setLoc(location(source.range));
  auto function = emitter.make<mlir::func::FuncOp>(symbolOf(key), functionType(key));
  if (key.concrete) {
    ir::attr::className.set(function, emitter.getStringAttr(key.concrete->name));
    if (source.isConstructor)
      ir::attr::constructor.set(function);
    else if (key.isHidden)
      ir::attr::hidden.set(function);
    else if (!key.isForIntersect())
      ir::attr::methodName.set(function, emitter.getStringAttr(slotName(source)));
    if (options.source && source.sends.traced)
      ir::attr::states.set(function);
  }
  if (source.mayRunInLookup)
    ir::attr::inLookup.set(function);
  functions[key] = function;
  pending.push_back(key);
  return function;
}

//===----------------------------------------------------------------------===//
// Classes
//===----------------------------------------------------------------------===//

static void collectMembers(const typed::Class &definition,
                           std::vector<const typed::Member *> &members) {
  if (definition.base)
    collectMembers(*definition.base, members);
  for (const auto &member : definition.members)
    if (!member->isConst)
      members.push_back(member.get());
}

// The functions that objects of the class run, inherited functions first, each in its most derived
// form.
static void collectFunctions(const typed::Class &definition, const typed::Class &concrete,
                             std::vector<const typed::Function *> &functions) {
  if (definition.base)
    collectFunctions(*definition.base, concrete, functions);
  for (const auto &function : definition.functions) {
    const typed::Function &resolved =
        function->isConstructor ? *function : resolve(*function, &concrete);
    if (function->isConstructor)
      functions.erase(std::remove_if(functions.begin(), functions.end(),
                                     [](const auto *other) { return other->isConstructor; }),
                      functions.end());
    if (std::find(functions.begin(), functions.end(), &resolved) == functions.end())
      functions.push_back(&resolved);
  }
}

static const char *spelling(ast::Access access) {
  switch (access) {
  case ast::Access::Public:
    return "public";
  case ast::Access::Scratch:
    return "scratch";
  default:
    return "private";
  }
}

void ModuleLowering::lowerClass(const typed::Class &definition) {
  emitter.setLoc(location(definition.range));
  auto op = emitter.make<ir::ClassOp>(definition.name, definition.root,
                                      definition.base ? definition.base->name : "");
  symbols.insert(definition.name);
  std::vector<const typed::Member *> members;
  collectMembers(definition, members);
  {
    mlir::OpBuilder::InsertionGuard guard(emitter);
    if (op.getBody().empty())
      emitter.createBlock(&op.getBody());
    emitter.setInsertionPointToEnd(&op.getBody().front());
    for (const typed::Member *member : members) {
      emitter.setLoc(location(member->range));
      emitter.make<ir::MemberDeclOp>(member->name, type(member->type), spelling(member->access));
    }
  }
  lowerInitialize(definition);

  bool hasScratch = !scratchMembers(&definition).empty();
  std::vector<const typed::Function *> methods;
  collectFunctions(definition, definition, methods);
  for (const typed::Function *method : methods) {
    bool isIntersect = method->isStateMethod && method->name == "intersect";
    // Helpers that only `intersect` can call are lowered with it.
    if (!method->isStateMethod && !method->isConstructor && definition.root == "rt_Primitive" &&
        hasScratch && takesPartInIntersection(*method, &definition))
      continue;
    function({method, &definition, isIntersect && hasScratch});
  }
}

// Member defaults, as a function of the object.
void ModuleLowering::lowerInitialize(const typed::Class &definition) {
  std::vector<const typed::Member *> members;
  collectMembers(definition, members);
  members.erase(std::remove_if(members.begin(), members.end(),
                               [](const auto *member) { return !member->init; }),
                members.end());
  if (members.empty())
    return;
  emitter.setLoc(location(definition.range));
  std::string symbol = definition.name + ".initialize";
  symbols.insert(symbol);
  auto function = emitter.make<mlir::func::FuncOp>(
      symbol, emitter.getFunctionType({ir::RefType::get(context(), definition.name)}, {}));
  ir::attr::className.set(function, emitter.getStringAttr(definition.name));
  ir::attr::constructor.set(function);
  FunctionLowering(*this, {nullptr, &definition, false}, function).runInitialize(members);
}

//===----------------------------------------------------------------------===//
// The module
//===----------------------------------------------------------------------===//

void ModuleLowering::run() {
  for (const auto &definition : source.classes)
    if (options.classes.empty() || options.classes.count(definition->name))
      lowerClass(*definition);
  if (options.classes.empty())
    for (const auto &free : source.functions)
      if (free->body)
        function({free.get(), nullptr, false});
  while (!pending.empty()) {
    FunctionKey key = pending.front();
    pending.pop_front();
    FunctionLowering(*this, key, functions[key]).run();
  }
}

} // namespace rtsl::lowering
