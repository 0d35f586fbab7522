#include "codegen/cpp/runtime/Slots.h"

#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/runtime/Payloads.h"
#include "codegen/cpp/runtime/RunState.h"
#include "codegen/passes/errors/DeriveHitErrors.h"

namespace rtsl::cpp {

namespace {
struct Slot {
  const char *base;
  const char *method;
};
constexpr Slot allSlots[] = {
#define RTSL_SLOT(base, method) {#base, #method},
#include "language/Slots.def"
#define RTSL_SAMPLING_SLOT(base, method) {#base, #method},
#include "language/SamplingSlots.def"
};
} // namespace

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
  std::vector<Code> arguments = {rt};
  if (context.signatures.takesScratch(*method))
    arguments.push_back(storedScratch(context.names, definition));
  return {statement(callMember(object, context.names.of(method), std::move(arguments)))};
}

Declarations slots(Context &context, const StateEntries &entries,
                   const std::set<const typed::Class *> &withHitErrors,
                   std::vector<FilledSlot> &filled) {
  Namespace made = {"slots", {}};
  for (const Slot &slot : allSlots) {
    if (isRunBySteps(entries, slot.method))
      continue;
    const Statements body =
        dispatch(context.names, classesBelow(context.module, slot.base),
                 [&](const typed::Class &definition) {
                   return callSlotMethod(context, withHitErrors, definition, slot.method);
                 });
    if (body.empty())
      continue;
    appendApart(made.members, declare(slotFunction(slot.method, withState(context.options, body))));
    filled.push_back({slot.base, slot.method});
  }
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
