//===- ClassParts.cpp - members and methods of classes --------------------===//
#include "Generator.h"

#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl::random {

static void append(std::vector<Variable> &to, const std::vector<Variable> &more) {
  to.insert(to.end(), more.begin(), more.end());
}

static const std::vector<typed::StateVariable> &stateVariables() {
  static const std::vector<typed::StateVariable> all = {
#define RTSL_STATE_VARIABLE(name, type, ...) typed::StateVariable::name,
#include "language/StateVariables.def"
  };
  return all;
}

StateSet common(StateSet a, StateSet b) {
  StateSet both;
  for (typed::StateVariable variable : stateVariables())
    if (a.has(variable) && b.has(variable))
      both = both | StateSet{variable};
  return both;
}

bool isIn(StateSet part, StateSet all) {
  return std::all_of(
      stateVariables().begin(), stateVariables().end(),
      [&](typed::StateVariable variable) { return all.has(variable) || !part.has(variable); });
}

/// Some of the state that has a value, and all that may be written.
std::vector<Variable> Generator::stateOf(StateSet reads, StateSet writes) {
  std::vector<Variable> variables;
  const unsigned percent = chance(25) ? 100 : 30;
  for (typed::StateVariable variable : stateVariables())
    if (writes.has(variable) || (reads.has(variable) && chance(percent)))
      variables.push_back({std::string("rt_") + typed::name(variable), typeOf(variable, types),
                           writes.has(variable)});
  return variables;
}

/// What a function may read that methods call: what has a value in one of them. Of a class below
/// `root`, or of any.
StateSet Generator::someReads(const std::string &root) {
  std::vector<const MethodModel *> methods;
  for (const RootModel &model : rootModels())
    for (const MethodModel &method : model.methods)
      if (root.empty() || model.name == root)
        methods.push_back(&method);
  return chance(40) ? pick(methods)->reads : StateSet();
}

std::vector<Variable> Generator::around(const ClassPlan &plan) {
  std::vector<Variable> variables = constants;
  append(variables, plan.members);
  return variables;
}

std::vector<Variable> Generator::around(const ClassPlan &plan, const Function &function) {
  std::vector<Variable> variables = around(plan);
  append(variables, stateOf(function.reads, {}));
  return variables;
}

/// What a function of the class may do.
Context Generator::contextOf(const Function &function, const ClassPlan &plan) const {
  Context rules;
  rules.self = &plan;
  rules.reads = function.reads;
  rules.rand = function.draws;
  rules.lookup = function.looksUp;
  rules.answers = function.answers;
  rules.raises = function.raises;
  rules.changes = function.changes || plan.root.empty();
  rules.converts = function.converts;
  rules.illuminance = function.lights;
  return rules;
}

//===----------------------------------------------------------------------===//
// Parts of a class
//===----------------------------------------------------------------------===//

ClassPlan *Generator::startClass(const char *stem, const std::string &root, const ClassPlan *base,
                                 Node *&members) {
  auto plan = base ? std::make_unique<ClassPlan>(*base) : std::make_unique<ClassPlan>();
  plan->name = global(stem);
  plan->root = root;
  plan->base = base;
  NodePtr list = makeList();
  members = list.get();
  program.tree->children.push_back(makeNode(Role::Fixed,
                                            "class " + plan->name +
                                                (base           ? " : " + base->name
                                                 : root.empty() ? ""
                                                                : " : " + root) +
                                                " {$};",
                                            std::move(list)));
  plans.push_back(std::move(plan));
  return plans.back().get();
}

void Generator::addMembers(ClassPlan &plan, Node &members, unsigned count) {
  for (; count > 0; --count) {
    const std::string name = fresh("m");
    const Type *type = anyType();
    context = Context();
    context.constantOnly = true;
    scope = constants;
    for (const Variable &member : plan.members)
      if (member.isConstant)
        scope.push_back(member);
    const unsigned kind = below(10);
    if (kind == 0) {
      members.children.push_back(declare(name, type, expression(type, 2), "const "));
      plan.members.push_back({name, type, false, true});
    } else if (kind == 1) {
      const unsigned rank = 1 + below(3);
      const Type *element = smallType();
      std::string text = "public " + toString(element) + " " + name;
      for (unsigned i = 0; i != rank; ++i)
        text += "[]";
      members.children.push_back(makeNode(Role::Fixed, text + someRange(element).text + ";"));
      plan.members.push_back({name, types.buffer(element, rank), false, false});
    } else if (kind < 4) {
      members.children.push_back(declare(name, type, expression(type, 2), "public "));
      plan.members.push_back({name, type, false, false});
    } else {
      const bool isPublic = kind < 8;
      const RangeText range = isPublic ? someRange(type) : RangeText();
      const bool hasDefault = !range.inside.empty() && chance(50);
      members.children.push_back(
          makeNode(Role::Fixed, (isPublic ? "public " : "private ") + toString(type) + " " + name +
                                    range.text + (hasDefault ? " = " + range.inside : "") + ";"));
      plan.members.push_back({name, type, false, false});
    }
    context.constantOnly = false;
  }
}

/// Few classes refer to all that they may.
Generator::Targets Generator::someOf(const Targets &targets) {
  Targets chosen;
  for (const ClassPlan *target : targets)
    if (likely(40))
      chosen.push_back(target);
  return chosen;
}

/// References to objects of earlier classes, so that there are no cycles.
void Generator::addReferences(ClassPlan &plan, Node &members, const Targets &targets) {
  for (const ClassPlan *target : targets) {
    const std::string name = fresh("o");
    const unsigned form = below(4);
    const unsigned count = 1 + below(3);
    members.children.push_back(
        makeNode(Role::Fixed, std::string("public ") + (chance(30) ? "optional " : "") +
                                  target->name + " " + name +
                                  (form == 0   ? "[" + std::to_string(count) + "]"
                                   : form == 1 ? "[]"
                                               : "") +
                                  ";"));
    plan.references.push_back({name, target, form == 0 ? count : 0, form == 1});
  }
}

void Generator::addImage(ClassPlan &plan, Node &members) {
  if (!hasImages(program.seed) || !plan.image.empty())
    return;
  plan.image = fresh("image");
  plan.images = chance(30) ? 2 + below(2) : 0;
  const std::string size = plan.images != 0 ? "[" + std::to_string(plan.images) + "]" : "";
  members.children.push_back(makeNode(Role::Fixed, "public sampler2D " + plan.image + size + ";"));
}

void Generator::addConstructor(ClassPlan &plan, Node &members) {
  Function made;
  made.signature.result = types.voidType;
  for (unsigned n = below(4); n-- > 0;)
    made.signature.parameters.push_back({anyType(), ast::Direction::In});
  context = Context();
  context.returns = false;
  references.clear();
  std::vector<Variable> visible = around(plan);
  for (Variable &variable : visible)
    variable.writable = !variable.isConstant && !variable.type->is(TypeKind::Buffer);
  members.children.push_back(function(made, "constructor", visible));
}

void Generator::addFunction(ClassPlan &plan, Node &members, bool remote, unsigned traces,
                            bool answers) {
  Function made;
  made.remote = remote;
  made.reads = someReads(plan.root);
  if (remote && chance(50)) // by methods of another class
    made.reads = common(made.reads, someReads(""));
  made.answers = answers;
  made.draws = plan.root != "rt_Primitive" || chance(50);
  made.looksUp = plan.root != "rt_Primitive" && plan.root != "rt_Camera";
  made.raises = program.raises && plan.root != "rt_Primitive" && chance(60);
  const bool ofHits = plan.root == "rt_Material" || plan.root == "rt_Texture";
  made.changes = made.converts = ofHits && chance(60);
  made.lights = plan.root == "rt_Material" && !answers && chance(30);
  made.signature.result = chance(12) ? types.voidType : anyType();
  if (traces != 0 && chance(70))
    made.signature.result = types.color;
  for (unsigned n = below(4); n-- > 0;) {
    const Type *type = anyType();
    made.signature.parameters.push_back({type, chance(60)   ? ast::Direction::In
                                               : chance(50) ? ast::Direction::Out
                                                            : ast::Direction::InOut});
  }
  made.name = fresh("g");
  context = contextOf(made, plan);
  context.traces = traces;
  references = plan.references;
  members.children.push_back(function(made, made.name, around(plan, made)));
  plan.functions.push_back(std::move(made));
}

/// A function that calls itself on what a member refers to: an object made before, so that it ends.
void Generator::addRecursion(ClassPlan &plan, Node &members, const Type *result, unsigned traces) {
  const std::string next = fresh("o");
  members.children.push_back(
      makeNode(Role::Fixed, "public optional " + plan.name + " " + next + ";"));
  Function made;
  made.name = fresh("g");
  made.remote = true;
  made.work = 40;
  made.traces = traces;
  made.signature.result = result;
  made.signature.parameters.push_back({types.floatType, ast::Direction::In});
  context = contextOf(made, plan);
  context.traces = traces != 0 ? 1 : 0;
  references = plan.references;
  NodePtr value;
  do { // the function has no room for declarations that an expression needs before it
    pending.clear();
    scope = around(plan, made);
    scope.push_back({"x", types.floatType, true});
    value = expression(result, 2);
  } while (!pending.empty());
  const std::string type = toString(result);
  members.children.push_back(makeNode(Role::Fixed,
                                      type + " " + made.name + "(float x) { " + type +
                                          " own = $; return " + next + " ? own + 0.5 * " + next +
                                          "." + made.name + "(0.75 * x) : own - " + type + "(x); }",
                                      std::move(value)));
  plan.references.push_back({next, &plan, 0, false});
  plan.functions.push_back(std::move(made));
}

/// Another definition of an inherited function. It calls only what stood before that: no cycles.
void Generator::overrideFunction(ClassPlan &plan, Node &members) {
  if (!plan.base || plan.base->functions.empty())
    return;
  const std::size_t number = below(static_cast<unsigned>(plan.base->functions.size()));
  Function made = plan.functions[number];
  ClassPlan visible = plan;
  visible.functions.resize(number);
  context = contextOf(made, visible);
  context.traces = made.traces;
  references = plan.references;
  members.children.push_back(function(made, made.name, around(plan, made)));
}

/// Changes components of a vector among the `state` that the method writes, before a ray and after
/// it. Their numbers are known only when the program runs.
void Generator::componentsAroundARay(Node &body, const std::vector<Variable> &state) {
  std::vector<Variable> vectors;
  for (const Variable &variable : state)
    if (variable.writable && variable.type->isVector())
      vectors.push_back(variable);
  if (vectors.empty() || context.traces == 0 || !chance(60))
    return;
  const Variable &vector = pick(vectors);
  const std::string count = std::to_string(vector.type->count) + "u";
  const auto component = [&] {
    return vector.name + (chance(60) ? "[h % " : "[(h >> 8u) % ") + count + "]";
  };
  const auto change = [&] {
    static const char *const operators[] = {" = ", " = ", " += ", " *= "};
    NodePtr made = makeNode(Role::Statement, component() + operators[below(4)] + "$;",
                            expression(types.floatType, 2));
    if (chance(25)) {
      NodePtr list = makeList();
      list->children.push_back(std::move(made));
      made = makeNode(Role::Statement, "if ($) {$}", condition(1), std::move(list));
    }
    add(body, std::move(made));
  };
  change();
  if (chance(30))
    change();
  if (!payloads.empty() && chance(50)) {
    add(body, payloadRay());
  } else if (context.traces != 0) { // what was added before may have sent the last one
    --context.traces;
    const Type *vec3 = types.vector(types.floatType, 3);
    NodePtr origin = converted(vec3, 1);
    NodePtr ray = makeNode(Role::Statement, "h = hash_color(h, trace($, $));", std::move(origin),
                           direction(1));
    add(body, std::move(ray));
  }
  if (chance(30)) // reads one
    add(body, makeNode(Role::Statement, "h = hash_float(h, " + component() + ");"));
  if (chance(70))
    change();
  body.children.push_back(hashed(vector));
}

/// A method of the engine's: some statements, then everything that they made, as one hash, then
/// `result`, which makes the state that the method writes from it. What it may do is the checker's
/// table; `rules` is what it does of that. `more` is what it sees beside state.
void Generator::addMethod(ClassPlan &plan, Node &members, const std::string &name,
                          std::vector<Variable> more, const std::string &result,
                          unsigned statementCount, Context rules, const std::string &parameters) {
  const MethodModel &model = *rootModel(plan.root)->method(name, !parameters.empty());
  context = rules;
  context.self = &plan;
  context.onReturn = result;
  context.reads = model.reads;
  context.lookup = model.abilities.has(Ability::Lookup);
  context.rand = model.abilities.has(Ability::Random);
  context.answers = model.abilities.has(Ability::AnyHit);
  context.changes = model.abilities.has(Ability::Derivatives);
  context.converts = model.abilities.has(Ability::Spaces);
  // Which primitives and selectors a ray tests is not defined, nor how often.
  context.raises = program.raises && plan.root != "rt_Primitive" && plan.root != "rt_Selector" &&
                   (plan.root != "rt_Camera" || chance(30));
  references = plan.references;
  work = 0;
  workLimit = large ? 400 : 60;
  scope = around(plan);
  std::vector<Variable> state = stateOf(model.reads, model.writes);
  append(state, more);
  append(scope, state);
  append(scope, plan.outputs);
  scope.push_back({"h", types.uintType, false});
  const std::size_t first = scope.size();

  NodePtr body = makeList();
  body->children.push_back(makeNode(
      Role::Statement, "uint h = " + std::to_string(static_cast<std::uint32_t>(random())) + "u;"));
  for (const Variable &variable : state)
    if (chance(12) && scalarCount(variable.type) <= 12)
      body->children.push_back(hashed(variable));
  const std::size_t payload = parameters.find_last_of(' ') + 1; // its name
  const std::string method = name + parameters.substr(0, payload);
  if (plan.base && plan.base->methods.count(method) && chance(context.traces != 0 ? 25 : 50)) {
    body->children.push_back(makeNode(Role::Statement, plan.base->name + "::" + name + "(" +
                                                           parameters.substr(payload) + ");"));
    context.traces /= 2; // the base's rays are sent too
  }
  plan.methods.insert(method);
  if (!plan.image.empty() && chance(60)) {
    NodePtr looked = ofImage(types.vector(types.floatType, 4), 2);
    add(*body, makeNode(Role::Statement, "h = hash_vec4(h, $);", std::move(looked)));
  }
  const bool areFirst = chance(50);
  if (areFirst)
    componentsAroundARay(*body, state);
  if (context.illuminance && lit)
    add(*body, illuminance(nesting()));
  statements(*body, some(statementCount), nesting());
  if (!areFirst)
    componentsAroundARay(*body, state);
  if (model.abilities.has(Ability::CallSampling))
    for (const char *own : {"sampleBSDF", "BSDF", "evaluatePDF", "emission"})
      if (plan.methods.count(own) && chance(40))
        body->children.push_back(makeNode(Role::Statement, own + std::string("();")));
  if (model.abilities.has(Ability::CallColor))
    for (const char *own : {"shade", "miss"})
      if (plan.methods.count(own) && chance(25))
        body->children.push_back(makeNode(Role::Statement, own + std::string("();")));
  hashAll(*body, first);
  for (const Variable &variable : state)
    if (variable.writable)
      body->children.push_back(hashed(variable));
  members.children.push_back(makeNode(
      Role::Fixed, "void " + name + "(" + parameters + ") {$  " + result + "}", std::move(body)));
}

/// A method that answers rays which carry a `payload`.
void Generator::addPayloadMethod(ClassPlan &plan, Node &members, const std::string &name,
                                 const Type *payload, std::vector<Variable> state, Context rules) {
  const std::string parameter = fresh("p");
  const bool asks = name == "anyHit";
  // if it does not, the order in which hits are queried is not visible
  const bool writes = !asks || chance(60);
  state.push_back({parameter, payload, writes});
  std::string result = writes ? parameter + ".h = h; " : "";
  if (asks) // for some hits
    result += "if ((h & 3u) == 0u) ignoreIntersection(); if ((h & 12u) == 0u) terminateRay(); ";
  addMethod(plan, members, name, std::move(state), result, 1 + below(4), rules,
            "inout " + toString(payload) + " " + parameter);
}

} // namespace rtsl::random
