#include "codegen/cpp/Variables.h"

#include "codegen/cpp/functions/FunctionPrinter.h"
#include "codegen/cpp/runtime/Payloads.h"

#include <algorithm>
#include <cmath>

namespace rtsl::cpp {

//===----------------------------------------------------------------------===//
// Structs
//===----------------------------------------------------------------------===//

/// `friend bool operator==(const Ray &a, const Ray &b)` with this value.
static Declaration comparison(const std::string &type, const char *name, Code value) {
  Function made;
  made.specifiers = "friend";
  made.result = "bool";
  made.name = name;
  made.parameters = {byConstReference(type, "a"), byConstReference(type, "b")};
  made.body = Statements{returning(std::move(value))};
  return declare(std::move(made));
}

/// The operators == and != of a struct.
static Declarations comparisons(const Names &names, const typed::Struct &structure) {
  const Code a = name("a"), b = name("b");
  Code equal;
  for (const typed::Field &field : structure.fields) {
    const std::string &own = names.of(&field);
    const Code part = binary(Operator::Equal, member(a, own), member(b, own));
    equal = equal ? binary(Operator::And, equal, part) : part;
  }
  const std::string &type = names.of(&structure);
  return {comparison(type, "operator==", equal),
          comparison(type, "operator!=", unary(UnaryOperator::Not, binary(Operator::Equal, a, b)))};
}

Declaration Variables::structure(const typed::Struct &structure) const {
  Struct made;
  made.name = context.names.of(&structure);
  if (std::optional<Declaration> type = rayType(context.facts, structure))
    made.members.push_back(std::move(*type));
  const bool hasRayType = !made.members.empty();
  for (std::size_t i = 0; i < structure.fields.size(); ++i) {
    const typed::Field &field = structure.fields[i];
    const Code initial =
        field.type->is(TypeKind::Bool) ? list("", {}) : context.types.zero(field.type);
    Declaration declared = declare(
        Variable{{}, context.types.inMemory(field.type), {context.names.of(&field), initial}},
        field.comment);
    declared.trailing = context.notes.trailingComment(field.range);
    declared.hasSpace =
        i == 0 ? hasRayType
               : context.notes.followsEmptyLine(field.range, structure.fields[i - 1].range);
    made.members.push_back(std::move(declared));
  }
  const bool isCompared =
      std::any_of(context.required.comparedStructs.begin(), context.required.comparedStructs.end(),
                  [&](const Type *compared) { return compared->structure == &structure; });
  if (isCompared)
    appendApart(made.members, comparisons(context.names, structure));
  return declare(std::move(made), structure.comment);
}

/// Whether the initialiser is a constant expression in C++: it consists of numbers, other constant
/// expressions and operators except division. Functions of the header are not constexpr, and the
/// result must not be infinite.
bool Variables::isConstexpr(const Type *type, const typed::Constant *value, const std::string &name,
                            const Code &initialiser) {
  if (!type->isScalar() || !value ||
      (type->is(TypeKind::Float) && !std::isfinite(value->scalars.front().f)))
    return false;
  bool isPlain = true;
  forEachPart(initialiser, [&](const ExpressionNode &part) {
    switch (part.kind) {
    case ExpressionKind::Literal:
    case ExpressionKind::Parentheses:
    case ExpressionKind::Unary:
    case ExpressionKind::Conditional:
      break;
    case ExpressionKind::Name:
      isPlain &= constexprNames.count(part.name) != 0;
      break;
    case ExpressionKind::Binary:
      isPlain &= part.op != Operator::Divide && part.op != Operator::Remainder;
      break;
    default:
      isPlain = false;
    }
  });
  if (isPlain)
    constexprNames.insert(name);
  return isPlain;
}

Declaration Variables::constant(const typed::Variable &constant) {
  FunctionPrinter printer(context, nullptr);
  const std::string &name = context.names.of(&constant);
  const Code initialiser = printer.expressions.initialiser(*constant.init);
  const bool isPlain = isConstexpr(constant.type, constant.constant.get(), name, initialiser) ||
                       printer.literals.isTable(*constant.init);
  Declaration declared = declare(Variable{isPlain ? "inline constexpr" : "inline const",
                                          context.types.of(constant.type),
                                          {name, initialiser}},
                                 constant.comment);
  declared.trailing = context.notes.trailingComment(constant.init->range);
  return declared;
}

Declaration Variables::member(const typed::Member &member) {
  FunctionPrinter printer(context, nullptr, member.owner);
  Variable made;
  Code value =
      member.init ? printer.expressions.initialiser(*member.init) : context.types.zero(member.type);
  if (member.isConst) {
    const bool isPlain =
        isConstexpr(member.type, member.constant.get(), context.names.of(&member), value) ||
        (member.init && printer.literals.isTable(*member.init));
    made.qualifiers = isPlain ? "static constexpr" : "inline static const";
    made.type = context.types.of(member.type);
  } else {
    if (member.type->is(TypeKind::Bool)) // converts in braces
      value = member.init ? list("", {value}) : list("", {});
    made.type = context.types.inMemory(member.type);
  }
  made.declarator = {context.names.of(&member), value};
  Declaration declared = declare(std::move(made), member.comment);
  declared.trailing =
      context.notes.trailingComment(member.init ? member.init->range : member.range);
  return declared;
}

} // namespace rtsl::cpp
