#include "codegen/cpp/Names.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <algorithm>
#include <cctype>

namespace rtsl::cpp {

bool isReserved(const std::string &word) {
  static const std::set<std::string> words = {
      // Keywords of C++17 and C++20, and the spelled operators.
      "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break",
      "case", "catch", "char", "char8_t", "char16_t", "char32_t", "class", "compl", "concept",
      "const", "consteval", "constexpr", "constinit", "const_cast", "continue", "co_await",
      "co_return", "co_yield", "decltype", "default", "delete", "do", "double", "dynamic_cast",
      "else", "enum", "explicit", "export", "extern", "false", "float", "for", "friend", "goto",
      "if", "inline", "int", "long", "mutable", "namespace", "new", "noexcept", "not", "not_eq",
      "nullptr", "operator", "or", "or_eq", "private", "protected", "public", "register",
      "reinterpret_cast", "requires", "return", "short", "signed", "sizeof", "static",
      "static_assert", "static_cast", "struct", "switch", "template", "this", "thread_local",
      "throw", "true", "try", "typedef", "typeid", "typename", "union", "unsigned", "using",
      "virtual", "void", "volatile", "wchar_t", "while", "xor", "xor_eq",
      // Macros of the standard library and of common systems.
      "assert", "errno", "major", "minor", "makedev", "linux", "unix", "stdin", "stdout", "stderr",
      "signbit", "offsetof", "setjmp", "NULL", "NAN", "INFINITY", "HUGE_VAL", "EOF", "BUFSIZ",
      "RAND_MAX", "EXIT_SUCCESS", "EXIT_FAILURE", "CHAR_BIT", "INT_MIN", "INT_MAX", "UINT_MAX",
      "LONG_MIN", "LONG_MAX", "FLT_MIN", "FLT_MAX", "FLT_EPSILON", "DBL_MIN", "DBL_MAX",
      "DBL_EPSILON", "EDOM", "ERANGE", "EILSEQ", "DOMAIN", "OVERFLOW", "UNDERFLOW", "M_PI", "M_E",
      "M_LN2", "M_SQRT2", "M_PI_2", "M_PI_4", "MB_CUR_MAX", "FP_NAN", "FP_INFINITE", "FP_ZERO",
      "FP_NORMAL", "FP_SUBNORMAL", "SIZE_MAX",
      // What generated code uses.
      "glm", "std", "rtsl", "rt", "scratch", "State", "Color", "Scratch", "Id", "lights", "program",
      "describe", "describeFields", "slots", "className", "visit", "Step"};
  if (words.count(word))
    return true;
  // Reserved to the implementation, and RTSL's and GLM's macros.
  const bool isImplementation =
      word.find("__") != std::string::npos ||
      (word.size() > 1 && word[0] == '_' && std::isupper(static_cast<unsigned char>(word[1])));
  return isImplementation || word.compare(0, 4, "GLM_") == 0 || word.compare(0, 5, "RTSL_") == 0 ||
         word.compare(0, 5, "rtsl_") == 0;
}

/// Names that are in scope where generated code, rather than the author's, names types: the
/// functions in the namespace `slots`, and their parameters.
static const std::set<std::string> &besideTypes() {
  static const std::set<std::string> words = {
#define RTSL_SLOT(base, method) #method,
#include "language/Slots.def"
#define RTSL_PAYLOAD_SLOT(base, method) #method "WithPayload",
#include "language/PayloadSlots.def"
      "runState", "ray", "object", "step", "frame", "call", "fields"};
  return words;
}

/// The name without the spellings that C++ reserves for implementations.
static std::string cleaned(std::string word) {
  for (std::size_t at; (at = word.find("__")) != std::string::npos;)
    word.erase(at, 1);
  if (word.size() > 1 && word[0] == '_' && std::isupper(static_cast<unsigned char>(word[1])))
    word.erase(0, 1);
  return word;
}

std::string unique(std::string name, std::set<std::string> &taken,
                   const std::set<std::string> &around) {
  for (std::size_t at; (at = name.find("__")) != std::string::npos;) // C++ reserves these names
    name.erase(at, 1);
  const std::string base = name;
  for (unsigned i = 2; isReserved(name) || around.count(name) || !taken.insert(name).second; ++i)
    name = base + std::to_string(i);
  return name;
}

/// Gives the entity a name that differs from `avoided` and from `all`, the names of others.
void Names::give(const void *entity, const std::string &name, const std::string &shown,
                 const Avoided &avoided, const std::set<std::string> &all) {
  const auto avoids = [&avoided](const std::string &one) {
    return std::any_of(avoided.begin(), avoided.end(),
                       [&one](const auto *names) { return names->count(one) != 0; });
  };
  std::string result = cleaned(name);
  if (isReserved(result) || avoids(result) || (result != name && all.count(result))) {
    std::string base = result.back() == '_' ? result : result + "_";
    for (const char *prefix : {"GLM_", "RTSL_", "rtsl_"}) // reserved prefixes
      if (const std::size_t length = std::string(prefix).size();
          base.compare(0, length, prefix) == 0)
        base.erase(length - 1, 1);
    result = base;
    for (unsigned i = 2; avoids(result) || all.count(result) || isReserved(result); ++i)
      result = base + std::to_string(i);
  }
  if (result != name)
    changes.push_back({shown, result});
  names[entity] = result;
}

Names::Names(const typed::Module &module) {
  nameFileLevel(module);
  for (const auto &definition : module.classes)
    nameClass(*definition);
  for (const auto &function : module.functions)
    nameLocals(*function);
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      nameLocals(*function);
}

void Names::nameFileLevel(const typed::Module &module) {
  std::set<std::string> all;
  for (const auto &structure : module.structs)
    all.insert(structure->name);
  for (const auto &definition : module.classes)
    all.insert(definition->name);
  for (const auto &constant : module.constants)
    all.insert(constant->name);
  for (const auto &function : module.functions)
    all.insert(function->name);

  auto add = [&](const void *entity, const std::string &name,
                 const std::set<std::string> &avoid = {}) {
    give(entity, name, name, {&avoid}, all);
    fileLevel.insert(names[entity]);
  };
  for (const auto &structure : module.structs)
    add(structure.get(), structure->name, besideTypes());
  for (const auto &definition : module.classes)
    add(definition.get(), definition->name, besideTypes());
  typeNames = fileLevel;
  for (const auto &constant : module.constants)
    add(constant.get(), constant->name);
  for (const auto &function : module.functions) // overloads share their new name
    add(function.get(), function->name);

  // Types of references.
  auto addReference = [&](const std::string &className, const std::string &base) {
    std::string name = base + "Ref";
    while (fileLevel.count(name) || all.count(name))
      name += "_";
    references[className] = name;
    fileLevel.insert(name);
    typeNames.insert(name);
  };
  for (const auto &definition : module.classes)
    addReference(definition->name, names[definition.get()]);
  for (const char *root : {"Camera", "Primitive", "Texture", "Material", "Light", "RayGeneration",
                           "Miss", "Selector", "Exception"})
    addReference(std::string("rt_") + root, root);

  for (const auto &structure : module.structs) {
    std::set<std::string> fields;
    for (const typed::Field &field : structure->fields)
      fields.insert(field.name);
    for (const typed::Field &field : structure->fields)
      give(&field, field.name, structure->name + "." + field.name, {&typeNames}, fields);
  }
}

std::string Names::reference(const std::string &className) const {
  return references.at(className);
}

// Members and methods of a class and its bases; a method that overrides another has its name.
void Names::nameClass(const typed::Class &definition) {
  std::set<std::string> all;
  for (const typed::Class *at = &definition; at; at = at->base) {
    for (const auto &member : at->members)
      all.insert(member->name);
    for (const auto &function : at->functions)
      all.insert(function->name);
  }
  auto add = [&](const void *entity, const std::string &name) {
    give(entity, name, definition.name + "." + name, {&typeNames}, all);
    memberNames.insert(names[entity]);
  };
  for (const auto &member : definition.members)
    add(member.get(), member->name);
  for (const auto &function : definition.functions)
    add(function.get(), function->name);
}

// A local name must not hide what its function may mention by the same name in C++: types,
// functions, methods, and for variables (whose initialisers C++ reads in their own scope) members,
// constants and variables around them.
void Names::nameLocals(const typed::Function &function) {
  std::set<std::string> all;
  for (const auto &parameter : function.parameters)
    all.insert(parameter->name);
  for (const auto &local : function.locals)
    all.insert(local->name);

  std::set<std::string> methods;
  std::set<std::string> members;
  for (const typed::Class *at = function.owner; at; at = at->base) {
    for (const auto &method : at->functions)
      methods.insert(names[method.get()]);
    for (const auto &member : at->members)
      members.insert(names[member.get()]);
  }
  const std::string prefix =
      function.owner ? function.owner->name + "." + function.name : function.name;

  for (const auto &parameter : function.parameters)
    if (!parameter->name.empty())
      give(parameter.get(), parameter->name, prefix + "." + parameter->name, {&fileLevel, &methods},
           all);
    else
      names[parameter.get()] = "";
  for (const auto &local : function.locals) {
    std::set<std::string> read;
    if (local->init)
      forEachExpr(*local->init, [&](const typed::Expr &expr) {
        if (auto *variable = dynCast<typed::VariableExpr>(&expr))
          if (auto known = names.find(variable->variable); known != names.end())
            read.insert(known->second);
      });
    give(local.get(), local->name, prefix + "." + local->name,
         {&fileLevel, &methods, &members, &read}, all);
    all.insert(names[local.get()]);
  }
}

const std::string &Names::of(const void *entity) const {
  return names.at(entity);
}

std::string nameOfRoot(const std::string &root) {
  return root == typed::helperRoot ? "Helper" : root.substr(3);
}

std::string identifierOf(const std::string &path) {
  std::string stem = path.substr(path.find_last_of('/') + 1);
  stem = stem.substr(0, stem.find('.'));
  std::string name;
  for (char c : stem)
    name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())))
    name = "shaders" + name;
  return isReserved(name) ? name + "_shaders" : name;
}

} // namespace rtsl::cpp
