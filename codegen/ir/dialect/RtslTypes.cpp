//===- RtslTypes.cpp - types of the `rtsl` dialect ------------------------===//
#include "codegen/ir/dialect/RtslTypes.h"

#include "codegen/ir/dialect/RtslDialect.h"

#include "mlir/IR/Builders.h"
#include "mlir/IR/DialectImplementation.h"
#include "llvm/ADT/SmallSet.h"
#include "llvm/ADT/TypeSwitch.h"

/// The optional `, output` of a buffer.
static mlir::ParseResult parseOutput(mlir::AsmParser &parser, bool &output) {
  output = mlir::succeeded(parser.parseOptionalComma());
  return output ? parser.parseKeyword("output") : mlir::success();
}
static void printOutput(mlir::AsmPrinter &printer, bool output) {
  if (output)
    printer << ", output";
}

#define GET_TYPEDEF_CLASSES
#include "codegen/ir/dialect/RtslTypes.cpp.inc"

namespace rtsl::ir {

using llvm::function_ref;
using mlir::InFlightDiagnostic;
using mlir::LogicalResult;

void RtslDialect::registerTypes() {
  addTypes<
#define GET_TYPEDEF_LIST
#include "codegen/ir/dialect/RtslTypes.cpp.inc"
      >();
}

//===----------------------------------------------------------------------===//
// Predicates
//===----------------------------------------------------------------------===//

bool isScalar(mlir::Type type) {
  return type.isF32() || type.isSignlessInteger(32) || type.isSignlessInteger(1);
}

/// A vector of 1 to 16 scalars, fixed in length.
static bool isVector(mlir::Type type, function_ref<bool(mlir::Type)> element) {
  auto vector = llvm::dyn_cast<mlir::VectorType>(type);
  return vector && vector.getRank() == 1 && !vector.isScalable() && vector.getNumElements() <= 16 &&
         element(vector.getElementType());
}

static bool isFloat(mlir::Type type) {
  return type.isF32();
}
static bool isInt(mlir::Type type) {
  return type.isSignlessInteger(32);
}

static bool isDouble(mlir::Type type) {
  return type.isF64();
}

bool isWide(mlir::Type type) {
  return isDouble(type) || isVector(type, isDouble);
}

bool isValueType(mlir::Type type) {
  return isScalar(type) || isVector(type, isScalar) || llvm::isa<RefType>(type) || isWide(type);
}

bool isStorable(mlir::Type type) {
  // The parts of an aggregate were verified when it was made.
  return (isValueType(type) && !isWide(type)) || llvm::isa<StructType, ArrayType, BufferType>(type);
}

bool isFloatOrVector(mlir::Type type) {
  return isFloat(type) || isVector(type, isFloat);
}
bool isIntOrVector(mlir::Type type) {
  return isInt(type) || isVector(type, isInt);
}
bool isColor(mlir::Type type) {
  return isVector(type, isFloat);
}

bool isVec3(mlir::Type type) {
  return isVector(type, isFloat) && llvm::cast<mlir::VectorType>(type).getNumElements() == 3;
}

bool isPtrToValue(mlir::Type type) {
  auto pointer = llvm::dyn_cast<PtrType>(type);
  return pointer && isValueType(pointer.getPointee());
}

mlir::Type intLike(mlir::Type type) {
  mlir::Type i32 = mlir::IntegerType::get(type.getContext(), 32);
  if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
    return vector.clone(i32);
  return i32;
}

unsigned leafCount(mlir::Type type) {
  if (auto array = llvm::dyn_cast<ArrayType>(type))
    return array.getLength() * leafCount(array.getElement());
  if (auto structure = llvm::dyn_cast<StructType>(type)) {
    unsigned count = 0;
    for (mlir::Type field : structure.getFieldTypes())
      count += leafCount(field);
    return count;
  }
  return 1;
}

//===----------------------------------------------------------------------===//
// Verification
//===----------------------------------------------------------------------===//

static LogicalResult verifyStorable(function_ref<InFlightDiagnostic()> emitError, mlir::Type type,
                                    llvm::StringRef what) {
  if (isStorable(type))
    return mlir::success();
  return emitError() << what << " cannot be " << type
                     << ": memory holds f32, i32, i1, vectors of 1 to 16 of them, references, "
                        "structs, arrays and buffers";
}

LogicalResult RefType::verify(function_ref<InFlightDiagnostic()> emitError,
                              llvm::StringRef className) {
  if (className.empty())
    return emitError() << "a reference names a class";
  return mlir::success();
}

LogicalResult PtrType::verify(function_ref<InFlightDiagnostic()> emitError, mlir::Type pointee) {
  if (isWide(pointee)) // a variable's
    return mlir::success();
  return verifyStorable(emitError, pointee, "the pointee");
}

LogicalResult ArrayType::verify(function_ref<InFlightDiagnostic()> emitError, unsigned length,
                                mlir::Type element) {
  if (length == 0)
    return emitError() << "an array has at least one element";
  return verifyStorable(emitError, element, "an element");
}

LogicalResult BufferType::verify(function_ref<InFlightDiagnostic()> emitError, mlir::Type element,
                                 unsigned rank, bool) {
  if (rank < 1 || rank > 3)
    return emitError() << "a buffer has 1 to 3 dimensions, not " << rank;
  return verifyStorable(emitError, element, "an element");
}

LogicalResult StructType::verify(function_ref<InFlightDiagnostic()> emitError, llvm::StringRef name,
                                 llvm::ArrayRef<mlir::StringAttr> fieldNames,
                                 llvm::ArrayRef<mlir::Type> fieldTypes) {
  if (name.empty())
    return emitError() << "a struct has a name";
  if (fieldNames.size() != fieldTypes.size())
    return emitError() << "struct `" << name << "` has " << fieldNames.size() << " field names and "
                       << fieldTypes.size() << " types";
  llvm::SmallPtrSet<mlir::Attribute, 8> seen;
  for (auto [field, type] : llvm::zip_equal(fieldNames, fieldTypes)) {
    if (!seen.insert(field).second)
      return emitError() << "struct `" << name << "` has two fields called `" << field.getValue()
                         << "`";
    if (mlir::failed(verifyStorable(emitError, type, "a field")))
      return mlir::failure();
  }
  return mlir::success();
}

//===----------------------------------------------------------------------===//
// Text
//===----------------------------------------------------------------------===//

mlir::Type StructType::parse(mlir::AsmParser &parser) {
  llvm::SMLoc location = parser.getCurrentLocation();
  std::string name;
  llvm::SmallVector<mlir::StringAttr> names;
  llvm::SmallVector<mlir::Type> types;
  auto parseField = [&]() -> mlir::ParseResult {
    std::string field;
    mlir::Type type;
    if (parser.parseKeywordOrString(&field) || parser.parseColonType(type))
      return mlir::failure();
    names.push_back(parser.getBuilder().getStringAttr(field));
    types.push_back(type);
    return mlir::success();
  };
  if (parser.parseLess() || parser.parseString(&name) || parser.parseComma() ||
      parser.parseCommaSeparatedList(mlir::AsmParser::Delimiter::Braces, parseField) ||
      parser.parseGreater())
    return {};
  return parser.getChecked<StructType>(location, parser.getContext(), llvm::StringRef(name),
                                       llvm::ArrayRef(names), llvm::ArrayRef(types));
}

void StructType::print(mlir::AsmPrinter &printer) const {
  printer << "<\"" << getName() << "\", {";
  llvm::interleaveComma(llvm::zip_equal(getFieldNames(), getFieldTypes()), printer, [&](auto pair) {
    auto [name, type] = pair;
    printer.printKeywordOrString(name.getValue());
    printer << ": " << type;
  });
  printer << "}>";
}

//===----------------------------------------------------------------------===//
// Parts, for splitting variables: those of a struct are indexed by name, those of an array by
// number
//===----------------------------------------------------------------------===//

std::optional<unsigned> StructType::fieldIndex(llvm::StringRef name) const {
  for (auto [index, field] : llvm::enumerate(getFieldNames()))
    if (field.getValue() == name)
      return index;
  return std::nullopt;
}

std::optional<llvm::DenseMap<mlir::Attribute, mlir::Type>>
StructType::getSubelementIndexMap() const {
  llvm::DenseMap<mlir::Attribute, mlir::Type> parts;
  for (auto [name, type] : llvm::zip_equal(getFieldNames(), getFieldTypes()))
    parts.insert({name, type});
  return parts;
}

mlir::Type StructType::getTypeAtIndex(mlir::Attribute index) const {
  auto name = llvm::dyn_cast<mlir::StringAttr>(index);
  std::optional<unsigned> field = name ? fieldIndex(name.getValue()) : std::nullopt;
  return field ? getFieldTypes()[*field] : mlir::Type();
}

std::optional<llvm::DenseMap<mlir::Attribute, mlir::Type>>
ArrayType::getSubelementIndexMap() const {
  // A long array stays in memory: that many variables cost more than they save.
  constexpr unsigned longest = 64;
  if (getLength() > longest)
    return std::nullopt;
  mlir::Builder builder(getContext());
  llvm::DenseMap<mlir::Attribute, mlir::Type> parts;
  for (unsigned index = 0; index < getLength(); ++index)
    parts.insert({builder.getI32IntegerAttr(index), getElement()});
  return parts;
}

mlir::Type ArrayType::getTypeAtIndex(mlir::Attribute index) const {
  auto number = llvm::dyn_cast<mlir::IntegerAttr>(index);
  return number && number.getInt() >= 0 && number.getInt() < getLength() ? getElement()
                                                                         : mlir::Type();
}

} // namespace rtsl::ir
