//===- Classes.cpp - the classes of a scene -------------------------------===//
#include "Generator.h"

#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl::random {

static const char *const toColor = "rt_SampleColor = toColor(h); ";

static void append(std::vector<Variable> &to, const std::vector<Variable> &more) {
  to.insert(to.end(), more.begin(), more.end());
}

static const std::vector<typed::StateVariable> &stateVariables() {
  static const std::vector<typed::StateVariable> all = {
#define RTSL_STATE_VARIABLE(name, type) typed::StateVariable::name,
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
      members.children.push_back(makeNode(Role::Fixed, text + ";"));
      plan.members.push_back({name, types.buffer(element, rank), false, false});
    } else if (kind < 4) {
      members.children.push_back(declare(name, type, expression(type, 2), "public "));
      plan.members.push_back({name, type, false, false});
    } else {
      members.children.push_back(makeNode(Role::Fixed, (kind < 8 ? "public " : "private ") +
                                                           toString(type) + " " + name + ";"));
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
void Generator::addRecursion(ClassPlan &plan, Node &members) {
  const std::string next = fresh("o");
  members.children.push_back(
      makeNode(Role::Fixed, "public optional " + plan.name + " " + next + ";"));
  Function made;
  made.name = fresh("g");
  made.remote = true;
  made.work = 40;
  made.signature.result = types.floatType;
  made.signature.parameters.push_back({types.floatType, ast::Direction::In});
  context = contextOf(made, plan);
  references = plan.references;
  NodePtr value;
  do { // the function has no room for declarations that an expression needs before it
    pending.clear();
    scope = around(plan, made);
    scope.push_back({"x", types.floatType, true});
    value = expression(types.floatType, 2);
  } while (!pending.empty());
  members.children.push_back(makeNode(Role::Fixed,
                                      "float " + made.name + "(float x) { float own = $; return " +
                                          next + " ? own + 0.5 * " + next + "." + made.name +
                                          "(0.75 * x) : own - x; }",
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
  references = plan.references;
  work = 0;
  workLimit = large ? 400 : 60;
  scope = around(plan);
  std::vector<Variable> state = stateOf(model.reads, model.writes);
  append(state, more);
  append(scope, state);
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
  statements(*body, some(statementCount), nesting());
  if (model.abilities.has(Ability::CallSampling))
    for (const char *own : {"sampleBSDF", "BSDF", "evaluatePDF", "emission"})
      if (plan.methods.count(own) && chance(40))
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

//===----------------------------------------------------------------------===//
// Classes
//===----------------------------------------------------------------------===//

void Generator::makeCamera(const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Camera", "rt_Camera", nullptr, members);
  if (likely(30))
    addMembers(*plan, *members, 1 + below(2));
  addReferences(*plan, *members, someOf(targets));
  if (likely(40))
    addFunction(*plan, *members, false, 0);
  addMethod(*plan, *members, "generateRay", {},
            "rt_RayOrigin = toVector(h); rt_RayDirection = toVector(h * 2654435761u); ", below(2),
            Context());
  members->children.back()->children[0]->children.insert(
      members->children.back()->children[0]->children.begin() + 1,
      makeNode(Role::Statement, "h = hash_vec2(h, rt_ScreenCoord);"));
  program.camera = plan->name;
}

const ClassPlan *Generator::makePrimitive(const ClassPlan *base, const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Primitive", "rt_Primitive", base, members);
  if (!base)
    for (const Variable &attribute : attributes)
      members->children.push_back(makeNode(Role::Fixed, "scratch " + toString(attribute.type) +
                                                            " " + attribute.name + ";"));
  addMembers(*plan, *members, some(below(3)));
  addReferences(*plan, *members, someOf(targets));
  if (!base && likely(40))
    addConstructor(*plan, *members);
  if (base)
    overrideFunction(*plan, *members);
  else
    for (unsigned n = some(below(4)); n-- > 0;)
      addFunction(*plan, *members, chance(50), 0);

  if (!base || chance(50)) {
    addMethod(*plan, *members, "intersect", {}, "", below(4), Context());
    // Scratch members have a value before a hit is reported.
    Node &body = *members->children.back()->children[0];
    body.children.insert(body.children.begin() + 1,
                         makeNode(Role::Statement, "h = hash_vec3(hash_vec3(h, rt_RayOrigin), "
                                                   "rt_RayDirection);"));
    for (unsigned time = 0; time != 2; ++time) {
      NodePtr list = makeList();
      for (const Variable &attribute : attributes) {
        NodePtr value = converted(attribute.type, 2);
        add(*list, makeNode(Role::Statement, attribute.name + " = $;", std::move(value)));
      }
      if (time == 0) {
        for (NodePtr &child : list->children)
          body.children.push_back(std::move(child));
        // The error of t is stated, or derived from arithmetic, or neither.
        const char *t = chance(40) ? "abs(dot(rt_RayOrigin - vec3(0.5), rt_RayDirection)) / (0.25 "
                                     "+ dot(rt_RayDirection, rt_RayDirection))"
                                   : "0.125 + 4.0 * toUnit(h)";
        const char *error = chance(40) ? ", 0.5 * toUnit(h * 11u)" : "";
        body.children.push_back(makeNode(
            Role::Statement, std::string("bool won = (h & 3u) != 0u && hit(") + t + error + ");"));
      } else {
        list->children.push_back(makeNode(Role::Statement, "hit(0.5 + toUnit(h * 2654435761u));"));
        body.children.push_back(
            makeNode(Role::Statement, "if (!won && (h & 8u) != 0u) {$}", std::move(list)));
      }
    }
  }

  // What runs for the hit that won reads what `intersect` has left.
  std::vector<Variable> left;
  for (const Variable &attribute : attributes)
    left.push_back({attribute.name, attribute.type, false});
  const auto add = [&](const char *name, const std::vector<Variable> &more,
                       const std::string &result, unsigned count) {
    addMethod(*plan, *members, name, more, result, count, Context());
  };
  add("computeNormal", left,
      "rt_GeometricNormal = toVector(h); " +
          std::string(chance(50) ? "rt_ShadingNormal = toVector(h * 3u); " : ""),
      below(3));
  if (likely(60))
    add("computeTextureCoordinates", left,
        "rt_TextureUVW = toVector(h); rt_TextureUV = vec2(toUnit(h), toUnit(h * 5u)); ", below(3));
  if (likely(40))
    add("computeDerivatives", left,
        "rt_dPdu = toVector(h); rt_dPdv = toVector(h * 7u); rt_dsdu = toUnit(h); rt_dtdv = "
        "toUnit(h * 9u); ",
        below(2));
  if (likely(25)) {
    add("generateSample", {},
        "rt_HitPoint = toVector(h); rt_GeometricNormal = toVector(h * 7u); rt_PDF = toUnit(h); ",
        1 + below(2));
    add("samplePDF", {}, "rt_PDF = toUnit(h); ", below(2));
  }
  if (likely(50))
    add("computeBounds", {}, "rt_BoundMin = toVector(h); rt_BoundMax = toVector(h * 3u); ",
        below(2));
  program.primitives.push_back(plan->name);
  return plan;
}

const ClassPlan *Generator::makeLight(const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Light", "rt_Light", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  if (chance(40))
    addConstructor(*plan, *members);
  addReferences(*plan, *members, someOf(targets));
  for (unsigned n = some(below(3)); n-- > 0;)
    addFunction(*plan, *members, chance(60), 0);
  addMethod(*plan, *members, "illumination", {},
            "rt_LightDirection = toVector(h); rt_LightDistance = 0.5 + 8.0 * toUnit(h); "
            "rt_LightColor = toColor(h); ",
            1 + below(3), Context());
  program.lights.push_back(plan->name);
  if (chance(40))
    program.lights.push_back(plan->name);
  return plan;
}

/// A class of no rt_ class.
const ClassPlan *Generator::makeHelper(const ClassPlan *base) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Helper", "", base, members);
  addMembers(*plan, *members, some(1 + below(3)));
  if (!base && chance(50))
    addConstructor(*plan, *members);
  if (!base && chance(60))
    addRecursion(*plan, *members);
  if (base)
    overrideFunction(*plan, *members);
  addFunction(*plan, *members, true, 0);
  program.helpers.push_back(plan->name);
  return plan;
}

const ClassPlan *Generator::makeTexture(const ClassPlan *base, const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Texture", "rt_Texture", base, members);
  addMembers(*plan, *members, some(1 + below(3)));
  addReferences(*plan, *members, targets);
  if (!base && chance(50))
    addConstructor(*plan, *members);
  if (!base && chance(30))
    addRecursion(*plan, *members);
  if (base)
    overrideFunction(*plan, *members);
  if (!base || chance(40))
    addFunction(*plan, *members, true, 0);
  if (!base || chance(60))
    addMethod(*plan, *members, "lookup", {},
              "rt_TextureColor = toColor(h); rt_FloatTextureValue = toUnit(h); ", 1 + below(3),
              Context());
  program.textures.push_back(plan->name);
  return plan;
}

void Generator::makeMiss(const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Miss", "rt_Miss", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  addReferences(*plan, *members, someOf(targets));
  const unsigned traces = program.traces && chance(50) ? 2 : 0;
  if (chance(40))
    addFunction(*plan, *members, false, traces);
  Context rules;
  rules.traces = traces;
  rules.print = true;
  addMethod(*plan, *members, "miss", {}, toColor, 1 + below(4), rules);
  for (const Type *payload : payloads)
    if (chance(70))
      addPayloadMethod(*plan, *members, "miss", payload, {}, rules);
  if (chance(40)) {
    addMethod(*plan, *members, "sampleDirection", {},
              "rt_RayDirection = toVector(h); rt_SampleColor = toColor(h); rt_PDF = toUnit(h); ",
              1 + below(2), Context());
    addMethod(*plan, *members, "directionPDF", {}, "rt_PDF = toUnit(h); ", below(2), Context());
  }
  program.miss = plan->name;
}

/// Above some instances: which of four children a ray may enter.
void Generator::makeSelector(const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Selector", "rt_Selector", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  if (chance(40))
    addConstructor(*plan, *members);
  addReferences(*plan, *members, someOf(targets));
  addMethod(*plan, *members, "visit", {},
            "visitChild(int(h & 3u)); if ((h & 12u) != 0u) visitChild(int(h >> 4u & 3u)); ",
            1 + below(3), Context());
  program.selector = plan->name;
}

const ClassPlan *Generator::makeMaterial(const ClassPlan *base, const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Material", "rt_Material", base, members);
  addMembers(*plan, *members, some(below(4)));
  addReferences(*plan, *members, targets);
  if (!base) {
    for (const Variable &attribute : attributes)
      if (chance(50)) {
        members->children.push_back(makeNode(Role::Fixed, "scratch " + toString(attribute.type) +
                                                              " " + attribute.name + ";"));
        plan->scratch.push_back(attribute);
      }
    if (chance(40))
      addConstructor(*plan, *members);
  }
  const unsigned traces = program.traces ? 4 : 0;
  if (base)
    overrideFunction(*plan, *members);
  for (unsigned n = some(below(3)); n-- > 0;)
    addFunction(*plan, *members, chance(60), chance(60) ? traces / 2 : 0);
  if (!base && !payloads.empty() && likely(60))
    addFunction(*plan, *members, chance(60), 0, /*answers=*/true);
  if (!base || chance(40)) // what `shade` and `closestHit` may call
    addBsdf(*plan, *members);
  if (!base || chance(60)) {
    std::vector<Variable> attributesOfHit = plan->scratch;
    for (Variable &attribute : attributesOfHit)
      attribute.writable = false;
    Context rules;
    rules.illuminance = chance(50);
    rules.print = true;
    rules.traces = traces;
    addMethod(*plan, *members, "shade", attributesOfHit, toColor, 4 + below(6), rules);
    rules.illuminance = false;
    for (const Type *payload : payloads) {
      rules.traces = traces / 2;
      rules.illuminance = chance(40);
      if (chance(80))
        addPayloadMethod(*plan, *members, "closestHit", payload, attributesOfHit, rules);
      rules.illuminance = false;
      rules.traces = 0;
      if (chance(50))
        addPayloadMethod(*plan, *members, "anyHit", payload, attributesOfHit, rules);
    }
  }
  program.materials.push_back(plan->name);
  if (plan->scratch.empty())
    program.meshMaterials.push_back(plan->name);
  return plan;
}

/// What sampling a surface queries of its material.
void Generator::addBsdf(ClassPlan &plan, Node &members) {
  if (!likely(40))
    return;
  std::vector<Variable> attributesOfHit = plan.scratch;
  for (Variable &attribute : attributesOfHit)
    attribute.writable = false;
  Context rules;
  rules.print = true;
  auto add = [&](const char *name, const std::string &result) {
    addMethod(plan, members, name, attributesOfHit, result, 1 + below(3), rules);
  };
  add("sampleBSDF",
      "rt_LightDirection = toVector(h); rt_BSDFValue = toColor(h); rt_PDF = toUnit(h); ");
  add("BSDF", "rt_BSDFValue = toColor(h); ");
  add("evaluatePDF", "rt_PDF = toUnit(h); ");
  if (chance(50))
    add("emission", "rt_EmissionColor = toColor(h); ");
}

void Generator::makeClasses() {
  for (unsigned n = below(4), words = 0; n-- > 0;) {
    const Type *type = smallType();
    words += type->is(TypeKind::Color) ? program.colorComponents : type->componentCount();
    if (words <= 28)
      attributes.push_back({global("s"), type}); // programs that are compiled together share none
  }
  if (program.traces && likely(80))
    for (unsigned n = 1 + below(2); n-- > 0;)
      makePayload();
  Targets helpers, textures, all;
  if (likely(60)) {
    helpers.push_back(makeHelper(nullptr));
    if (likely(60))
      makeHelper(helpers[0]);
  }
  if (likely(80)) {
    textures.push_back(makeTexture(nullptr, helpers));
    if (likely(70))
      makeTexture(textures[0], {});
    if (likely(40))
      textures.push_back(makeTexture(nullptr, {textures[0]}));
  }
  textures.insert(textures.end(), helpers.begin(), helpers.end()); // what materials refer to
  all = textures;
  if (chance(50))
    all.push_back(makeLight(textures));
  const ClassPlan *primitive = makePrimitive(nullptr, all);
  if (likely(30))
    makePrimitive(primitive, {});
  all.push_back(primitive);
  Targets met = textures; // by materials, nearly always textures
  for (const ClassPlan *other : someOf(all))
    if (std::find(met.begin(), met.end(), other) == met.end())
      met.push_back(other);
  const ClassPlan *first = makeMaterial(nullptr, met);
  if (likely(60))
    makeMaterial(first, {});
  if (likely(50)) {
    met.push_back(first);
    makeMaterial(nullptr, met);
  }
  all.push_back(first);
  makeCamera(all);
  if (likely(80))
    makeMiss(all);
  if (likely(50))
    makeSelector(helpers);
}

} // namespace rtsl::random
