#include "codegen/cpp/states/StateMachines.h"

#include "codegen/cpp/states/FrameFields.h"
#include "codegen/cpp/states/statements/StatePrinter.h"
#include "codegen/ir/Attributes.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace rtsl::cpp {

//===----------------------------------------------------------------------===//
// One method
//===----------------------------------------------------------------------===//

static std::string capitalised(std::string word) {
  word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

static std::string uncapitalised(std::string word) {
  word[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(word[0])));
  return word;
}

/// The states to which other states of the method jump.
static std::set<std::string> joinsOf(const std::vector<mlir::func::FuncOp> &states) {
  std::set<std::string> symbols, joins;
  for (mlir::func::FuncOp state : states)
    if (state != states.front()) // where calls begin
      symbols.insert(state.getSymName().str());
  for (mlir::func::FuncOp state : states)
    state.walk([&](ir::NextOp next) {
      if (next.getTransition() == ir::Transition::Jump && next.getState() &&
          symbols.count(next.getState()->str()))
        joins.insert(next.getState()->str());
    });
  return joins;
}

/// The meaning of a frame field, quoted from the source: the comment at its declaration, or the
/// line that computes it.
std::string StateMachines::meaningOf(const typed::Function &method, const FrameField &field) {
  if (field.isTraced)
    return fmt::format("the color of the ray of line {}", field.madeIn);
  if (field.isReturned)
    return fmt::format("the result of the call of line {}", field.madeIn);
  for (const auto &local : method.locals)
    if (local->name == field.key)
      if (std::string comment =
              context.notes.trailingComment(local->init ? local->init->range : local->range);
          comment.compare(0, 3, "// ") == 0)
        return comment.substr(3, comment.find('\n') - 3);
  std::string line = context.notes.textOfLine(method.range, field.madeIn);
  // On one line with the declaration, at 100 columns.
  const std::size_t room =
      64 - std::min<std::size_t>(context.types.of(field.type).size() + field.name.size(), 40);
  if (line.size() > room)
    line = line.substr(0, line.rfind(' ', room - 4)) + " ...";
  return line.empty() ? field.key : "`" + line + "`";
}

/// The states of a method, with the names that they have in C++.
Machine StateMachines::machineOf(const typed::Class &definition, const typed::Function &method,
                                 std::set<std::string> &taken) {
  Machine machine;
  machine.definition = &definition;
  machine.method = &method;
  machine.file = context.notes.shownFile(method.range);
  machine.called = method.isStateMethod ? nullptr : context.split.calledMethod(definition, method);
  machine.slot = typed::slotName(context.module, method);
  machine.states = context.split.statesOf(definition, machine.slot, machine.called != nullptr);
  machine.name = context.split.nameOfMachine(definition, method);
  if (machine.called &&
      machine.called->structure != capitalised(machine.name)) // there are others of the name
    machine.name = uncapitalised(machine.called->structure);
  for (mlir::func::FuncOp state : machine.states)
    state.walk([&](ir::EnterOp call) {
      machine.callBefore[call.getResume().value_or("").str()] =
          context.split.calledMethod(call.getCallee().str());
    });
  machine.joins = joinsOf(machine.states);
  // Functions and states of one name in C++ would have different results.
  machine.functions = {context.split.overridesVirtual(method)
                           ? unique(machine.name + "Begin", taken, context.namesInFile())
                           : machine.name};
  for (std::size_t i = 1; i < machine.states.size(); ++i) {
    const std::string symbol = machine.states[i].getSymName().str();
    const char *begin = machine.joins.count(symbol)        ? "FromJoin"
                        : machine.callBefore.count(symbol) ? "AfterCall"
                                                           : "AfterTrace";
    machine.functions.push_back(
        unique(fmt::format("{}{}{}", machine.name, begin, i), taken, context.namesInFile()));
    machine.stepOf[symbol] = context.split.stepName(definition, machine.functions.back());
  }
  return machine;
}

/// The names of the parameters that the printer adds, which differ from the author's.
static void nameParameters(const Context &context, Machine &machine) {
  std::set<std::string> taken = context.namesInClass(*machine.definition);
  for (std::size_t at = 0; machine.called && at < machine.called->arguments.size(); ++at)
    taken.insert(machine.addressName(context, at));
  for (std::string *name : {&machine.frameName, &machine.callName}) {
    while (taken.count(*name) || context.namesInFile().count(*name))
      *name += '_';
    taken.insert(*name);
  }
}

/// The struct with the frame fields of a method; nothing if the frame holds only its arguments.
std::optional<Declaration> StateMachines::frameStructure(Machine &machine,
                                                         std::set<std::string> &taken) {
  if (machine.frame.empty()) {
    if (machine.called)
      machine.frameStruct = machine.frameType = context.split.structureOf(*machine.called);
    return std::nullopt;
  }
  std::set<std::string> &others = frameStructs[machine.definition];
  taken.insert(others.begin(), others.end());
  machine.frameStruct = unique(capitalised(machine.name) + "Frame", taken, context.namesInFile());
  others.insert(machine.frameStruct);
  machine.frameType = context.names.of(machine.definition) + "::" + machine.frameStruct;
  Struct made;
  made.name = machine.frameStruct;
  made.base = machine.called ? context.split.structureOf(*machine.called) : "";
  const auto isBool = [](const FrameField &field) {
    return field.type && field.type->is(TypeKind::Bool) && !field.isObject;
  };
  // bools share a byte
  const bool packs = std::count_if(machine.frame.begin(), machine.frame.end(), isBool) > 1;
  for (const FrameField &field : machine.frame) {
    if (!field.type) {
      context.unsupported(machine.method->range,
                          fmt::format("`{}` in the frame of a method in C++", field.key));
      continue;
    }
    Variable variable = {{}, context.types.of(field.type), {field.name, {}}};
    variable.bits = packs && isBool(field) ? 1 : 0;
    made.members.push_back(declare(std::move(variable)));
    made.members.back().trailing =
        fmt::format("// needed by line {}: {}", field.neededBy, meaningOf(*machine.method, field));
  }
  return declare(std::move(made),
                 fmt::format("// What `{}` keeps across its traces.", machine.name));
}

/// Does a state write fields of its frame?
static bool writesFrame(mlir::func::FuncOp state) {
  bool writes = false;
  state.walk([&](mlir::Operation *op) {
    writes |= llvm::isa<ir::FrameStoreOp, ir::CallResultOp>(op);
    if (llvm::isa<ir::FrameObjectOp>(op))
      for (mlir::Operation *user : op->getUsers())
        writes |= ir::writesTo(user, op->getResult(0));
  });
  return writes;
}

/// The comment above a state: the source line where it begins.
static std::string headingOf(const Machine &machine, mlir::func::FuncOp state) {
  unsigned line = 0;
  state.walk([&](mlir::Operation *op) {
    if (llvm::isa<ir::TraceResultOp, ir::TraceReturnedOp, ir::CallReturnedOp>(op) && line == 0)
      line = lineOf(op->getLoc(), machine.file);
  });
  const std::string symbol = state.getSymName().str();
  if (line == 0)
    return {};
  if (machine.joins.count(symbol) != 0)
    return fmt::format("// From line {}, on all paths.", line);
  if (machine.callBefore.count(symbol) != 0)
    return fmt::format("// After the call of line {}.", line);
  return fmt::format("// After the ray of line {}.", line);
}

/// Names for arguments of a called method that are addresses, above the body that mentions them.
void StateMachines::nameArguments(const Machine &machine, Statements &body) {
  for (std::size_t at = 0; machine.called && at < machine.called->arguments.size(); ++at)
    if (const std::string address = machine.addressName(context, at); mentions(body, address)) {
      const Code argument = cpp::member(cpp::name(machine.frameName), machine.called->fields[at]);
      body.insert(body.begin(),
                  cpp::declaration(context.types.of(machine.argumentType(at)) + " &", address,
                                   unary(UnaryOperator::Dereference, argument)));
    }
}

/// One state as a function, whose parameters are what its body mentions; records how it is called.
Declaration StateMachines::stateFunction(const Machine &machine, MethodPrinter &printer,
                                         std::size_t number) {
  const typed::Class &definition = *machine.definition;
  const typed::Function &method = *machine.method;
  mlir::func::FuncOp state = machine.states[number];
  StatePrinter statePrinter(printer);
  Statements body = statePrinter.body(state);
  nameArguments(machine, body);

  Function made;
  made.result = "rtsl::Next";
  made.name = machine.functions[number];
  made.isConst = true;
  std::vector<Parameter> &parameters = made.parameters;
  parameters = {byReference("State", mentions(body, "rt") ? "rt" : "")};
  std::vector<Code> arguments = {cpp::name("rt")};
  const typed::Variable *payload =
      typed::takesPayload(method) ? method.parameters.front().get() : nullptr;
  if (payload && mentions(body, context.names.of(payload))) {
    parameters.push_back(
        byReference(context.names.of(payload->type->structure), context.names.of(payload)));
    arguments.push_back(payloadAt(context.names, *payload->type->structure));
  }
  if (mentions(body, "scratch")) {
    parameters.push_back(byConstReference("Scratch", "scratch"));
    arguments.push_back(storedScratch(context.names, definition));
  }
  const Code bottom = cpp::name("frame");
  const Code frame =
      machine.hasFrame()
          ? cpp::call(withParameters(machine.called ? "rtsl::calledFrameAt" : "rtsl::frameAt",
                                     {machine.frameType}),
                      {bottom})
          : bottom;
  if (mentions(body, machine.frameName)) {
    parameters.push_back(byReference(machine.frameStruct, machine.frameName));
    parameters.back().isConst = !writesFrame(state);
    arguments.push_back(frame);
  }
  const std::string symbol = state.getSymName().str();
  const auto before = machine.callBefore.find(symbol);
  if (before != machine.callBefore.end() && before->second && mentions(body, machine.callName)) {
    const std::string structure = context.split.structureOf(*before->second);
    parameters.push_back(byConstReference(structure, machine.callName));
    arguments.push_back(cpp::call(withParameters("rtsl::callAbove", {structure}), {frame}));
  }
  made.body = std::move(body);

  const MethodCall call = {made.name, std::move(arguments)};
  Declaration declared = declare(std::move(made));
  if (number == 0) {
    entries.firstCalls[{&definition, machine.slot}] = call;
    declared.comment = method.comment;
    declared.place = context.lineDirective(method.range);
  } else {
    entries.steps.push_back({machine.stepOf.at(symbol), &definition, &method, call});
    declared.comment = headingOf(machine, state);
  }
  return declared;
}

Declarations StateMachines::of(const typed::Class &definition, const typed::Function &method) {
  // names that the printer adds must differ from the author's
  std::set<std::string> taken = context.namesInClass(definition);
  Machine machine = machineOf(definition, method, taken);
  nameParameters(context, machine);
  MethodPrinter printer(context, context.split.program->source, machine);
  collectFrame(machine, printer, context.split.typeNames());
  Declarations all;
  if (std::optional<Declaration> frame = frameStructure(machine, taken))
    all.push_back(std::move(*frame));
  if (machine.hasFrame())
    (machine.called ? entries.calledFrames : entries.frames).push_back(machine.frameType);
  for (std::size_t number = 0; number < machine.states.size(); ++number)
    appendApart(all, stateFunction(machine, printer, number));
  return all;
}

/// Does the derived class override a method that this method calls on its own object and that is
/// part of its states, in the derived class or in its base?
bool StateMachines::differsIn(const typed::Class &derived, const typed::Function &method) const {
  std::set<const typed::Function *> seen = {&method};
  std::vector<const typed::Function *> open = {&method};
  bool differs = false;
  while (!open.empty()) {
    const typed::Function *function = open.back();
    open.pop_back();
    forEachExpr(*function->body, [&](const typed::Expr &expr) {
      auto *call = dynCast<typed::CallExpr>(&expr);
      if (!call || !call->onSelf)
        return;
      const typed::Function &here = typed::resolve(*call, &derived);
      const typed::Function &above = typed::resolve(*call, derived.base);
      differs |= &here != &above && !(context.split.isWhole(here) && context.split.isWhole(above));
      if (here.body && seen.insert(&here).second)
        open.push_back(&here);
    });
  }
  return differs;
}

Declarations StateMachines::inherited(const typed::Class &definition) {
  Declarations machines;
  if (!context.split.program)
    return machines;
  std::set<std::string> known;
  for (const auto &own : definition.functions)
    known.insert(typed::slotName(context.module, *own));
  for (const typed::Class *at = definition.base; at; at = at->base)
    for (const auto &method : at->functions)
      if (known.insert(typed::slotName(context.module, *method)).second &&
          context.split.isSplit(definition, *method) && differsIn(definition, *method))
        appendApart(machines, of(definition, *method));
  return machines;
}

} // namespace rtsl::cpp
