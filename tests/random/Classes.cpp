//===- Classes.cpp - the classes of a scene -------------------------------===//
#include "Generator.h"

#include "sema/TypeProperties.h"

#include <algorithm>

namespace rtsl::random {

static const char *const toColor = "rt_SampleColor = toColor(h); ";

/// What every method that runs for a ray sees.
static std::vector<Variable> everyRay(TypeContext &types) {
  return {{"rt_LaunchIndex", types.vector(types.uintType, 2), false},
          {"rt_LaunchSize", types.vector(types.uintType, 2), false},
          {"rt_Depth", types.intType, false},
          {"rt_TimeSeed", types.floatType, false}};
}

static std::vector<Variable> named(const Type *type, std::initializer_list<const char *> names,
                                   bool writable = false) {
  std::vector<Variable> variables;
  for (const char *name : names)
    variables.push_back({std::string("rt_") + name, type, writable});
  return variables;
}

static void append(std::vector<Variable> &to, const std::vector<Variable> &more) {
  to.insert(to.end(), more.begin(), more.end());
}

std::vector<Variable> Generator::around(const ClassPlan &plan) {
  std::vector<Variable> variables = constants;
  append(variables, plan.members);
  return variables;
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
  program.tree->children.push_back(
      makeNode(Role::Fixed, "class " + plan->name + " : " + (base ? base->name : root) + " {$};",
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
      members.children.push_back(makeNode(
          Role::Fixed, (kind < 8 ? "public " : "private ") + toString(type) + " " + name + ";"));
      plan.members.push_back({name, type, false, false});
    }
    context.constantOnly = false;
  }
}

/// References to objects of earlier classes, so that there are no circles.
void Generator::addReferences(ClassPlan &plan, Node &members,
                              const std::vector<const ClassPlan *> &targets) {
  for (const ClassPlan *target : targets) {
    const std::string name = fresh("o");
    const unsigned form = below(4);
    const unsigned count = 1 + below(3);
    members.children.push_back(makeNode(
        Role::Fixed, "public " + target->name + " " + name +
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

void Generator::addFunction(ClassPlan &plan, Node &members, bool remote, unsigned traces) {
  Function made;
  made.remote = remote;
  made.signature.result = chance(12) ? types.voidType : anyType();
  if (traces != 0 && chance(70))
    made.signature.result = types.color;
  for (unsigned n = below(4); n-- > 0;) {
    const Type *type = anyType();
    made.signature.parameters.push_back(
        {type, chance(60)   ? ast::Direction::In
               : chance(50) ? ast::Direction::Out
                            : ast::Direction::InOut});
  }
  made.name = fresh("g");
  context = Context();
  context.self = &plan;
  context.traces = traces;
  context.lookup = plan.root != "rt_Primitive";
  context.rand = plan.root != "rt_Primitive";
  references = plan.references;
  members.children.push_back(function(made, made.name, around(plan)));
  plan.functions.push_back(std::move(made));
}

/// Another definition of an inherited function. It calls only what stood before that: no circles.
void Generator::overrideFunction(ClassPlan &plan, Node &members) {
  if (!plan.base || plan.base->functions.empty())
    return;
  const std::size_t number = below(static_cast<unsigned>(plan.base->functions.size()));
  Function made = plan.functions[number];
  ClassPlan visible = plan;
  visible.functions.resize(number);
  context = Context();
  context.self = &visible;
  context.traces = made.traces;
  context.lookup = plan.root != "rt_Primitive";
  context.rand = plan.root != "rt_Primitive";
  references = plan.references;
  members.children.push_back(function(made, made.name, around(plan)));
}

/// A method of the engine's: some statements, then everything that they made, as one hash, then
/// `result`, which makes the state that the method writes from it.
void Generator::addMethod(const ClassPlan &plan, Node &members, const std::string &name,
                          std::vector<Variable> state, const std::string &result,
                          unsigned statementCount, Context rules, const std::string &parameters) {
  context = rules;
  context.self = &plan;
  context.onReturn = result;
  references = plan.references;
  work = 0;
  workLimit = large ? 400 : 60;
  scope = around(plan);
  if (context.ray)
    append(scope, everyRay(types));
  append(scope, state);
  scope.push_back({"h", types.uintType, false});
  const std::size_t first = scope.size();

  NodePtr body = makeList();
  body->children.push_back(makeNode(
      Role::Statement, "uint h = " + std::to_string(static_cast<std::uint32_t>(random())) + "u;"));
  for (const Variable &variable : state)
    if (!variable.writable && chance(12) && scalarCount(variable.type) <= 12)
      body->children.push_back(hashed(variable));
  statements(*body, some(statementCount), nesting());
  hashAll(*body, first);
  for (const Variable &variable : state)
    if (variable.writable)
      body->children.push_back(hashed(variable));
  members.children.push_back(
      makeNode(Role::Fixed, "void " + name + "(" + parameters + ") {$  " + result + "}", std::move(body)));
}

/// A method that answers rays which carry a `payload`.
void Generator::addPayloadMethod(const ClassPlan &plan, Node &members, const std::string &name, const Type *payload,
                                 std::vector<Variable> state, Context rules) {
  const std::string parameter = fresh("p");
  const bool asks = name == "anyHit";
  const bool writes = !asks || chance(60); // if it does not, the order in which hits are asked for does not show
  state.push_back({parameter, payload, writes});
  std::string result = writes ? parameter + ".h = h; " : "";
  if (asks) // for some hits
    result += "if ((h & 3u) == 0u) ignoreIntersection(); if ((h & 12u) == 0u) terminateRay(); ";
  addMethod(plan, members, name, std::move(state), result, 1 + below(4), rules, "inout " + toString(payload) + " " + parameter);
}

//===----------------------------------------------------------------------===//
// Classes
//===----------------------------------------------------------------------===//

void Generator::makeCamera() {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Camera", "rt_Camera", nullptr, members);
  if (likely(30))
    addMembers(*plan, *members, 1 + below(2));
  Context rules;
  rules.rand = true;
  addMethod(*plan, *members, "generateRay",
            named(types.vector(types.floatType, 2), {"ScreenCoord", "LensCoord"}),
            "rt_RayOrigin = toVector(h); rt_RayDirection = toVector(h * 2654435761u); ", below(2),
            rules);
  members->children.back()->children[0]->children.insert(
      members->children.back()->children[0]->children.begin() + 1,
      makeNode(Role::Statement, "h = hash_vec2(h, rt_ScreenCoord);"));
  program.camera = plan->name;
}

void Generator::makePrimitive(const ClassPlan *base) {
  const Type *vec3 = types.vector(types.floatType, 3);
  Node *members = nullptr;
  ClassPlan *plan = startClass("Primitive", "rt_Primitive", base, members);
  if (!base)
    for (const Variable &attribute : attributes)
      members->children.push_back(makeNode(
          Role::Fixed, "scratch " + toString(attribute.type) + " " + attribute.name + ";"));
  addMembers(*plan, *members, some(below(3)));
  if (!base && likely(40))
    addConstructor(*plan, *members);
  if (base)
    overrideFunction(*plan, *members);
  else if (likely(70))
    addFunction(*plan, *members, false, 0);

  std::vector<Variable> ray = named(vec3, {"RayOrigin", "RayDirection", "InverseRayDirection"});
  append(ray, named(types.floatType, {"Epsilon"}));
  if (!base || chance(50)) {
    Context rules;
    addMethod(*plan, *members, "intersect", ray, "", below(4), rules);
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
        body.children.push_back(makeNode(
            Role::Statement, "bool won = (h & 3u) != 0u && hit(0.125 + 4.0 * toUnit(h));"));
      } else {
        list->children.push_back(
            makeNode(Role::Statement, "hit(0.5 + toUnit(h * 2654435761u));"));
        body.children.push_back(
            makeNode(Role::Statement, "if (!won && (h & 8u) != 0u) {$}", std::move(list)));
      }
    }
  }

  // Everything below runs for the hit that won.
  std::vector<Variable> hit = ray;
  append(hit, named(vec3, {"HitPoint"}));
  append(hit, named(types.floatType, {"HitDistance"}));
  append(hit, named(types.intType, {"PrimitiveIndex", "InstanceIndex"}));
  for (const Variable &attribute : attributes)
    hit.push_back({attribute.name, attribute.type, false});
  Context rules;
  rules.rand = true;
  addMethod(*plan, *members, "computeNormal", hit,
            "rt_GeometricNormal = toVector(h); " +
                std::string(chance(50) ? "rt_ShadingNormal = toVector(h * 3u); " : ""),
            below(3), rules);
  append(hit, named(vec3, {"GeometricNormal", "ShadingNormal"}));
  if (likely(60))
    addMethod(*plan, *members, "computeTextureCoordinates", hit,
              "rt_TextureUVW = toVector(h); rt_TextureUV = vec2(toUnit(h), toUnit(h * 5u)); ",
              below(3), rules);
  if (likely(40))
    addMethod(*plan, *members, "computeDerivatives", hit,
              "rt_dPdu = toVector(h); rt_dPdv = toVector(h * 7u); rt_dsdu = toUnit(h); rt_dtdv = "
              "toUnit(h * 9u); ",
              below(2), rules);
  if (likely(25)) {
    addMethod(*plan, *members, "generateSample", named(types.floatType, {"PDF"}, true),
              "rt_HitPoint = toVector(h); rt_GeometricNormal = toVector(h * 7u); rt_PDF = toUnit(h); ", 1 + below(2), rules);
    addMethod(*plan, *members, "samplePDF", named(types.floatType, {"PDF"}, true), "rt_PDF = toUnit(h); ", below(2), rules);
  }
  if (likely(25)) {
    Context noRay;
    noRay.ray = false;
    addMethod(*plan, *members, "computeBounds", {}, "rt_BoundMin = toVector(h); rt_BoundMax = toVector(h * 3u); ", below(2),
              noRay);
  }
  program.primitives.push_back(plan->name);
}

void Generator::makeLight() {
  const Type *vec3 = types.vector(types.floatType, 3);
  Node *members = nullptr;
  ClassPlan *plan = startClass("Light", "rt_Light", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  if (chance(40))
    addConstructor(*plan, *members);
  std::vector<Variable> state = named(vec3, {"HitPoint", "GeometricNormal", "ShadingNormal"});
  append(state, named(vec3, {"LightDirection"}, true));
  append(state, named(types.floatType, {"LightDistance"}, true));
  append(state, named(types.color, {"LightColor"}, true));
  Context rules;
  rules.rand = true;
  addMethod(*plan, *members, "illumination", state,
            "rt_LightDirection = toVector(h); rt_LightDistance = 0.5 + 8.0 * toUnit(h); "
            "rt_LightColor = toColor(h); ",
            1 + below(3), rules);
  program.lights.push_back(plan->name);
  if (chance(40))
    program.lights.push_back(plan->name);
}

/// Textures read where they are looked up only if every caller is on a surface.
const ClassPlan *Generator::makeTexture(const ClassPlan *base,
                                        const std::vector<const ClassPlan *> &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Texture", "rt_Texture", base, members);
  addMembers(*plan, *members, some(1 + below(3)));
  addReferences(*plan, *members, targets);
  if (!base && chance(50))
    addConstructor(*plan, *members);
  if (base)
    overrideFunction(*plan, *members);
  if (!base || chance(40))
    addFunction(*plan, *members, true, 0);
  if (!base || chance(60)) {
    std::vector<Variable> state;
    append(state, named(types.color, {"TextureColor"}, true));
    append(state, named(types.floatType, {"FloatTextureValue"}, true));
    append(state, named(types.vector(types.floatType, 2), {"TextureUV"}));
    append(state, named(types.vector(types.floatType, 3), {"TextureUVW"}));
    if (chance(40))
      append(state, named(types.floatType, {"dsdu", "dtdu", "dsdv", "dtdv", "du", "dv"}));
    Context rules;
    rules.rand = rules.lookup = true;
    addMethod(*plan, *members, "lookup", state,
              "rt_TextureColor = toColor(h); rt_FloatTextureValue = toUnit(h); ", 1 + below(3),
              rules);
    Node &body = *members->children.back()->children[0];
    body.children.insert(body.children.begin(),
                         makeNode(Role::Statement,
                                  "rt_TextureColor = color(0.5); rt_FloatTextureValue = 0.25;"));
  }
  program.textures.push_back(plan->name);
  return plan;
}

void Generator::makeMiss(const std::vector<const ClassPlan *> &) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Miss", "rt_Miss", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  const unsigned traces = program.traces && chance(50) ? 2 : 0;
  if (chance(40))
    addFunction(*plan, *members, false, traces);
  std::vector<Variable> state = named(types.vector(types.floatType, 3),
                                      {"RayOrigin", "RayDirection", "InverseRayDirection"});
  append(state, named(types.color, {"SampleColor"}, true));
  Context rules;
  rules.rand = true;
  rules.traces = traces;
  rules.print = true;
  addMethod(*plan, *members, "miss", state, toColor, 1 + below(4), rules);
  state.erase(state.end() - 1);
  for (const Type *payload : payloads)
    if (chance(70))
      addPayloadMethod(*plan, *members, "miss", payload, state, rules);
  program.miss = plan->name;
}

const ClassPlan *Generator::makeMaterial(const ClassPlan *base,
                                         const std::vector<const ClassPlan *> &targets) {
  const Type *vec3 = types.vector(types.floatType, 3);
  Node *members = nullptr;
  ClassPlan *plan = startClass("Material", "rt_Material", base, members);
  addMembers(*plan, *members, some(below(4)));
  addReferences(*plan, *members, targets);
  if (!base) {
    for (const Variable &attribute : attributes)
      if (chance(50)) {
        members->children.push_back(makeNode(
            Role::Fixed, "scratch " + toString(attribute.type) + " " + attribute.name + ";"));
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
  if (!base || chance(60)) {
    std::vector<Variable> state = named(vec3, {"RayOrigin", "RayDirection", "HitPoint",
                                               "GeometricNormal", "ShadingNormal"});
    if (chance(20))
      append(state, named(vec3, {"InverseRayDirection", "dPdu", "dPdv", "TextureUVW"}));
    if (chance(30))
      append(state, named(types.vector(types.floatType, 2), {"TextureUV"}));
    append(state, named(types.floatType, {"HitDistance"}));
    append(state, named(types.intType, {"PrimitiveIndex", "InstanceIndex"}));
    append(state, named(types.color, {"SampleColor"}, true));
    append(state, plan->scratch);
    for (std::size_t i = state.size() - plan->scratch.size(); i != state.size(); ++i)
      state[i].writable = false;
    Context rules;
    rules.rand = rules.lookup = true;
    rules.illuminance = chance(50);
    rules.print = true;
    rules.traces = traces;
    addMethod(*plan, *members, "shade", state, toColor, 4 + below(6), rules);
    rules.illuminance = false;
    state.erase(std::find_if(state.begin(), state.end(), [](const Variable &each) { return each.writable; }));
    for (const Type *payload : payloads) {
      rules.traces = traces / 2;
      if (chance(80))
        addPayloadMethod(*plan, *members, "closestHit", payload, state, rules);
      rules.traces = 0;
      if (chance(50))
        addPayloadMethod(*plan, *members, "anyHit", payload, state, rules);
    }
  }
  if (!base || chance(40))
    addBsdf(*plan, *members);
  program.materials.push_back(plan->name);
  if (plan->scratch.empty())
    program.meshMaterials.push_back(plan->name);
  return plan;
}

/// What who samples a surface asks of its material.
void Generator::addBsdf(const ClassPlan &plan, Node &members) {
  if (!likely(40))
    return;
  const Type *vec3 = types.vector(types.floatType, 3);
  std::vector<Variable> read = named(vec3, {"RayDirection", "HitPoint", "GeometricNormal", "ShadingNormal"});
  append(read, named(types.vector(types.floatType, 2), {"TextureUV"}));
  append(read, plan.scratch);
  for (Variable &variable : read)
    variable.writable = false;
  Context rules;
  rules.rand = rules.lookup = rules.print = true;
  auto add = [&](const char *name, std::vector<Variable> state, const std::string &result) {
    append(state, read);
    addMethod(plan, members, name, std::move(state), result, 1 + below(3), rules);
  };
  std::vector<Variable> sampled = named(types.color, {"BSDFValue"}, true);
  append(sampled, named(vec3, {"LightDirection"}, true));
  append(sampled, named(types.floatType, {"PDF"}, true));
  append(sampled, named(types.vector(types.floatType, 2), {"BSDFSeed"}));
  add("sampleBSDF", sampled, "rt_LightDirection = toVector(h); rt_BSDFValue = toColor(h); rt_PDF = toUnit(h); ");
  std::vector<Variable> evaluated = named(types.color, {"BSDFValue"}, true);
  append(evaluated, named(vec3, {"LightDirection"}));
  add("BSDF", evaluated, "rt_BSDFValue = toColor(h); ");
  evaluated = named(types.floatType, {"PDF"}, true);
  append(evaluated, named(vec3, {"LightDirection"}));
  add("evaluatePDF", evaluated, "rt_PDF = toUnit(h); ");
  if (chance(50))
    add("emission", named(types.color, {"EmissionColor"}, true), "rt_EmissionColor = toColor(h); ");
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
  makeCamera();
  makePrimitive(nullptr);
  if (likely(30))
    makePrimitive(plans.back().get());
  if (chance(50))
    makeLight();

  std::vector<const ClassPlan *> textures;
  if (likely(80)) {
    textures.push_back(makeTexture(nullptr, {}));
    if (likely(70))
      makeTexture(textures[0], {});
    if (likely(40))
      textures.push_back(makeTexture(nullptr, {textures[0]}));
  }
  const ClassPlan *first = makeMaterial(nullptr, textures);
  if (likely(60))
    makeMaterial(first, {});
  if (likely(50)) {
    std::vector<const ClassPlan *> targets = textures;
    targets.push_back(first);
    makeMaterial(nullptr, targets);
  }
  if (likely(80))
    makeMiss(textures);
}

} // namespace rtsl::random
