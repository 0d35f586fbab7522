//===- CheckConstruct.cpp - constructors and initialisers -----------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/fold/ConstantFold.h"

namespace rtsl {

using typed::ExprPtr;

ExprPtr FunctionChecker::checkConstruct(const Type *type, SourceRange typeRange,
                                        const std::vector<ast::ExprPtr> &args, SourceRange range) {
  std::vector<ExprPtr> values;
  bool broken = type->isError();
  for (const ast::ExprPtr &arg : args) {
    values.push_back(checkValue(*arg));
    broken |= values.back()->type->isError();
  }
  if (broken)
    return errorExpr(range);
  if (type->is(TypeKind::Void) || type->is(TypeKind::Class)) {
    Diagnostic &diagnostic = diagnostics.report(Code::notConstructible, typeRange, toString(type));
    if (type->is(TypeKind::Class))
      diagnostic.note("objects are created by the scene; a shader only refers to them");
    return errorExpr(range);
  }
  if (type->is(TypeKind::Struct) || type->is(TypeKind::Array))
    return constructAggregate(type, std::move(values), range);
  if (values.empty()) {
    diagnostics.report(Code::constructorNeedsArguments, range, toString(type));
    return errorExpr(range);
  }
  if (type->is(TypeKind::Color))
    return constructColor(std::move(values), range);
  if (type->is(TypeKind::Bool) && values.size() == 1 && values[0]->type->is(TypeKind::Class)) {
    ExprPtr tested = convertTo(std::move(values[0]), type, false);
    tested->range = range;
    return tested;
  }
  for (const ExprPtr &value : values) {
    if (value->type->scalar())
      continue;
    rejectColorPiece(type, *value);
    return errorExpr(range);
  }
  if (type->isScalar()) {
    if (values.size() != 1) {
      diagnostics.report(Code::tooManyComponents, values[1]->range, toString(type));
      return errorExpr(range);
    }
    return constructScalar(type, std::move(values[0]), range);
  }
  return type->isVector() ? constructVector(type, std::move(values), range)
                          : constructMatrix(type, std::move(values), range);
}

/// A color, struct, array or reference among the pieces of a scalar, vector or matrix.
void FunctionChecker::rejectColorPiece(const Type *type, const typed::Expr &arg) {
  Diagnostic &diagnostic =
      diagnostics.report(Code::badPiece, arg.range, toString(type), toString(arg.type));
  if (!arg.type->is(TypeKind::Color))
    return;
  diagnostic.note("the number of components of a color depends on the target");
  if (type->isScalar())
    diagnostic.fix(arg.range, "luminance(" + sourceText(arg.range) + ")");
}

/// Converts the scalars of `arg` and keeps its shape.
ExprPtr FunctionChecker::convertScalars(ExprPtr arg, const Type *scalar) {
  if (arg->type->isMatrix() && !scalar->is(TypeKind::Float)) {
    // A matrix has only float scalars: it is split into components first.
    if (arg->type->componentCount() > 4)
      return arg;
    auto vector = makeExpr<typed::ConstructExpr>(types.vector(types.floatType, 4), arg->range);
    vector->args.push_back(std::move(arg));
    arg = std::move(vector);
  }
  const Type *converted = withScalar(arg->type, scalar, types); // before it is moved
  return convertTo(std::move(arg), converted, false);
}

ExprPtr FunctionChecker::constructScalar(const Type *type, ExprPtr arg, SourceRange range) {
  if (arg->type->isScalar() && arg->type != type) {
    ExprPtr converted = convertTo(std::move(arg), type, false);
    converted->range = range;
    return converted;
  }
  auto node = makeExpr<typed::ConstructExpr>(type, range);
  if (!arg->type->isScalar() && arg->type->scalar() != type) {
    // The first component is taken, then converted.
    const Type *scalar = arg->type->scalar();
    node->type = scalar;
    node->args.push_back(std::move(arg));
    ExprPtr converted = convertTo(std::move(node), type, false);
    converted->range = range;
    return converted;
  }
  node->args.push_back(std::move(arg));
  return node;
}

/// Do the pieces fill the type? Every piece must contribute; with `exact` nothing may be left over.
bool FunctionChecker::requirePieces(const Type *type, std::vector<ExprPtr> &args, SourceRange range,
                                    bool exact) {
  const std::uint32_t needed = type->componentCount();
  std::uint32_t given = 0;
  for (const ExprPtr &arg : args) {
    if (given >= needed || (exact && given + arg->type->componentCount() > needed)) {
      diagnostics.report(Code::tooManyComponents, arg->range, toString(type))
          .note(toString(type) + " has " + std::to_string(needed) + " components");
      return false;
    }
    given += arg->type->componentCount();
  }
  if (given >= needed)
    return true;
  diagnostics.report(Code::tooFewComponents, range, toString(type), needed, given);
  return false;
}

ExprPtr FunctionChecker::constructVector(const Type *type, std::vector<ExprPtr> args,
                                         SourceRange range) {
  const bool broadcast = args.size() == 1 && args[0]->type->isScalar();
  if (!broadcast && !requirePieces(type, args, range, false))
    return errorExpr(range);
  auto node = makeExpr<typed::ConstructExpr>(type, range);
  for (ExprPtr &arg : args)
    node->args.push_back(convertScalars(std::move(arg), type->element));
  // `vec3(iv)` is only the conversion of a vector.
  if (node->args.size() == 1 && node->args[0]->kind == typed::ExprKind::Convert &&
      node->args[0]->type == type) {
    ExprPtr conversion = std::move(node->args[0]);
    conversion->range = range;
    return conversion;
  }
  return node;
}

ExprPtr FunctionChecker::constructMatrix(const Type *type, std::vector<ExprPtr> args,
                                         SourceRange range) {
  const bool single = args.size() == 1 && !args[0]->type->isVector();
  if (!single) {
    for (const ExprPtr &arg : args)
      if (arg->type->isMatrix()) {
        diagnostics.report(Code::badPiece, arg->range, toString(type), toString(arg->type))
            .note("a matrix is constructed from one matrix alone, or from numbers and vectors by "
                  "column");
        return errorExpr(range);
      }
    if (!requirePieces(type, args, range, true))
      return errorExpr(range);
  }
  auto node = makeExpr<typed::ConstructExpr>(type, range);
  for (ExprPtr &arg : args)
    node->args.push_back(convertScalars(std::move(arg), types.floatType));
  return node;
}

ExprPtr FunctionChecker::constructColor(std::vector<ExprPtr> args, SourceRange range) {
  auto node = makeExpr<typed::ConstructExpr>(types.color, range);
  if (args.size() == 1 && args[0]->type->is(TypeKind::Color))
    return std::move(args[0]);
  for (ExprPtr &arg : args) {
    if (!arg->type->isNumericScalar()) {
      Diagnostic &diagnostic =
          diagnostics.report(Code::badPiece, arg->range, "color", toString(arg->type));
      const bool simple = arg->kind == typed::ExprKind::Variable ||
                          arg->kind == typed::ExprKind::Member ||
                          arg->kind == typed::ExprKind::State;
      const std::string text = sourceText(arg->range);
      if (args.size() == 1 && simple && arg->type->isVector() && arg->type->count >= 3)
        diagnostic.fix(arg->range, text + ".r, " + text + ".g, " + text + ".b");
      else
        diagnostic.note("a color is constructed from one number, or from red, green and blue");
      return errorExpr(range);
    }
    node->args.push_back(convertTo(std::move(arg), types.floatType));
  }
  if (node->args.size() != 1 && node->args.size() != 3) {
    diagnostics.report(Code::wrongArgumentCount, range, "color", "1 or 3 arguments",
                       node->args.size());
    return errorExpr(range);
  }
  return node;
}

ExprPtr FunctionChecker::constructAggregate(const Type *type, std::vector<ExprPtr> args,
                                            SourceRange range) {
  const bool isArray = type->is(TypeKind::Array);
  const std::size_t needed = isArray ? type->count : type->structure->fields.size();
  if (args.size() != needed) {
    Diagnostic &diagnostic = diagnostics.report(
        Code::wrongArgumentCount, range, toString(type),
        std::to_string(needed) + (needed == 1 ? " argument" : " arguments"), args.size());
    if (!isArray)
      diagnostic.label(type->structure->range, "defined here");
    return errorExpr(range);
  }
  auto node = makeExpr<typed::ConstructExpr>(type, range);
  bool broken = false;
  for (std::size_t i = 0; i != needed; ++i) {
    const Type *wanted = isArray ? type->element : type->structure->fields[i].type;
    Label label;
    if (!isArray)
      label = {type->structure->fields[i].range, "for this field"};
    node->args.push_back(coerce(std::move(args[i]), wanted, label));
    broken |= node->args.back()->type->isError();
  }
  return broken ? errorExpr(range) : std::move(node);
}

/// `float[](1, 2, 3)`: as many elements as there are arguments.
ExprPtr FunctionChecker::constructUnsizedArray(const ast::ConstructExpr &expr) {
  const Type *unsized = resolveType(expr.type, nullptr, true);
  if (unsized->isError())
    return errorExpr(expr.range);
  if (unsized->count != 1 || expr.args.empty()) {
    diagnostics.report(Code::unsizedArray, expr.type.range);
    return errorExpr(expr.range);
  }
  const Type *type = types.array(unsized->element, static_cast<std::uint32_t>(expr.args.size()));
  return checkConstruct(type, expr.type.range, expr.args, expr.range);
}

//===----------------------------------------------------------------------===//
// Initialisers
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkInitializer(const ast::Expr &init, const Type *type) {
  if (init.kind == ast::ExprKind::InitializerList) {
    if (recursion >= maxRecursion)
      return errorExpr(init.range);
    ++recursion;
    ExprPtr result = checkInitializerList(cast<ast::InitializerListExpr>(init), type);
    --recursion;
    return result;
  }
  ExprPtr value = checkValue(init);
  if (type->isError())
    return errorExpr(init.range);
  return coerce(std::move(value), type);
}

/// `{...}`: the parts of an aggregate, vector (its components) or matrix (its columns), each
/// initialised in turn.
ExprPtr FunctionChecker::checkInitializerList(const ast::InitializerListExpr &list,
                                              const Type *type) {
  std::vector<const Type *> parts;
  if (type->is(TypeKind::Struct)) {
    for (const typed::Field &field : type->structure->fields)
      parts.push_back(field.type);
  } else if (type->is(TypeKind::Array) || type->isVector() || type->isMatrix()) {
    // The count is compared first: an array may be far longer than its list.
    parts.assign(std::min<std::size_t>(type->count, list.elements.size() + 1), type->element);
  } else if (type->isError()) {
    return errorExpr(list.range);
  } else {
    diagnostics.report(Code::listForScalar, list.range, toString(type));
    return errorExpr(list.range);
  }
  const std::size_t needed = type->is(TypeKind::Struct) ? parts.size() : type->count;
  if (list.elements.size() != needed) {
    diagnostics.report(Code::wrongArgumentCount, list.range, toString(type),
                       std::to_string(needed) + (needed == 1 ? " element" : " elements"),
                       list.elements.size());
    return errorExpr(list.range);
  }
  auto node = makeExpr<typed::ConstructExpr>(type, list.range);
  bool broken = false;
  for (std::size_t i = 0; i != needed; ++i) {
    node->args.push_back(checkInitializer(*list.elements[i], parts[i]));
    broken |= node->args.back()->type->isError();
  }
  return broken ? errorExpr(list.range) : std::move(node);
}

const Type *FunctionChecker::deduceUnsized(const ast::VariableDecl &declaration, ExprPtr &init) {
  const Type *unsized = resolveType(declaration.type, &declaration.name, true);
  if (unsized->isError())
    return unsized;
  if (unsized->count != 1 || !declaration.init) {
    diagnostics.report(Code::unsizedArray, declaration.type.range)
        .note("give it a length, or an initialiser that has one");
    return types.error;
  }
  if (declaration.init->kind == ast::ExprKind::InitializerList) {
    const auto &list = cast<ast::InitializerListExpr>(*declaration.init);
    if (list.elements.empty()) {
      diagnostics.report(Code::unsizedArray, list.range);
      return types.error;
    }
    const Type *type =
        types.array(unsized->element, static_cast<std::uint32_t>(list.elements.size()));
    init = checkInitializerList(list, type);
    return type;
  }
  init = checkValue(*declaration.init);
  if (init->type->isError())
    return types.error;
  if (!init->type->is(TypeKind::Array) || init->type->element != unsized->element) {
    diagnostics.report(Code::noConversion, init->range, toString(init->type), toString(unsized));
    return types.error;
  }
  return init->type;
}

} // namespace rtsl
