#include "codegen/cpp/runtime/Payloads.h"

#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/runtime/Slots.h"
#include "runtime/device/ray/Abi.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

static bool isPayloadMethod(const typed::Function &function) {
  return typed::takesPayload(function);
}

static const typed::Struct *payloadOf(const typed::Function &method) {
  return method.parameters.front()->type->structure;
}

std::vector<const typed::Function *> payloadMethods(const typed::Class &definition,
                                                    const std::string &name) {
  std::vector<const typed::Function *> methods;
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      if (isPayloadMethod(*function) && function->name == name && function->body &&
          std::none_of(methods.begin(), methods.end(), [&](const auto *known) {
            return payloadOf(*known) == payloadOf(*function);
          }))
        methods.push_back(function.get());
  return methods;
}

/// RTSL_FIRST_HIT and others, as the header names them, combined; nothing if there are none.
static Code searchFlags(std::uint32_t search) {
  Code flags;
  for (const auto &[bit, flag] : {std::pair(RTSL_FIRST_HIT, "rtsl::firstHit"),
                                  std::pair(RTSL_INVOKE_ANY_HIT, "rtsl::invokeAnyHit"),
                                  std::pair(RTSL_IN_ORDER, "rtsl::inOrder")})
    if (search & bit)
      flags = flags ? binary(Operator::BitOr, flags, name(flag)) : name(flag);
  return flags;
}

std::optional<Declaration> rayType(const ModuleFacts &facts, const typed::Struct &structure) {
  for (const RayTypeFacts &type : facts.rayTypes)
    if (type.payload == &structure) {
      std::vector<Code> parts = {integer(type.number)};
      if (const Code search = searchFlags(type.search))
        parts.push_back(search);
      return declare(Variable{"static constexpr",
                              "rtsl::RayType",
                              {"rayType", list("rtsl::RayType", std::move(parts))}},
                     "// The type of the rays that carry it.");
    }
  return std::nullopt;
}

//===----------------------------------------------------------------------===//
// Entries
//===----------------------------------------------------------------------===//

namespace {
struct PayloadSlot {
  const char *base;
  const char *method;
};
constexpr PayloadSlot payloadSlotTable[] = {
#define RTSL_PAYLOAD_SLOT(base, method) {#base, #method},
#include "language/PayloadSlots.def"
};
} // namespace

/// The slot's methods, each called for the rays that carry the payload that it takes.
static Statements callPayloadMethods(Context &context, const char *base, const char *name) {
  Statements tests; // from the last type to the first
  const std::vector<const typed::Class *> classes = classesBelow(context.module, base);
  for (auto type = context.facts.rayTypes.rbegin(); type != context.facts.rayTypes.rend(); ++type) {
    Statements body =
        dispatch(context.names, classes, [&](const typed::Class &definition) -> Statements {
          for (const typed::Function *method : payloadMethods(definition, name))
            if (payloadOf(*method) == type->payload) {
              std::vector<Code> arguments = {cpp::name("rt")};
              if (context.signatures.takesScratch(*method))
                arguments.push_back(storedScratch(context.names, definition));
              arguments.push_back(cpp::name("payload"));
              return {statement(callMember(objectOf(context.names, definition),
                                           context.names.of(method), std::move(arguments)))};
            }
          return {};
        });
    if (body.empty())
      continue;
    body.insert(body.begin(),
                cpp::declaration("auto &", "payload", payloadAt(context.names, *type->payload)));
    Statement test =
        branch(carries(context.names, *type->payload), std::move(body), /*hasBraces=*/true);
    test.otherwise = std::move(tests);
    tests = {std::move(test)};
  }
  return tests;
}

Declarations payloadSlots(Context &context, const StateEntries &entries) {
  Declarations slots;
  for (const PayloadSlot &slot : payloadSlotTable) {
    const bool isAnyHit = std::string(slot.method) == "anyHit";
    if (!entries.empty() && !isAnyHit)
      continue; // runState has them
    const Statements tests = callPayloadMethods(context, slot.base, slot.method);
    if (tests.empty())
      continue;
    Function made =
        slotFunction(slot.method + std::string("WithPayload"), withState(context.options, tests));
    if (context.required.throwsFromAnyHit && isAnyHit)
      made.caught = "rtsl::EndOfAnyHit";
    appendApart(slots, declare(std::move(made)));
  }
  return slots;
}

Statements describePayloads(const Context &context, const StateEntries &entries) {
  Statements all;
  for (const PayloadSlot &slot : payloadSlotTable)
    for (const typed::Class *definition : classesBelow(context.module, slot.base))
      if ((entries.empty() || std::string(slot.method) == "anyHit") &&
          !payloadMethods(*definition, slot.method).empty()) {
        all.push_back(setSlot(fmt::format("{}_{}_payload", slot.base, slot.method),
                              slot.method + std::string("WithPayload")));
        break;
      }
  return all;
}

} // namespace rtsl::cpp
