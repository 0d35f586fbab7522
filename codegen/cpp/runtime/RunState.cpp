#include "codegen/cpp/runtime/RunState.h"

#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/states/CalledMethods.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

namespace {
/// A method with which the machine begins.
struct Beginning {
  const char *base, *method, *step,
      *slot; // names of the class, the function, its number in C++, and its slot
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

bool isRunBySteps(const StateEntries &entries, const std::string &slot) {
  return !entries.empty() &&
         (slot == "shade" || slot == "miss" || slot == "generate" || slot == "closestHit");
}

Declarations RunState::stepNumbers() const {
  if (entries.empty())
    return {};
  Enum made = {"Step", "rtsl::Next", {}};
  std::vector<std::string> begin;
  auto add = [&](const std::string &step) {
    made.values.push_back({step, made.values.empty() ? std::optional(1u) : std::nullopt});
    begin.push_back(fmt::format("`{}`", step));
  };
  for (const Beginning &one : beginnings)
    if (isThere(classesBelow(context.module, one.base), one))
      add(one.step);
  for (const CalledMethod &called : context.split.calledMethods)
    add(called.step);
  for (const Step &step : entries.steps)
    made.values.push_back({step.name, std::nullopt});
  const std::string last = begin.back();
  begin.pop_back();
  return {
      declare(std::move(made),
              fmt::format("// The states: methods begin at {}{}{}, the others run after a ray{}.",
                          fmt::join(begin, ", "), begin.empty() ? "" : " and ", last,
                          context.split.calledMethods.empty() ? "" : " or a call"))};
}

/// The method of a class with which the machine begins, for rays that carry this payload; null: it
/// has none.
static const typed::Function *methodOf(const typed::Class &definition, const Beginning &one,
                                       const typed::Struct *payload) {
  auto takes = [&](const typed::Function &function) {
    return payload ? typed::takesPayload(function) &&
                         function.parameters.front()->type->structure == payload
                   : function.parameters.empty();
  };
  for (const typed::Class *at = &definition; at; at = at->base) {
    const auto found =
        std::find_if(at->functions.begin(), at->functions.end(), [&](const auto &function) {
          return function->isStateMethod && function->body && function->name == one.method &&
                 takes(*function);
        });
    if (found != at->functions.end())
      return found->get();
  }
  return nullptr;
}

/// Runs the first state of a class's method, or all of it if it does not trace.
Statements RunState::begin(const typed::Class &definition, const typed::Function &method,
                           const typed::Struct *payload) {
  // States of its own class, or of one between it and the method's: a base has others.
  for (const typed::Class *at = &definition; at != method.owner->base; at = at->base)
    if (auto first = entries.firstCalls.find({at, typed::slotName(context.module, method)});
        first != entries.firstCalls.end())
      return {returning(first->second.on(objectOf(context.names, definition)))};
  std::vector<Code> arguments = {cpp::name("rt")};
  if (context.signatures.takesScratch(method))
    arguments.push_back(storedScratch(context.names, definition));
  if (payload)
    arguments.push_back(payloadAt(context.names, *payload));
  return {statement(callMember(objectOf(context.names, definition), context.names.of(&method),
                               std::move(arguments))),
          returning(cpp::name("rtsl::done"))};
}

Declarations RunState::function() {
  if (entries.empty())
    return {};
  const Statement done = returning(cpp::name("rtsl::done"));
  auto begin = [&](const Beginning &one, const typed::Struct *payload) {
    return dispatch(context.names, classesBelow(context.module, one.base),
                    [&](const typed::Class &definition) -> Statements {
                      const typed::Function *method = methodOf(definition, one, payload);
                      return method ? this->begin(definition, *method, payload) : Statements();
                    });
  };
  Statement choice = simple(StatementKind::Switch);
  choice.value = staticCast("Step", cpp::name("step"));
  auto add = [&](const std::string &step, Statements body) {
    const bool declares = !body.empty() && body.front().is(StatementKind::Declaration);
    choice.arms.push_back({{cpp::name("Step::" + step)}, false, declares, std::move(body)});
  };
  for (const Beginning &one : beginnings) {
    if (!isThere(classesBelow(context.module, one.base), one))
      continue;
    Statements body;
    if (!one.hasPayload)
      body = begin(one, nullptr);
    for (const RayTypeFacts &type : context.facts.rayTypes)
      if (Statements run = one.hasPayload ? begin(one, type.payload) : Statements(); !run.empty())
        body.push_back(
            branch(carries(context.names, *type.payload), std::move(run), /*hasBraces=*/true));
    if (!endsInReturn(body))
      body.push_back(done);
    add(one.step, std::move(body));
  }
  for (const CalledMethod &called : context.split.calledMethods)
    add(called.step, runCalledMethod(context, entries, called));
  for (const Step &step : entries.steps)
    add(step.name, {returning(step.call.on(objectOf(context.names, *step.definition)))});
  Statements body = withState(context.options, {choice, done});
  Parameter frame = byPointer("void", "frame");
  frame.isCommented = !mentions(body, "frame");
  Function made;
  made.specifiers = "inline";
  made.result = "rtsl::Next";
  made.name = "runState";
  made.parameters = {byPointer("RtslState", "ray"), byValue("rtsl::Next", "step"),
                     byValue("RtslRef", "object"), frame};
  made.body = std::move(body);
  return {declare(std::move(made))};
}

Statements RunState::describe() const {
  if (entries.empty())
    return {};
  const Code program = name("program");
  Statements all = {
      statement(callMember(program, withParameters("states", entries.frames),
                           {unary(UnaryOperator::Address, name("slots::runState"))}))};
  if (!context.split.calledMethods.empty())
    all.push_back(statement(
        callMember(program, withParameters("calls", entries.calledFrames),
                   {integer(static_cast<std::int64_t>(context.split.calledMethods.size()))})));
  for (const Beginning &one : beginnings)
    if (isThere(classesBelow(context.module, one.base), one))
      all.push_back(statement(
          assign(cpp::member(cpp::member(callMember(program, "slots", {}), "states"), one.slot),
                 staticCast("rtsl::Next", name("Step::" + std::string(one.step))))));
  return all;
}

} // namespace rtsl::cpp
