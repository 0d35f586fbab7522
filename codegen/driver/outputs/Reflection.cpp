//===- Reflection.cpp - the description of a module as JSON ---------------===//
#include "codegen/driver/outputs/Reflection.h"

#include "codegen/cpp/Names.h"
#include "codegen/explain/ReportJson.h"
#include "codegen/ir/Layout.h"
#include "codegen/link/Members.h"
#include "codegen/lower/Lowering.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Effects.h"

#include "mlir/IR/MLIRContext.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>

namespace rtsl::driver {

namespace {

using Json = nlohmann::ordered_json;

class Describer {
public:
  Describer(const typed::Module &module, const LowerOptions &options, mlir::ModuleOp ir)
      : module(module), ir(ir), types(module, options, ir), effects(module), names(module) {}

  Json describe() {
    Json result;
    result["rtslReflection"] = 1;
    result["structs"] = Json::array();
    for (const auto &structure : module.structs)
      result["structs"].push_back(describe(*structure));
    result["functions"] = Json::array();
    for (const auto &function : module.functions)
      if (function->body)
        result["functions"].push_back(describe(*function));
    result["classes"] = Json::array();
    for (const auto &definition : module.classes)
      result["classes"].push_back(describe(*definition));
    result["cppNames"] = Json::array();
    for (const auto &[name, cpp] : names.renamed())
      result["cppNames"].push_back({{"name", name}, {"cpp", cpp}});
    return result;
  }

private:
  /// The text of a comment, without the markers.
  static std::string plain(const std::string &comment) {
    std::string text;
    std::size_t at = 0;
    while (at < comment.size()) {
      const std::size_t end = std::min(comment.find('\n', at), comment.size());
      std::string line = comment.substr(at, end - at);
      for (const char *marker : {"// ", "//", "/* ", "/*", " * "})
        if (line.compare(0, std::strlen(marker), marker) == 0) {
          line.erase(0, std::strlen(marker));
          break;
        }
      if (const std::size_t close = line.rfind("*/"); close != std::string::npos)
        line.erase(close);
      while (!line.empty() && line.back() == ' ')
        line.pop_back();
      text += (text.empty() ? "" : "\n") + line;
      at = end + 1;
    }
    return text;
  }
  static void addComment(Json &json, const std::string &comment) {
    if (!comment.empty())
      json["comment"] = plain(comment);
  }

  Json describe(const typed::Struct &structure) {
    Json json = {{"name", structure.name}};
    addComment(json, structure.comment);
    // For an existing type this has no side effect.
    const Type *type = const_cast<TypeContext &>(module.types).structure(&structure);
    const auto layout = mlir::cast<ir::StructType>(types.type(type));
    json["size"] = ir::sizeInBytes(layout);
    json["fields"] = Json::array();
    for (unsigned i = 0; i < structure.fields.size(); ++i) {
      const typed::Field &field = structure.fields[i];
      Json one = {{"name", field.name},
                  {"type", toString(field.type)},
                  {"offset", ir::fieldOffset(layout, i)},
                  {"size", ir::sizeInBytes(types.type(field.type))}};
      addComment(one, field.comment);
      json["fields"].push_back(std::move(one));
    }
    Json payloadOf = Json::array();
    for (const auto &definition : module.classes)
      for (const auto &function : definition->functions)
        if (function->isStateMethod && !function->parameters.empty() &&
            function->parameters[0]->type == type)
          payloadOf.push_back(definition->name + "." + function->name);
    if (!payloadOf.empty())
      json["payloadOf"] = std::move(payloadOf);
    return json;
  }

  static Json value(const Type *type, const typed::Constant &constant) {
    Json scalars = Json::array();
    const Type *scalar = type->scalar();
    for (typed::Constant::Scalar one : constant.scalars) {
      if (type->is(TypeKind::Color) || !scalar || scalar->is(TypeKind::Float))
        scalars.push_back(one.f);
      else if (scalar->is(TypeKind::Bool))
        scalars.push_back(one.b);
      else if (scalar->is(TypeKind::UInt))
        scalars.push_back(one.u);
      else
        scalars.push_back(one.i);
    }
    return scalars.size() == 1 ? scalars[0] : scalars;
  }

  Json describe(const typed::Member &member, ir::ClassOp record) {
    static const char *const words[] = {"const", "public", "private", "scratch"};
    const char *access = member.isConst                          ? words[0]
                         : member.access == ast::Access::Public  ? words[1]
                         : member.access == ast::Access::Scratch ? words[3]
                                                                 : words[2];
    Json json = {{"name", member.name}, {"type", toString(member.type)}, {"access", access}};
    if (const std::optional<std::uint32_t> offset =
            record ? ir::memberOffset(record, member.name) : std::nullopt) {
      json["offset"] = *offset;
      json["size"] = ir::sizeInBytes(types.type(member.type));
    }
    // The components of a color depend on the target, so defaults are given as one number or as
    // RGB.
    if (member.init && (member.type->scalar() || member.type->is(TypeKind::Color)))
      if (const std::optional<typed::Constant> known = evaluate(*member.init))
        json[member.isConst ? "value" : "default"] = value(member.type, *known);
    json["hasDefault"] = member.init != nullptr;
    if (member.values)
      json["range"] = toString(*member.values);
    if (member.isOptional)
      json["isOptional"] = true;
    if (member.owner)
      json["declaredIn"] = member.owner->name;
    addComment(json, member.comment);
    return json;
  }

  Json parameters(const typed::Function &function) {
    Json list = Json::array();
    for (const auto &parameter : function.parameters) {
      static const char *const directions[] = {"in", "out", "inout"};
      list.push_back({{"name", parameter->name},
                      {"type", toString(parameter->type)},
                      {"direction", directions[static_cast<int>(parameter->direction)]}});
      if (parameter->values)
        list.back()["range"] = toString(*parameter->values);
    }
    return list;
  }

  Json describe(const typed::Function &function) {
    Json json = {{"name", function.name}, {"returns", toString(function.returnType)}};
    json["parameters"] = parameters(function);
    addComment(json, function.comment);
    const typed::Effects &facts = effects.function(function);
    Json reads = Json::array(), writes = Json::array();
    auto note = [&](typed::StateVariable variable) {
      const void *place = typed::EffectsOf::place(variable);
      const std::string name = std::string("rt_") + typed::name(variable);
      if (facts.reads.count(place))
        reads.push_back(name);
      if (facts.writes.count(place))
        writes.push_back(name);
    };
#define RTSL_STATE_VARIABLE(name, type, ...) note(typed::StateVariable::name);
#include "language/StateVariables.def"
    json["stateRead"] = std::move(reads);
    json["stateWritten"] = std::move(writes);
    json["traces"] = function.sends.any();
    json["random"] = facts.random;
    return json;
  }

  Json describe(const typed::Class &definition) {
    Json json = {{"name", definition.name},
                 {"base", definition.base ? definition.base->name : definition.root},
                 {"root", definition.root}};
    addComment(json, definition.comment);
    auto record = ir.lookupSymbol<ir::ClassOp>(definition.name);
    if (record)
      json["recordSize"] = ir::recordSize(record);
    json["members"] = Json::array();
    for (const typed::Member *member : allMembers(definition))
      if (!member->changeOf)
        json["members"].push_back(describe(*member, record));
    if (const typed::Function *constructor = findConstructor(definition))
      json["constructor"] = {{"parameters", parameters(*constructor)}};
    json["methods"] = Json::array();
    for (const auto &function : definition.functions)
      if (!function->isConstructor && function->body) {
        Json method = describe(*function);
        method["calledByEngine"] = function->isStateMethod;
        json["methods"].push_back(std::move(method));
      }
    return json;
  }

  const typed::Module &module;
  mlir::ModuleOp ir;
  lowering::ModuleLowering types;
  typed::EffectsOf effects;
  cpp::Names names;
};

} // namespace

Reflection::Reflection(const Compilation &compilation) {
  LowerOptions lowering;
  lowering.diagnostics = &compilation.diagnostics;
  lowering.colorComponents = compilation.options.colorComponents;
  Describer describer(*compilation.input.module, lowering, *compilation.ir);
  json = std::make_unique<Json>(describer.describe());
  (*json)["colorComponents"] = lowering.colorComponents;
}

Reflection::~Reflection() = default;

void Reflection::addStates(const SplitReport &report) {
  (*json)["tracing"] = jsonOf(report);
}

std::string Reflection::text() const {
  return json->dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace rtsl::driver
