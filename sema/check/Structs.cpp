//===- Structs.cpp - structs and constants at file level ------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/TypeProperties.h"

namespace rtsl {

/// Constants that depend on one another, and structs whose sizes do, are resolved on demand, by
/// recursion up to this depth.
static constexpr unsigned maxDemandDepth = 200;

//===----------------------------------------------------------------------===//
// Structs
//===----------------------------------------------------------------------===//

/// Resolves structs in the order in which they contain one another, without recursion: chains may
/// be long.
void Program::resolveStructs() {
  enum class Mark : std::uint8_t { Open, Done };
  std::unordered_map<std::string, Mark> marks;
  struct Frame {
    std::string name;
    std::size_t nextField = 0;
  };
  for (const std::string &root : structOrder) {
    std::vector<Frame> stack;
    auto enter = [&](const std::string &name) {
      if (structs.count(name) && marks.emplace(name, Mark::Open).second)
        stack.push_back({name, 0});
    };
    enter(root);
    while (!stack.empty()) {
      Frame &frame = stack.back();
      const std::vector<ast::VariableDecl> &fields = structs[frame.name].declaration->fields;
      if (frame.nextField != fields.size()) {
        const std::string next = fields[frame.nextField++].type.name.text;
        enter(next);
        continue;
      }
      const std::string name = frame.name;
      marks[name] = Mark::Done;
      stack.pop_back();
      structure(name, structs[name].definition->range);
    }
  }
}

const typed::Struct *Program::structure(const std::string &name, SourceRange usedAt) {
  StructEntry &entry = structs.at(name);
  if (entry.state == StructEntry::State::Checked)
    return entry.definition;
  if (entry.state == StructEntry::State::InProgress) {
    diagnostics.report(Code::recursiveStruct, usedAt, name)
        .label(entry.definition->range, "`" + name + "` is defined here");
    return nullptr;
  }
  if (structDepth == maxDemandDepth) {
    diagnostics.report(Code::typeTooDeep, usedAt, maxTypeNesting);
    return nullptr;
  }
  ++structDepth;
  entry.state = StructEntry::State::InProgress;
  resolveFields(entry);
  entry.state = StructEntry::State::Checked;
  --structDepth;
  module.structs.push_back(std::move(entry.owned));
  return entry.definition;
}

void Program::resolveFields(StructEntry &entry) {
  FunctionChecker checker(*this, nullptr, nullptr);
  std::unordered_map<std::string, SourceRange> seen;
  for (const ast::VariableDecl &declaration : entry.declaration->fields) {
    typed::Field field;
    field.name = declaration.name.text;
    field.range = declaration.name.range;
    field.comment = declaration.comment;
    field.type = checker.resolveType(declaration.type, &declaration.name);
    if (field.type->is(TypeKind::Void)) {
      diagnostics.report(Code::voidVariable, declaration.type.range, field.name);
      field.type = types.error;
    }
    if (nestingDepth(field.type) >= maxTypeNesting) {
      diagnostics.report(Code::typeTooDeep, declaration.type.range, maxTypeNesting);
      field.type = types.error;
    }
    if (declaration.init)
      diagnostics.report(Code::fieldInitializer, declaration.init->range, field.name)
          .note("initialise the fields where the struct is constructed: `" +
                entry.definition->name + "(...)`");
    if (auto [other, fresh] = seen.emplace(field.name, field.range); !fresh) {
      diagnostics.report(Code::redefinition, field.range, field.name)
          .label(other->second, "first defined here");
      continue;
    }
    entry.definition->fields.push_back(std::move(field));
  }
  // The error may be in what should have been a field.
  const auto isInside = [&](const Diagnostic &other) {
    const SourceRange whole = entry.declaration->range;
    return other.range.file == whole.file && other.range.begin >= whole.begin &&
           other.range.end <= whole.end;
  };
  if (entry.declaration->fields.empty() &&
      std::none_of(diagnostics.all().begin(), diagnostics.all().end(), isInside))
    diagnostics.report(Code::emptyStruct, entry.definition->range, entry.definition->name);
}

//===----------------------------------------------------------------------===//
// Constants
//===----------------------------------------------------------------------===//

void Program::resolveConstants() {
  for (const std::string &name : constantOrder)
    constant(name, constants[name].variable->range);
}

const typed::Variable *Program::constant(const std::string &name, SourceRange usedAt) {
  GlobalConstant &entry = constants.at(name);
  if (entry.state == GlobalConstant::State::InProgress || constantDepth == maxDemandDepth) {
    const bool cyclic = entry.state == GlobalConstant::State::InProgress;
    diagnostics.report(cyclic ? Code::recursiveConstant : Code::constantsTooDeep, usedAt, name)
        .label(entry.variable->range, "`" + name + "` is defined here");
    return nullptr;
  }
  if (entry.state == GlobalConstant::State::Unchecked) {
    ++constantDepth;
    entry.state = GlobalConstant::State::InProgress;
    checkConstant(entry);
    entry.state = GlobalConstant::State::Checked;
    --constantDepth;
    module.constants.push_back(std::move(entry.owned));
  }
  return entry.variable->type->isError() ? nullptr : entry.variable;
}

void Program::checkConstant(GlobalConstant &entry) {
  const ast::VariableDecl &declaration = *entry.declaration;
  typed::Variable &variable = *entry.variable;
  FunctionChecker checker(*this, nullptr, nullptr);
  const bool unsized =
      !declaration.type.dimensions.empty() && !declaration.type.dimensions.back().size;
  const Type *type = unsized ? checker.deduceUnsized(declaration, variable.init)
                             : checker.resolveType(declaration.type, &declaration.name);
  // Qualifiers of members have been reported: they say the same.
  const bool isReported = declaration.accessRange.isValid() ||
                          declaration.directionRange.isValid() ||
                          declaration.optionalRange.isValid();
  if (!declaration.isConst && !isReported)
    diagnostics.report(Code::globalNotConst, variable.range, variable.name)
        .note("a variable must be a member of a class, or local to a function");
  if (type->is(TypeKind::Void)) {
    diagnostics.report(Code::voidVariable, declaration.type.range, variable.name);
    return;
  }
  if (!declaration.init) {
    if (declaration.isConst)
      diagnostics.report(Code::constNeedsValue, variable.range, variable.name);
    return;
  }
  if (!unsized)
    variable.init = checker.checkInitializer(*declaration.init, type);
  if (!variable.init || variable.init->type->isError() || !declaration.isConst)
    return;
  if (checker.requireConstant(*variable.init, "the value of `" + variable.name + "`",
                              &variable.constant))
    variable.type = type;
}

} // namespace rtsl
