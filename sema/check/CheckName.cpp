//===- CheckName.cpp - names, fields, swizzles and indices ----------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/check/Suggest.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace rtsl {

using typed::ExprPtr;

//===----------------------------------------------------------------------===//
// Uses that only some methods allow
//===----------------------------------------------------------------------===//

bool FunctionChecker::record(Use use) {
  if (!facts) {
    // Outside of functions there is no method whose state could be used.
    diagnostics.report(Code::useOutsideFunction, use.range, use.what);
    return false;
  }
  // In a method of the engine the rules are known; for other functions they follow from the call
  // graph.
  if (rules && scope->root)
    judgeUse(diagnostics, use, *scope->root, *rules, nullptr);
  else
    facts->uses.push_back(std::move(use));
  return true;
}

bool FunctionChecker::recordState(Use::Kind kind, typed::StateVariable variable,
                                  SourceRange range) {
  Use use;
  use.kind = kind;
  use.variable = variable;
  const bool ofALight = variable == typed::StateVariable::LightDirection ||
                        variable == typed::StateVariable::LightDistance ||
                        variable == typed::StateVariable::LightColor;
  if (kind == Use::Kind::ReadState && ofALight && rules && rules->name == "shade" &&
      illuminances == 0 && !isLit && !written.has(variable))
    diagnostics.report(Code::lightOutsideIlluminance, range,
                       std::string("rt_") + typed::name(variable));
  use.what = std::string("rt_") + typed::name(variable);
  use.range = range;
  return record(std::move(use));
}

bool FunctionChecker::recordSpecial(Ability ability, const std::string &what, SourceRange range,
                                    const typed::Member *member) {
  Use use;
  use.ability = ability;
  use.what = what;
  use.range = range;
  use.member = member;
  if (facts) {
    facts->sends.traced |= ability == Ability::Trace;
    facts->sends.shadow |=
        ability == Ability::Illuminance && (what == "illuminance" || what == "illuminate");
  }
  return record(std::move(use));
}

std::string FunctionChecker::whyNotHere(const std::string &name) const {
  typed::StateVariable variable;
  const bool isState =
      name.compare(0, 3, "rt_") == 0 && findStateVariable(name.substr(3), variable);
  const std::optional<Ability> ability = abilityNeeded(name.substr(0, name.find('(')));
  if (!isState && !ability)
    return {};
  if (!facts)
    return "`" + name + "` cannot be used outside of functions";
  if (!scope || !scope->root)
    return {}; // depends on its callers
  const MethodModel allowed = rules ? *rules : unionOfMethods(*scope->root);
  if (isState && !allowed.reads.has(variable))
    return "`" + name + "`, which may be meant, " +
           (scope->root->sees.has(variable) ? "has no value in `" + allowed.name + "`"
                                            : "belongs to " + classesThatSee(variable));
  if (ability && !allowed.abilities.has(*ability))
    return "`" + name + "`, which may be meant, is allowed only in " + methodsWith(*ability);
  return {};
}

std::vector<std::string> FunctionChecker::whatMayStandHere(std::vector<std::string> names) const {
  const auto isMisplaced = [this](const std::string &name) { return !whyNotHere(name).empty(); };
  names.erase(std::remove_if(names.begin(), names.end(), isMisplaced), names.end());
  return names;
}

//===----------------------------------------------------------------------===//
// Names
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkName(const ast::NameExpr &expr, Access access) {
  if (const typed::Variable *variable = locals.find(expr.name))
    return variableAccess(variable, expr.range, access);
  if (scope)
    if (const typed::Member *member = program.findMember(scope, expr.name))
      return memberAccess(member, expr.range, access);
  if (expr.name.compare(0, 3, "rt_") == 0)
    return checkState(expr.name, expr.range, access);
  if (scope && !program.findMethods(scope, expr.name).empty()) {
    diagnostics.report(Code::notAValue, expr.range, expr.name, "a function");
    return errorExpr(expr.range);
  }
  if (const Symbol *symbol = program.findSymbol(expr.name, expr.range)) {
    if (symbol->kind == Symbol::Kind::Constant) {
      if (const typed::Variable *constant = program.constant(expr.name, expr.range))
        return variableAccess(constant, expr.range, access);
      return errorExpr(expr.range);
    }
    const char *what = symbol->kind == Symbol::Kind::Struct  ? "a struct"
                       : symbol->kind == Symbol::Kind::Class ? "a class"
                                                             : "a function";
    diagnostics.report(Code::notAValue, expr.range, expr.name, what)
        .label(symbol->range, "defined here");
    return errorExpr(expr.range);
  }
  if (program.builtins.find(expr.name)) {
    diagnostics.report(Code::notAValue, expr.range, expr.name, "a built-in function");
    return errorExpr(expr.range);
  }
  if (program.types.named(expr.name)) {
    diagnostics.report(Code::notAValue, expr.range, expr.name, "a type");
    return errorExpr(expr.range);
  }
  reportUnknownName(expr.name, expr.range);
  return errorExpr(expr.range);
}

void FunctionChecker::reportUnknownName(const std::string &name, SourceRange range) {
  const ForeignSpelling *foreign = foreignSpelling(name);
  const bool isThis = name == "this" || name == "self";
  if (!unknownNames.insert(name).second && !isThis && !(foreign && foreign->sure))
    return; // one report per function is enough, unless each use gets a fix
  Diagnostic &diagnostic = diagnostics.report(Code::unknownName, range, name);
  if (foreign) {
    suggestSpelling(diagnostic, *foreign, whyNotHere(foreign->replacement),
                    program.imports(foreign->module), range);
    const SourceRange dot{range.file, range.end, range.end + 1};
    if (isThis && range.end < diagnostics.sources().text(range.file).size() &&
        sourceText(dot) == ".")
      diagnostic.fix(range.to(dot), "", true);
    return;
  }
  if (program.suggestImport(diagnostic, name))
    return;
  std::vector<std::string> candidates = locals.names();
  for (const ClassScope *at = scope; at; at = at->base)
    for (const auto &member : at->members)
      candidates.push_back(member.first);
  candidates.insert(candidates.end(), program.constantOrder.begin(), program.constantOrder.end());
  // The maps are unordered; messages must not be.
  std::sort(candidates.begin(), candidates.end());
  const std::string closest = closestName(name, candidates);
  typed::StateVariable state;
  if (!closest.empty())
    diagnostic.fix(range, closest);
  else if (findStateVariable(name, state)) {
    if (const std::string whyNot = whyNotHere("rt_" + name); whyNot.empty())
      diagnostic.fix(range, "rt_" + name);
    else
      diagnostic.note(whyNot);
  }
}

/// The names that contain the word or are contained in it: authors remember a part.
static std::vector<std::string> namesAround(std::string word,
                                            const std::vector<std::string> &names) {
  const auto lower = [](std::string &text) {
    for (char &c : text)
      c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  };
  lower(word);
  std::vector<std::string> found;
  for (const std::string &name : names) {
    std::string other = name.substr(3); // without rt_
    lower(other);
    if ((word.size() > 1 && other.find(word) != std::string::npos) ||
        (other.size() > 2 && word.find(other) != std::string::npos))
      found.push_back(name);
  }
  return found;
}

ExprPtr FunctionChecker::checkState(const std::string &name, SourceRange range, Access access) {
  typed::StateVariable variable;
  if (!findStateVariable(name.substr(3), variable)) {
    if (rootModel(name)) {
      diagnostics.report(Code::notAValue, range, name, "a class");
      return errorExpr(range);
    }
    Diagnostic &diagnostic = diagnostics.report(Code::unknownState, range, name);
    const std::vector<std::string> names = whatMayStandHere(stateVariableNames());
    const std::vector<std::string> around = namesAround(name.substr(3), names);
    if (const std::string closest = closestName(name, names); !closest.empty())
      diagnostic.fix(range, closest);
    else if (around.size() == 1)
      diagnostic.fix(range, around.front());
    else if (!around.empty())
      diagnostic.note(fmt::format("there are `{}`", fmt::join(around, "`, `")));
    return errorExpr(range);
  }
  if (access != Access::Read && !recordState(Use::Kind::WriteState, variable, range))
    return errorExpr(range);
  if (access != Access::Write && !recordState(Use::Kind::ReadState, variable, range))
    return errorExpr(range);
  if (access != Access::Read)
    written = written | StateSet{variable};
  auto node = makeExpr<typed::StateExpr>(typeOf(variable, types), range);
  node->variable = variable;
  return node;
}

/// Constants of these types are referred to by name: a table of a thousand numbers is not copied to
/// every use.
static bool isAggregate(const Type *type) {
  return type->is(TypeKind::Array) || type->is(TypeKind::Struct);
}

ExprPtr FunctionChecker::memberAccess(const typed::Member *member, SourceRange range,
                                      Access access) {
  if (member->type->isError())
    return errorExpr(range);
  if (member->isConst) {
    if (member->constant && access == Access::Read && !isAggregate(member->type)) {
      ExprPtr value = literal(member->type, range, *member->constant);
      static_cast<typed::LiteralExpr &>(*value).member = member;
      return value;
    }
  } else if (!facts) {
    diagnostics.report(Code::useOutsideFunction, range, member->name);
    return errorExpr(range);
  } else if (member->access == ast::Access::Scratch) {
    if (access != Access::Read)
      recordSpecial(Ability::WriteScratch, member->name, range, member);
    if (access != Access::Write)
      recordSpecial(Ability::ReadScratch, member->name, range, member);
  } else if (access != Access::Read) {
    const bool isBuffer = member->type->is(TypeKind::Buffer);
    if (!isBuffer)
      recordSpecial(Ability::WriteMembers, member->name, range, member);
    else if (member->type->mode != BufferMode::Read) // others: `requireTarget`
      recordSpecial(Ability::WriteBuffers, member->name, range, member);
  }
  auto node = makeExpr<typed::MemberExpr>(member->type, range);
  node->member = member;
  return node;
}

ExprPtr FunctionChecker::variableAccess(const typed::Variable *variable, SourceRange range,
                                        Access access) {
  mentioned.insert(variable);
  if (variable->type->isError())
    return errorExpr(range);
  if (variable->constant && access == Access::Read && !isAggregate(variable->type)) {
    ExprPtr value = literal(variable->type, range, *variable->constant);
    static_cast<typed::LiteralExpr &>(*value).variable = variable;
    return value;
  }
  auto node = makeExpr<typed::VariableExpr>(variable->type, range);
  node->variable = variable;
  return node;
}

//===----------------------------------------------------------------------===//
// Fields and swizzles
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkMember(const ast::MemberExpr &expr, Access access) {
  ExprPtr base = checkExpr(*expr.base, access);
  const Type *type = base->type;
  if (type->isError())
    return errorExpr(expr.range);
  if (type->isVector() || type->isNumericScalar() || type->is(TypeKind::Bool))
    return checkSwizzle(std::move(base), expr.member, expr.range, access);
  if (type->is(TypeKind::Struct)) {
    const std::vector<typed::Field> &fields = type->structure->fields;
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i != fields.size(); ++i) {
      if (fields[i].name == expr.member.text) {
        if (fields[i].type->isError())
          return errorExpr(expr.range);
        auto node = makeExpr<typed::FieldExpr>(fields[i].type, expr.range);
        node->base = std::move(base);
        node->field = i;
        return node;
      }
      names.push_back(fields[i].name);
    }
    Diagnostic &diagnostic =
        diagnostics.report(Code::unknownField, expr.member.range, toString(type), expr.member.text);
    diagnostic.label(type->structure->range, "`" + type->structure->name + "` is defined here");
    if (const std::string closest = closestName(expr.member.text, names); !closest.empty())
      diagnostic.fix(expr.member.range, closest);
    return errorExpr(expr.range);
  }
  if (type->is(TypeKind::Color)) {
    diagnostics.report(Code::colorHasNoComponents, expr.member.range, expr.member.text)
        .note("the number of components of a color depends on the target; `luminance(c)` gives one "
              "number");
    return errorExpr(expr.range);
  }
  if (type->is(TypeKind::Class)) {
    diagnostics
        .report(Code::memberOfOtherObject, expr.member.range, toString(type), expr.member.text)
        .note("only functions of another object can be used: `reference.function()`");
    return errorExpr(expr.range);
  }
  Diagnostic &diagnostic =
      diagnostics.report(Code::noMembers, expr.member.range, toString(type), expr.member.text);
  if (expr.member.text == "length" || expr.member.text == "size")
    diagnostic.fix(expr.member.range, "length()");
  return errorExpr(expr.range);
}

/// The component that a letter denotes, and the set of letters that it belongs to.
static int componentOf(char letter, int &set) {
  static const char *const sets[] = {"xyzw", "rgba", "stpq"};
  for (set = 0; set != 3; ++set)
    for (int i = 0; i != 4; ++i)
      if (sets[set][i] == letter)
        return i;
  return -1;
}

ExprPtr FunctionChecker::checkSwizzle(ExprPtr base, const ast::Name &letters, SourceRange range,
                                      Access access) {
  const Type *type = base->type;
  const std::uint32_t available = type->componentCount();
  std::vector<std::uint8_t> components;
  int firstSet = -1;
  for (char letter : letters.text) {
    int set = 0;
    const int component = componentOf(letter, set);
    if (component < 0 || letters.text.size() > 4) {
      Diagnostic &diagnostic =
          diagnostics.report(Code::badSwizzle, letters.range, toString(type), letters.text);
      if (letters.text == "length" || letters.text == "size")
        diagnostic.fix(letters.range, "length()");
      else
        diagnostic.note("components are named by one to four letters of `xyzw`, `rgba` or `stpq`");
      return errorExpr(range);
    }
    if (firstSet >= 0 && set != firstSet) {
      diagnostics.report(Code::mixedSwizzle, letters.range, letters.text)
          .note("take all letters from one of `xyzw`, `rgba` and `stpq`");
      return errorExpr(range);
    }
    firstSet = set;
    if (static_cast<std::uint32_t>(component) >= available) {
      diagnostics.report(Code::swizzleOutOfRange, letters.range, toString(type),
                         std::string(1, letter));
      return errorExpr(range);
    }
    components.push_back(static_cast<std::uint8_t>(component));
  }
  if (access != Access::Read) {
    std::vector<std::uint8_t> sorted = components;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      diagnostics.report(Code::duplicateSwizzle, letters.range, letters.text);
      return errorExpr(range);
    }
  }
  if (type->isScalar()) { // `f.x` is `f`, `f.xxx` is `vec3(f)`
    base->range = range;
    if (components.size() == 1)
      return base;
    auto node = makeExpr<typed::ConstructExpr>(
        types.vector(type, static_cast<std::uint32_t>(components.size())), range);
    node->args.push_back(std::move(base));
    return node;
  }
  const Type *result =
      components.size() == 1
          ? type->element
          : types.vector(type->element, static_cast<std::uint32_t>(components.size()));
  auto node = makeExpr<typed::SwizzleExpr>(result, range);
  node->base = std::move(base);
  node->components = std::move(components);
  return node;
}

//===----------------------------------------------------------------------===//
// Indices
//===----------------------------------------------------------------------===//

void FunctionChecker::reportUnreadable(const typed::Expr &buffer) {
  const auto *member = dynCast<typed::MemberExpr>(&typed::rootOf(buffer));
  if (!member)
    return; // reported already
  diagnostics.report(Code::bufferWriteOnly, buffer.range, member->member->name)
      .label(member->member->range, "declared here")
      .note("buffers that are read and written are declared `inout`");
}

ExprPtr FunctionChecker::checkIndex(const ast::IndexExpr &expr, Access access) {
  ExprPtr base = checkExpr(*expr.base, access);
  ExprPtr index = checkValue(*expr.index);
  const Type *type = base->type;
  if (type->isError() || index->type->isError())
    return errorExpr(expr.range);
  const bool isBuffer = type->is(TypeKind::Buffer);
  if (!type->isVector() && !type->isMatrix() && !type->is(TypeKind::Array) && !isBuffer) {
    Diagnostic &diagnostic = diagnostics.report(Code::notIndexable, base->range, toString(type));
    if (type->is(TypeKind::Color))
      diagnostic.note("the number of components of a color depends on the target; `luminance(c)` "
                      "gives one number");
    return errorExpr(expr.range);
  }
  if (!index->type->is(TypeKind::Int) && !index->type->is(TypeKind::UInt)) {
    Diagnostic &diagnostic =
        diagnostics.report(Code::indexNotInteger, index->range, toString(index->type));
    if (index->type->is(TypeKind::Float))
      diagnostic.fix(index->range, "int(" + sourceText(index->range) + ")");
    return errorExpr(expr.range);
  }
  if (std::optional<std::int64_t> value = evaluateInteger(*index)) {
    if (*value < 0 || (!isBuffer && *value >= std::int64_t(type->count))) {
      Diagnostic &diagnostic =
          diagnostics.report(Code::indexOutOfRange, index->range, *value, toString(type));
      if (!isBuffer)
        diagnostic.note(type->count == 1
                            ? std::string("the only index is 0")
                            : "valid indices are 0 to " + std::to_string(type->count - 1));
      return errorExpr(expr.range);
    }
  }
  if (isBuffer && type->count == 1 && type->mode == BufferMode::Write && access != Access::Write)
    reportUnreadable(*base);
  const Type *element = isBuffer && type->count > 1
                            ? types.buffer(type->element, type->count - 1, type->mode)
                            : type->element;
  auto node = makeExpr<typed::IndexExpr>(element, expr.range);
  node->base = std::move(base);
  node->index = std::move(index);
  return node;
}

//===----------------------------------------------------------------------===//
// Lvalues
//===----------------------------------------------------------------------===//

/// Is the source text an lvalue? The typed tree of `+x` and `color(c)` may be just a variable, but
/// they are no lvalues.
static bool isLvalueAsWritten(const ast::Expr &expr) {
  const ast::Expr *at = &expr;
  for (;;) {
    if (const auto *paren = dynCast<ast::ParenExpr>(at))
      at = paren->inner.get();
    else if (const auto *member = dynCast<ast::MemberExpr>(at))
      at = member->base.get();
    else if (const auto *index = dynCast<ast::IndexExpr>(at))
      at = index->base.get();
    else
      return at->kind == ast::ExprKind::Name;
  }
}

bool FunctionChecker::requireTarget(const ast::Expr &source, const typed::Expr &target,
                                    const char *action) {
  const typed::Expr *at = &target;
  bool throughBuffer = false;
  for (;;) {
    if (const auto *field = dynCast<typed::FieldExpr>(at))
      at = field->base.get();
    else if (const auto *swizzle = dynCast<typed::SwizzleExpr>(at))
      at = swizzle->base.get();
    else if (const auto *index = dynCast<typed::IndexExpr>(at)) {
      throughBuffer |= index->base->type->is(TypeKind::Buffer);
      at = index->base.get();
    } else
      break;
  }
  const bool isStored = at->kind == typed::ExprKind::Variable ||
                        at->kind == typed::ExprKind::Member || at->kind == typed::ExprKind::State ||
                        at->type->isError();
  if (!isLvalueAsWritten(source) || !isStored) {
    diagnostics.report(Code::notATarget, target.range, action);
    return false;
  }
  if (at->type->isError())
    return false;
  if (const auto *variable = dynCast<typed::VariableExpr>(at)) {
    if (!variable->variable->isConst)
      return true;
    diagnostics.report(Code::constTarget, target.range, action, variable->variable->name)
        .label(variable->variable->range, "declared `const` here");
    return false;
  }
  if (const auto *member = dynCast<typed::MemberExpr>(at)) {
    if (member->member->isConst) {
      diagnostics.report(Code::constTarget, target.range, action, member->member->name)
          .label(member->member->range, "declared `const` here");
      return false;
    }
    const bool isElement = throughBuffer && !target.type->is(TypeKind::Buffer);
    if (isElement && member->type->mode != BufferMode::Read)
      return true;
    if (throughBuffer || member->type->is(TypeKind::Buffer)) {
      Diagnostic &diagnostic =
          diagnostics.report(Code::bufferReadOnly, target.range, action, member->member->name);
      diagnostic.label(member->member->range, "declared here");
      if (member->type->mode != BufferMode::Read)
        diagnostic.note("only its elements can be written");
      else if (scope && scope->root && scope->root->name == "rt_RayGeneration")
        diagnostic.note("buffers that an rt_RayGeneration writes are declared `public out`, or "
                        "`public inout` if it also reads them");
      return false;
    }
    return true;
  }
  return true;
}

} // namespace rtsl
