//===- AstExpressions.cpp - parse tree to syntax tree: expressions --------===//
#include "frontend/syntax/AstBuilder.h"
#include "frontend/syntax/TokenCheck.h"

#include <algorithm>
#include <limits>

namespace rtsl {

using namespace ast;

namespace {

using Parser = AstBuilder::Parser;

/// The operator of a token; compound assignments give the operator that they contain.
BinaryOp binaryOp(std::size_t type) {
  switch (type) {
  case Parser::STAR:
  case Parser::STAR_ASSIGN:
    return BinaryOp::Mul;
  case Parser::SLASH:
  case Parser::SLASH_ASSIGN:
    return BinaryOp::Div;
  case Parser::PERCENT:
  case Parser::PERCENT_ASSIGN:
    return BinaryOp::Mod;
  case Parser::PLUS:
  case Parser::PLUS_ASSIGN:
    return BinaryOp::Add;
  case Parser::MINUS:
  case Parser::MINUS_ASSIGN:
    return BinaryOp::Sub;
  case Parser::LEFT_SHIFT:
  case Parser::LEFT_SHIFT_ASSIGN:
    return BinaryOp::Shl;
  case Parser::RIGHT_SHIFT:
  case Parser::RIGHT_SHIFT_ASSIGN:
    return BinaryOp::Shr;
  case Parser::LESS:
    return BinaryOp::Less;
  case Parser::GREATER:
    return BinaryOp::Greater;
  case Parser::LESS_EQUAL:
    return BinaryOp::LessEqual;
  case Parser::GREATER_EQUAL:
    return BinaryOp::GreaterEqual;
  case Parser::EQUAL_EQUAL:
    return BinaryOp::Equal;
  case Parser::NOT_EQUAL:
    return BinaryOp::NotEqual;
  case Parser::AMPERSAND:
  case Parser::AND_ASSIGN:
    return BinaryOp::BitAnd;
  case Parser::CARET:
  case Parser::XOR_ASSIGN:
    return BinaryOp::BitXor;
  case Parser::BAR:
  case Parser::OR_ASSIGN:
    return BinaryOp::BitOr;
  case Parser::AND_AND:
    return BinaryOp::LogicalAnd;
  case Parser::XOR_XOR:
    return BinaryOp::LogicalXor;
  default:
    return BinaryOp::LogicalOr;
  }
}

UnaryOp prefixOp(std::size_t type) {
  switch (type) {
  case Parser::PLUS_PLUS:
    return UnaryOp::PreIncrement;
  case Parser::MINUS_MINUS:
    return UnaryOp::PreDecrement;
  case Parser::PLUS:
    return UnaryOp::Plus;
  case Parser::MINUS:
    return UnaryOp::Minus;
  case Parser::NOT:
    return UnaryOp::Not;
  default:
    return UnaryOp::BitNot;
  }
}

/// Value of the digits of a decimal, octal or hexadecimal literal, saturated.
std::uint64_t integerValue(std::string_view digits) {
  std::uint64_t base = 10;
  if (digits.size() > 1 && digits[0] == '0') {
    const bool isHexadecimal = digits[1] == 'x' || digits[1] == 'X';
    base = isHexadecimal ? 16 : 8;
    digits.remove_prefix(isHexadecimal ? 2 : 1);
  }
  constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t value = 0;
  for (const char c : digits) {
    const auto digit = static_cast<std::uint64_t>(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
    if (value > (largest - digit) / base)
      return largest;
    value = value * base + digit;
  }
  return value;
}

} // namespace

ExprPtr AstBuilder::error(SourceRange where) const {
  auto result = std::make_unique<ErrorExpr>();
  result->range = where;
  return result;
}

ExprPtr AstBuilder::buildExpression(Parser::ExpressionContext *context) {
  if (!context)
    return error({file, 0, 0});
  if (context->exception)
    return error(range(context));
  const auto operands = context->expr();
  if (operands.size() - 1 > maxNesting) {
    diagnostics.report(Code::nestedTooDeep, range(operands[maxNesting]->start), "expression",
                       maxNesting);
    return error(range(context));
  }
  ExprPtr result = buildExpr(operands.front());
  for (std::size_t i = 1; i < operands.size(); ++i) {
    auto comma = std::make_unique<CommaExpr>();
    comma->left = std::move(result);
    comma->right = buildExpr(operands[i]);
    comma->range = comma->left->range.to(comma->right->range);
    result = std::move(comma);
  }
  return result;
}

ExprPtr AstBuilder::buildCondition(Parser::ConditionContext *context, SourceRange owner) {
  if (!context)
    return error(owner);
  return context->exception ? error(range(context)) : buildExpression(context->expression());
}

ExprPtr AstBuilder::buildExpr(Parser::ExprContext *context) {
  if (!context)
    return error({file, 0, 0});
  if (context->exception)
    return error(range(context));
  if (auto *identifier = dynamic_cast<Parser::NameContext *>(context)) {
    if (identifier->COLON_COLON()) {
      diagnostics
          .report(Code::qualifiedName, range(context), text(range(identifier->IDENTIFIER(0))),
                  text(range(identifier->IDENTIFIER(1))))
          .note(
              "a member is named without its class: names are unique among a class and its bases");
      return error(range(context));
    }
    auto result = make<NameExpr>(context);
    result->name = text(range(identifier->IDENTIFIER(0)));
    return result;
  }
  if (auto *constant = dynamic_cast<Parser::ConstantContext *>(context))
    return buildLiteral(constant->literal());
  if (auto *binary = dynamic_cast<Parser::BinaryContext *>(context)) {
    auto result = make<BinaryExpr>(context);
    const auto operands = binary->expr();
    result->op = binaryOp(binary->op->getType());
    result->opRange = range(binary->op);
    result->left = buildExpr(operands[0]);
    result->right = buildExpr(operands[1]);
    return result;
  }
  if (auto *member = dynamic_cast<Parser::MemberContext *>(context)) {
    auto result = make<MemberExpr>(context);
    result->base = buildExpr(member->expr());
    result->member = name(member->IDENTIFIER());
    return result;
  }
  if (auto *call = dynamic_cast<Parser::CallContext *>(context))
    return buildCall(call);
  if (auto *paren = dynamic_cast<Parser::ParenContext *>(context)) {
    auto result = make<ParenExpr>(context);
    result->inner = buildExpression(paren->expression());
    return result;
  }
  if (auto *index = dynamic_cast<Parser::IndexContext *>(context))
    return buildIndex(index);
  if (auto *prefix = dynamic_cast<Parser::PrefixContext *>(context)) {
    auto result = make<UnaryExpr>(context);
    result->op = prefixOp(prefix->op->getType());
    result->opRange = range(prefix->op);
    result->operand = buildExpr(prefix->expr());
    return result;
  }
  if (auto *postfix = dynamic_cast<Parser::PostfixContext *>(context)) {
    auto result = make<UnaryExpr>(context);
    result->op = postfix->op->getType() == Parser::PLUS_PLUS ? UnaryOp::PostIncrement
                                                             : UnaryOp::PostDecrement;
    result->opRange = range(postfix->op);
    result->operand = buildExpr(postfix->expr());
    return result;
  }
  return buildConditionalOrAssignment(
      static_cast<Parser::ConditionalOrAssignmentContext *>(context));
}

ExprPtr AstBuilder::buildConditionalOrAssignment(Parser::ConditionalOrAssignmentContext *context) {
  const auto operands = context->expr();
  if (auto *assignment = context->assignment()) {
    auto result = make<AssignExpr>(context);
    const std::size_t type = assignment->start->getType();
    result->compound = type != Parser::ASSIGN;
    result->op = binaryOp(type);
    result->opRange = range(assignment);
    result->target = buildExpr(operands[0]);
    result->value = buildExpr(operands[1]);
    return result;
  }
  auto result = make<ConditionalExpr>(context);
  result->condition = buildExpr(operands[0]);
  result->whenTrue = buildExpression(context->expression());
  result->whenFalse = buildExpr(operands[1]);
  return result;
}

ExprPtr AstBuilder::buildIndex(Parser::IndexContext *context) {
  auto result = make<IndexExpr>(context);
  result->base = buildExpr(context->expr());
  if (auto *index = context->expression()) {
    result->index = buildExpression(index);
  } else {
    const SourceRange brackets = range(context->LEFT_BRACKET()).to(range(context->RIGHT_BRACKET()));
    diagnostics.report(Code::missingIndex, brackets);
    result->index = error(brackets);
  }
  return result;
}

//===----------------------------------------------------------------------===//
// Calls
//===----------------------------------------------------------------------===//

std::vector<ExprPtr> AstBuilder::buildArguments(Parser::ArgumentsContext *context) {
  std::vector<ExprPtr> arguments;
  if (!context)
    return arguments;
  for (auto *argument : context->expr())
    arguments.push_back(buildExpr(argument));
  return arguments;
}

ExprPtr AstBuilder::buildCall(Parser::CallContext *context) {
  if (context->arguments()->exception)
    return error(range(context)); // it cannot be known which function was meant
  Parser::ExprContext *callee = context->expr();
  if (dynamic_cast<Parser::IndexContext *>(callee))
    return buildConstruct(context);
  auto result = make<CallExpr>(context);
  if (auto *function = dynamic_cast<Parser::NameContext *>(callee)) {
    if (function->COLON_COLON())
      result->base = name(function->IDENTIFIER(0));
    result->callee = name(function->IDENTIFIER().back());
  } else if (auto *method = dynamic_cast<Parser::MemberContext *>(callee)) {
    result->receiver = buildExpr(method->expr());
    result->callee = name(method->IDENTIFIER());
  } else {
    if (!tokens[callee->start->getTokenIndex()].isBroken)
      diagnostics.report(Code::notCallable, range(callee));
    return error(range(context));
  }
  result->args = buildArguments(context->arguments());
  return result;
}

/// `float[3][](...)`: the callee parses as a name with indices.
ExprPtr AstBuilder::buildConstruct(Parser::CallContext *context) {
  auto result = make<ConstructExpr>(context);
  Parser::ExprContext *callee = context->expr();
  result->type.range = range(callee);
  while (auto *index = dynamic_cast<Parser::IndexContext *>(callee)) {
    ArrayDimension dimension;
    dimension.range = range(index->LEFT_BRACKET()).to(range(index->RIGHT_BRACKET()));
    if (auto *size = index->expression())
      dimension.size = buildExpression(size);
    result->type.dimensions.push_back(std::move(dimension));
    callee = index->expr();
  }
  std::reverse(result->type.dimensions.begin(), result->type.dimensions.end());
  auto *type = dynamic_cast<Parser::NameContext *>(callee);
  if (!type || type->COLON_COLON()) {
    diagnostics.report(Code::notCallable, result->type.range);
    return error(range(context));
  }
  result->type.name = name(type->IDENTIFIER(0));
  result->args = buildArguments(context->arguments());
  return result;
}

ExprPtr AstBuilder::buildInitializer(Parser::InitializerContext *context) {
  if (context->exception)
    return error(range(context));
  if (auto *value = context->expr())
    return buildExpr(value);
  auto result = make<InitializerListExpr>(context);
  for (auto *element : context->initializer())
    result->elements.push_back(buildInitializer(element));
  return result;
}

//===----------------------------------------------------------------------===//
// Literals
//===----------------------------------------------------------------------===//

ExprPtr AstBuilder::buildLiteral(Parser::LiteralContext *context) {
  const SourceRange where = range(context);
  std::string spelling = text(where);
  if (tokens[context->start->getTokenIndex()].isBroken)
    return error(where);
  switch (context->start->getType()) {
  case Parser::INT_LITERAL: {
    auto result = make<IntLiteral>(context);
    result->isUnsigned = spelling.back() == 'u' || spelling.back() == 'U';
    result->value = integerValue(
        std::string_view(spelling).substr(0, spelling.size() - (result->isUnsigned ? 1 : 0)));
    result->spelling = std::move(spelling);
    return result;
  }
  case Parser::FLOAT_LITERAL: {
    auto result = make<FloatLiteral>(context);
    const std::size_t end = std::min(spelling.find_first_of("fFlL"), spelling.size());
    result->suffix = end == spelling.size() ? "" : spelling.size() - end == 1 ? "f" : "lf";
    result->spelling = spelling.substr(0, end);
    return result;
  }
  case Parser::STRING_LITERAL: {
    auto result = make<StringLiteral>(context);
    for (std::size_t i = 1; i + 1 < spelling.size(); ++i) {
      if (spelling[i] != '\\') {
        result->value += spelling[i];
        continue;
      }
      ++i;
      const std::string_view escapes = "nt\"\\";
      const std::size_t escape = escapes.find(spelling[i]);
      if (escape == std::string_view::npos) {
        const auto at = static_cast<std::uint32_t>(where.begin + i - 1);
        diagnostics
            .report(Code::unknownEscape, SourceRange{file, at, at + 2}, spelling.substr(i - 1, 2))
            .note("the escapes are `\\n`, `\\t`, `\\\"` and `\\\\`");
        continue;
      }
      result->value += "\n\t\"\\"[escape];
    }
    return result;
  }
  default: {
    auto result = make<BoolLiteral>(context);
    result->value = context->start->getType() == Parser::TRUE;
    return result;
  }
  }
}

} // namespace rtsl
