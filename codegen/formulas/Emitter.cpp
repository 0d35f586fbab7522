//===- Emitter.cpp - concise construction of IR ---------------------------===//
#include "codegen/formulas/Emitter.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/Matchers.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"

namespace rtsl::lowering {

namespace arith = mlir::arith;
namespace math = mlir::math;

mlir::Type scalarType(mlir::Type type) {
  if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
    return vector.getElementType();
  return type;
}

unsigned vectorWidth(mlir::Type type) {
  if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
    return static_cast<unsigned>(vector.getNumElements());
  return 0;
}

mlir::Type withScalar(mlir::Type shape, mlir::Type scalar) {
  if (unsigned width = vectorWidth(shape))
    return mlir::VectorType::get({width}, scalar);
  return scalar;
}

void eraseUnused(mlir::Region &region) {
  for (mlir::Block &block : region)
    // Backwards, so that operands of an erased operation are unused when they are reached.
    for (mlir::Operation &op : llvm::make_early_inc_range(llvm::reverse(block))) {
      for (mlir::Region &inner : op.getRegions())
        eraseUnused(inner);
      if (op.use_empty() && (mlir::isPure(&op) || llvm::isa<ir::LoadOp>(op)) &&
          !op.hasTrait<mlir::OpTrait::IsTerminator>())
        op.erase();
    }
}

//===----------------------------------------------------------------------===//
// Constants and vectors
//===----------------------------------------------------------------------===//

Value Emitter::floatConstant(float value) {
  return make<arith::ConstantOp>(getFloatAttr(getF32Type(), llvm::APFloat(value)));
}

Value Emitter::intConstant(std::int64_t value) {
  return make<arith::ConstantOp>(
      getI32IntegerAttr(static_cast<std::int32_t>(static_cast<std::uint32_t>(value))));
}

Value Emitter::boolConstant(bool value) {
  return make<arith::ConstantOp>(getBoolAttr(value));
}

Value Emitter::constant(mlir::Type type, double value) {
  mlir::Type scalar = scalarType(type);
  mlir::TypedAttr attribute;
  if (scalar.isF32())
    attribute = getFloatAttr(scalar, llvm::APFloat(static_cast<float>(value)));
  else if (scalar.isInteger(1))
    attribute = getBoolAttr(value != 0);
  else
    attribute = getI32IntegerAttr(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(value))));
  if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
    attribute = mlir::DenseElementsAttr::get(vector, mlir::Attribute(attribute));
  return make<arith::ConstantOp>(attribute);
}

Value Emitter::zero(mlir::Type type) {
  return ir::createZero(*this, getLoc(), type);
}

Value Emitter::vector(llvm::ArrayRef<Value> components) {
  auto type = mlir::VectorType::get({static_cast<std::int64_t>(components.size())},
                                    components.front().getType());
  return fold<mlir::vector::FromElementsOp>(type, mlir::ValueRange(components));
}

Value Emitter::splat(Value scalar, unsigned count) {
  return fold<mlir::vector::BroadcastOp>(mlir::VectorType::get({count}, scalar.getType()), scalar);
}

Value Emitter::extract(Value vector, unsigned component) {
  return fold<mlir::vector::ExtractOp>(vector, static_cast<std::int64_t>(component));
}

// The vector dialect indexes with `index`; our indices are i32 and known to be in range.
static Value position(Emitter &emitter, Value component) {
  return emitter.fold<arith::IndexCastUIOp>(emitter.getIndexType(), component);
}

Value Emitter::extract(Value vector, Value component) {
  return fold<mlir::vector::ExtractOp>(vector, mlir::OpFoldResult(position(*this, component)));
}

Value Emitter::insert(Value vector, Value scalar, unsigned component) {
  return fold<mlir::vector::InsertOp>(scalar, vector, static_cast<std::int64_t>(component));
}

Value Emitter::insert(Value vector, Value scalar, Value component) {
  return fold<mlir::vector::InsertOp>(scalar, vector,
                                      mlir::OpFoldResult(position(*this, component)));
}

Value Emitter::shuffle(Value vector, llvm::ArrayRef<std::int64_t> components) {
  return fold<mlir::vector::ShuffleOp>(vector, vector, components);
}

//===----------------------------------------------------------------------===//
// Memory
//===----------------------------------------------------------------------===//

Value Emitter::variable(llvm::StringRef name, mlir::Type type) {
  return make<ir::VarOp>(name, type);
}
Value Emitter::load(Value address) {
  return fold<ir::LoadOp>(address);
}
void Emitter::store(Value value, Value address) {
  make<ir::StoreOp>(value, address);
}
void Emitter::copy(Value from, Value to) {
  make<ir::CopyOp>(from, to);
}
Value Emitter::field(Value address, llvm::StringRef name) {
  return make<ir::FieldOp>(address, name);
}
Value Emitter::element(Value address, Value index) {
  return make<ir::ElementOp>(address, index);
}
Value Emitter::element(Value address, unsigned index) {
  return element(address, intConstant(index));
}

//===----------------------------------------------------------------------===//
// Control
//===----------------------------------------------------------------------===//

bool Emitter::hidesConstants() const {
  mlir::Operation *at = getInsertionBlock()->getParentOp();
  auto module = llvm::dyn_cast<mlir::ModuleOp>(at);
  return ir::attr::hidesConstants.isOn(module ? module : at->getParentOfType<mlir::ModuleOp>());
}

bool Emitter::isTerminated() const {
  mlir::Block *block = getInsertionBlock();
  return !block->empty() && block->back().hasTrait<mlir::OpTrait::IsTerminator>();
}

void Emitter::fill(mlir::Region &region, Block body) {
  mlir::OpBuilder::InsertionGuard guard(*this);
  mlir::Block *block = region.empty() ? createBlock(&region) : &region.front();
  setInsertionPointToEnd(block);
  body();
  if (!isTerminated())
    make<ir::YieldOp>();
}

void Emitter::ifThen(Value condition, Block then, Block otherwise) {
  auto op = make<ir::IfOp>(condition);
  fill(op.getThenRegion(), then);
  if (otherwise)
    fill(op.getElseRegion(), otherwise);
}

void Emitter::loop(bool testAfter, llvm::function_ref<Value()> condition, Block body, Block step) {
  auto op = make<ir::LoopOp>(testAfter);
  if (condition) {
    mlir::OpBuilder::InsertionGuard guard(*this);
    createBlock(&op.getCondition());
    make<ir::ConditionOp>(condition());
  }
  fill(op.getBody(), body);
  if (step)
    fill(op.getStep(), step);
}

void Emitter::switchOver(Value value, const std::vector<Arm> &arms) {
  llvm::SmallVector<llvm::SmallVector<std::int32_t>> values;
  std::optional<unsigned> defaultArm;
  for (const Arm &arm : arms) {
    auto &labels = values.emplace_back();
    for (std::int64_t label : arm.values)
      labels.push_back(static_cast<std::int32_t>(static_cast<std::uint32_t>(label)));
    if (arm.isDefault)
      defaultArm = static_cast<unsigned>(values.size() - 1);
  }
  auto op = make<ir::SwitchOp>(value, values, defaultArm);
  for (auto [region, arm] : llvm::zip_equal(op.getArms(), arms))
    fill(region, arm.body);
}

void Emitter::illuminance(Value point, Value normal, Value cosAngle, Block body) {
  auto op = make<ir::IlluminanceOp>(point, normal, cosAngle);
  fill(op.getBody(), body);
}

void Emitter::returnValues(mlir::ValueRange values) {
  make<ir::ReturnOp>(values);
}

//===----------------------------------------------------------------------===//
// Numbers
//===----------------------------------------------------------------------===//

// Extends both to the shape of the wider one.
static void unify(Num &a, Num &b) {
  if (a.width() == b.width())
    return;
  if (a.width() == 0)
    a = a.splat(b.width());
  else
    b = b.splat(a.width());
}

template <typename FloatOp, typename IntOp>
static Num arithmetic(Num a, Num b) {
  unify(a, b);
  Emitter &emitter = a.at();
  Value left = a, right = b;
  return {emitter,
          a.isFloat() ? emitter.fold<FloatOp>(left, right) : emitter.fold<IntOp>(left, right)};
}

template <typename Op>
static Num apply(Num a, Num b) {
  unify(a, b);
  Value left = a, right = b;
  return {a.at(), a.at().fold<Op>(left, right)};
}

template <typename Op>
static Num apply(Num a) {
  Value operand = a;
  return {a.at(), a.at().fold<Op>(operand)};
}

Num Num::operator[](unsigned component) const {
  return width() == 0 ? *this : Num(*emitter, emitter->extract(value, component));
}

Num Num::constants(const std::vector<double> &values) const {
  llvm::SmallVector<float, 16> floats(values.begin(), values.end());
  auto type =
      mlir::VectorType::get({static_cast<std::int64_t>(floats.size())}, emitter->getF32Type());
  return {*emitter, emitter->make<arith::ConstantOp>(
                        mlir::DenseElementsAttr::get(type, llvm::ArrayRef<float>(floats)))};
}

Num Num::vector(const std::vector<Num> &components) {
  const llvm::SmallVector<Value, 4> values(components.begin(), components.end());
  Emitter &emitter = components.front().at();
  return {emitter, emitter.vector(values)};
}

Num Num::shuffle(std::initializer_list<std::int64_t> components) const {
  return {*emitter, emitter->shuffle(value, components)};
}

Num Num::bits() const {
  return {*emitter,
          emitter->fold<arith::BitcastOp>(withScalar(type(), emitter->getI32Type()), value)};
}
Num Num::asFloat() const {
  return {*emitter,
          emitter->fold<arith::BitcastOp>(withScalar(type(), emitter->getF32Type()), value)};
}

Num operator+(Num a, Num b) {
  return arithmetic<arith::AddFOp, arith::AddIOp>(a, b);
}
Num operator-(Num a, Num b) {
  return arithmetic<arith::SubFOp, arith::SubIOp>(a, b);
}
Num operator*(Num a, Num b) {
  return arithmetic<arith::MulFOp, arith::MulIOp>(a, b);
}
Num operator/(Num a, Num b) {
  return apply<arith::DivFOp>(a, b);
}
Num operator-(Num a) {
  return a.isFloat() ? apply<arith::NegFOp>(a) : a.like(0) - a;
}
Num operator&(Num a, Num b) {
  return apply<arith::AndIOp>(a, b);
}
Num operator|(Num a, Num b) {
  return apply<arith::OrIOp>(a, b);
}
Num operator^(Num a, Num b) {
  return apply<arith::XOrIOp>(a, b);
}
Num operator!(Num a) {
  return a ^ a.like(1);
}
Num shiftLeft(Num a, Num count) {
  return apply<arith::ShLIOp>(a, count);
}
Num shiftRight(Num a, Num count) {
  return apply<arith::ShRUIOp>(a, count);
}
Num shiftRightSigned(Num a, Num count) {
  return apply<arith::ShRSIOp>(a, count);
}

static Num compare(Num a, Num b, arith::CmpFPredicate floats, arith::CmpIPredicate integers) {
  unify(a, b);
  Emitter &emitter = a.at();
  Value left = a, right = b;
  return {emitter, a.isFloat() ? emitter.fold<arith::CmpFOp>(floats, left, right)
                               : emitter.fold<arith::CmpIOp>(integers, left, right)};
}

Num less(Num a, Num b) {
  return compare(a, b, arith::CmpFPredicate::OLT, arith::CmpIPredicate::slt);
}
Num lessEqual(Num a, Num b) {
  return compare(a, b, arith::CmpFPredicate::OLE, arith::CmpIPredicate::sle);
}
Num equal(Num a, Num b) {
  return compare(a, b, arith::CmpFPredicate::OEQ, arith::CmpIPredicate::eq);
}
Num notEqual(Num a, Num b) {
  return compare(a, b, arith::CmpFPredicate::UNE, arith::CmpIPredicate::ne);
}
Num lessUnsigned(Num a, Num b) {
  return compare(a, b, arith::CmpFPredicate::OLT, arith::CmpIPredicate::ult);
}

Num select(Num condition, Num a, Num b) {
  unify(a, b);
  if (condition.width() != 0 && a.width() == 0) {
    a = a.splat(condition.width());
    b = b.splat(condition.width());
  }
  Emitter &emitter = a.at();
  Value c = condition, whenTrue = a, whenFalse = b;
  return {emitter, emitter.fold<arith::SelectOp>(c, whenTrue, whenFalse)};
}

Num fma(Num a, Num b, Num c) {
  unify(a, b);
  unify(a, c);
  unify(b, c);
  Emitter &emitter = a.at();
  Value x = a, y = b, z = c;
  return {emitter, emitter.fold<math::FmaOp>(x, y, z)};
}
Num sqrt(Num a) {
  return apply<math::SqrtOp>(a);
}
Num floor(Num a) {
  return apply<math::FloorOp>(a);
}
Num ceil(Num a) {
  return apply<math::CeilOp>(a);
}
Num trunc(Num a) {
  return apply<math::TruncOp>(a);
}
Num roundEven(Num a) {
  return apply<math::RoundEvenOp>(a);
}
Num abs(Num a) {
  return a.isFloat() ? apply<math::AbsFOp>(a) : select(less(a, 0.0), -a, a);
}

template <typename Op>
static Num convert(Num a, mlir::Type scalar) {
  Value operand = a;
  return {a.at(), a.at().fold<Op>(withScalar(a.type(), scalar), operand)};
}

Num toInt(Num a) {
  return convert<ir::ToSintOp>(a, a.at().getI32Type());
}
Num toFloat(Num a) {
  return convert<arith::SIToFPOp>(a, a.at().getF32Type());
}
Num fromBool(Num a) {
  return convert<arith::ExtUIOp>(a, a.at().getI32Type());
}

std::optional<std::int32_t> constantOf(Num value) {
  llvm::APInt constant;
  if (mlir::matchPattern(static_cast<Value>(value), mlir::m_ConstantInt(&constant)))
    return static_cast<std::int32_t>(constant.getSExtValue());
  return std::nullopt;
}

} // namespace rtsl::lowering
