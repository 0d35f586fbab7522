//===- Analysis.cpp - what lowering asks about a typed tree ---------------===//
#include "codegen/lower/Analysis.h"

#include "sema/Casting.h"

namespace rtsl::lowering {

using ast::StmtKind;
using typed::ExprKind;
using ExprVisitor = std::function<void(const typed::Expr &)>;

//===----------------------------------------------------------------------===//
// Walks
//===----------------------------------------------------------------------===//

static void forEachChild(const typed::Expr &expr, const ExprVisitor &visit) {
  auto one = [&](const typed::ExprPtr &child) {
    if (child)
      visit(*child);
  };
  auto several = [&](const std::vector<typed::ExprPtr> &children) {
    for (const typed::ExprPtr &child : children)
      one(child);
  };
  switch (expr.kind) {
  case ExprKind::Literal:
  case ExprKind::Variable:
  case ExprKind::State:
  case ExprKind::Member:
  case ExprKind::String:
    return;
  case ExprKind::Field:
    return one(cast<typed::FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return one(cast<typed::SwizzleExpr>(expr).base);
  case ExprKind::Index:
    one(cast<typed::IndexExpr>(expr).base);
    return one(cast<typed::IndexExpr>(expr).index);
  case ExprKind::Length:
    return one(cast<typed::LengthExpr>(expr).base);
  case ExprKind::Unary:
    return one(cast<typed::UnaryExpr>(expr).operand);
  case ExprKind::IncDec:
    return one(cast<typed::IncDecExpr>(expr).target);
  case ExprKind::Binary:
    one(cast<typed::BinaryExpr>(expr).left);
    return one(cast<typed::BinaryExpr>(expr).right);
  case ExprKind::Assign:
    one(cast<typed::AssignExpr>(expr).target);
    return one(cast<typed::AssignExpr>(expr).value);
  case ExprKind::Conditional:
    one(cast<typed::ConditionalExpr>(expr).condition);
    one(cast<typed::ConditionalExpr>(expr).whenTrue);
    return one(cast<typed::ConditionalExpr>(expr).whenFalse);
  case ExprKind::Comma:
    one(cast<typed::CommaExpr>(expr).left);
    return one(cast<typed::CommaExpr>(expr).right);
  case ExprKind::Convert:
    return one(cast<typed::ConvertExpr>(expr).operand);
  case ExprKind::Construct:
    return several(cast<typed::ConstructExpr>(expr).args);
  case ExprKind::Builtin:
    return several(cast<typed::BuiltinExpr>(expr).args);
  case ExprKind::Call:
    return several(cast<typed::CallExpr>(expr).args);
  case ExprKind::MethodCall:
    one(cast<typed::MethodCallExpr>(expr).receiver);
    return several(cast<typed::MethodCallExpr>(expr).args);
  }
}

void forEachExpr(const typed::Expr &expr, const ExprVisitor &visit) {
  visit(expr);
  forEachChild(expr, [&](const typed::Expr &child) { forEachExpr(child, visit); });
}

void forEachExpr(const typed::Stmt &stmt, const ExprVisitor &visit) {
  auto expr = [&](const typed::ExprPtr &child) {
    if (child)
      forEachExpr(*child, visit);
  };
  auto inner = [&](const typed::StmtPtr &child) {
    if (child)
      forEachExpr(*child, visit);
  };
  switch (stmt.kind) {
  case StmtKind::Compound:
    for (const typed::StmtPtr &child : cast<typed::CompoundStmt>(stmt).body)
      inner(child);
    return;
  case StmtKind::Declaration:
    for (const typed::Variable *variable : cast<typed::DeclarationStmt>(stmt).variables)
      expr(variable->init);
    return;
  case StmtKind::Expression:
    return expr(cast<typed::ExpressionStmt>(stmt).expr);
  case StmtKind::If:
    expr(cast<typed::IfStmt>(stmt).condition);
    inner(cast<typed::IfStmt>(stmt).thenStmt);
    return inner(cast<typed::IfStmt>(stmt).elseStmt);
  case StmtKind::For:
    inner(cast<typed::ForStmt>(stmt).init);
    expr(cast<typed::ForStmt>(stmt).condition);
    expr(cast<typed::ForStmt>(stmt).step);
    return inner(cast<typed::ForStmt>(stmt).body);
  case StmtKind::While:
    expr(cast<typed::WhileStmt>(stmt).condition);
    return inner(cast<typed::WhileStmt>(stmt).body);
  case StmtKind::DoWhile:
    inner(cast<typed::DoWhileStmt>(stmt).body);
    return expr(cast<typed::DoWhileStmt>(stmt).condition);
  case StmtKind::Switch:
    expr(cast<typed::SwitchStmt>(stmt).value);
    for (const auto &arm : cast<typed::SwitchStmt>(stmt).arms)
      for (const typed::StmtPtr &child : arm.body)
        inner(child);
    return;
  case StmtKind::Return:
    return expr(cast<typed::ReturnStmt>(stmt).value);
  case StmtKind::Illuminance:
    expr(cast<typed::IlluminanceStmt>(stmt).point);
    expr(cast<typed::IlluminanceStmt>(stmt).normal);
    expr(cast<typed::IlluminanceStmt>(stmt).angle);
    return inner(cast<typed::IlluminanceStmt>(stmt).body);
  case StmtKind::Case:
  case StmtKind::Break:
  case StmtKind::Continue:
  case StmtKind::Empty:
    return;
  }
}

//===----------------------------------------------------------------------===//
// Questions
//===----------------------------------------------------------------------===//

// The variable that a place is, or is part of.
static const typed::Variable *variableOf(const typed::Expr *place) {
  while (place) {
    if (auto *variable = dynCast<typed::VariableExpr>(place))
      return variable->variable;
    if (auto *field = dynCast<typed::FieldExpr>(place))
      place = field->base.get();
    else if (auto *swizzle = dynCast<typed::SwizzleExpr>(place))
      place = swizzle->base.get();
    else if (auto *index = dynCast<typed::IndexExpr>(place))
      place = index->base.get();
    else
      return nullptr;
  }
  return nullptr;
}

std::set<const typed::Variable *> assignedVariables(const typed::Stmt &body) {
  std::set<const typed::Variable *> assigned;
  auto add = [&](const typed::ExprPtr &place) {
    if (const typed::Variable *variable = variableOf(place.get()))
      assigned.insert(variable);
  };
  auto addOutputs = [&](const typed::Function *function, const std::vector<typed::ExprPtr> &args) {
    for (std::size_t i = 0; function && i < args.size(); ++i)
      if (function->parameters[i]->direction != ast::Direction::In)
        add(args[i]);
  };
  forEachExpr(body, [&](const typed::Expr &expr) {
    if (auto *assign = dynCast<typed::AssignExpr>(&expr))
      add(assign->target);
    else if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
      add(incDec->target);
    else if (auto *call = dynCast<typed::CallExpr>(&expr))
      addOutputs(call->function, call->args);
    else if (auto *call = dynCast<typed::MethodCallExpr>(&expr))
      addOutputs(call->function, call->args);
    else if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
      // Those of built-ins with out parameters; counting the others too does no harm.
      switch (builtin->builtin) {
      case typed::Builtin::Modf:
      case typed::Builtin::Frexp:
      case typed::Builtin::UaddCarry:
      case typed::Builtin::UsubBorrow:
      case typed::Builtin::UmulExtended:
      case typed::Builtin::ImulExtended:
      case typed::Builtin::TracePayload:
        for (const typed::ExprPtr &arg : builtin->args)
          add(arg);
        break;
      default:
        break;
      }
  });
  return assigned;
}

static bool isPureBuiltin(typed::Builtin builtin) {
  switch (builtin) {
  case typed::Builtin::Modf:
  case typed::Builtin::Frexp:
  case typed::Builtin::UaddCarry:
  case typed::Builtin::UsubBorrow:
  case typed::Builtin::UmulExtended:
  case typed::Builtin::ImulExtended:
  case typed::Builtin::Rand:
  case typed::Builtin::Trace:
  case typed::Builtin::TracePayload:
  case typed::Builtin::Hit:
  case typed::Builtin::IgnoreIntersection:
  case typed::Builtin::TerminateRay:
  case typed::Builtin::VisitChild:
  case typed::Builtin::Print:
    return false;
  default:
    return true;
  }
}

bool hasSideEffects(const typed::Expr &expr) {
  bool found = false;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    switch (inner.kind) {
    case ExprKind::IncDec:
    case ExprKind::Assign:
    case ExprKind::Call:
    case ExprKind::MethodCall:
      found = true;
      break;
    case ExprKind::Builtin:
      found = found || !isPureBuiltin(cast<typed::BuiltinExpr>(inner).builtin);
      break;
    default:
      break;
    }
  });
  return found;
}

// A few operations each, on every target.
static unsigned costOf(typed::Builtin builtin, unsigned limit) {
  switch (builtin) {
  case typed::Builtin::Abs:
  case typed::Builtin::Floor:
  case typed::Builtin::Ceil:
  case typed::Builtin::Trunc:
  case typed::Builtin::IsNan:
  case typed::Builtin::IsInf:
  case typed::Builtin::Not:
    return 1;
  case typed::Builtin::Min:
  case typed::Builtin::Max:
  case typed::Builtin::Step:
  case typed::Builtin::Fract:
  case typed::Builtin::Fma:
  case typed::Builtin::LessThan:
  case typed::Builtin::LessThanEqual:
  case typed::Builtin::GreaterThan:
  case typed::Builtin::GreaterThanEqual:
  case typed::Builtin::Equal:
  case typed::Builtin::NotEqual:
    return 2;
  case typed::Builtin::Any:
  case typed::Builtin::All:
  case typed::Builtin::Sign:
  case typed::Builtin::Clamp:
  case typed::Builtin::Mix:
    return 4;
  case typed::Builtin::Dot:
  case typed::Builtin::Inside:
    return 6;
  default:
    return limit;
  }
}

bool isCheap(const typed::Expr &expr) {
  constexpr unsigned limit = 12;
  unsigned cost = 0;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    switch (inner.kind) {
    case ExprKind::Literal:
    case ExprKind::Variable:
    case ExprKind::State:
    case ExprKind::Member:
    case ExprKind::Swizzle:
    case ExprKind::Field:
    case ExprKind::Unary:
    case ExprKind::Convert:
      cost += 1;
      break;
    case ExprKind::Binary: {
      const auto &binary = cast<typed::BinaryExpr>(inner);
      bool isDivision = binary.op == ast::BinaryOp::Div || binary.op == ast::BinaryOp::Mod;
      bool isLarge = binary.left->type->isMatrix() || binary.right->type->isMatrix();
      cost += isDivision || isLarge ? limit + 1 : 2;
      break;
    }
    case ExprKind::Builtin:
      cost += costOf(cast<typed::BuiltinExpr>(inner).builtin, limit + 1);
      break;
    case ExprKind::Construct:
      cost += inner.type->isScalar() || inner.type->isVector() ? 1 : limit + 1;
      break;
    default:
      cost += limit + 1;
    }
    if (inner.type->isMatrix() || inner.type->is(TypeKind::Struct) ||
        inner.type->is(TypeKind::Array) || inner.type->is(TypeKind::Buffer))
      cost += limit + 1;
  });
  return cost <= limit;
}

bool isPlace(const typed::Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Variable:
  case ExprKind::State:
    return true;
  case ExprKind::Member:
    return !cast<typed::MemberExpr>(expr).member->isConst;
  case ExprKind::Field:
    return isPlace(*cast<typed::FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return isPlace(*cast<typed::SwizzleExpr>(expr).base);
  case ExprKind::Index:
    return isPlace(*cast<typed::IndexExpr>(expr).base);
  default:
    return false;
  }
}

//===----------------------------------------------------------------------===//
// Functions
//===----------------------------------------------------------------------===//

bool sameParameters(const typed::Function &a, const typed::Function &b) {
  if (a.parameters.size() != b.parameters.size())
    return false;
  for (std::size_t i = 0; i < a.parameters.size(); ++i)
    if (a.parameters[i]->type != b.parameters[i]->type)
      return false;
  return true;
}

const typed::Function &resolve(const typed::Function &callee, const typed::Class *concrete) {
  if (!callee.owner)
    return callee;
  for (const typed::Class *type = concrete; type; type = type->base)
    for (const auto &function : type->functions)
      if (function->name == callee.name && sameParameters(*function, callee))
        return *function;
  return callee;
}

static bool takesPart(const typed::Function &function, const typed::Class *concrete,
                      std::set<const typed::Function *> &visited) {
  if (!function.body || !visited.insert(&function).second)
    return false;
  bool found = false;
  forEachExpr(*function.body, [&](const typed::Expr &expr) {
    if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
      found = found || builtin->builtin == typed::Builtin::Hit;
    else if (auto *member = dynCast<typed::MemberExpr>(&expr))
      found = found || member->member->access == ast::Access::Scratch;
    else if (auto *call = dynCast<typed::CallExpr>(&expr))
      found = found || takesPart(resolve(*call->function, concrete), concrete, visited);
  });
  return found;
}

bool takesPartInIntersection(const typed::Function &function, const typed::Class *concrete) {
  std::set<const typed::Function *> visited;
  return takesPart(function, concrete, visited);
}

} // namespace rtsl::lowering
