#include "codegen/cpp/states/CalledMethods.h"

#include "codegen/cpp/runtime/Dispatch.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>

namespace rtsl::cpp {

/// Is it passed as an address?
static bool isAddress(const typed::Variable *argument) {
  return !argument || argument->direction != ast::Direction::In ||
         argument->type->is(TypeKind::Struct) || argument->type->is(TypeKind::Array) ||
         argument->type->isMatrix();
}

Declarations callStructures(Context &context, const std::string &className) {
  Declarations all;
  for (const CalledMethod &called : context.split.calledMethods) {
    if (called.definition->name != className)
      continue;
    Struct made;
    made.name = called.structure;
    made.members.push_back(declare(
        Variable{"static constexpr", "Step", {"begin", cpp::name("Step::" + called.step)}}));
    for (std::size_t i = 0; i < called.arguments.size(); ++i) {
      const typed::Variable *argument = called.arguments[i];
      const std::string of =
          context.types.of(argument ? argument->type : called.function->returnType);
      made.members.push_back(
          declare(Variable{{}, isAddress(argument) ? of + " *" : of, {called.fields[i], {}}}));
    }
    if (!called.returned.empty())
      made.members.push_back(declare(Variable{
          {}, context.types.of(called.function->returnType), {called.returned, list("", {})}}));
    appendApart(
        all, declare(std::move(made), fmt::format("// The arguments{} of `{}`.",
                                                  called.returned.empty() ? "" : " and the result",
                                                  context.names.of(called.function))));
  }
  return all;
}

/// Starts the first state of the method of the object's class, or calls the method if it does not
/// trace.
Statements runCalledMethod(Context &context, const StateEntries &entries,
                           const CalledMethod &called) {
  const Code callFrame = cpp::name("call");
  Statements body = dispatch(
      context.names, classesBelow(context.module, called.definition->name),
      [&](const typed::Class &definition) -> Statements {
        const typed::Function *method = findMethod(definition, *called.function);
        if (!method)
          return {};
        for (const typed::Class *at = &definition; at != method->owner->base;
             at = at->base) // states of bases of `owner` belong to other definitions
          if (auto first = entries.firstCalls.find({at, called.slot});
              first != entries.firstCalls.end())
            return {returning(first->second.on(objectOf(context.names, definition)))};
        std::vector<Code> arguments;
        if (context.signatures.takesState(*method))
          arguments.push_back(cpp::name("rt"));
        if (context.signatures.takesScratch(*method))
          arguments.push_back(storedScratch(context.names, definition));
        auto field = [&](std::size_t i) {
          const Code own = cpp::member(callFrame, called.fields[i]);
          return isAddress(called.arguments[i]) ? unary(UnaryOperator::Dereference, own) : own;
        };
        for (std::size_t i = 0; i < called.arguments.size(); ++i)
          if (called.arguments[i])
            arguments.push_back(field(i));
        const Code run = callMember(objectOf(context.names, definition), context.names.of(method),
                                    std::move(arguments));
        if (!called.returned.empty())
          return {statement(assign(cpp::member(callFrame, called.returned), run))};
        if (!called.arguments.empty() && !called.arguments.front())
          return {statement(assign(field(0), run))};
        return {statement(run)};
      },
      typed::mayReferToNothing(context.module));
  if (mentions(body, callFrame->name)) {
    const Code located =
        call(withParameters("rtsl::calledFrameAt", {context.split.structureOf(called)}),
             {cpp::name("frame")});
    body.insert(body.begin(), declaration("auto &", callFrame->name, located));
  }
  if (!endsInReturn(body))
    body.push_back(returning(cpp::call("rtsl::returnToCaller", {cpp::name("rt")})));
  return body;
}

} // namespace rtsl::cpp
