#include "codegen/cpp/tree/Print.h"

#include <fmt/format.h>

namespace rtsl::cpp {

/// A word and the space after it; nothing if there is no word.
static std::string before(const std::string &word) {
  return word.empty() ? word : word + " ";
}

static std::string print(const Parameter &parameter) {
  static constexpr const char *marks[] = {" ", " &", " *"};
  return std::string(parameter.isUnread ? "[[maybe_unused]] " : "") +
         (parameter.isConst ? "const " : "") + parameter.type +
         marks[static_cast<int>(parameter.pass)] +
         (parameter.isCommented && !parameter.name.empty() ? "/*" + parameter.name + "*/"
                                                           : parameter.name);
}

static std::string print(const Function &function) {
  std::string text =
      function.templateParameters.empty() ? "" : "template <" + function.templateParameters + ">\n";
  text += before(function.specifiers) + function.result + " " + function.name + "(";
  for (std::size_t i = 0; i < function.parameters.size(); ++i)
    text += (i == 0 ? "" : ", ") + print(function.parameters[i]);
  text += std::string(")") + (function.isConst ? " const" : "") +
          (function.isOverride ? " override" : "");
  if (!function.body)
    return text + ";\n";
  if (!function.caught.empty())
    return text + " try {\n" + print(*function.body) + "} catch (const " + function.caught +
           " &) {\n}\n";
  return text + " {\n" + print(*function.body) + "}\n";
}

static std::string print(const Variable &variable) {
  return before(variable.qualifiers) + variable.type + " " +
         print(variable.declarator, variable.type) +
         (variable.bits != 0 ? fmt::format(" : {}", variable.bits) : "") + ";\n";
}

static std::string print(const Struct &structure) {
  const std::string head =
      "struct " + structure.name + (structure.base.empty() ? "" : " : " + structure.base);
  return structure.isOnlyDeclared ? head + ";\n"
                                  : head + " {\n" + print(structure.members) + "};\n";
}

static std::string print(const Enum &enumeration) {
  std::vector<std::string> values;
  for (const Enumerator &one : enumeration.values)
    values.push_back(one.value ? fmt::format("{} = {}", one.name, *one.value) : one.name);
  return fmt::format("enum class {} : {} {{ {} }};\n", enumeration.name, enumeration.underlying,
                     fmt::join(values, ", "));
}

static std::string print(const Namespace &space) {
  return "namespace " + before(space.name) + "{\n\n" + print(space.members) + "\n} // namespace" +
         (space.name.empty() ? "" : " " + space.name) + "\n";
}

static std::string print(const Alias &alias) {
  return "using " + alias.name + " = " + alias.type + ";\n";
}

static std::string print(const Using &named) {
  return "using " + named.name + ";\n";
}

static std::string print(const Include &include) {
  return "#include <" + include.file + ">\n";
}

static std::string print(const Define &macro) {
  return "#define " + macro.name + "\n";
}

static std::string print(const OnlyComment &) {
  return {};
}

std::string print(const Declaration &declaration) {
  std::string text = std::visit([](const auto &what) { return print(what); }, declaration.what);
  if (!declaration.trailing.empty())
    addComment(text, declaration.trailing);
  return (declaration.comment.empty() ? "" : declaration.comment + "\n") +
         (declaration.place ? print(*declaration.place) : "") + text;
}

std::string print(const Declarations &declarations) {
  std::string text;
  for (std::size_t i = 0; i < declarations.size(); ++i)
    text += (declarations[i].hasSpace && i > 0 ? "\n" : "") + print(declarations[i]);
  return text;
}

} // namespace rtsl::cpp
