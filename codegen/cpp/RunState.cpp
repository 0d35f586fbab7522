//===- RunState.cpp - all states of a program, by number ------------------===//
#include "codegen/cpp/Printer.h"

#include "sema/typed/Analysis.h"

#include <fmt/format.h>

namespace rtsl::cpp {

namespace {
/// A method with which the machine begins.
struct Beginning {
  const char *base, *method, *step,
      *slot; // of the class, of the function, its number in C++, and who asks for it
  bool hasPayload;
};
constexpr Beginning beginnings[] = {
    {"rt_Material", "shade", "shade", "shadeFirst", false},
    {"rt_Miss", "miss", "miss", "missFirst", false},
    {"rt_Material", "closestHit", "closestHit", "closestHitFirst", true},
    {"rt_Miss", "miss", "missWithPayload", "missWithPayloadFirst", true},
    {"rt_RayGeneration", "generate", "generate", "generateFirst", false}};
} // namespace

/// Does some class have such a method?
static bool isThere(const std::vector<const typed::Class *> &classes, const Beginning &one) {
  for (const typed::Class *definition : classes)
    for (const typed::Class *at = definition; at; at = at->base)
      for (const auto &method : at->functions)
        if (method->isStateMethod && method->body && method->name == one.method &&
            typed::takesPayload(*method) == one.hasPayload)
          return true;
  return false;
}

bool ModulePrinter::isRunBySteps(const std::string &slot) const {
  return !firstCalls.empty() &&
         (slot == "shade" || slot == "miss" || slot == "generate" || slot == "closestHit");
}

std::string ModulePrinter::stepNumbers() const {
  if (firstCalls.empty())
    return {};
  std::vector<std::string> numbers, begin;
  auto add = [&](const std::string &step) {
    numbers.push_back(numbers.empty() ? step + " = 1" : step);
    begin.push_back(fmt::format("`{}`", step));
  };
  for (const Beginning &one : beginnings)
    if (isThere(classesBelow(one.base), one))
      add(one.step);
  for (const CalledMethod &called : calledMethods)
    add(called.step);
  for (const Step &step : steps)
    numbers.push_back(step.name);
  const std::string last = begin.back();
  begin.pop_back();
  return fmt::format(
      "// Where a method goes on: {}{} begin{}, the others run when a ray is back{}.\n"
      "enum class Step : rtsl::Next {{ {} }};\n",
      begin.empty() ? "" : join(begin, ", ") + " and ", last, begin.empty() ? "s" : "",
      calledMethods.empty() ? "" : " or a call over", join(numbers, ", "));
}

std::string ModulePrinter::runState() {
  if (firstCalls.empty())
    return {};
  const Statement done = returning(cpp::name("rtsl::done"));
  // The first state of a method, or all of it if it does not trace.
  auto begin = [&](const Beginning &one, const typed::Struct *payload) {
    return dispatch(classesBelow(one.base), [&](const typed::Class &definition) -> Statements {
      const typed::Function *method = nullptr;
      for (const typed::Class *at = &definition; at && !method; at = at->base)
        for (const auto &function : at->functions)
          if (function->isStateMethod && function->body && function->name == one.method &&
              (payload ? typed::takesPayload(*function) &&
                             function->parameters.front()->type->structure == payload
                       : function->parameters.empty()))
            method = function.get();
      if (!method)
        return {};
      // States of its own class, or of one between it and the method's: a base has others.
      for (const typed::Class *at = &definition; at != method->owner->base; at = at->base)
        if (auto first = firstCalls.find({at, typed::slotName(module, *method)});
            first != firstCalls.end())
          return {returning(first->second.on(objectOf(definition)))};
      std::vector<Code> arguments = {cpp::name("rt")};
      if (takesScratch(*method))
        arguments.push_back(storedScratch(definition));
      if (payload)
        arguments.push_back(payloadAt(*payload));
      return {statement(callMember(objectOf(definition), names.of(method), std::move(arguments))),
              done};
    });
  };
  Statement choice = simple(StatementKind::Switch);
  choice.value = staticCast("Step", cpp::name("step"));
  auto add = [&](const std::string &step, Statements body) {
    const bool declares = !body.empty() && body.front().is(StatementKind::Declaration);
    choice.arms.push_back({{cpp::name("Step::" + step)}, false, declares, std::move(body)});
  };
  for (const Beginning &one : beginnings) {
    if (!isThere(classesBelow(one.base), one))
      continue;
    Statements body;
    if (!one.hasPayload)
      body = begin(one, nullptr);
    for (const RayTypeFacts &type : facts.rayTypes)
      if (Statements run = one.hasPayload ? begin(one, type.payload) : Statements(); !run.empty())
        body.push_back(branch(carries(*type.payload), std::move(run), /*hasBraces=*/true));
    if (!endsInReturn(body))
      body.push_back(done);
    add(one.step, std::move(body));
  }
  for (const CalledMethod &called : calledMethods)
    add(called.step, runCalledMethod(called));
  for (const Step &step : steps)
    add(step.name, {returning(step.call.on(objectOf(*step.definition)))});
  Statements body = withState({choice, done});
  return fmt::format("\ninline rtsl::Next runState(RtslState *ray, rtsl::Next step, RtslRef "
                     "object, void *{}) {{\n{}}}\n",
                     mentions(body, "frame") ? "frame" : "/*frame*/", print(body));
}

std::string ModulePrinter::describeStates() const {
  if (firstCalls.empty())
    return {};
  std::string text = fmt::format("program.states<{}>(&slots::runState);\n", join(frames, ", "));
  if (!calledMethods.empty())
    text += fmt::format("program.calls<{}>({});\n", join(calledFrames, ", "), calledMethods.size());
  for (const Beginning &one : beginnings)
    if (isThere(classesBelow(one.base), one))
      text += fmt::format("program.slots().states.{} = static_cast<rtsl::Next>(Step::{});\n",
                          one.slot, one.step);
  return text;
}

} // namespace rtsl::cpp
