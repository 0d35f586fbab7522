//===- Collect.cpp - the files of a compilation and their names -----------===//
//
// All files share one namespace: an import adds a file once, and the order of declarations does not
// matter.
//
//===----------------------------------------------------------------------===//
#include "sema/check/Program.h"

#include <unordered_set>

namespace rtsl {

const Symbol *Program::findSymbol(const std::string &name, SourceRange usedAt) const {
  auto found = symbols.find(name);
  if (found == symbols.end())
    return nullptr;
  const Symbol &symbol = found->second;
  if (isOfLibrary(usedAt) &&
      !(symbol.kind == Symbol::Kind::Function ? libraryFunctionNames.count(name) != 0
                                              : isOfLibrary(symbol.range)))
    return nullptr;
  return &symbol;
}

std::vector<const typed::Function *> Program::findFunctions(const std::string &name,
                                                            SourceRange usedAt) const {
  std::vector<const typed::Function *> found;
  if (const auto overloads = functions.find(name); overloads != functions.end())
    for (const typed::Function *function : overloads->second)
      if (!isOfLibrary(usedAt) || isOfLibrary(function->range))
        found.push_back(function);
  return found;
}

bool Program::suggestImport(Diagnostic &diagnostic, const std::string &name) const {
  const std::string module = finder ? finder(name) : std::string();
  if (!module.empty())
    diagnostic.note(fmt::format("it is in the standard library: add `import {};`", module));
  return !module.empty();
}

bool Program::imports(const std::string &libraryModule) const {
  for (const ast::TranslationUnit *unit : units)
    for (const ast::ImportDecl &import : unit->imports)
      if (!import.isFile && import.path == libraryModule)
        return true;
  return false;
}

void Program::collect(const std::vector<const ast::TranslationUnit *> &roots,
                      const ImportResolver &resolver) {
  std::unordered_set<const ast::TranslationUnit *> seen;
  for (const ast::TranslationUnit *root : roots)
    if (root && seen.insert(root).second)
      units.push_back(root);
  for (std::size_t i = 0; i != units.size(); ++i)
    for (const ast::ImportDecl &import : units[i]->imports)
      if (const ast::TranslationUnit *imported = resolver(import, units[i]->file))
        if (seen.insert(imported).second)
          units.push_back(imported);
  for (const ast::TranslationUnit *unit : units) {
    if (unit->isOfLibrary)
      libraryFiles.insert(unit->file);
    collectUnit(*unit);
  }
}

/// Declares a name; false (reported) if it is already declared as something else. Functions may
/// share a name.
bool Program::declareSymbol(const ast::Name &name, Symbol::Kind kind) {
  if (name.text.compare(0, 3, "rt_") == 0) {
    diagnostics.report(Code::reservedName, name.range, name.text);
    return false;
  }
  auto [entry, fresh] = symbols.emplace(name.text, Symbol{kind, name.range});
  if (fresh || (kind == Symbol::Kind::Function && entry->second.kind == kind))
    return true;
  diagnostics.report(Code::redefinition, name.range, name.text)
      .label(entry->second.range, "first defined here");
  return false;
}

void Program::collectUnit(const ast::TranslationUnit &unit) {
  for (const ast::StructDecl &declaration : unit.structs) {
    if (!declareSymbol(declaration.name, Symbol::Kind::Struct))
      continue;
    StructEntry &entry = structs[declaration.name.text];
    entry.declaration = &declaration;
    entry.owned = std::make_unique<typed::Struct>();
    entry.definition = entry.owned.get();
    entry.definition->name = declaration.name.text;
    entry.definition->range = declaration.name.range;
    entry.definition->comment = declaration.comment;
    structOrder.push_back(declaration.name.text);
  }
  for (const ast::VariableDecl &declaration : unit.constants) {
    if (!declareSymbol(declaration.name, Symbol::Kind::Constant))
      continue;
    GlobalConstant &entry = constants[declaration.name.text];
    entry.declaration = &declaration;
    entry.owned = std::make_unique<typed::Variable>();
    entry.variable = entry.owned.get();
    entry.variable->kind = typed::Variable::Kind::Global;
    entry.variable->name = declaration.name.text;
    entry.variable->range = declaration.name.range;
    entry.variable->comment = declaration.comment;
    entry.variable->isConst = true;
    entry.variable->type = types.error;
    constantOrder.push_back(declaration.name.text);
  }
  for (const ast::FunctionDecl &declaration : unit.functions) {
    functionNames.insert(declaration.name.text);
    if (unit.isOfLibrary)
      libraryFunctionNames.insert(declaration.name.text);
  }
  for (const ast::ClassDecl &declaration : unit.classes) {
    if (!declareSymbol(declaration.name, Symbol::Kind::Class))
      continue;
    auto scope = std::make_unique<ClassScope>();
    scope->declaration = &declaration;
    scope->owned = std::make_unique<typed::Class>();
    scope->definition = scope->owned.get();
    scope->definition->name = declaration.name.text;
    scope->definition->range = declaration.name.range;
    scope->definition->comment = declaration.comment;
    scopeOf[scope->definition] = scope.get();
    for (const ast::VariableDecl &member : declaration.members)
      ++memberNames[member.name.text];
    for (const ast::FunctionDecl &function : declaration.functions)
      ++methodNames[function.name.text];
    classes.emplace(declaration.name.text, std::move(scope));
    classOrder.push_back(declaration.name.text);
  }
}

bool Program::namesFunction(const ClassScope *scope, const std::string &name,
                            SourceRange usedAt) const {
  if ((isOfLibrary(usedAt) ? libraryFunctionNames : functionNames).count(name))
    return true;
  for (const ClassScope *at = methodNames.count(name) ? scope : nullptr; at; at = at->base)
    for (const ast::FunctionDecl &function : at->declaration->functions)
      if (function.name.text == name)
        return true;
  return false;
}

} // namespace rtsl
