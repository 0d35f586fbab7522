//===- Payloads.cpp - rays that carry a struct ----------------------------===//
//
// A struct that rays carry has a number, and says how hits of its rays are searched for: both come
// from linking (codegen/link/RayTypes.cpp). Methods that take a payload are reached through slots
// that ask which it is.
//
// `ignoreIntersection()` and `terminateRay()` end `anyHit` at once, from functions that it calls
// too: in C++ each `return`s, and so does who called it. Where C++ has no `return`, in the middle
// of an expression, an exception ends them all.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "runtime/device/ray/Abi.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::Builtin;

//===----------------------------------------------------------------------===//
// Types of rays
//===----------------------------------------------------------------------===//

static bool isPayloadMethod(const typed::Function &function) {
  return typed::takesPayload(function);
}

static const typed::Struct *payloadOf(const typed::Function &method) {
  return method.parameters.front()->type->structure;
}

std::vector<const typed::Function *> ModulePrinter::payloadMethods(const typed::Class &definition,
                                                                   const std::string &name) const {
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
  for (const auto &[bit, flag] :
       {std::pair(RTSL_FIRST_HIT, "rtsl::firstHit"), std::pair(RTSL_ASK_ANY_HIT, "rtsl::askAnyHit"),
        std::pair(RTSL_IN_ORDER, "rtsl::inOrder")})
    if (search & bit)
      flags = flags ? binary(Operator::BitOr, flags, name(flag)) : name(flag);
  return flags;
}

std::optional<Declaration> ModulePrinter::rayType(const typed::Struct &structure) const {
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
Statements ModulePrinter::callPayloadMethods(const char *base, const char *name) {
  Statements tests; // from the last type to the first
  const std::vector<const typed::Class *> classes = classesBelow(base);
  for (auto type = facts.rayTypes.rbegin(); type != facts.rayTypes.rend(); ++type) {
    Statements body = dispatch(classes, [&](const typed::Class &definition) -> Statements {
      for (const typed::Function *method : payloadMethods(definition, name))
        if (payloadOf(*method) == type->payload) {
          std::vector<Code> arguments = {cpp::name("rt")};
          if (takesScratch(*method))
            arguments.push_back(storedScratch(definition));
          arguments.push_back(cpp::name("payload"));
          return {
              statement(callMember(objectOf(definition), names.of(method), std::move(arguments)))};
        }
      return {};
    });
    if (body.empty())
      continue;
    body.insert(body.begin(), cpp::declaration("auto &", "payload", payloadAt(*type->payload)));
    Statement test = branch(carries(*type->payload), std::move(body), /*hasBraces=*/true);
    test.otherwise = std::move(tests);
    tests = {std::move(test)};
  }
  return tests;
}

Declarations ModulePrinter::payloadSlots() {
  Declarations slots;
  for (const PayloadSlot &slot : payloadSlotTable) {
    const bool isAnyHit = std::string(slot.method) == "anyHit";
    if (!firstCalls.empty() && !isAnyHit)
      continue; // runState has them
    const Statements tests = callPayloadMethods(slot.base, slot.method);
    if (tests.empty())
      continue;
    Function made = slotFunction(slot.method + std::string("WithPayload"), withState(tests));
    if (throwsFromAnyHit && isAnyHit)
      made.caught = "rtsl::EndOfAnyHit";
    appendApart(slots, declare(std::move(made)));
  }
  return slots;
}

Code ModulePrinter::payloadAt(const typed::Struct &payload) const {
  return call(withParameters("rtsl::payloadOf", {names.of(&payload)}), {cpp::name("ray")});
}

Code ModulePrinter::carries(const typed::Struct &payload) const {
  return call(withParameters("rtsl::carries", {names.of(&payload)}), {cpp::name("ray")});
}

/// `program.slots().base_name = &slots::function;`
Statement setSlot(const std::string &name, const std::string &function) {
  return statement(assign(member(callMember(cpp::name("program"), "slots", {}), name),
                          unary(UnaryOperator::Address, cpp::name("slots::" + function))));
}

Statements ModulePrinter::describePayloads() {
  Statements all;
  for (const PayloadSlot &slot : payloadSlotTable)
    for (const typed::Class *definition : classesBelow(slot.base))
      if ((firstCalls.empty() || std::string(slot.method) == "anyHit") &&
          !payloadMethods(*definition, slot.method).empty()) {
        all.push_back(setSlot(fmt::format("{}_{}_payload", slot.base, slot.method),
                              slot.method + std::string("WithPayload")));
        break;
      }
  return all;
}

//===----------------------------------------------------------------------===//
// Answers of anyHit
//===----------------------------------------------------------------------===//

// A function is printed once for all classes that inherit it.
bool ModulePrinter::mayAnswerHit(const typed::Function &function) {
  return function.owner ? hitAnswers.mayAnswerOf(function)
                        : hitAnswers.mayAnswer(function, nullptr);
}

bool FunctionPrinter::mayEndAnyHit() const {
  return function && (!function->isStateMethod || function->name == "anyHit") &&
         module.mayAnswerHit(*function);
}

static Code answerIn(const typed::Expr &expr) {
  return call(std::string("rtsl::") + typed::name(cast<typed::BuiltinExpr>(expr).builtin),
              {name("rt")});
}

Statements FunctionPrinter::hitAnswer(const typed::Expr &expr) {
  if (!typed::isHitAnswer(expr))
    return {};
  if (function->returnType->is(TypeKind::Void))
    return {returning(answerIn(expr))};
  return {statement(answerIn(expr)), returning(list("", {}))};
}

Code FunctionPrinter::endOfAnyHit(const typed::BuiltinExpr &expr) {
  before->push_back(statement(answerIn(expr)));
  leaveIfAnswered();
  return {};
}

void FunctionPrinter::leaveIfAnswered() {
  if (isInLambda) {
    module.throwsFromAnyHit = true;
    before->push_back(statement(cpp::call("rtsl::endIfAnswered", {name("rt")})));
    return;
  }
  const Statement leave =
      returning(function->returnType->is(TypeKind::Void) ? Code() : list("", {}));
  before->push_back(branch(cpp::call("rtsl::isAnswered", {name("rt")}), {leave}));
}

} // namespace rtsl::cpp
