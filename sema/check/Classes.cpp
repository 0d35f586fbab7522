//===- Classes.cpp - bases and members ------------------------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/check/Suggest.h"
#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl {

//===----------------------------------------------------------------------===//
// Lookup
//===----------------------------------------------------------------------===//

const typed::Member *Program::findMember(const ClassScope *scope, const std::string &name) const {
  if (!memberNames.count(name)) // chains of bases may be long
    return nullptr;
  for (const ClassScope *at = scope; at; at = at->base)
    if (auto found = at->members.find(name); found != at->members.end())
      return found->second;
  return nullptr;
}

bool sameParameters(const typed::Function &a, const typed::Function &b) {
  return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(),
                    b.parameters.end(),
                    [](const auto &x, const auto &y) { return x->type == y->type; });
}

std::vector<const typed::Function *> Program::findMethods(const ClassScope *scope,
                                                          const std::string &name) const {
  std::vector<const typed::Function *> result;
  if (!methodNames.count(name))
    return result;
  for (const ClassScope *at = scope; at; at = at->base) {
    auto found = at->functions.find(name);
    if (found == at->functions.end())
      continue;
    for (const typed::Function *function : found->second) {
      const bool overridden =
          std::any_of(result.begin(), result.end(), [&](const typed::Function *other) {
            return sameParameters(*function, *other);
          });
      if (!overridden)
        result.push_back(function);
    }
  }
  return result;
}

//===----------------------------------------------------------------------===//
// Bases
//===----------------------------------------------------------------------===//

/// A default class and those that it derives from, which are default classes too. Bases may still
/// form a cycle: then it ends after as many classes as there are.
std::vector<const ClassScope *> Program::defaultChain(const ClassScope &scope) const {
  std::vector<const ClassScope *> chain = {&scope};
  while (chain.size() != classes.size()) {
    const auto base = classes.find(chain.back()->declaration->base.text);
    if (base == classes.end() || !base->second->declaration->defaultRange.isValid())
      break;
    chain.push_back(base->second.get());
  }
  return chain;
}

/// Finds the default classes of each rt_ class, in source order.
void Program::findDefaults() {
  for (const std::string &name : classOrder) {
    ClassScope &scope = *classes[name];
    const SourceRange written = scope.declaration->defaultRange;
    if (!written.isValid())
      continue;
    const RootModel *root = rootModel(defaultChain(scope).back()->declaration->base.text);
    if (!root) {
      diagnostics
          .report(Code::badDefaultClass, written, name,
                  "its base is neither one of the rt_ classes nor a `default` class")
          .fix(written, "");
      continue;
    }
    for (const ast::VariableDecl &member : scope.declaration->members)
      diagnostics.report(Code::badDefaultClass, member.name.range, name, "it has members")
          .note("every " + root->name + " of the program would have them");
    defaults[root].push_back(&scope);
  }
}

static bool defines(const ast::ClassDecl &owner, const ast::FunctionDecl &required) {
  return std::any_of(owner.functions.begin(), owner.functions.end(),
                     [&](const ast::FunctionDecl &one) {
                       return one.body && one.name.text == required.name.text &&
                              one.parameters.size() == required.parameters.size();
                     });
}

/// The default class from which a class derives that names an rt_ class as its base: the first
/// whose required methods, those without a body, it or a default class between them defines. Null
/// if there is none.
ClassScope *Program::defaultOf(const ClassScope &scope) const {
  const auto candidates = defaults.find(scope.root);
  if (candidates == defaults.end() || scope.declaration->defaultRange.isValid())
    return nullptr;
  const auto fits = [&](const ClassScope *candidate) {
    std::vector<const ast::ClassDecl *> derived = {scope.declaration};
    for (const ClassScope *one : defaultChain(*candidate)) {
      for (const ast::FunctionDecl &method : one->declaration->functions)
        if (!method.body && std::none_of(derived.begin(), derived.end(), [&](const auto *owner) {
              return defines(*owner, method);
            }))
          return false;
      derived.push_back(one->declaration);
    }
    return true;
  };
  const auto found = std::find_if(candidates->second.begin(), candidates->second.end(), fits);
  return found == candidates->second.end() ? nullptr : *found;
}

void Program::linkBase(ClassScope &scope) {
  const ast::Name &base = scope.declaration->base;
  if (base.text.empty()) {
    scope.root = &helperModel();
    scope.definition->root = scope.root->name;
    return;
  }
  if (const RootModel *root = rootModel(base.text)) {
    scope.root = root;
    scope.definition->root = root->name;
    if (ClassScope *base = defaultOf(scope)) {
      scope.base = base;
      scope.definition->base = base->definition;
    }
    return;
  }
  if (auto found = classes.find(base.text); found != classes.end()) {
    scope.base = found->second.get();
    scope.definition->base = found->second->definition;
    return;
  }
  if (const Symbol *symbol = findSymbol(base.text, base.range)) {
    diagnostics.report(Code::notAClass, base.range, base.text).label(symbol->range, "defined here");
    return;
  }
  if (types.named(base.text)) {
    diagnostics.report(Code::notAClass, base.range, base.text);
    return;
  }
  std::vector<std::string> candidates = classOrder;
  for (const RootModel &root : rootModels())
    candidates.push_back(root.name);
  Diagnostic &diagnostic = diagnostics.report(Code::unknownBase, base.range, base.text);
  if (suggestImport(diagnostic, base.text))
    return;
  std::string closest = closestName(base.text, candidates);
  if (closest.empty() && rootModel("rt_" + base.text))
    closest = "rt_" + base.text;
  if (!closest.empty())
    diagnostic.fix(base.range, closest);
  else
    diagnostic.note(
        "the base classes are rt_Camera, rt_Primitive, rt_Texture, rt_Material, rt_Light, "
        "rt_RayGeneration, rt_Miss, rt_Selector and rt_Exception");
}

/// Reports every cycle of bases and cuts it at one class. Returns whether there were any.
bool Program::breakCycles() {
  bool isCut = false;
  std::unordered_map<const ClassScope *, unsigned>
      visitedBy; // the number of the walk that visited a class
  unsigned walk = 0;
  for (const std::string &name : classOrder) {
    ++walk;
    ClassScope *at = classes[name].get();
    for (; at && visitedBy.emplace(at, walk).second; at = const_cast<ClassScope *>(at->base))
      ;
    if (!at || visitedBy[at] != walk)
      continue;
    Diagnostic &diagnostic = diagnostics.report(Code::inheritanceCycle, at->declaration->base.range,
                                                at->definition->name);
    unsigned shown = 0;
    for (const ClassScope *other = at->base; other != at && shown != 8;
         other = other->base, ++shown)
      diagnostic.label(other->declaration->base.range, "`" + other->definition->name +
                                                           "` derives from `" +
                                                           other->declaration->base.text + "`");
    at->base = nullptr;
    at->definition->base = nullptr;
    isCut = true;
  }
  return isCut;
}

std::vector<ClassScope *> Program::classesBaseFirst() {
  std::vector<ClassScope *> order;
  std::unordered_map<const ClassScope *, bool> placed;
  for (const std::string &name : classOrder) {
    std::vector<ClassScope *> path;
    for (ClassScope *at = classes[name].get(); at && !placed[at];
         at = const_cast<ClassScope *>(at->base))
      path.push_back(at);
    for (auto at = path.rbegin(); at != path.rend(); ++at) {
      placed[*at] = true;
      order.push_back(*at);
    }
  }
  return order;
}

/// Rejects the first class of a chain that has too many bases; further derived classes are not
/// reported.
void Program::limitInheritance() {
  std::unordered_map<const ClassScope *, unsigned> basesOf;
  for (const ClassScope *scope : baseFirst) {
    const unsigned bases = scope->base ? basesOf[scope->base] + 1 : 0;
    basesOf[scope] = bases;
    if (bases == maxInheritanceDepth + 1)
      diagnostics
          .report(Code::inheritanceTooDeep, scope->declaration->name.range, scope->definition->name,
                  maxInheritanceDepth)
          .label(scope->declaration->base.range,
                 "this base already has the maximum number of bases");
  }
}

void Program::resolveClasses() {
  findDefaults();
  for (const std::string &name : classOrder)
    linkBase(*classes[name]);
  const bool hadCycles = breakCycles();
  baseFirst = classesBaseFirst();
  if (!hadCycles) // the rest of a cut cycle is not a real chain
    limitInheritance();
  for (ClassScope *scope : baseFirst) {
    if (scope->base) {
      scope->root = scope->base->root;
      scope->definition->root = scope->base->definition->root;
    }
    module.classes.push_back(std::move(scope->owned));
  }
  for (ClassScope *scope : baseFirst)
    declareMembers(*scope);
}

//===----------------------------------------------------------------------===//
// Members
//===----------------------------------------------------------------------===//

void Program::declareMembers(ClassScope &scope) {
  for (const ast::VariableDecl &declaration : scope.declaration->members)
    declareMember(scope, declaration);
}

void Program::declareMember(ClassScope &scope, const ast::VariableDecl &declaration) {
  FunctionChecker checker(*this, &scope, nullptr);
  auto member = std::make_unique<typed::Member>();
  member->name = declaration.name.text;
  member->range = declaration.name.range;
  member->comment = declaration.comment;
  member->owner = scope.definition;
  member->isConst = declaration.isConst;
  member->access = declaration.isConst                       ? ast::Access::None
                   : declaration.access == ast::Access::None ? ast::Access::Private
                                                             : declaration.access;
  const bool unsized =
      std::any_of(declaration.type.dimensions.begin(), declaration.type.dimensions.end(),
                  [](const ast::ArrayDimension &dimension) { return !dimension.size; });
  if (declaration.isConst && unsized)
    member->type = checker.deduceUnsized(declaration, member->init);
  else
    member->type = checker.resolveType(declaration.type, &declaration.name, true);
  if (member->type->is(TypeKind::Void)) {
    diagnostics.report(Code::voidVariable, declaration.type.range, member->name);
    member->type = types.error;
  }
  if (member->type->is(TypeKind::Buffer) && declaration.directionRange.isValid())
    member->type = types.buffer(
        member->type->element, member->type->count,
        declaration.direction == ast::Direction::Out ? BufferMode::Write : BufferMode::ReadWrite);
  checkMemberQualifiers(scope, declaration, member->type);
  member->isOptional = declaration.optionalRange.isValid();

  if (declaration.isConst) {
    if (!declaration.init) {
      diagnostics.report(Code::constNeedsValue, member->range, member->name);
      member->type = types.error;
    } else {
      if (!unsized)
        member->init = checker.checkInitializer(*declaration.init, member->type);
      if (!member->init ||
          !checker.requireConstant(*member->init, "the value of `" + member->name + "`",
                                   &member->constant))
        member->type = types.error;
    }
  } else if (declaration.init) {
    const bool takesDefault = member->access != ast::Access::Scratch &&
                              !member->type->is(TypeKind::Buffer) &&
                              !member->type->is(TypeKind::Class);
    if (takesDefault)
      member->init = checker.checkInitializer(*declaration.init, member->type);
    else
      diagnostics.report(Code::noDefault, declaration.init->range,
                         member->access == ast::Access::Scratch ? "a scratch member"
                         : member->type->is(TypeKind::Buffer)   ? "a buffer"
                                                                : "a reference");
    if (member->init && member->init->type->isError())
      member->init.reset();
  }
  checkRange(checker, declaration, *member);

  if (member->name.compare(0, 3, "rt_") == 0)
    diagnostics.report(Code::reservedName, member->range, member->name);
  if (const typed::Member *other = findMember(&scope, member->name)) {
    Diagnostic &diagnostic = diagnostics.report(Code::redefinition, member->range, member->name);
    diagnostic.label(other->range, "first defined here");
    if (other->owner != scope.definition)
      diagnostic.note("`" + scope.definition->name + "` inherits it from `" + other->owner->name +
                      "`");
    return;
  }
  scope.members.emplace(member->name, member.get());
  scope.definition->members.push_back(std::move(member));
}

void Program::checkMemberQualifiers(const ClassScope &scope, const ast::VariableDecl &declaration,
                                    const Type *type) {
  const std::string &name = declaration.name.text;
  if (declaration.optionalRange.isValid() && !type->isError()) {
    const Type *element = type;
    while (element->is(TypeKind::Array) || element->is(TypeKind::Buffer))
      element = element->element;
    const char *reason =
        !element->is(TypeKind::Class) ? "only references can be"
        : declaration.access != ast::Access::Public
            ? "only public members can be; a `private` reference may always be empty"
            : nullptr;
    if (reason)
      diagnostics.report(Code::misplacedOptional, declaration.optionalRange, name, reason);
  }
  if (declaration.directionRange.isValid() && !type->isError()) {
    const char *reason = !type->is(TypeKind::Buffer)
                             ? "only buffers can be: `public out float data[];`"
                         : !scope.root || scope.root->name != "rt_RayGeneration"
                             ? "only buffers of an rt_RayGeneration can be"
                         : contains(type, TypeKind::Class) ? "its elements hold references"
                                                           : nullptr;
    if (reason)
      diagnostics.report(Code::misplacedOutput, declaration.directionRange, name,
                         diagnostics.sources().text(declaration.directionRange), reason);
  }
  if (declaration.isConst) {
    if (declaration.access == ast::Access::Public || declaration.access == ast::Access::Scratch)
      diagnostics.report(Code::constMemberAccess, declaration.accessRange,
                         std::string(diagnostics.sources().text(declaration.accessRange)), name);
    return;
  }
  if (declaration.access == ast::Access::None) {
    diagnostics.report(Code::memberWithoutAccess, declaration.name.range, name)
        .note("`public` is set by the scene, `private` by the constructor, `scratch` by "
              "`intersect`, `const` never")
        .fix({declaration.range.file, declaration.range.begin, declaration.range.begin},
             "private ");
  } else if (declaration.access == ast::Access::Scratch && scope.root && !scope.root->hasScratch) {
    diagnostics
        .report(Code::scratchWithoutHit, declaration.accessRange, withArticle(scope.root->name))
        .note("scratch members pass values from `intersect` to the later methods of the same "
              "hit: an "
              "rt_Primitive writes them, an rt_Material reads them");
  }
  if (type->is(TypeKind::Buffer) && declaration.access != ast::Access::Public)
    diagnostics.report(Code::bufferNotPublic, declaration.name.range, name)
        .note("only the scene can give a buffer its size");
}

} // namespace rtsl
