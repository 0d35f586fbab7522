#include "codegen/cpp/runtime/Slots.h"

#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/runtime/Payloads.h"
#include "codegen/cpp/runtime/RunState.h"
#include "codegen/passes/errors/DeriveHitErrors.h"
#include "language/SlotTable.h"

#include <algorithm>

namespace rtsl::cpp {

/// Calls the method of a slot on the object, if the class has it.
static Statements callSlotMethod(Context &context,
                                 const std::set<const typed::Class *> &withHitErrors,
                                 const typed::Class &definition, const std::string &name) {
  const Code object = objectOf(context.names, definition), rt = cpp::name("rt");
  if (name == hitErrorMethod.str()) {
    if (withHitErrors.count(&definition) == 0)
      return {};
    return {statement(call("boundHitError", {rt, object}))};
  }
  const typed::Function *method = slotMethod(definition, name);
  if (!method)
    return {};
  if (context.signatures.takesScratch(*method) && method->name == "intersect")
    return {statement(call("rtsl::intersect", {rt, object}))};
  if (name == typed::scratchChangesMethod)
    return {statement(call("rtsl::computeChanges", {rt, object}))};
  std::vector<Code> arguments = {rt};
  if (context.signatures.takesScratch(*method))
    arguments.push_back(storedScratch(context.names, definition));
  return {statement(callMember(object, context.names.of(method), std::move(arguments)))};
}

Declarations slots(Context &context, const StateEntries &entries,
                   const std::set<const typed::Class *> &withHitErrors,
                   std::vector<FilledSlot> &filled) {
  Namespace made = {"slots", {}};
  const auto add = [&](const Slot &slot) {
    if (isRunBySteps(entries, slot.method))
      return;
    const Statements body =
        dispatch(context.names, classesBelow(context.module, slot.base),
                 [&](const typed::Class &definition) {
                   return callSlotMethod(context, withHitErrors, definition, slot.method);
                 });
    if (body.empty())
      return;
    appendApart(made.members, declare(slotFunction(slot.method, withState(context.options, body))));
    filled.push_back({slot.base, slot.method});
  };
  std::for_each(std::begin(methodSlots), std::end(methodSlots), add);
  std::for_each(std::begin(samplingSlots), std::end(samplingSlots), add);
  appendApart(made.members, payloadSlots(context, entries));
  appendApart(made.members, RunState(context, entries).function());
  Declarations all = {
      declare(OnlyComment{},
              "//===----------------------------------------------------------------------===//\n"
              "// Functions that the runtime calls\n"
              "//===----------------------------------------------------------------------===//")};
  appendApart(all, declare(std::move(made)));
  return all;
}

/// `program.slots().name = &slots::function;`
Statement setSlot(const std::string &name, const std::string &function) {
  return statement(assign(member(callMember(cpp::name("program"), "slots", {}), name),
                          unary(UnaryOperator::Address, cpp::name("slots::" + function))));
}

} // namespace rtsl::cpp
