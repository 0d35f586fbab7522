//===- LibraryNames.cpp - which module of the library defines a name ------===//
#include "codegen/driver/sources/LibraryNames.h"

#include "codegen/driver/sources/StandardLibrary.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace rtsl {

static std::unordered_set<std::string> wordsOf(const std::string &file) {
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::unordered_set<std::string> words;
  addWords(text, words);
  return words;
}

template <typename Declarations>
static bool hasName(const Declarations &declarations, const std::string &name) {
  return std::any_of(declarations.begin(), declarations.end(),
                     [&](const auto &one) { return one.name.text == name; });
}

std::string LibraryNames::moduleThatDefines(const std::string &name) {
  if (modules.empty())
    for (const std::string &module : findModule("std").parts) {
      const std::string file = findModule(module).file;
      modules.push_back({module, file, wordsOf(file)});
    }
  for (const Module &module : modules)
    if (module.words.count(name))
      if (const ast::TranslationUnit *unit = loader.load(module.file);
          unit && (hasName(unit->classes, name) || hasName(unit->functions, name) ||
                   hasName(unit->structs, name) || hasName(unit->constants, name)))
        return module.name;
  return {};
}

} // namespace rtsl
