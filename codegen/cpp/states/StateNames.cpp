//===- StateNames.cpp - names and types of what a state computes ----------===//
#include "codegen/cpp/states/StateWriter.h"
#include "codegen/ir/Attributes.h"

#include "codegen/passes/continuation/common/Names.h"
#include "sema/typed/Casting.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/TypeSwitch.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace rtsl::cpp {

namespace arith = mlir::arith;

std::size_t Machine::given(ir::CallArgumentOp argument) const {
  const auto at = std::find(called->offsets.begin(), called->offsets.end(),
                            static_cast<std::int32_t>(argument.getOffset()));
  return static_cast<std::size_t>(at - called->offsets.begin());
}

const Type *Machine::givenType(std::size_t number) const {
  const typed::Variable *given = called->given[number];
  return given ? given->type : method->returnType;
}

std::string Machine::addressName(const Context &context, std::size_t number) const {
  if (!called->given[number])
    return called->fields[number];
  const std::size_t before = called->given.size() - method->parameters.size();
  const std::string &name = context.names.of(method->parameters[number - before].get());
  return name.empty() ? called->fields[number] : name;
}

/// To make types that the author has not named: nothing changes but what is known.
static TypeContext &typesOf(const Context &context) {
  return const_cast<TypeContext &>(context.module.types);
}

/// The type of a state variable; null: the name is none's.
static const Type *stateType(TypeContext &types, llvm::StringRef name) {
  static const std::map<std::string, std::string> words = {
#define RTSL_STATE_VARIABLE(name, type) {#name, #type},
#include "language/StateVariables.def"
  };
  const auto found = words.find(name.str());
  if (found == words.end())
    return nullptr;
  return types.named(found->second == "uint2" ? "uvec2" : found->second);
}

const Type *StateWriter::vec3() {
  return typesOf(context).vector(typesOf(context).floatType, 3);
}

std::string StateWriter::spelling(llvm::StringRef name) {
  std::string spelled;
  for (std::size_t at = 0; at != name.size(); ++at)
    if (llvm::isAlnum(name[at]) || name[at] == '_')
      spelled += name[at];
    else if (name[at] != ']' && (at + 1 == name.size() || !llvm::isDigit(name[at + 1])))
      spelled += '_';
  const auto isAuthors = [&](const auto &variable) { return variable->name == name; };
  if (!stateType(typesOf(context), name) || llvm::any_of(machine.method->locals, isAuthors) ||
      llvm::any_of(machine.method->parameters, isAuthors))
    return spelled;
  spelled[0] = llvm::toLower(spelled[0]);
  return spelled;
}

std::string StateWriter::freshName(const std::string &wanted) {
  std::string clean = spelling(wanted);
  while (clean.find("__") != std::string::npos)
    clean.erase(clean.find("__"), 1);
  if (clean.empty() || std::isdigit(static_cast<unsigned char>(clean.front())))
    clean = "value" + clean;
  std::string name = clean;
  for (unsigned i = 2; isReserved(name) || isAlways(name) || printer.temporaries.count(name) ||
                       !taken.insert(name).second;
       ++i)
    name = clean + (i == 2 && (isReserved(clean) || isAlways(clean)) ? "_" : std::to_string(i));
  printer.usedNames.insert(name);
  return name;
}

bool isOwnName(llvm::StringRef name) {
  return llvm::any_of(llvm::ArrayRef<llvm::StringRef>{"both", "either"}, [&](llvm::StringRef own) {
    llvm::StringRef rest = name;
    return rest.consume_front(own) &&
           rest.find_first_not_of(".0123456789") == llvm::StringRef::npos;
  });
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

const std::string &StateWriter::nameOf(ir::VarOp variable) {
  std::string &name = variableNames[variable];
  if (name.empty()) { // "sum.2" is another sum
    const auto [base, number] = variable.getName().rsplit('.');
    const bool isNumbered = !number.empty() && llvm::all_of(number, llvm::isDigit);
    name = freshName((isNumbered ? base : variable.getName()).str());
  }
  return name;
}

std::string StateWriter::nameOfValue(mlir::Value value) {
  if (auto whole = value.getDefiningOp<ir::ExpressionOp>();
      whole && source.entries[whole.getSource()].kind == SourceTable::Kind::AngleCosine)
    return "cosine";
  const std::string name = nameFor(value);
  const bool isOfIr = name == "expression" || name == "evaluate" || name == "call_returned";
  if (auto load = value.getDefiningOp<ir::FrameLoadOp>(); load && isOfIr)
    for (const FrameField &field : machine.frame)
      if (!field.isObject && field.slot == load.getName())
        return field.name;
  auto call = value.getDefiningOp<ir::EvaluateOp>();
  if (!call || name != "value")
    return name;
  const typed::Expr *expr = source.entries[call.getSource()].expr;
  const typed::Function *callee = nullptr;
  if (auto *direct = dynCast<typed::CallExpr>(expr))
    callee = direct->function;
  else if (auto *method = dynCast<typed::MethodCallExpr>(expr))
    callee = method->function;
  if (!callee)
    return name;
  unsigned number = 1; // `bounce1` is what the first call of `bounce` gives
  while (taken.count(context.names.of(callee) + std::to_string(number)))
    ++number;
  return context.names.of(callee) + std::to_string(number);
}

/// Of a number in the IR, which is not marked as unsigned; null: it is none.
static const Type *scalarType(TypeContext &types, mlir::Type type) {
  if (type.isF32())
    return types.floatType;
  if (type.isInteger(1))
    return types.boolType;
  return type.isInteger(32) ? types.intType : nullptr;
}

/// Of a vector's components; `known` is their type in the IR.
static const Type *scalarOf(TypeContext &types, const Type *vector, mlir::Type known) {
  if (vector && vector->isVector())
    return vector->element;
  return known ? scalarType(types, known) : nullptr;
}

const Type *StateWriter::declaredType(mlir::Value address) {
  mlir::Operation *op = address.getDefiningOp();
  if (llvm::isa_and_nonnull<ir::PayloadOp>(op))
    return machine.method->parameters.front()->type;
  if (auto argument = llvm::dyn_cast_or_null<ir::CallArgumentOp>(op))
    return machine.givenType(machine.given(argument));
  if (auto field = llvm::dyn_cast_or_null<ir::FieldOp>(op)) {
    const Type *base = declaredType(field.getBase());
    if (base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return part.type;
    return nullptr;
  }
  if (auto element = llvm::dyn_cast_or_null<ir::ElementOp>(op)) {
    const Type *base = declaredType(element.getBase());
    return base && (base->is(TypeKind::Array) || base->isMatrix()) ? base->element : nullptr;
  }
  auto number = op ? ir::attr::declared.of(op) : mlir::IntegerAttr();
  return number ? source.types[static_cast<std::size_t>(number.getInt())] : nullptr;
}

/// Is it of the type of other values, whatever that is?
static bool isMadeOfParts(mlir::Value value) {
  namespace vector = mlir::vector;
  return llvm::isa_and_nonnull<ir::LoadOp, vector::InsertOp, vector::ExtractOp, vector::ShuffleOp,
                               vector::FromElementsOp, vector::BroadcastOp>(value.getDefiningOp());
}

const Type *StateWriter::varType(ir::VarOp variable) {
  auto [at, isNew] = variableTypes.try_emplace(variable);
  if (!isNew)
    return at->second;
  if (const Type *declared = declaredType(variable))
    return variableTypes[variable] = declared;
  const Type *type = nullptr;
  for (const bool ofParts : {false, true}) // which may be its own
    for (mlir::Operation *user : variable->getUsers())
      if (auto store = llvm::dyn_cast<ir::StoreOp>(user);
          store && !type && isMadeOfParts(store.getValue()) == ofParts)
        type = typeOf(store.getValue());
  if (!type)
    type = scalarType(typesOf(context), llvm::cast<ir::PtrType>(variable.getType()).getPointee());
  return variableTypes[variable] = type;
}

const Type *StateWriter::typeOfSlot(const std::string &slot, mlir::Type type) {
  TypeContext &types = typesOf(context);
  auto vector = llvm::dyn_cast<mlir::VectorType>(type);
  const mlir::Type scalar = vector ? vector.getElementType() : type;
  const auto width = vector ? static_cast<unsigned>(vector.getNumElements()) : 1u;
  const std::string name = slot.substr(0, slot.find('.')); // "sum.2" is another sum
  const Type *found = nullptr;
  auto look = [&](const typed::Function &function) {
    for (const auto *variables : {&function.parameters, &function.locals})
      for (const auto &variable : *variables) {
        const Type *part = variable->type->scalar();
        const bool isAlike = variable->name == name && part &&
                             variable->type->componentCount() == width &&
                             part->is(TypeKind::Float) == scalar.isF32() &&
                             part->is(TypeKind::Bool) == scalar.isInteger(1);
        if (isAlike && !found)
          found = variable->type;
      }
  };
  look(*machine.method);
  for (const auto &function : context.module.functions)
    look(*function);
  for (const auto &definition : context.module.classes)
    for (const auto &function : definition->functions)
      look(*function);
  const bool isKnown = scalar.isF32() || scalar.isInteger(1); // the rest may be unsigned
  if (found || !isKnown)
    return found;
  const Type *own = scalarType(types, scalar);
  return vector ? types.vector(own, width) : own;
}

const Type *StateWriter::typeOf(mlir::Value value) {
  TypeContext &types = typesOf(context);
  mlir::Operation *op = value.getDefiningOp();
  if (!op)
    return nullptr;
  if (llvm::isa<ir::PtrType>(value.getType()))
    return declaredType(value);
  auto vectorOf = [&](const Type *scalar, std::int64_t width) -> const Type * {
    return scalar && scalar->isScalar() ? types.vector(scalar, static_cast<std::uint32_t>(width))
                                        : nullptr;
  };
  return llvm::TypeSwitch<mlir::Operation *, const Type *>(op)
      .Case([&](ir::ExpressionOp expression) {
        const SourceTable::Entry &entry = source.entries[expression.getSource()];
        return entry.kind == SourceTable::Kind::AngleCosine ? types.floatType : entry.expr->type;
      })
      .Case([&](ir::EvaluateOp call) { return source.entries[call.getSource()].expr->type; })
      .Case([&](ir::LoadOp load) {
        if (auto variable = load.getAddress().getDefiningOp<ir::VarOp>())
          return varType(variable);
        if (auto state = load.getAddress().getDefiningOp<ir::StateOp>())
          return stateType(typesOf(context), state.getName());
        const Type *declared = declaredType(load.getAddress());
        return declared ? declared : scalarType(types, value.getType());
      })
      .Case([&](ir::FrameLoadOp load) -> const Type * {
        for (const FrameField &field : machine.frame)
          if (!field.isObject && field.slot == load.getName())
            return field.type;
        return nullptr;
      })
      .Case<ir::TraceResultOp>([&](auto) { return types.color; })
      .Case([&](ir::CallArgumentOp argument) { return machine.givenType(machine.given(argument)); })
      .Case([&](ir::CallReturnedOp) {
        const auto call =
            machine.callBefore.find(op->getParentOfType<mlir::func::FuncOp>().getSymName().str());
        const bool isKnown = call != machine.callBefore.end() && call->second;
        return isKnown ? call->second->function->returnType : nullptr;
      })
      .Case([&](ir::CastRefOp cast) { return typeOf(cast.getObject()); })
      .Case([&](arith::SelectOp select) {
        const Type *type = typeOf(select.getTrueValue());
        return type ? type : typeOf(select.getFalseValue());
      })
      .Case([&](mlir::vector::InsertOp insert) {
        const Type *type = typeOf(insert.getDest());
        return type ? type
                    : vectorOf(typeOf(insert.getValueToStore()),
                               insert.getDestVectorType().getNumElements());
      })
      .Case([&](mlir::vector::ExtractOp part) {
        return scalarOf(types, typeOf(part.getSource()), value.getType());
      })
      .Case([&](mlir::vector::FromElementsOp made) {
        const Type *scalar = scalarType(types, made.getElements().front().getType());
        for (mlir::Value part : made.getElements()) // constants are not marked as unsigned
          if (const Type *type = typeOf(part);
              type && part.getDefiningOp<arith::ConstantOp>() == nullptr)
            scalar = type;
        return vectorOf(scalar, static_cast<std::int64_t>(made.getElements().size()));
      })
      .Case([&](mlir::vector::BroadcastOp same) {
        return vectorOf(typeOf(same.getSource()), same.getResultVectorType().getNumElements());
      })
      .Case([&](mlir::vector::ShuffleOp chosen) {
        return vectorOf(scalarOf(types, typeOf(chosen.getV1()), {}),
                        static_cast<std::int64_t>(chosen.getMask().size()));
      })
      .Default([&](mlir::Operation *) { return scalarType(types, value.getType()); });
}

} // namespace rtsl::cpp
