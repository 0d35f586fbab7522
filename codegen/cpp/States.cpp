//===- States.cpp - methods that trace, as their states -------------------===//
#include "codegen/cpp/States.h"

#include "codegen/cpp/StateWriter.h"
#include "codegen/lower/Analysis.h"
#include "codegen/link/Members.h"
#include "sema/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>

namespace rtsl::cpp {

using typed::StateVariable;

//===----------------------------------------------------------------------===//
// What lowering asks
//===----------------------------------------------------------------------===//

static const std::vector<std::pair<StateVariable, const char *>> &stateVariables() {
  static const std::vector<std::pair<StateVariable, const char *>> all = {
#define RTSL_STATE_VARIABLE(name, type) {StateVariable::name, #name},
#include "runtime/device/StateVariables.def"
  };
  return all;
}

SourceTable makeSourceTable(const typed::Module &module) {
  auto effects = std::make_shared<EffectsOf>(module);
  SourceTable table;
  table.isPure = [effects](const typed::Function &function) {
    const Effects &inside = effects->function(function);
    return inside.isPure() && !inside.usesRay && !inside.usesScratch && !function.mayTrace;
  };
  table.writes = [effects](const typed::Expr &expr) -> std::optional<std::vector<std::string>> {
    auto *call = dynCast<typed::CallExpr>(&expr);
    if (!call) // of a method that is known when the scene is
      return std::nullopt;
    const Effects &inside = effects->function(*call->function);
    if (inside.traces || inside.writesScratch || inside.reportsHit)
      return std::nullopt;
    std::vector<std::string> names;
    for (const auto &[variable, name] : stateVariables())
      if (inside.writes.count(EffectsOf::place(variable)))
        names.emplace_back(name);
    return names;
  };
  return table;
}

//===----------------------------------------------------------------------===//
// What is split
//===----------------------------------------------------------------------===//

/// Does the function trace, itself or through what it calls? (`mayTrace` counts shadow rays too.)
static bool traces(const typed::Module &module, const typed::Function &function) {
  if (!function.mayTrace || !function.body)
    return false;
  bool found = false;
  forEachExpr(*function.body, [&](const typed::Expr &expr) {
    if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
      found = found || builtin->builtin == typed::Builtin::Trace || builtin->builtin == typed::Builtin::TracePayload;
    auto *call = dynCast<typed::CallExpr>(&expr);
    if (!call || found)
      return;
    found = traces(module, *call->function);
    for (const auto &definition : module.classes) // one that overrides it
      for (const auto &other : definition->functions)
        found = found || (call->function->owner && definition.get() != call->function->owner &&
                          definition->derivesFrom(call->function->owner) && other->name == call->function->name &&
                          lowering::sameParameters(*other, *call->function) && traces(module, *other));
  });
  return found;
}

// States that lie in a method which is known only when the scene is would need a frame of their own.
void ModulePrinter::refuseTracesThroughReferences() {
  const auto mayTrace = [&](const typed::Function &function) {
    if (traces(module, function))
      return true;
    for (const auto &definition : module.classes)
      for (const auto &other : definition->functions)
        if (definition.get() != function.owner && definition->derivesFrom(function.owner) &&
            other->name == function.name && lowering::sameParameters(*other, function) && traces(module, *other))
          return true;
    return false;
  };
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      if (function->body)
        forEachExpr(*function->body, [&](const typed::Expr &expr) {
          auto *call = dynCast<typed::MethodCallExpr>(&expr);
          if (call && call->function && mayTrace(*call->function))
            unsupported(call->range, "a method that traces, called through a reference, in C++ with states,");
        });
}

static std::vector<mlir::func::FuncOp> statesOf(const StateProgram &program, const std::string &className,
                                                const std::string &method) {
  std::vector<mlir::func::FuncOp> states;
  mlir::ModuleOp ir = program.ir;
  for (auto function : ir.getOps<mlir::func::FuncOp>()) {
    auto ofClass = function->getAttrOfType<mlir::StringAttr>("rtsl.class");
    auto ofMethod = function->getAttrOfType<mlir::StringAttr>("rtsl.method");
    if (function->hasAttr("rtsl.state") && ofClass && ofMethod && ofClass.getValue() == className &&
        ofMethod.getValue() == method)
      states.push_back(function);
  }
  return states;
}

/// `shade`, or `closestHit.Radiance` where there may be one for each payload: what the IR calls a method.
static std::string slotName(const typed::Function &method) {
  return lowering::takesPayload(method) ? method.name + "." + toString(method.parameters.front()->type) : method.name;
}

bool ModulePrinter::isSplit(const typed::Class &definition, const typed::Function &method) const {
  return states && method.isStateMethod && traces(module, method) &&
         !statesOf(*states, definition.name, slotName(method)).empty();
}

bool ModulePrinter::isPartOfStates(const typed::Class &, const typed::Function &function) const {
  return states && !function.isStateMethod && traces(module, function);
}

bool ModulePrinter::isRunBySteps(const std::string &slot) const {
  return !firstCalls.empty() && (slot == "shade" || slot == "miss" || slot == "generate" || slot == "closestHit");
}

std::set<std::string> ModulePrinter::namesInScope(const typed::Class &definition) const {
  std::set<std::string> found = {module.classes.empty() ? std::string() : options.name};
  for (const auto &structure : module.structs)
    found.insert(names.of(structure.get()));
  for (const auto &constant : module.constants)
    found.insert(names.of(constant.get()));
  for (const auto &function : module.functions)
    found.insert(names.of(function.get()));
  for (const auto &other : module.classes)
    found.insert(names.of(other.get()));
  for (const typed::Class *at = &definition; at; at = at->base) {
    for (const auto &member : at->members)
      found.insert(names.of(member.get()));
    for (const auto &function : at->functions)
      found.insert(names.of(function.get()));
  }
  return found;
}

//===----------------------------------------------------------------------===//
// One method
//===----------------------------------------------------------------------===//

static std::string capitalised(std::string word) {
  word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

/// The first line that asks for what lies at an address.
static unsigned lineOfAccess(mlir::Value address) {
  unsigned line = 0;
  for (mlir::Operation *user : address.getUsers()) {
    const bool isPart = llvm::isa<ir::FieldOp, ir::ElementOp>(user);
    const unsigned at = isPart ? lineOfAccess(user->getResult(0)) : lineOf(user->getLoc());
    if (at != 0 && (line == 0 || at < line))
      line = at;
  }
  return line;
}

/// The line where what is in the frame is needed: that of the first thing that is made of it.
static unsigned lineOfUse(ir::FrameLoadOp load) {
  unsigned line = 0;
  for (mlir::Operation *user : load->getUsers())
    if (unsigned at = lineOf(user->getLoc()); at != 0 && (line == 0 || at < line))
      line = at;
  return line;
}

/// The fields of the frame, in the order in which they are saved first.
static void collectFrame(Machine &machine, StateWriter &writer) {
  std::set<std::string> taken;
  auto field = [&](llvm::StringRef slot, bool isObject = false) -> FrameField & {
    for (FrameField &known : machine.frame)
      if (known.slot == slot && known.isObject == isObject)
        return known;
    std::string name; // "sum.2" is the second sum, "ray.origin" a part
    for (std::size_t at = 0; at != slot.size(); ++at)
      if (std::isalnum(static_cast<unsigned char>(slot[at])) || slot[at] == '_')
        name += slot[at];
      else if (at + 1 == slot.size() || !std::isdigit(static_cast<unsigned char>(slot[at + 1])))
        name += '_';
    if (name == "evaluate" || name == "expression") // what the IR calls it
      name = "value";
    std::string unique = name;
    for (unsigned i = 2; isReserved(unique) || !taken.insert(unique).second; ++i)
      unique = name + std::to_string(i);
    machine.frame.push_back({slot.str(), unique, "", 0, 0, !isObject, isObject});
    return machine.frame.back();
  };
  for (auto [number, state] : llvm::enumerate(machine.states))
    state.walk([&](ir::FrameObjectOp object) {
      FrameField &saved = field(object.getName(), /*isObject=*/true);
      saved.type = writer.typeOf(object);
      saved.madeIn = lineOf(object.getLoc());
      const unsigned line = lineOfAccess(object);
      if (number != 0 && line != 0 && (saved.neededBy == 0 || line < saved.neededBy))
        saved.neededBy = line;
    });
  for (mlir::func::FuncOp state : machine.states) {
    state.walk([&](ir::FrameStoreOp store) {
      FrameField &saved = field(store.getName());
      if (unsigned line = lineOf(store.getLoc()); saved.madeIn == 0)
        saved.madeIn = line;
      saved.isTraced &= store.getValue().getDefiningOp<ir::TraceResultOp>() != nullptr;
    });
    state.walk([&](ir::FrameLoadOp load) {
      FrameField &saved = field(load.getName());
      if (unsigned line = lineOfUse(load); line != 0 && (saved.neededBy == 0 || line < saved.neededBy))
        saved.neededBy = line;
    });
  }
  for (bool changed = true; changed;) { // a value may be loaded and saved again
    changed = false;
    for (mlir::func::FuncOp state : machine.states)
      state.walk([&](ir::FrameStoreOp store) {
        FrameField &saved = field(store.getName());
        if (!saved.type.empty())
          return;
        saved.type = writer.typeOf(store.getValue());
        changed |= !saved.type.empty();
      });
  }
  std::stable_partition(machine.frame.begin(), machine.frame.end(),
                        [](const FrameField &saved) { return saved.type != "bool"; });
}

static bool mentions(const std::string &text, const std::string &word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    auto isPart = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
    const bool begins = at == 0 || !isPart(text[at - 1]);
    const char next = at + word.size() < text.size() ? text[at + word.size()] : ' ';
    if (begins && (next == '.' || !isPart(next)))
      return true;
  }
  return false;
}

/// What a field of the frame is, in the author's words: the comment at its declaration, or the line that makes it.
std::string ModulePrinter::meaningOf(const typed::Function &method, const FrameField &field) const {
  if (field.isTraced)
    return fmt::format("what the ray of line {} brought back", field.madeIn);
  for (const auto &local : method.locals)
    if (local->name == field.slot)
      if (std::string comment = notes.trailingComment(local->init ? local->init->range : local->range);
          comment.compare(0, 3, "// ") == 0)
        return comment.substr(3);
  std::string line = notes.textOfLine(method.range, field.madeIn);
  // On one line with the declaration, at 100 columns.
  const std::size_t room = 64 - std::min<std::size_t>(field.type.size() + field.name.size(), 40);
  if (line.size() > room)
    line = line.substr(0, line.rfind(' ', room - 4)) + " ...";
  return line.empty() ? field.slot : "`" + line + "`";
}

std::string ModulePrinter::stateMachine(const typed::Class &definition, const typed::Function &method) {
  Machine machine;
  machine.definition = &definition;
  machine.method = &method;
  machine.states = statesOf(*states, definition.name, slotName(method));
  std::string name = names.of(&method);
  const typed::Variable *payload = lowering::takesPayload(method) ? method.parameters.front().get() : nullptr;
  if (payload && std::count_if(definition.functions.begin(), definition.functions.end(),
                               [&](const auto &other) { return other->name == method.name; }) > 1)
    name += names.of(payload->type->structure); // there is one for each
  std::vector<std::string> functions = {name};
  for (std::size_t i = 1; i < machine.states.size(); ++i) {
    functions.push_back(fmt::format("{}AfterTrace{}", name, i));
    machine.stepOf[machine.states[i].getSymName().str()] =
        fmt::format("{}_{}", names.of(&definition), functions.back());
  }
  StateWriter writer(*this, states->source, machine);
  collectFrame(machine, writer);

  const std::string frame = capitalised(name) + "Frame";
  std::string text;
  if (!machine.frame.empty()) {
    text += fmt::format("// What `{}` needs when its rays come back.\nstruct {} {{\n", name, frame);
    const auto isBool = [](const FrameField &field) { return field.type == "bool" && !field.isObject; };
    const bool packs = std::count_if(machine.frame.begin(), machine.frame.end(), isBool) > 1; // bools share a byte
    for (const FrameField &field : machine.frame) {
      if (field.type.empty())
        unsupported(method.range, fmt::format("`{}` in the frame of a method in C++", field.slot));
      text += fmt::format("{} {}{}; // needed by line {}: {}\n", field.type, field.name,
                          packs && isBool(field) ? " : 1" : "", field.neededBy, meaningOf(method, field));
    }
    text += "};\n\n";
    frames.push_back(names.of(&definition) + "::" + frame);
  }

  for (std::size_t i = 0; i < machine.states.size(); ++i) {
    const std::string body = writer.body(machine.states[i]);
    std::vector<std::string> parameters = {mentions(body, "rt") ? "State &rt" : "State &"}, arguments = {"rt"};
    if (payload && mentions(body, names.of(payload))) {
      parameters.push_back(names.of(payload->type->structure) + " &" + names.of(payload));
      arguments.push_back("rtsl::payloadOf<" + names.of(payload->type->structure) + ">(ray)");
    }
    if (writer.usesScratch) {
      parameters.emplace_back("const Scratch &scratch");
      arguments.push_back("rtsl::loadScratch<" + names.of(&definition) + "::Scratch>(rt)");
    }
    if (mentions(body, machine.frameName)) {
      bool writes = false;
      machine.states[i].walk([&](ir::FrameStoreOp) { writes = true; });
      machine.states[i].walk([&](ir::FrameObjectOp object) {
        for (mlir::Operation *user : object->getUsers())
          writes |= writesTo(user, object);
      });
      parameters.push_back((writes ? "" : "const ") + frame + " &" + machine.frameName);
      arguments.push_back(fmt::format("rtsl::frameAt<{}::{}>(frame)", names.of(&definition), frame));
    }
    const std::string call = functions[i] + "(" + join(arguments, ", ") + ")";
    if (i == 0) {
      text += commentText(method.comment);
      firstCalls[{&definition, slotName(method)}] = call;
    } else {
      unsigned line = 0;
      machine.states[i].walk([&](mlir::Operation *op) {
        if (llvm::isa<ir::TraceResultOp, ir::TraceReturnedOp>(op) && line == 0)
          line = lineOf(op->getLoc());
      });
      text += line ? fmt::format("\n// When the ray of line {} is back.\n", line) : "\n";
      steps.push_back({machine.stepOf.at(machine.states[i].getSymName().str()), &definition, &method, call});
    }
    if (i == 0)
      text += lineDirective(method.range);
    text += fmt::format("rtsl::Next {}({}) const {{\n{}}}\n", functions[i], join(parameters, ", "), body);
  }
  return text;
}

// Objects of a class that inherits a method run that of the base, unless what it calls on itself is
// another function and has become part of the states.
std::string ModulePrinter::inheritedStateMachines(const typed::Class &definition) {
  std::string text;
  if (!states)
    return text;
  const bool isOther = std::any_of(definition.functions.begin(), definition.functions.end(), [&](const auto &function) {
    return !function->isStateMethod && traces(module, *function);
  });
  std::set<std::string> known;
  for (const auto &own : definition.functions)
    known.insert(slotName(*own));
  for (const typed::Class *at = definition.base; at && isOther; at = at->base)
    for (const auto &method : at->functions)
      if (method->isStateMethod && known.insert(slotName(*method)).second && isSplit(definition, *method))
        text += "\n" + stateMachine(definition, *method);
  return text;
}

//===----------------------------------------------------------------------===//
// The whole
//===----------------------------------------------------------------------===//

namespace {
/// A method with which the machine begins.
struct Beginning {
  const char *base, *method, *step, *slot; // of the class, of the function, its number in C++, and who asks for it
  bool hasPayload;
};
constexpr Beginning beginnings[] = {{"rt_Material", "shade", "shade", "shadeFirst", false},
                                    {"rt_Miss", "miss", "miss", "missFirst", false},
                                    {"rt_Material", "closestHit", "closestHit", "closestHitFirst", true},
                                    {"rt_Miss", "miss", "missWithPayload", "missWithPayloadFirst", true},
                                    {"rt_RayGeneration", "generate", "generate", "generateFirst", false}};
} // namespace

/// Does some class have such a method?
static bool isThere(const ModulePrinter &printer, const std::vector<const typed::Class *> &classes, const Beginning &one) {
  static_cast<void>(printer);
  for (const typed::Class *definition : classes)
    for (const typed::Class *at = definition; at; at = at->base)
      for (const auto &method : at->functions)
        if (method->isStateMethod && method->body && method->name == one.method &&
            lowering::takesPayload(*method) == one.hasPayload)
          return true;
  return false;
}

std::string ModulePrinter::stepNumbers() const {
  if (firstCalls.empty())
    return {};
  std::vector<std::string> numbers, begin;
  for (const Beginning &one : beginnings)
    if (isThere(*this, classesBelow(one.base), one)) {
      numbers.push_back(numbers.empty() ? std::string(one.step) + " = 1" : one.step);
      begin.push_back(fmt::format("`{}`", one.step));
    }
  for (const Step &step : steps)
    numbers.push_back(step.name);
  const std::string last = begin.back();
  begin.pop_back();
  return fmt::format("// Where a method goes on: {}{} begin{}, the others run when a ray is back.\n"
                     "enum class Step : rtsl::Next {{ {} }};\n",
                     begin.empty() ? "" : join(begin, ", ") + " and ", last, begin.empty() ? "s" : "",
                     join(numbers, ", "));
}

std::string ModulePrinter::runState() {
  if (firstCalls.empty())
    return {};
  auto object = [&](const typed::Class &definition) {
    return "rtsl::object<" + names.of(&definition) + ">(rt, object).";
  };
  // The first state of a method, or all of it if it does not trace.
  auto begin = [&](const Beginning &one, const typed::Struct *payload) {
    return dispatch(classesBelow(one.base), [&](const typed::Class &definition) -> std::string {
      const typed::Function *method = nullptr;
      for (const typed::Class *at = &definition; at && !method; at = at->base)
        for (const auto &function : at->functions)
          if (function->isStateMethod && function->body && function->name == one.method &&
              (payload ? lowering::takesPayload(*function) && function->parameters.front()->type->structure == payload
                       : function->parameters.empty()))
            method = function.get();
      if (!method)
        return {};
      for (const typed::Class *at = &definition; at; at = at->base)
        if (auto first = firstCalls.find({at, slotName(*method)}); first != firstCalls.end())
          return "return " + object(definition) + first->second;
      std::string arguments = "rt";
      if (takesScratch(*method))
        arguments += ", rtsl::loadScratch<" + names.of(&definition) + "::Scratch>(rt)";
      if (payload)
        arguments += ", rtsl::payloadOf<" + names.of(payload) + ">(ray)";
      return object(definition) + names.of(method) + "(" + arguments + ");\nreturn rtsl::done";
    });
  };
  std::string text = fmt::format("\ninline rtsl::Next runState(RtslState *ray, rtsl::Next step, RtslRef object, "
                                 "[[maybe_unused]] void *frame) {{\nState &rt = rtsl::stateOf<{}>(ray);\n"
                                 "switch (static_cast<Step>(step)) {{\n",
                                 options.colorComponents);
  auto returns = [](const std::string &body) {
    return body.rfind("return ", 0) == 0 && body.find('\n') + 1 == body.size();
  };
  for (const Beginning &one : beginnings) {
    if (!isThere(*this, classesBelow(one.base), one))
      continue;
    text += fmt::format("case Step::{}:\n", one.step);
    if (!one.hasPayload) {
      const std::string body = begin(one, nullptr);
      text += body + (returns(body) ? "" : "return rtsl::done;\n");
      continue;
    }
    for (const RayType &type : rayTypes)
      if (const std::string body = begin(one, type.payload); !body.empty())
        text += fmt::format("if (rtsl::carries<{}>(ray)) {{\n{}}}\n", names.of(type.payload), body);
    text += "return rtsl::done;\n";
  }
  for (const Step &step : steps)
    text += "case Step::" + step.name + ":\nreturn " + object(*step.definition) + step.call + ";\n";
  return text + "}\nreturn rtsl::done;\n}\n";
}

std::string ModulePrinter::describeStates() const {
  if (firstCalls.empty())
    return {};
  std::string text = fmt::format("program.states<{}>(&slots::runState);\n", join(frames, ", "));
  for (const Beginning &one : beginnings)
    if (isThere(*this, classesBelow(one.base), one))
      text += fmt::format("program.slots().states.{} = static_cast<rtsl::Next>(Step::{});\n", one.slot, one.step);
  return text;
}

} // namespace rtsl::cpp
