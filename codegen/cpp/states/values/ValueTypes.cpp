#include "codegen/cpp/states/values/ValueTypes.h"

#include "codegen/ir/Attributes.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/TypeSwitch.h"

#include <map>

namespace rtsl::cpp {

namespace arith = mlir::arith;

/// For types that do not occur in the source. Only the cache of known types changes.
static TypeContext &typesOf(const Context &context) {
  return const_cast<TypeContext &>(context.module.types);
}

/// Names of state variables, and of their types.
static const std::map<std::string, std::string> &stateVariables() {
  static const std::map<std::string, std::string> words = {
#define RTSL_STATE_VARIABLE(name, type, ...) {#name, #type},
#include "language/StateVariables.def"
  };
  return words;
}

bool isStateVariable(llvm::StringRef name) {
  return stateVariables().count(name.str()) != 0;
}

/// The type of the state variable of this name; null if there is none.
static const Type *stateType(TypeContext &types, llvm::StringRef name) {
  const auto found = stateVariables().find(name.str());
  if (found == stateVariables().end())
    return nullptr;
  return types.named(found->second == "uint3" ? "uvec3" : found->second);
}

const Type *ValueTypes::vec3() {
  return typesOf(context).vector(typesOf(context).floatType, 3);
}

/// The type of a scalar in the IR, which does not distinguish signed and unsigned integers; null if
/// it is not a scalar.
static const Type *scalarType(TypeContext &types, mlir::Type type) {
  if (type.isF32())
    return types.floatType;
  if (type.isInteger(1))
    return types.boolType;
  return type.isInteger(32) ? types.intType : nullptr;
}

/// The type of a vector's components; `known` is their type in the IR.
static const Type *scalarOf(TypeContext &types, const Type *vector, mlir::Type known) {
  if (vector && vector->isVector())
    return vector->element;
  return known ? scalarType(types, known) : nullptr;
}

const Type *ValueTypes::ofMemory(mlir::Value address) {
  mlir::Operation *op = address.getDefiningOp();
  if (llvm::isa_and_nonnull<ir::PayloadOp>(op))
    return machine.method->parameters.front()->type;
  if (auto argument = llvm::dyn_cast_or_null<ir::CallArgumentOp>(op))
    return machine.argumentType(machine.argumentNumber(argument));
  if (auto field = llvm::dyn_cast_or_null<ir::FieldOp>(op)) {
    const Type *base = ofMemory(field.getBase());
    if (base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return part.type;
    return nullptr;
  }
  if (auto element = llvm::dyn_cast_or_null<ir::ElementOp>(op)) {
    const Type *base = ofMemory(element.getBase());
    return base && (base->is(TypeKind::Array) || base->isMatrix()) ? base->element : nullptr;
  }
  auto number = op ? ir::attr::declared.of(op) : mlir::IntegerAttr();
  return number ? source.types[static_cast<std::size_t>(number.getInt())] : nullptr;
}

/// Does the type of the value follow from other values?
static bool isMadeOfParts(mlir::Value value) {
  namespace vector = mlir::vector;
  return llvm::isa_and_nonnull<ir::LoadOp, vector::InsertOp, vector::ExtractOp, vector::ShuffleOp,
                               vector::FromElementsOp, vector::BroadcastOp>(value.getDefiningOp());
}

const Type *ValueTypes::ofVariable(ir::VarOp variable) {
  auto [at, isNew] = variables.try_emplace(variable);
  if (!isNew)
    return at->second;
  if (const Type *declared = ofMemory(variable))
    return variables[variable] = declared;
  const Type *type = nullptr;
  for (const bool ofParts : {false, true}) // whose type may follow from this variable
    for (mlir::Operation *user : variable->getUsers())
      if (auto store = llvm::dyn_cast<ir::StoreOp>(user);
          store && !type && isMadeOfParts(store.getValue()) == ofParts)
        type = of(store.getValue());
  if (!type)
    type = scalarType(typesOf(context), llvm::cast<ir::PtrType>(variable.getType()).getPointee());
  return variables[variable] = type;
}

const Type *ValueTypes::ofSaved(const std::string &key, mlir::Type type) {
  TypeContext &types = typesOf(context);
  auto vector = llvm::dyn_cast<mlir::VectorType>(type);
  const mlir::Type scalar = vector ? vector.getElementType() : type;
  const auto width = vector ? static_cast<unsigned>(vector.getNumElements()) : 1u;
  const std::string name = key.substr(0, key.find('.')); // "sum.2": a second variable `sum`
  const Type *found = nullptr;
  auto look = [&](const typed::Function &function) {
    for (const auto *list : {&function.parameters, &function.locals})
      for (const auto &variable : *list) {
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

const Type *ValueTypes::of(mlir::Value value) {
  TypeContext &types = typesOf(context);
  mlir::Operation *op = value.getDefiningOp();
  if (!op)
    return nullptr;
  if (llvm::isa<ir::PtrType>(value.getType()))
    return ofMemory(value);
  auto vectorOf = [&](const Type *scalar, std::int64_t width) -> const Type * {
    return scalar && scalar->isScalar() ? types.vector(scalar, static_cast<std::uint32_t>(width))
                                        : nullptr;
  };
  return llvm::TypeSwitch<mlir::Operation *, const Type *>(op)
      .Case([&](ir::ExpressionOp expression) {
        const SourceTable::Entry &entry = source.entries[expression.getSource()];
        return entry.kind == SourceTable::Kind::AngleCosine ? types.floatType : entry.expr->type;
      })
      .Case([&](ir::EvaluateOp call) {
        const SourceTable::Entry &entry = source.entries[call.getSource()];
        return entry.kind == SourceTable::Kind::Index ? entry.leaves.front()->type
                                                      : entry.expr->type;
      })
      .Case([&](ir::LoadOp load) {
        if (auto variable = load.getAddress().getDefiningOp<ir::VarOp>())
          return ofVariable(variable);
        if (auto state = load.getAddress().getDefiningOp<ir::StateOp>())
          return stateType(typesOf(context), state.getName());
        const Type *declared = ofMemory(load.getAddress());
        return declared ? declared : scalarType(types, value.getType());
      })
      .Case([&](ir::FrameLoadOp load) -> const Type * {
        const FrameField *field = machine.savedField(load.getName());
        return field ? field->type : nullptr;
      })
      .Case<ir::TraceResultOp>([&](auto) { return types.color; })
      .Case([&](ir::CallArgumentOp argument) {
        return machine.argumentType(machine.argumentNumber(argument));
      })
      .Case([&](ir::CallReturnedOp) {
        const auto call =
            machine.callBefore.find(op->getParentOfType<mlir::func::FuncOp>().getSymName().str());
        const bool isKnown = call != machine.callBefore.end() && call->second;
        return isKnown ? call->second->function->returnType : nullptr;
      })
      .Case([&](ir::CastRefOp cast) { return of(cast.getObject()); })
      .Case([&](arith::IndexCastUIOp index) {
        const Type *type = of(index.getIn());
        return type ? type : types.intType;
      })
      .Case([&](arith::SelectOp select) {
        const Type *type = of(select.getTrueValue());
        return type ? type : of(select.getFalseValue());
      })
      .Case([&](mlir::vector::InsertOp insert) {
        const Type *type = of(insert.getDest());
        return type ? type
                    : vectorOf(of(insert.getValueToStore()),
                               insert.getDestVectorType().getNumElements());
      })
      .Case([&](mlir::vector::ExtractOp part) {
        return scalarOf(types, of(part.getSource()), value.getType());
      })
      .Case([&](mlir::vector::FromElementsOp made) {
        const Type *scalar = scalarType(types, made.getElements().front().getType());
        for (mlir::Value part : made.getElements()) // constants are not marked as unsigned
          if (const Type *type = of(part);
              type && part.getDefiningOp<arith::ConstantOp>() == nullptr)
            scalar = type;
        return vectorOf(scalar, static_cast<std::int64_t>(made.getElements().size()));
      })
      .Case([&](mlir::vector::BroadcastOp same) {
        return vectorOf(of(same.getSource()), same.getResultVectorType().getNumElements());
      })
      .Case([&](mlir::vector::ShuffleOp chosen) {
        return vectorOf(scalarOf(types, of(chosen.getV1()), {}),
                        static_cast<std::int64_t>(chosen.getMask().size()));
      })
      .Default([&](mlir::Operation *) { return scalarType(types, value.getType()); });
}

} // namespace rtsl::cpp
