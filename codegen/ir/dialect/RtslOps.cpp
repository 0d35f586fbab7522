//===- RtslOps.cpp - building and verifying the operations ----------------===//
#include "codegen/ir/dialect/RtslOps.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/ClassTable.h"
#include "codegen/ir/dialect/RtslDialect.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Matchers.h"
#include "llvm/ADT/StringSwitch.h"

namespace rtsl::ir {

using mlir::ParseResult;

//===----------------------------------------------------------------------===//
// The arms of a switch: `{ arm [1, 2] {...} arm [3] default {...} }`
//===----------------------------------------------------------------------===//

static ParseResult parseSwitchArms(mlir::OpAsmParser &parser, mlir::ArrayAttr &values,
                                   mlir::IntegerAttr &defaultArm,
                                   llvm::SmallVectorImpl<std::unique_ptr<mlir::Region>> &arms) {
  mlir::Builder &builder = parser.getBuilder();
  llvm::SmallVector<mlir::Attribute> allValues;
  if (parser.parseLBrace())
    return mlir::failure();
  while (mlir::succeeded(parser.parseOptionalKeyword("arm"))) {
    llvm::SmallVector<int32_t> ofArm;
    bool hasList = mlir::succeeded(parser.parseOptionalLSquare());
    if (hasList) {
      do {
        if (parser.parseInteger(ofArm.emplace_back()))
          return mlir::failure();
      } while (mlir::succeeded(parser.parseOptionalComma()));
      if (parser.parseRSquare())
        return mlir::failure();
    }
    llvm::SMLoc location = parser.getCurrentLocation();
    if (mlir::succeeded(parser.parseOptionalKeyword("default"))) {
      if (defaultArm)
        return parser.emitError(location, "a switch has one default arm");
      defaultArm = builder.getI32IntegerAttr(arms.size());
    } else if (!hasList) {
      return parser.emitError(location, "expected the arm's values, `[...]`, or `default`");
    }
    if (parser.parseRegion(*arms.emplace_back(std::make_unique<mlir::Region>())))
      return mlir::failure();
    allValues.push_back(builder.getDenseI32ArrayAttr(ofArm));
  }
  values = builder.getArrayAttr(allValues);
  return parser.parseRBrace();
}

static void printSwitchArms(mlir::OpAsmPrinter &printer, SwitchOp op, mlir::ArrayAttr values,
                            mlir::IntegerAttr defaultArm,
                            llvm::MutableArrayRef<mlir::Region> arms) {
  printer << "{";
  printer.increaseIndent();
  for (auto [index, arm] : llvm::enumerate(arms)) {
    printer.printNewline();
    printer << "arm ";
    llvm::ArrayRef<int32_t> ofArm = op.armValues(index);
    if (!ofArm.empty()) {
      printer << "[";
      llvm::interleaveComma(ofArm, printer);
      printer << "] ";
    }
    if (defaultArm && defaultArm.getInt() == static_cast<int64_t>(index))
      printer << "default ";
    printer.printRegion(arm);
  }
  printer.decreaseIndent();
  printer.printNewline();
  printer << "}";
}

} // namespace rtsl::ir

#define GET_OP_CLASSES
#include "codegen/ir/dialect/RtslOps.cpp.inc"

namespace rtsl::ir {

using mlir::LogicalResult;
using mlir::Value;
using NameSetter = llvm::function_ref<void(Value, llvm::StringRef)>;

Value createZero(mlir::OpBuilder &builder, mlir::Location location, mlir::Type type) {
  if (llvm::isa<RefType>(type))
    return NullRefOp::create(builder, location, type);
  return mlir::arith::ConstantOp::create(builder, location, builder.getZeroAttr(type));
}

mlir::Type pointee(Value address) {
  return llvm::cast<PtrType>(address.getType()).getPointee();
}

/// `emitOpError` unless the result is the address of a `part`.
static LogicalResult verifyPart(mlir::Operation *op, mlir::Type part) {
  mlir::Type expected = PtrType::get(part);
  if (op->getResult(0).getType() == expected)
    return mlir::success();
  return op->emitOpError() << "gives " << expected << ", not " << op->getResult(0).getType();
}

//===----------------------------------------------------------------------===//
// Module level
//===----------------------------------------------------------------------===//

void ClassOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, llvm::StringRef name,
                    llvm::StringRef root, llvm::StringRef base) {
  state.addAttribute(getSymNameAttrName(state.name), builder.getStringAttr(name));
  state.addAttribute(getRootAttrName(state.name), builder.getStringAttr(root));
  if (!base.empty())
    state.addAttribute(getBaseAttrName(state.name),
                       mlir::FlatSymbolRefAttr::get(builder.getContext(), base));
  state.addRegion()->emplaceBlock();
}

LogicalResult ClassOp::verify() {
  if (!getRoot().starts_with("rt_") && getRoot() != helperRoot)
    return emitOpError() << "has root \"" << getRoot() << "\", which is not an `rt_` class";
  return mlir::success();
}

LogicalResult ClassOp::verifyRegions() {
  for (mlir::Operation &op : getBody().front())
    if (!llvm::isa<MemberDeclOp>(op))
      return op.emitOpError()
             << "is not allowed in `rtsl.class`, which holds `rtsl.member_decl` only";
  return mlir::success();
}

MemberDeclOp ClassOp::findMember(llvm::StringRef name) {
  return lookupSymbol<MemberDeclOp>(name);
}

LogicalResult MemberDeclOp::verify() {
  if (!llvm::is_contained({"public", "private", "scratch"}, getAccess()))
    return emitOpError() << "has access \"" << getAccess()
                         << "\"; expected \"public\", \"private\" or \"scratch\"";
  if (!isStorable(getType()))
    return emitOpError() << "has type " << getType() << ", which cannot be stored in memory";
  return mlir::success();
}

//===----------------------------------------------------------------------===//
// Memory
//===----------------------------------------------------------------------===//

void VarOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, llvm::StringRef name,
                  mlir::Type type) {
  build(builder, state, PtrType::get(type), name);
}

void VarOp::getAsmResultNames(NameSetter setName) {
  setName(getResult(), getName());
}

void LoadOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, Value address) {
  build(builder, state, pointee(address), address);
}

/// A copy of a value is a load and a store.
LogicalResult CopyOp::canonicalize(CopyOp op, mlir::PatternRewriter &rewriter) {
  if (op.getSource() == op.getTarget()) {
    rewriter.eraseOp(op);
    return mlir::success();
  }
  if (!isValueType(pointee(op.getSource())))
    return mlir::failure();
  Value value = LoadOp::create(rewriter, op.getLoc(), op.getSource());
  rewriter.replaceOpWithNewOp<StoreOp>(op, value, op.getTarget());
  return mlir::success();
}

void FieldOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, Value base,
                    llvm::StringRef field) {
  auto type = llvm::cast<StructType>(pointee(base));
  std::optional<unsigned> index = type.fieldIndex(field);
  assert(index && "the struct has no such field");
  build(builder, state, PtrType::get(type.getFieldTypes()[*index]), base, field);
}

LogicalResult FieldOp::verify() {
  auto type = llvm::cast<StructType>(pointee(getBase()));
  std::optional<unsigned> index = type.fieldIndex(getField());
  if (!index)
    return emitOpError() << "names field \"" << getField() << "\", which struct `" << type.getName()
                         << "` does not have";
  return verifyPart(*this, type.getFieldTypes()[*index]);
}

void ElementOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, Value base,
                      Value index) {
  auto type = llvm::cast<ArrayType>(pointee(base));
  build(builder, state, PtrType::get(type.getElement()), base, index);
}

std::optional<int32_t> ElementOp::constantIndex() {
  llvm::APInt value;
  if (!mlir::matchPattern(getIndex(), mlir::m_ConstantInt(&value)))
    return std::nullopt;
  return static_cast<int32_t>(value.getSExtValue());
}

LogicalResult ElementOp::verify() {
  // A pass may have found the index to be a constant out of range; such code never runs.
  return verifyPart(*this, llvm::cast<ArrayType>(pointee(getBase())).getElement());
}

void MemberOp::getAsmResultNames(NameSetter setName) {
  setName(getResult(), getMember());
}

LogicalResult MemberOp::verifySymbolUses(mlir::SymbolTableCollection &symbols) {
  if (attr::offset.isOn(*this)) // after conversion to LLVM the class may be gone
    return mlir::success();
  llvm::StringRef className = llvm::cast<RefType>(getObject().getType()).getClassName();
  auto classOp = symbols.lookupNearestSymbolFrom<ClassOp>(
      *this, mlir::StringAttr::get(getContext(), className));
  if (!classOp)
    return emitOpError() << "needs class `" << className << "`, which no `rtsl.class` declares";
  MemberDeclOp member = classOp.findMember(getMember());
  if (!member)
    return emitOpError() << "names member \"" << getMember() << "\", which class `" << className
                         << "` does not have";
  if (member.isScratch())
    return emitOpError() << "names the scratch member \"" << getMember()
                         << "\", which is not in the record; use `rtsl.attribute`";
  return verifyPart(*this, member.getType());
}

void StateOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, llvm::StringRef name,
                    mlir::Type type) {
  build(builder, state, PtrType::get(type), name);
}

LogicalResult PrintOp::verify() {
  std::size_t words = 0;
  for (std::int32_t count : getWords())
    words += static_cast<std::size_t>(count);
  if (getItems().size() != getWords().size() || words != getValues().size())
    return emitOpError() << "prints " << getItems().size() << " items of " << words
                         << " words, but has " << getValues().size();
  return mlir::success();
}

void PayloadOp::getAsmResultNames(NameSetter setName) {
  setName(getResult(), "payload");
}

void StateOp::getAsmResultNames(NameSetter setName) {
  setName(getResult(), getName());
}

/// The type of a state variable in StateVariables.def; empty if there is none of that name.
/// `hitError` is a field of RtslState that shaders cannot name.
static llvm::StringRef stateVariableType(llvm::StringRef name) {
  return llvm::StringSwitch<llvm::StringRef>(name)
#define RTSL_STATE_VARIABLE(name, type, ...) .Case(#name, #type)
#include "language/StateVariables.def"
      .Case("hitError", "float")
      .Default("");
}

LogicalResult StateOp::verify() {
  llvm::StringRef kind = stateVariableType(getName());
  if (kind.empty())
    return emitOpError() << "names \"" << getName() << "\", which is not a state variable"
                         << (getName().starts_with("rt_") ? "; leave out `rt_`" : "");
  mlir::Type type = pointee(getResult());
  if (kind == "color") {
    if (!isColor(type))
      return emitOpError() << "must give a color for \"" << getName() << "\", not " << type;
    return mlir::success();
  }
  mlir::Builder b(getContext());
  mlir::Type f32 = b.getF32Type(), i32 = b.getI32Type();
  auto vector = [](int64_t count, mlir::Type element) -> mlir::Type {
    return mlir::VectorType::get({count}, element);
  };
  return verifyPart(*this, llvm::StringSwitch<mlir::Type>(kind)
                               .Case("float", f32)
                               .Case("int", i32)
                               .Case("uint3", vector(3, i32))
                               .Case("vec2", vector(2, f32))
                               .Case("vec3", vector(3, f32))
                               .Case("mat4", ArrayType::get(4, vector(4, f32))));
}

void AttributeOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, llvm::StringRef name,
                        mlir::Type type, std::optional<int32_t> axis) {
  build(builder, state, PtrType::get(type), name, mlir::IntegerAttr(),
        axis ? builder.getI32IntegerAttr(*axis) : mlir::IntegerAttr());
}

void AttributeOp::getAsmResultNames(NameSetter setName) {
  setName(getResult(), getName());
}

LogicalResult AttributeOp::verify() {
  if (getOffset() && static_cast<int32_t>(*getOffset()) < 0)
    return emitOpError() << "has a negative offset";
  if (getAxis().value_or(0) > 1)
    return emitOpError() << "has an axis that is neither 0 nor 1";
  return mlir::success();
}

void BufferElementOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, Value buffer,
                            mlir::ValueRange indices) {
  auto type = llvm::cast<BufferType>(pointee(buffer));
  build(builder, state, PtrType::get(type.getElement()), buffer, indices);
}

LogicalResult BufferElementOp::verify() {
  auto type = llvm::cast<BufferType>(pointee(getBuffer()));
  if (getIndices().size() != type.getRank())
    return emitOpError() << "has " << getIndices().size() << " indices for " << type.getRank()
                         << " dimensions";
  return verifyPart(*this, type.getElement());
}

LogicalResult AtomicOp::verify() {
  if (!pointee(getAddress()).isInteger(32))
    return emitOpError() << "changes an i32, not " << pointee(getAddress());
  if ((getKind() == AtomicKind::CompareExchange) != bool(getExpected()))
    return emitOpError() << "takes an expected value for `compare_exchange` only";
  return mlir::success();
}

LogicalResult BufferLengthOp::verify() {
  auto type = llvm::cast<BufferType>(pointee(getBuffer()));
  if (getDim() >= type.getRank())
    return emitOpError() << "queries dimension " << getDim() << " of " << type.getRank();
  return mlir::success();
}

//===----------------------------------------------------------------------===//
// Rays and numbers
//===----------------------------------------------------------------------===//

LogicalResult IlluminateOp::verify() {
  if (getIndex() && !getNormal() != !getCosAngle())
    return emitOpError() << "takes `normal` and `cos` together";
  if (getCosAngle() && !getIndex())
    return emitOpError() << "takes `cos` only with a light";
  return mlir::success();
}

static unsigned operandCount(Elementary function) {
  switch (function) {
#define RTSL_ELEMENTARY_BINARY(Id, name) case Elementary::Id:
#include "math/ElementaryFunctions.def"
    return 2;
  default:
    return 1;
  }
}

LogicalResult ElementaryOp::verify() {
  const unsigned expected = operandCount(getFunction());
  if (getOperands().size() != expected)
    return emitOpError() << "<" << stringifyElementary(getFunction()) << "> takes " << expected
                         << (expected == 1 ? " operand" : " operands") << ", not "
                         << getOperands().size();
  return mlir::success();
}

} // namespace rtsl::ir
