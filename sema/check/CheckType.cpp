//===- CheckType.cpp - types as spelled in the source ---------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/check/Suggest.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl {

/// Larger values cannot be addressed within a record or a frame.
static constexpr std::uint64_t maxTypeBytes = 0x7fffffffull;

static const Type *typeOfName(const ast::Name &name, Program &program) {
  if (const Type *keyword = program.types.named(name.text))
    return keyword;
  if (rootModel(name.text))
    return program.types.reference(name.text);
  if (const Symbol *symbol = program.findSymbol(name.text, name.range)) {
    if (symbol->kind == Symbol::Kind::Struct) {
      const typed::Struct *structure = program.structure(name.text, name.range);
      return structure ? program.types.structure(structure) : program.types.error;
    }
    if (symbol->kind == Symbol::Kind::Class)
      return program.types.reference(program.classes.at(name.text)->definition);
    program.diagnostics.report(Code::notATypeName, name.range, name.text)
        .label(symbol->range, "defined here");
    return program.types.error;
  }
  Diagnostic &diagnostic = program.diagnostics.report(Code::unknownType, name.range, name.text);
  if (const ForeignSpelling *foreign = foreignSpelling(name.text)) {
    suggestSpelling(diagnostic, *foreign, "", program.imports(foreign->module), name.range);
    return program.types.error;
  }
  if (program.suggestImport(diagnostic, name.text))
    return program.types.error;
  std::vector<std::string> candidates = {"bool",  "int",   "uint",  "float", "vec2",  "vec3",
                                         "vec4",  "ivec2", "ivec3", "ivec4", "uvec2", "uvec3",
                                         "uvec4", "bvec2", "bvec3", "bvec4", "mat2",  "mat3",
                                         "mat4",  "color", "void"};
  for (const RootModel &root : rootModels())
    candidates.push_back(root.name);
  candidates.insert(candidates.end(), program.structOrder.begin(), program.structOrder.end());
  candidates.insert(candidates.end(), program.classOrder.begin(), program.classOrder.end());
  if (const std::string closest = closestName(name.text, candidates); !closest.empty())
    diagnostic.fix(name.range, closest);
  return program.types.error;
}

const Type *FunctionChecker::resolveType(const ast::TypeName &typeName, const ast::Name *name,
                                         bool allowUnsized) {
  const Type *type = typeOfName(typeName.name, program);
  if (typeName.dimensions.empty())
    return type;
  if (typeName.dimensions.size() > maxTypeNesting) {
    diagnostics.report(Code::typeTooDeep, typeName.range, maxTypeNesting);
    return types.error;
  }
  // Outermost first: dimensions after the name, then those after the type.
  std::vector<const ast::ArrayDimension *> dimensions;
  for (const ast::ArrayDimension &dimension : typeName.dimensions)
    dimensions.push_back(&dimension);
  if (name && !name->text.empty())
    std::stable_partition(dimensions.begin(), dimensions.end(),
                          [&](const ast::ArrayDimension *dimension) {
                            return dimension->range.begin >= name->range.end;
                          });

  std::uint32_t rank = 0;
  while (rank != dimensions.size() && !dimensions[rank]->size)
    ++rank;
  if (rank > 3 || (rank != 0 && !allowUnsized)) {
    Diagnostic &diagnostic =
        diagnostics.report(rank > 3 ? Code::bufferRank : Code::unsizedArray, dimensions[0]->range);
    if (rank <= 3)
      diagnostic.note(
          "only public members may have any number of elements: `public float data[];`");
    return types.error;
  }
  if (type->is(TypeKind::Void)) {
    diagnostics.report(Code::arrayOfVoid, typeName.range);
    return types.error;
  }
  for (std::size_t i = dimensions.size(); i-- > rank;) {
    if (!dimensions[i]->size) {
      diagnostics.report(Code::unsizedArray, dimensions[i]->range)
          .note("dimensions without a size must come before those with one");
      return types.error;
    }
    typed::ExprPtr size = checkValue(*dimensions[i]->size);
    if (size->type->isError())
      return types.error;
    const SourceRange range = size->range;
    if (!size->type->is(TypeKind::Int) && !size->type->is(TypeKind::UInt)) {
      diagnostics.report(Code::arraySizeNotInteger, range, toString(size->type));
      return types.error;
    }
    const typed::Expr *obstacle = nullptr;
    const std::optional<std::int64_t> length = evaluateInteger(*size, &obstacle);
    if (!length) {
      if (obstacle)
        requireConstant(*size, "the size of an array");
      return types.error;
    }
    if (*length <= 0) {
      diagnostics.report(Code::arraySizeNotPositive, range, *length);
      return types.error;
    }
    if (type->isError())
      continue;
    type = types.array(type, static_cast<std::uint32_t>(*length));
  }
  if (type->isError())
    return type;
  if (nestingDepth(type) > maxTypeNesting) {
    diagnostics.report(Code::typeTooDeep, typeName.range, maxTypeNesting);
    return types.error;
  }
  if (sizeInBytes(type) > maxTypeBytes) {
    diagnostics.report(Code::typeTooLarge, typeName.range, toString(type), sizeInBytes(type))
        .note("use a buffer, whose size is set by the scene: `public float "
              "data[];`");
    return types.error;
  }
  return rank == 0 ? type : types.buffer(type, rank);
}

} // namespace rtsl
