//===- Light.cpp - what sends out light, scatters it and chooses it -------===//
#include "Generator.h"

namespace rtsl::random {

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

/// The distances of the squares of an object from its origin.
static const char *const offset = "0.7 - 1.1 * float(rt_PrimitiveIndex)";

/// Where a ray meets the square that addSamples() chooses points on.
std::string Generator::meetsSquare(const std::string &normal) {
  const std::string others = normal == "x" ? "yz" : normal == "y" ? "xz" : "xy";
  return "float t = (" + std::string(offset) + " - rt_RayOrigin." + normal +
         ") / rt_RayDirection." + normal + "; vec2 at = abs((rt_RayOrigin + t * rt_RayDirection)." +
         others + "); bool won = (h & 7u) != 0u && max(at.x, at.y) < 2.0 && hit(t);";
}

/// How a primitive chooses points on itself: a square evenly, and where rays meet it; other ones as
/// they like.
void Generator::addSamples(ClassPlan &plan, Node &members) {
  const bool isSquare = !plan.square.empty();
  const std::string point = "rt_HitPoint = vec3(4.0 * toUnit(h) - 2.0, 4.0 * toUnit(h * "
                            "2654435761u) - 2.0, 4.0 * toUnit(h * 5u) - 2.0); rt_HitPoint.";
  addMethod(plan, members, "generateSample", {},
            isSquare ? point + plan.square + " = " + offset + "; rt_GeometricNormal = vec3(0.0); " +
                           "rt_GeometricNormal." + plan.square + " = 1.0; rt_PDF = 0.0625; "
                     : "rt_HitPoint = toVector(h); rt_GeometricNormal = toVector(h * 7u); rt_PDF = "
                       "toUnit(h); ",
            1 + below(2), Context());
  if (chance(80))
    members.children.back()->children[0]->children.push_back(
        makeNode(Role::Statement, "h = hash_float(h, rand());"));
  addMethod(plan, members, "samplePDF", {}, isSquare ? "rt_PDF = 0.0625; " : "rt_PDF = toUnit(h); ",
            below(2), Context());
}

/// What sampling a surface queries of its material. The methods of most do not agree; some scatter
/// light alike in all directions, and some only shine.
void Generator::addBsdf(ClassPlan &plan, Node &members) {
  if (!lit && !likely(40))
    return;
  std::vector<Variable> attributesOfHit = plan.scratch;
  for (Variable &attribute : attributesOfHit)
    attribute.writable = false;
  Context rules;
  rules.print = true;
  auto add = [&](const char *name, const std::string &result) {
    addMethod(plan, members, name, attributesOfHit, result, some(1 + below(3)), rules);
  };
  const bool agrees = chance(30), onlyShines = lit && chance(20);
  const std::string evenly = "rt_PDF = 0.079577472; ";
  if (!onlyShines && chance(85))
    add("sampleBSDF",
        agrees ? "float z = 1.0 - 2.0 * rt_BSDFSeed.x, r = sqrt(max(0.0, 1.0 - z * z)), a = "
                 "6.2831853 * rt_BSDFSeed.y; rt_LightDirection = vec3(r * cos(a), r * sin(a), z); "
                 "rt_BSDFValue = color(0.125); " +
                     evenly
               : "rt_LightDirection = toVector(h); rt_BSDFValue = toColor(h); " +
                     std::string(chance(60) ? "rt_PDF = toUnit(h); "
                                            : "rt_PDF = (h & 12u) == 0u ? 0.0 : (h & 16u) == 0u ? "
                                              "toUnit(h) : -toUnit(h * 3u); "));
  if (!onlyShines && chance(90))
    add("BSDF", agrees ? "rt_BSDFValue = color(0.125); " : "rt_BSDFValue = toColor(h); ");
  if (!onlyShines && chance(85))
    add("evaluatePDF", agrees ? evenly : "rt_PDF = toUnit(h); ");
  if (onlyShines || chance(lit ? 80 : 50))
    add("emission", chance(50) ? "rt_EmissionColor = toColor(h); "
                               : "rt_EmissionColor = (h & 3u) == 0u ? color(0.0) : toColor(h); ");
  if (chance(lit ? 25 : 50))
    add("transmittance", "rt_SampleColor = toColor(h); ");
  if (usesPathTracer(program.seed) && chance(30)) // which the engine queries
    members.children.push_back(makeNode(
        Role::Fixed, "bool isTransmissive() { return " +
                         std::string(chance(50) ? "false" : "rt_HitPoint.x > 0.0") + "; }"));
}

/// The ray generation of the engine `path`.
void Generator::makePathTracer() {
  program.rayGeneration = global("RayGeneration");
  NodePtr members = makeList();
  if (chance(40))
    members->children.push_back(makeNode(
        Role::Fixed, "void begin(inout PathRay path) { path.weight *= color(1.0, 1.5, 0.75); "
                     "path.light = color(rt_ScreenCoord.x); }"));
  program.tree->children.push_back(makeNode(
      Role::Fixed, "class " + program.rayGeneration + " : PathTracer {$};", std::move(members)));
}

} // namespace rtsl::random
