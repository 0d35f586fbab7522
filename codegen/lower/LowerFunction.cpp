//===- LowerFunction.cpp - entry and exit of functions --------------------===//
//
// Scratch members of a primitive. In `intersect` they are variables of that call: a candidate
// without a hit must not change the values that the best hit so far has stored. Each `hit(t)` that
// is accepted is noted, and where `intersect` returns after one, the scratch members are stored as
// attributes of the hit. If a hit that is not the nearest has overwritten them, traversal runs
// `intersect` of the nearest one again (findLostAttributes in runtime/device/traverse/TestItem.h):
//
//   %n = rtsl.var "n"                       a variable for each scratch member
//   %accepted = rtsl.var "accepted"
//   ...  %h = rtsl.hit %t                   accepted = accepted | h
//   rtsl.if %accepted {                     at each return
//     rtsl.store (n), rtsl.attribute "n"
//   }
//
// A helper that uses scratch members or reports hits is lowered a second time for calls from
// `intersect`, as `Class.helper.intersect`, and takes the addresses of these variables after its
// own parameters. Everywhere else (and in every material) a scratch member is the attribute of the
// nearest hit.
//
//===----------------------------------------------------------------------===//
#include "codegen/lower/Lowering.h"
#include "sema/typed/Analysis.h"

namespace rtsl::lowering {

FunctionLowering::FunctionLowering(ModuleLowering &module, const FunctionKey &key,
                                   mlir::func::FuncOp function)
    : module(module), key(key), function(function), emitter(module.context()) {
  emitter.library = &module.library;
  emitter.setLoc(function.getLoc());
  emitter.setInsertionPointToStart(function.addEntryBlock());
}

Value FunctionLowering::self() {
  return function.getArgument(0);
}

void FunctionLowering::run() {
  bindParameters();
  mayEndAnyHit = (!key.isStateMethod() || key.function->name == "anyHit") &&
                 module.hitAnswers.mayAnswer(*key.function, key.concrete);
  if (key.inIntersect && !key.isForIntersect())
    enterIntersect();
  lower(*key.function->body);
  if (!emitter.isTerminated())
    emitReturnOfZero();
  eraseUnused(function.getBody());
}

void FunctionLowering::runInitialize(const std::vector<const typed::Member *> &members) {
  for (const typed::Member *member : members) {
    emitter.setLoc(module.location(member->range));
    Value address = emitter.make<ir::MemberOp>(module.pointer(member->type), self(), member->name);
    lowerInto(*member->init, address);
  }
  emitter.returnValues({});
  eraseUnused(function.getBody());
}

//===----------------------------------------------------------------------===//
// Entry
//===----------------------------------------------------------------------===//

void FunctionLowering::bindParameters() {
  const typed::Function &source = *key.function;
  unsigned next = 0;
  auto argument = [&](llvm::StringRef name) -> Value {
    mlir::BlockArgument value = function.getArgument(next++);
    value.setLoc(mlir::NameLoc::get(emitter.getStringAttr(name), value.getLoc()));
    return value;
  };
  if (key.concrete)
    argument("self");
  if (livesInMemory(source.returnType))
    resultAddress = argument("result");

  std::set<const typed::Variable *> assigned = assignedVariables(*source.body);
  for (const auto &parameter : source.parameters) {
    if (key.takesPayload()) {
      variables[parameter.get()].address =
          emitter.make<ir::PayloadOp>(module.pointer(parameter->type));
      continue;
    }
    Value value = argument(parameter->name);
    Binding &binding = variables[parameter.get()];
    if (livesInMemory(parameter->type) || parameter->direction != ast::Direction::In) {
      binding.address = value;
    } else if (assigned.count(parameter.get())) {
      binding.address = emitter.variable(parameter->name, value.getType());
      emitter.store(value, binding.address);
    } else {
      binding.value = {value};
    }
  }
  if (key.isForIntersect()) {
    if (key.concrete)
      for (const typed::Member *member : module.scratchMembers(key.concrete))
        scratch[member] = argument(member->name);
    accepted = argument("accepted");
  }
}

void FunctionLowering::enterIntersect() {
  for (const typed::Member *member : module.scratchMembers(key.concrete))
    scratch[member] = emitter.variable(member->name, module.type(member->type));
  accepted = emitter.variable("accepted", emitter.getI1Type());
  commitsScratch = true;
}

//===----------------------------------------------------------------------===//
// Exit
//===----------------------------------------------------------------------===//

void FunctionLowering::commitScratch() {
  if (!commitsScratch)
    return;
  emitter.ifThen(emitter.load(accepted), [&] {
    for (const typed::Member *member : module.scratchMembers(key.concrete)) {
      Value attribute = emitter.make<ir::AttributeOp>(member->name, module.type(member->type));
      if (isAggregate(member->type) || member->type->isMatrix())
        emitter.copy(scratch[member], attribute);
      else
        emitter.store(emitter.load(scratch[member]), attribute);
    }
  });
}

void FunctionLowering::emitReturn(const typed::Expr *value) {
  mlir::Location location = emitter.getLoc();
  Parts results;
  if (value && livesInMemory(value->type))
    lowerInto(*value, resultAddress); // new memory of the caller
  else if (value)
    results = lower(*value);
  emitter.setLoc(location);
  commitScratch();
  emitter.returnValues(results);
}

// A function with a result returns zero if control reaches its end.
void FunctionLowering::emitReturnOfZero() {
  const Type *type = key.function->returnType;
  commitScratch();
  if (livesInMemory(type)) {
    emitter.make<ir::ClearOp>(resultAddress);
    emitter.returnValues({});
  } else if (type->is(TypeKind::Void)) {
    emitter.returnValues({});
  } else {
    emitter.returnValues(emitter.zero(module.type(type)));
  }
}

} // namespace rtsl::lowering
