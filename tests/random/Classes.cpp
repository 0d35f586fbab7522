//===- Classes.cpp - the classes of a scene -------------------------------===//
#include "Generator.h"

#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl::random {

static const char *const toColor = "rt_SampleColor = toColor(h); ";

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
  if (!base)
    plan->square = chance(lit ? 85 : 20) ? std::string(1, "xyz"[below(3)]) : "";
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
        body.children.push_back(
            makeNode(Role::Statement,
                     !plan->square.empty()
                         ? meetsSquare(plan->square)
                         : std::string("bool won = (h & 3u) != 0u && hit(") + t + error + ");"));
      } else if (plan->square.empty()) {
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
      (plan->square.empty()
           ? "rt_GeometricNormal = toVector(h); "
           : "rt_GeometricNormal = vec3(0.0); rt_GeometricNormal." + plan->square + " = 1.0; ") +
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
  if (plan->square.empty() ? likely(25) : !base || chance(30))
    addSamples(*plan, *members);
  if (likely(50))
    add("computeBounds", {}, "rt_BoundMin = toVector(h); rt_BoundMax = toVector(h * 3u); ",
        below(2));
  program.primitives.push_back(plan->name);
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
    addRecursion(*plan, *members, types.floatType);
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
  addImage(*plan, *members);
  if (!base && chance(50))
    addConstructor(*plan, *members);
  if (!base && chance(30))
    addRecursion(*plan, *members, types.floatType);
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

/// What a sample is that an exception has ended.
void Generator::makeException(const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Exception", "rt_Exception", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  addReferences(*plan, *members, someOf(targets));
  addMethod(*plan, *members, "exception", {},
            "h = hash_int(h, rt_ExceptionCode); " + std::string(toColor), 1 + below(2), Context());
  program.exception = plan->name;
}

/// What sends the first rays, and writes elements of output buffers between them.
void Generator::makeRayGeneration(const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("RayGeneration", "rt_RayGeneration", nullptr, members);
  addMembers(*plan, *members, some(below(3)));
  addReferences(*plan, *members, someOf(targets));
  for (unsigned n = 1 + below(3); n-- > 0;) {
    const std::string name = fresh("b");
    const unsigned rank = 1 + below(3);
    const Type *element = plan->outputs.empty() || chance(30) ? types.color
                          : chance(40)                        ? vocabulary.scalars[1 + below(2)]
                                                              : smallType();
    std::string text = "public inout " + toString(element) + " " + name;
    for (unsigned i = 0; i != rank; ++i)
      text += "[]";
    members->children.push_back(makeNode(Role::Fixed, text + ";"));
    plan->outputs.push_back({name, types.buffer(element, rank), true});
  }
  Context rules;
  rules.print = true;
  rules.traces = program.traces ? 4 : 0;
  addMethod(*plan, *members, "generate", {}, toColor, 4 + below(6), rules);
  // First the camera's ray, which nearly always meets something, for an element that some pixels
  // have and others have not.
  const Variable &first = plan->outputs.front();
  if (program.traces && first.type->element == types.color) {
    std::string element = first.name;
    for (unsigned i = 0; i != first.type->count; ++i)
      element += program.inRange || i != 0
                     ? "[rt_LaunchIndex.x % uint(" + element + ".length())]"
                     : "[int(rt_LaunchIndex.x) - " + std::to_string(below(3)) + "]";
    Node &body = *members->children.back()->children[0];
    body.children.insert(
        body.children.begin() + 1,
        makeNode(Role::Statement, element + " = trace(rt_RayOrigin, rt_RayDirection);"));
  }
  program.rayGeneration = plan->name;
}

const ClassPlan *Generator::makeMaterial(const ClassPlan *base, const Targets &targets) {
  Node *members = nullptr;
  ClassPlan *plan = startClass("Material", "rt_Material", base, members);
  addMembers(*plan, *members, some(below(4)));
  addReferences(*plan, *members, targets);
  addImage(*plan, *members);
  if (!base) {
    for (const Variable &attribute : attributes)
      if (chance(lit ? 25 : 50)) { // a mesh, which has none, may shine
        members->children.push_back(makeNode(Role::Fixed, "scratch " + toString(attribute.type) +
                                                              " " + attribute.name + ";"));
        plan->scratch.push_back(attribute);
      }
    if (chance(40))
      addConstructor(*plan, *members);
  }
  const unsigned traces = program.traces ? 4 : 0;
  if (!base && likely(30)) // at most so many rays, for a chain of objects
    addRecursion(*plan, *members, types.color, traces);
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
    rules.illuminance = lit || chance(50);
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

void Generator::makeClasses() {
  for (unsigned n = below(4), words = 0; n-- > 0;) {
    const Type *type = smallType();
    words += type->is(TypeKind::Color) ? program.colorComponents : type->componentCount();
    if (contains(type, TypeKind::Float)) // and its changes
      words += 2 * type->componentCount();
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
  if (program.raises && chance(70))
    makeException(helpers);
  if (generates(program.seed))
    makeRayGeneration(textures);
  if (usesPathTracer(program.seed))
    makePathTracer();
}

} // namespace rtsl::random
