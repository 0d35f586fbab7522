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

/// RTSL_FIRST_HIT and others, as the header names them.
static std::vector<std::string> searchWords(std::uint32_t search) {
  std::vector<std::string> words;
  for (const auto &[bit, word] :
       {std::pair(RTSL_FIRST_HIT, "rtsl::firstHit"), std::pair(RTSL_ASK_ANY_HIT, "rtsl::askAnyHit"),
        std::pair(RTSL_IN_ORDER, "rtsl::inOrder")})
    if (search & bit)
      words.emplace_back(word);
  return words;
}

std::string ModulePrinter::rayType(const typed::Struct &structure) const {
  for (const RayTypeFacts &type : facts.rayTypes)
    if (type.payload == &structure) {
      const std::string search = join(searchWords(type.search), " | ");
      return fmt::format("// The type of the rays that carry it.\nstatic constexpr rtsl::RayType "
                         "rayType{{{}{}}};\n\n",
                         type.number, search.empty() ? "" : ", " + search);
    }
  return {};
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

std::string ModulePrinter::payloadSlots() {
  std::string text;
  for (const PayloadSlot &slot : payloadSlotTable) {
    if (!firstCalls.empty() && std::string(slot.method) != "anyHit")
      continue;       // runState has them
    Statements tests; // from the last type to the first
    const std::vector<const typed::Class *> classes = classesBelow(slot.base);
    for (auto type = facts.rayTypes.rbegin(); type != facts.rayTypes.rend(); ++type) {
      Statements body = dispatch(classes, [&](const typed::Class &definition) -> Statements {
        for (const typed::Function *method : payloadMethods(definition, slot.method))
          if (payloadOf(*method) == type->payload) {
            std::vector<Code> arguments = {cpp::name("rt")};
            if (takesScratch(*method))
              arguments.push_back(storedScratch(definition));
            arguments.push_back(cpp::name("payload"));
            return {statement(
                callMember(objectOf(definition), names.of(method), std::move(arguments)))};
          }
        return {};
      });
      if (body.empty())
        continue;
      body.insert(body.begin(), declaration("auto &", "payload", payloadAt(*type->payload)));
      Statement test = branch(carries(*type->payload), std::move(body), /*hasBraces=*/true);
      test.otherwise = std::move(tests);
      tests = {std::move(test)};
    }
    if (tests.empty())
      continue;
    const bool isCaught = throwsFromAnyHit && std::string(slot.method) == "anyHit";
    text +=
        fmt::format("\ninline void {}WithPayload(RtslState *ray, RtslRef object) {}{{\n{}}}{}\n",
                    slot.method, isCaught ? "try " : "", print(withState(tests)),
                    isCaught ? " catch (const rtsl::EndOfAnyHit &) {\n}" : "");
  }
  return text;
}

Code ModulePrinter::payloadAt(const typed::Struct &payload) const {
  return call(withParameters("rtsl::payloadOf", {names.of(&payload)}), {cpp::name("ray")});
}

Code ModulePrinter::carries(const typed::Struct &payload) const {
  return call(withParameters("rtsl::carries", {names.of(&payload)}), {cpp::name("ray")});
}

std::string ModulePrinter::describePayloads() {
  std::string text;
  for (const PayloadSlot &slot : payloadSlotTable)
    for (const typed::Class *definition : classesBelow(slot.base))
      if ((firstCalls.empty() || std::string(slot.method) == "anyHit") &&
          !payloadMethods(*definition, slot.method).empty()) {
        text += fmt::format("program.slots().{0}_{1}_payload = &slots::{1}WithPayload;\n",
                            slot.base, slot.method);
        break;
      }
  return text;
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
