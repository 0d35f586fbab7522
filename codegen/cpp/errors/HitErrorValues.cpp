#include "codegen/cpp/errors/HitErrorWriter.h"

#include "codegen/cpp/functions/Literals.h"

#include "mlir/IR/Matchers.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using mlir::Value;

unsigned HitErrorWriter::widthOf(mlir::Type type) {
  auto shape = llvm::dyn_cast<mlir::VectorType>(type);
  return shape ? static_cast<unsigned>(shape.getNumElements()) : 0;
}

mlir::Type HitErrorWriter::scalarOf(mlir::Type type) {
  auto shape = llvm::dyn_cast<mlir::VectorType>(type);
  return shape ? shape.getElementType() : type;
}

std::string HitErrorWriter::typeText(mlir::Type type) {
  const unsigned width = widthOf(type);
  const mlir::Type scalar = scalarOf(type);
  if (width > 4)
    return {};
  if (scalar.isF32())
    return width ? fmt::format("glm::vec{}", width) : "float";
  if (scalar.isF64())
    return width ? fmt::format("glm::dvec{}", width) : "double";
  if (scalar.isInteger(1))
    return width ? fmt::format("glm::bvec{}", width) : "bool";
  if (scalar.isInteger(32))
    return width ? fmt::format("glm::ivec{}", width) : "int";
  return !width && scalar.isIndex() ? "unsigned" : "";
}

bool HitErrorWriter::isDouble(mlir::Operation &op) {
  return scalarOf(op.getResult(0).getType()).isF64();
}

const std::string &HitErrorWriter::nameOf(Value value) {
  std::string &name = known[value];
  if (name.empty()) {
    name = uniqueNames.of(value);
    std::replace(name.begin(), name.end(), '.', '_');
    if (isReserved(name) || name == "rt" || name == "self")
      name += "_";
    name = unique(name, taken);
  }
  return name;
}

static Code number(mlir::Attribute attribute) {
  if (auto real = llvm::dyn_cast<mlir::FloatAttr>(attribute))
    return real.getType().isF64() ? doubleLiteral(real.getValue().convertToDouble())
                                  : floatLiteral(real.getValue().convertToFloat());
  const llvm::APInt value = llvm::cast<mlir::IntegerAttr>(attribute).getValue();
  return value.getBitWidth() == 1 ? boolean(!value.isZero()) : integer(value.getSExtValue());
}

Code HitErrorWriter::part(Value value, unsigned index) {
  mlir::Attribute attribute;
  if (!mlir::matchPattern(value, mlir::m_Constant(&attribute))) {
    const Code own = name(nameOf(value));
    return widthOf(value.getType()) ? component(own, index) : own;
  }
  if (auto dense = llvm::dyn_cast<mlir::DenseElementsAttr>(attribute))
    return number(dense.getValues<mlir::Attribute>()[index]);
  return number(attribute);
}

Code HitErrorWriter::whole(Value value) {
  mlir::Attribute attribute;
  if (!mlir::matchPattern(value, mlir::m_Constant(&attribute)))
    return name(nameOf(value));
  const unsigned width = widthOf(value.getType());
  if (!width)
    return part(value, 0);
  std::vector<Code> parts;
  for (unsigned i = 0; i < width; ++i)
    parts.push_back(part(value, i));
  return construct(typeText(value.getType()), std::move(parts));
}

void HitErrorWriter::define(Value result, Code value, Statements &out) {
  out.push_back(declaration("const", typeText(result.getType()), nameOf(result), std::move(value)));
}

void HitErrorWriter::defineEach(mlir::Operation &op, Statements &out,
                                const std::function<Code(unsigned)> &component) {
  const Value result = op.getResult(0);
  const unsigned width = widthOf(result.getType());
  if (!width)
    return define(result, component(0), out);
  std::vector<Code> parts;
  for (unsigned i = 0; i < width; ++i)
    parts.push_back(component(i));
  define(result, construct(typeText(result.getType()), std::move(parts)), out);
}

} // namespace rtsl::cpp
