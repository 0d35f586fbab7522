#include "codegen/cpp/runtime/Dispatch.h"

namespace rtsl::cpp {

std::vector<const typed::Class *> classesBelow(const typed::Module &module,
                                               const std::string &className) {
  std::vector<const typed::Class *> classes;
  for (const auto &definition : module.classes)
    for (const typed::Class *at = definition.get(); at; at = at->base)
      if (at->name == className || (!at->base && at->root == className)) {
        classes.push_back(definition.get());
        break;
      }
  return classes;
}

const typed::Function *findMethod(const typed::Class &definition, const typed::Function &like) {
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      if (function->name == like.name && typed::sameParameters(*function, like))
        return function.get();
  return nullptr;
}

bool endsInReturn(const Statements &statements) {
  return !statements.empty() && statements.back().is(StatementKind::Return);
}

Statements dispatch(const Names &names, const std::vector<const typed::Class *> &classes,
                    const std::function<Statements(const typed::Class &)> &run, bool mayBeNone) {
  Statement choice = simple(StatementKind::Switch);
  choice.value = staticCast("Id", call("rtsl::classOf", {cpp::name("rt"), cpp::name("object")}));
  for (const typed::Class *definition : classes) {
    Statements body = run(*definition);
    if (body.empty())
      continue;
    if (classes.size() == 1 && !mayBeNone)
      return body;
    if (classes.size() == 1)
      return {branch(binary(Operator::NotEqual, cpp::name("object"), integer(0)), std::move(body))};
    if (!endsInReturn(body))
      body.push_back(simple(StatementKind::Break));
    choice.arms.push_back(
        {{cpp::name("Id::" + names.of(definition))}, false, false, std::move(body)});
  }
  if (choice.arms.empty())
    return {};
  choice.arms.push_back({{}, true, false, {simple(StatementKind::Break)}});
  return {choice};
}

Code objectOf(const Names &names, const typed::Class &definition) {
  return call(withParameters("rtsl::object", {names.of(&definition)}),
              {cpp::name("rt"), cpp::name("object")});
}

Code storedScratch(const Names &names, const typed::Class &definition) {
  return call(withParameters("rtsl::loadScratch", {names.of(&definition) + "::Scratch"}),
              {cpp::name("rt")});
}

const typed::Function *slotMethod(const typed::Class &definition, const std::string &name) {
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      if (function->name == name && function->isStateMethod && function->parameters.empty())
        return function.get();
  return nullptr;
}

Statements withState(const Options &options, Statements body) {
  const Code state =
      call(withParameters("rtsl::stateOf", {std::to_string(options.colorComponents)}),
           {cpp::name("ray")});
  body.insert(body.begin(), declaration("State &", "rt", state));
  return body;
}

Function slotFunction(const std::string &name, Statements body) {
  Function made;
  made.specifiers = "inline";
  made.result = "void";
  made.name = name;
  made.parameters = {byPointer("RtslState", "ray"), byValue("RtslRef", "object")};
  made.body = std::move(body);
  return made;
}

Code payloadAt(const Names &names, const typed::Struct &payload) {
  return call(withParameters("rtsl::payloadOf", {names.of(&payload)}), {cpp::name("ray")});
}

Code carries(const Names &names, const typed::Struct &payload) {
  return call(withParameters("rtsl::carries", {names.of(&payload)}), {cpp::name("ray")});
}

} // namespace rtsl::cpp
