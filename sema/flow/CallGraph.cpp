//===- CallGraph.cpp - recursion, and which function may do what ----------===//
//
// Functions must not call themselves, except through references in members: the objects that
// members refer to form no cycle, so such a recursion ends, and the scene determines its depth. A
// function may send rays if one of its callees may: this is the one place that decides it
// (typed::Function::sends). A helper may use what the methods that reach it may use. All traversals
// are loops: chains of calls may be long.
//
//===----------------------------------------------------------------------===//
#include "sema/check/Program.h"
#include "support/ClosestName.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace rtsl {

//===----------------------------------------------------------------------===//
// Checking a use
//===----------------------------------------------------------------------===//

static std::string inMethod(const MethodModel &method) {
  return "`" + method.name + "`";
}

/// Adds why a variable that the class reads has no value in this method, and which method sets it.
static void explainNoValue(Diagnostic &diagnostic, typed::StateVariable variable,
                           const RootModel &root, const MethodModel &method) {
  using S = typed::StateVariable;
  if (method.name == "constructor") {
    diagnostic.note("the constructor runs when the scene is built: there is no ray yet");
  } else if (method.name == "computeBounds") {
    diagnostic.note(
        "`computeBounds` runs when the acceleration structure is built: there is no ray yet");
  } else if (method.name == "generateRay") {
    diagnostic.note(
        "`generateRay` makes the ray; use `1.0 / direction` of the direction that it writes");
  } else if (variable == S::HitPoint) {
    diagnostic.note("nothing has been hit yet; the point at parameter `t` is `rt_RayOrigin + t * "
                    "rt_RayDirection`");
  } else if (variable == S::PDF) {
    diagnostic.note(
        "`rt_PDF` is what `generateSample` and `samplePDF` write; no point has been sampled here");
  } else if (variable == S::SampleColor) {
    diagnostic.note("no ray of the classic engine exists here");
  } else {
    for (const MethodModel &other : root.methods)
      if (other.name != "generateSample" && other.writes.has(variable))
        diagnostic.note("`" + other.name + "` writes it for the closest hit, after `" +
                        method.name + "`; compute it in a function that both call");
  }
}

static bool judgeState(const Use &use, const RootModel &root, const MethodModel &method,
                       Diagnostics &diagnostics, const typed::Function *through) {
  const std::string variable = typed::name(use.variable);
  auto finish = [&](Diagnostic &diagnostic) {
    if (through)
      diagnostic.label(through->range,
                       "reached from " + inMethod(method) + " of " + withArticle(root.name));
    return false;
  };
  if (!root.sees.has(use.variable)) {
    const std::string classes = classesThatSee(use.variable);
    Diagnostic &diagnostic = diagnostics.report(Code::stateNotVisible, use.range,
                                                withArticle(root.name), "rt_" + variable);
    diagnostic.note("`rt_" + variable + "` belongs to " + classes);
    return finish(diagnostic);
  }
  if (use.kind == Use::Kind::ReadState) {
    if (method.reads.has(use.variable))
      return true;
    Diagnostic &diagnostic =
        diagnostics.report(Code::stateWithoutRay, use.range, "rt_" + variable, method.name);
    explainNoValue(diagnostic, use.variable, root, method);
    return finish(diagnostic);
  }
  if (method.writes.has(use.variable))
    return true;
  const std::string writers = methodsThatWrite(use.variable);
  if (writers.empty())
    return finish(diagnostics.report(Code::stateSetByEngine, use.range, "rt_" + variable));
  return finish(diagnostics.report(Code::stateReadOnly, use.range, "rt_" + variable, writers));
}

static bool judgeSpecial(const Use &use, const RootModel &root, const MethodModel &method,
                         Diagnostics &diagnostics, const typed::Function *through) {
  if (method.abilities.has(use.ability))
    return true;
  auto finish = [&](Diagnostic &diagnostic) {
    if (through)
      diagnostic.label(through->range,
                       "reached from " + inMethod(method) + " of " + withArticle(root.name));
    if (use.member)
      diagnostic.label(use.member->range, "declared here");
    return false;
  };
  switch (use.ability) {
  case Ability::WriteMembers: {
    Diagnostic &diagnostic =
        diagnostics.report(Code::memberReadOnly, use.range, use.what,
                           use.member->access == ast::Access::Public ? "public" : "private");
    diagnostic.note("all rays share the object; use a local variable");
    return finish(diagnostic);
  }
  case Ability::WriteBuffers: {
    Diagnostic &diagnostic =
        diagnostics.report(Code::bufferReadOnlyHere, use.range, use.what, method.name);
    diagnostic.note("output buffers are written while the launch runs: in " +
                    methodsWith(Ability::WriteBuffers) + ", and in functions that it calls");
    return finish(diagnostic);
  }
  case Ability::WriteScratch: {
    if (root.name == "rt_Material") {
      Diagnostic &diagnostic = diagnostics.report(Code::attributeReadOnly, use.range, use.what);
      diagnostic.note("a scratch member of a material has the value that the hit primitive wrote");
      return finish(diagnostic);
    }
    Diagnostic &diagnostic = diagnostics.report(Code::scratchReadOnly, use.range, use.what);
    diagnostic.note("a scratch member has the value that `intersect` wrote when it found the hit");
    return finish(diagnostic);
  }
  case Ability::ReadScratch: {
    Diagnostic &diagnostic =
        diagnostics.report(Code::scratchWithoutValue, use.range, use.what, method.name);
    diagnostic.note("scratch members have values from `intersect` on, for the closest hit");
    return finish(diagnostic);
  }
  case Ability::Trace: {
    Diagnostic &diagnostic = diagnostics.report(Code::misplacedTrace, use.range, inMethod(method));
    diagnostic.note("`trace` is allowed only in " + methodsWith(Ability::Trace) +
                    ", and in functions that these call");
    return finish(diagnostic);
  }
  case Ability::Illuminance: {
    Diagnostic &diagnostic =
        diagnostics.report(Code::misplacedIlluminance, use.range, use.what, inMethod(method));
    diagnostic.note("lights are gathered in " + methodsWith(Ability::Illuminance));
    return finish(diagnostic);
  }
  case Ability::Lookup: {
    Diagnostic &diagnostic =
        diagnostics.report(Code::misplacedLookup, use.range, use.what, inMethod(method));
    diagnostic.note("textures are looked up in " + methodsWith(Ability::Lookup));
    return finish(diagnostic);
  }
  default: {
    Diagnostic &diagnostic =
        diagnostics.report(Code::misplacedCall, use.range, use.what, inMethod(method));
    diagnostic.note("`" + use.what + "` is allowed only in " + methodsWith(use.ability));
    return finish(diagnostic);
  }
  }
}

bool judgeUse(Diagnostics &diagnostics, const Use &use, const RootModel &root,
              const MethodModel &method, const typed::Function *through) {
  return use.kind == Use::Kind::Special ? judgeSpecial(use, root, method, diagnostics, through)
                                        : judgeState(use, root, method, diagnostics, through);
}

//===----------------------------------------------------------------------===//
// The graph
//===----------------------------------------------------------------------===//

namespace {

class CallGraph {
public:
  CallGraph(Program &program, const std::vector<ClassScope *> &baseFirst)
      : program(program), baseFirst(baseFirst) {}

  void findOverriders();
  void refuseRecursion();
  void findRays();
  void judgeHelpers();

private:
  using Functions = std::vector<const typed::Function *>;

  /// All definitions that a call may run, for any object.
  Functions targets(const CallEdge &edge) const;
  /// The definitions that a call runs for an object of this class.
  Functions targetsFor(const CallEdge &edge, const ClassScope &scope) const;
  struct Cycle {
    Functions path;
    std::vector<SourceRange> calls;
    const typed::Function *again;
    SourceRange closing;
  };
  using IsFollowed = bool (*)(const CallEdge &);
  void walkCalls(IsFollowed isFollowed, std::vector<Cycle> &cycles) const;
  std::unordered_map<const typed::Function *, unsigned> findCycles() const;
  void reportCycle(const Cycle &cycle);
  void judgeFrom(const typed::Function &method, const ClassScope &scope, const MethodModel &rules);
  void reachFrom(const typed::Function &method);
  void warnOfMistypedMethod(const typed::Function &function, const RootModel &root);
  const FunctionFacts &factsOf(const typed::Function *function) const {
    static const FunctionFacts none;
    auto found = program.facts.find(function);
    return found == program.facts.end() ? none : found->second;
  }

  Program &program;
  const std::vector<ClassScope *> &baseFirst;
  std::unordered_map<const typed::Function *, Functions> overriders; // directly
  std::unordered_set<const ClassScope *> overridesHelper;
  std::unordered_set<const typed::Function *> reached;
  std::unordered_set<const Use *> reported;
};

} // namespace

void CallGraph::findOverriders() {
  for (const ClassScope *scope : baseFirst)
    for (const std::unique_ptr<typed::Function> &function : scope->definition->functions)
      for (const typed::Function *other : program.findMethods(scope->base, function->name))
        if (!function->isConstructor && sameParameters(*other, *function)) {
          overriders[other].push_back(function.get());
          if (!function->isStateMethod)
            overridesHelper.insert(scope);
        }
}

CallGraph::Functions CallGraph::targets(const CallEdge &edge) const {
  Functions all = {edge.callee};
  if (edge.dispatched)
    for (std::size_t i = 0; i != all.size(); ++i)
      if (auto found = overriders.find(all[i]); found != overriders.end())
        all.insert(all.end(), found->second.begin(), found->second.end());
  return all;
}

CallGraph::Functions CallGraph::targetsFor(const CallEdge &edge, const ClassScope &scope) const {
  if (!edge.dispatched || edge.throughReference)
    return targets(edge);
  for (const typed::Function *candidate : program.findMethods(&scope, edge.callee->name))
    if (sameParameters(*candidate, *edge.callee))
      return {candidate};
  return {edge.callee};
}

//===----------------------------------------------------------------------===//
// Recursion
//===----------------------------------------------------------------------===//

void CallGraph::reportCycle(const Cycle &cycle) {
  const auto &[path, calls, again, closing] = cycle;
  const auto first =
      static_cast<std::size_t>(std::find(path.begin(), path.end(), again) - path.begin());
  std::string chain = "`" + again->name + "`";
  for (std::size_t i = first + 1; i < path.size(); ++i)
    if (i - first <= 8)
      chain += " calls `" + path[i]->name + "`, which";
  chain += " calls `" + again->name + "`";
  Diagnostic &diagnostic = program.diagnostics.report(Code::recursion, closing, again->name);
  for (std::size_t i = first + 1; i < path.size() && i - first <= 8; ++i)
    diagnostic.label(calls[i], "`" + path[i - 1]->name + "` calls `" + path[i]->name + "` here");
  diagnostic.note(chain);
  diagnostic.note("only `trace` and calls through members may be recursive: "
                  "`member.function()`");
}

/// Depth first over all functions and the calls for which `isFollowed` holds.
void CallGraph::walkCalls(IsFollowed isFollowed, std::vector<Cycle> &cycles) const {
  enum class Mark : std::uint8_t { Open, Done };
  std::unordered_map<const typed::Function *, Mark> marks;
  struct Frame {
    const typed::Function *function;
    std::vector<std::pair<const typed::Function *, SourceRange>> next;
    std::size_t position = 0;
  };
  std::vector<Frame> stack;
  Functions path;
  std::vector<SourceRange> calls;
  auto enter = [&](const typed::Function *function, SourceRange call) {
    marks[function] = Mark::Open;
    Frame frame{function, {}, 0};
    for (const CallEdge &edge : factsOf(function).calls)
      if (isFollowed(edge))
        for (const typed::Function *target : targets(edge))
          frame.next.emplace_back(target, edge.range);
    stack.push_back(std::move(frame));
    path.push_back(function);
    calls.push_back(call);
  };
  auto walk = [&](const typed::Function *root) {
    if (marks.count(root))
      return;
    enter(root, root->range);
    while (!stack.empty()) {
      Frame &frame = stack.back();
      if (frame.position == frame.next.size()) {
        marks[frame.function] = Mark::Done;
        stack.pop_back();
        path.pop_back();
        calls.pop_back();
        continue;
      }
      const auto [target, range] = frame.next[frame.position++];
      const auto mark = marks.find(target);
      if (mark == marks.end())
        enter(target, range);
      else if (mark->second == Mark::Open)
        cycles.push_back({path, calls, target, range});
    }
  };
  for (const std::unique_ptr<typed::Function> &function : program.module.functions)
    walk(function.get());
  for (const ClassScope *scope : baseFirst)
    for (const std::unique_ptr<typed::Function> &function : scope->definition->functions)
      walk(function.get());
}

/// Functions in the same cycle of calls have the same number.
std::unordered_map<const typed::Function *, unsigned> CallGraph::findCycles() const {
  // Tarjan (1972), with a stack of its own.
  struct Node {
    unsigned order = 0, lowest = 0, cycle = 0; // order: from 1; cycle: from 1, when it is complete
  };
  struct Frame {
    const typed::Function *function;
    Functions next;
    std::size_t position = 0;
  };
  std::unordered_map<const typed::Function *, Node> nodes;
  std::vector<Frame> stack;
  Functions open;
  unsigned order = 0, cycles = 0;
  const auto enter = [&](const typed::Function *function) {
    nodes[function] = {++order, order, 0};
    open.push_back(function);
    Frame frame{function, {}, 0};
    for (const CallEdge &edge : factsOf(function).calls)
      for (const typed::Function *target : targets(edge))
        frame.next.push_back(target);
    stack.push_back(std::move(frame));
  };
  for (const auto &entry : program.facts) {
    if (nodes.count(entry.first))
      continue;
    enter(entry.first);
    while (!stack.empty()) {
      Frame &frame = stack.back();
      Node &node = nodes[frame.function];
      if (frame.position != frame.next.size()) {
        const typed::Function *target = frame.next[frame.position++];
        const auto known = nodes.find(target);
        if (known == nodes.end())
          enter(target);
        else if (known->second.cycle == 0)
          node.lowest = std::min(node.lowest, known->second.order);
        continue;
      }
      if (node.lowest == node.order) {
        ++cycles;
        for (const typed::Function *member = nullptr; member != frame.function;) {
          member = open.back();
          open.pop_back();
          nodes[member].cycle = cycles;
        }
      }
      const unsigned lowest = node.lowest;
      stack.pop_back();
      if (!stack.empty())
        nodes[stack.back().function].lowest = std::min(nodes[stack.back().function].lowest, lowest);
    }
  }
  std::unordered_map<const typed::Function *, unsigned> numbers;
  for (const auto &[function, node] : nodes)
    numbers[function] = node.cycle;
  return numbers;
}

void CallGraph::refuseRecursion() {
  // Without calls through members, no cycle is allowed.
  std::vector<Cycle> endless, cycles;
  walkCalls([](const CallEdge &edge) { return !edge.throughMember; }, endless);
  walkCalls([](const CallEdge &) { return true; }, cycles);
  for (const Cycle &cycle : endless)
    reportCycle(cycle);
  if (cycles.empty() || !endless.empty())
    return;
  // References other than members may not be part of a cycle either: they may lead back to the same
  // object.
  const auto numbers = findCycles();
  const auto judge = [&](const typed::Function *function) {
    for (const CallEdge &edge : factsOf(function).calls)
      if (edge.throughReference && !edge.throughMember)
        for (const typed::Function *target : targets(edge))
          if (numbers.at(target) == numbers.at(function)) {
            program.diagnostics.report(Code::recursion, edge.range, target->name)
                .note("the reference may lead back to the same object: only calls through members "
                      "may be recursive, `member.function()`");
            break;
          }
  };
  for (const std::unique_ptr<typed::Function> &function : program.module.functions)
    judge(function.get());
  for (const ClassScope *scope : baseFirst)
    for (const std::unique_ptr<typed::Function> &function : scope->definition->functions)
      judge(function.get());
}

//===----------------------------------------------------------------------===//
// Which functions send rays
//===----------------------------------------------------------------------===//

/// Propagates from functions whose bodies send rays to all that may call them.
void CallGraph::findRays() {
  std::unordered_map<const typed::Function *, std::vector<typed::Function *>> callers;
  for (const auto &[function, facts] : program.facts)
    for (const CallEdge &edge : facts.calls)
      for (const typed::Function *target : targets(edge))
        callers[target].push_back(const_cast<typed::Function *>(function));
  for (bool typed::SentRays::*kind : {&typed::SentRays::traced, &typed::SentRays::shadow}) {
    std::vector<typed::Function *> pending;
    for (const auto &[function, facts] : program.facts)
      if (facts.sends.*kind)
        pending.push_back(const_cast<typed::Function *>(function));
    while (!pending.empty()) {
      typed::Function *function = pending.back();
      pending.pop_back();
      if (std::exchange(function->sends.*kind, true))
        continue;
      if (const auto found = callers.find(function); found != callers.end())
        pending.insert(pending.end(), found->second.begin(), found->second.end());
    }
  }
  for (const auto &entry : program.facts) {
    auto *function = const_cast<typed::Function *>(entry.first);
    CallEdge call;
    call.callee = function;
    call.dispatched = true;
    for (const typed::Function *target : targets(call)) {
      function->callSends.traced |= target->sends.traced;
      function->callSends.shadow |= target->sends.shadow;
    }
  }
}

//===----------------------------------------------------------------------===//
// Helpers
//===----------------------------------------------------------------------===//

/// Checks the uses in all functions that are reached from an engine method, for an object of class
/// `scope`.
void CallGraph::judgeFrom(const typed::Function &method, const ClassScope &scope,
                          const MethodModel &rules) {
  std::unordered_set<const typed::Function *> seen = {&method};
  struct Step {
    const typed::Function *function;
    bool onOtherObject;
  };
  std::vector<Step> pending = {{&method, false}};
  while (!pending.empty()) {
    const Step step = pending.back();
    pending.pop_back();
    const FunctionFacts &facts = factsOf(step.function);
    const_cast<typed::Function *>(step.function)->mayRunInLookup |= method.name == "lookup";
    if (step.function != &method) {
      reached.insert(step.function);
      for (const Use &use : facts.uses) {
        // Member accesses in methods of another object are checked for that object.
        const bool ofObject = use.kind == Use::Kind::Special && use.member && step.onOtherObject;
        const bool writes = use.ability == Ability::WriteMembers ||
                            use.ability == Ability::WriteScratch ||
                            use.ability == Ability::WriteBuffers;
        if (reported.count(&use) || (ofObject && !writes))
          continue;
        if (!judgeUse(program.diagnostics, use, *scope.root, rules, &method))
          reported.insert(&use);
      }
    }
    for (const CallEdge &edge : facts.calls)
      for (const typed::Function *target :
           step.onOtherObject ? targets(edge) : targetsFor(edge, scope))
        if (seen.insert(target).second)
          pending.push_back({target, step.onOtherObject || edge.throughReference});
  }
}

/// Leaves the uses in the function and in those that it calls unchecked, unless a method of the
/// right class reaches them.
void CallGraph::reachFrom(const typed::Function &method) {
  Functions pending = {&method};
  while (!pending.empty()) {
    const typed::Function *function = pending.back();
    pending.pop_back();
    if (reached.insert(function).second)
      for (const CallEdge &edge : factsOf(function).calls)
        for (const typed::Function *target : targets(edge))
          pending.push_back(target);
  }
}

/// Warns of a function that is never called and whose name and signature resemble those of an
/// engine method: it was probably meant to be one.
void CallGraph::warnOfMistypedMethod(const typed::Function &function, const RootModel &root) {
  std::vector<std::string> names = {constructorModel().name};
  for (const MethodModel &method : root.methods)
    names.push_back(method.name);
  const std::string meant = closestName(function.name, names);
  const auto &parameters = function.parameters;
  const bool takesPayload = parameters.size() == 1 &&
                            parameters[0]->direction == ast::Direction::InOut &&
                            parameters[0]->type->is(TypeKind::Struct);
  const bool hasShape = meant == constructorModel().name || parameters.empty() || takesPayload;
  if (meant.empty() || !hasShape || !function.returnType->is(TypeKind::Void))
    return;
  program.diagnostics
      .report(Code::mistypedMethod, function.range, function.name, meant, withArticle(root.name))
      .fix(function.range, meant);
}

void CallGraph::judgeHelpers() {
  for (const ClassScope *scope : baseFirst) {
    if (!scope->root)
      continue;
    // Inherited methods reach other functions only if this class overrides one that they call.
    const bool withInherited = overridesHelper.count(scope) != 0;
    for (const ClassScope *at = scope; at; at = withInherited ? at->base : nullptr)
      for (const std::unique_ptr<typed::Function> &function : at->definition->functions) {
        if (function->isConstructor)
          judgeFrom(*function, *scope, constructorModel());
        else if (function->isStateMethod)
          if (const MethodModel *rules =
                  scope->root->method(function->name, !function->parameters.empty()))
            judgeFrom(*function, *scope, *rules);
      }
  }
  std::unordered_set<const typed::Function *> called;
  for (const auto &[caller, facts] : program.facts)
    for (const CallEdge &edge : facts.calls)
      for (const typed::Function *target : targets(edge)) {
        called.insert(target);
        const_cast<typed::Function *>(target)->isCalledOnSelf |=
            target->isStateMethod && edge.dispatched && !edge.throughReference;
      }
  for (const typed::Function *function : program.foreignMethods)
    reachFrom(*function);
  // A function that no method reaches yet may do what any method of its class may do.
  for (const ClassScope *scope : baseFirst) {
    if (!scope->root || scope->root == &helperModel())
      continue;
    MethodModel most = unionOfMethods(*scope->root);
    for (const std::unique_ptr<typed::Function> &function : scope->definition->functions)
      if (!function->isConstructor && !function->isStateMethod && !reached.count(function.get())) {
        for (const Use &use : factsOf(function.get()).uses)
          judgeUse(program.diagnostics, use, *scope->root, most, nullptr);
        if (!called.count(function.get()))
          warnOfMistypedMethod(*function, *scope->root);
      }
  }
}

void Program::judgeCalls() {
  CallGraph graph(*this, baseFirst);
  graph.findOverriders();
  graph.refuseRecursion();
  graph.findRays();
  graph.judgeHelpers();
}

} // namespace rtsl
