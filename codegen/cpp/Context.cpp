#include "codegen/cpp/Context.h"

namespace rtsl::cpp {

Context::Context(const typed::Module &module, const ModuleFacts &facts, const Options &options,
                 Diagnostics &diagnostics, const StateProgram *states)
    : module(module), facts(facts), options(options), names(module), notes(diagnostics.sources()),
      effects(module, options.prints, options.exceptions && options.checkIndices),
      types(names, options.colorComponents, required), scratch(module, effects),
      split(module, names, states), signatures(module, names, effects, types, scratch, split),
      diagnostics(diagnostics) {
  fileNames = {module.classes.empty() ? std::string() : options.name};
  auto add = [&](const auto &entities) {
    for (const auto &entity : entities)
      fileNames.insert(names.of(entity.get()));
  };
  add(module.structs);
  add(module.constants);
  add(module.functions);
  add(module.classes);
}

void Context::unsupported(SourceRange range, const std::string &what) {
  diagnostics.report(rtsl::Code::notSupportedYet, range, what)
      .note("`--trace=recurse` keeps `trace` as a call");
  failed = true;
}

std::optional<SourcePlace> Context::lineDirective(SourceRange range) const {
  return lineDirective(range, range.isValid() ? notes.line(range) : 0);
}

std::optional<SourcePlace> Context::lineDirective(SourceRange range, unsigned line) const {
  if (!options.lineDirectives || !range.isValid())
    return std::nullopt;
  return SourcePlace{notes.file(range), line};
}

std::set<std::string> Context::namesInClass(const typed::Class &definition) const {
  std::set<std::string> found;
  for (const typed::Class *at = &definition; at; at = at->base) {
    for (const auto &member : at->members)
      found.insert(names.of(member.get()));
    for (const auto &function : at->functions)
      found.insert(names.of(function.get()));
  }
  return found;
}

} // namespace rtsl::cpp
