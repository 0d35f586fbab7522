//===- RayTypesTest.cpp - who answers which payload, and in which order ---===//
#include "Linked.h"

#include "runtime/device/ray/Abi.h"

namespace rtsl {
namespace {

/// A scene with these materials in which the ray generation sends a `Shadow`. Returns `how` of its
/// ray.
std::uint32_t howToSearch(const std::string &materials, std::vector<std::string> classes,
                          std::uint32_t features = 0) {
  classes.push_back("Eye");
  Linked linked(R"(
struct Shadow { float light; bool isLit; vec2 parts[2]; };
class Eye : rt_RayGeneration {
  void generate() {
    Shadow s = Shadow(1.0, false, vec2[](vec2(0.0), vec2(0.0)));
    trace(vec3(0.0), vec3(1.0), 0.0, 1.0, s);
    rt_SampleColor = color(s.light);
  }
};
)" + materials,
                {classes, {}, {}, {}, {}, {}, true, runtime::Engine::Programs, features});
  EXPECT_TRUE(linked.succeeded);
  std::uint32_t how = ~0u;
  if (linked.succeeded)
    linked.ir->walk([&](ir::TracePayloadOp trace) { how = trace.getHow().value_or(~0u); });
  return how;
}

std::string material(const std::string &anyHit, const std::string &more = "") {
  return "class M : rt_Material { public float opacity; void anyHit(inout Shadow s) {" + anyHit +
         "} " + more + " };";
}

constexpr std::uint32_t invoke = RTSL_INVOKE_ANY_HIT, first = RTSL_FIRST_HIT,
                        inOrder = RTSL_IN_ORDER;

TEST(RayTypes, WhoAnswersDecidesWhatIsSearched) {
  EXPECT_EQ(
      howToSearch("class M : rt_Material { void closestHit(inout Shadow s) { s.light = 0.0; } };",
                  {"M"}),
      0u);
  EXPECT_EQ(
      howToSearch("class M : rt_Miss { void miss(inout Shadow s) { s.isLit = true; } };", {"M"}),
      first);
}

TEST(RayTypes, OrderDoesNotShowWhereNothingIsWritten) {
  const std::string refuse = "if (opacity < 0.5) ignoreIntersection();";
  const std::string closest = "void closestHit(inout Shadow s) { s.light = rt_HitDistance; }";
  EXPECT_EQ(howToSearch(material(refuse), {"M"}), invoke | first);
  EXPECT_EQ(howToSearch(material(refuse, closest), {"M"}), invoke);
  EXPECT_EQ(howToSearch(material("if (s.light < 0.5) ignoreIntersection();", closest), {"M"}),
            invoke);
  EXPECT_EQ(howToSearch(material(refuse + "terminateRay();"), {"M"}), invoke | first);
  // Whoever terminates would choose which hit is the nearest.
  EXPECT_EQ(howToSearch(material(refuse + "terminateRay();", closest), {"M"}), invoke | inOrder);
  EXPECT_EQ(howToSearch(material("if (rand() < opacity) ignoreIntersection();"), {"M"}),
            invoke | first | inOrder);
}

TEST(RayTypes, OrderShowsWhereSamplesMayEnd) {
  const std::string refuse = "if (s.parts[int(rt_HitDistance)].x < 0.5) ignoreIntersection();";
  const std::string closest = "void closestHit(inout Shadow s) { s.light = rt_HitDistance; }";
  EXPECT_EQ(howToSearch(material(refuse, closest), {"M"}), invoke);
  EXPECT_EQ(howToSearch(material(refuse, closest), {"M"}, RTSL_FEATURE_EXCEPTIONS),
            invoke | inOrder);
}

TEST(RayTypes, OrderShowsInWhatIsWritten) {
  EXPECT_EQ(howToSearch(material("s.light *= opacity; ignoreIntersection();"), {"M"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material("s.parts[0].x = 1.0; ignoreIntersection();"), {"M"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material("darken(s); ignoreIntersection();",
                                 "void darken(inout Shadow s) { s.light = 0.0; }"),
                        {"M"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material("Shadow t = s; t.light = 0.0; s = t; terminateRay();"), {"M"}),
            invoke | first | inOrder);
}

TEST(RayTypes, SameConstantsAndTheEndShowNoOrder) {
  const std::string end = "s.light = 0.0; s.parts[1] = vec2(1.0); terminateRay();";
  EXPECT_EQ(howToSearch(material(end), {"M"}), invoke | first);
  EXPECT_EQ(howToSearch(material("if (opacity < 0.5) ignoreIntersection();" + end), {"M"}),
            invoke | first);
  // One way through accepts without writing.
  EXPECT_EQ(howToSearch(material("if (opacity > 0.5) {" + end + "}"), {"M"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material("s.light = opacity; terminateRay();"), {"M"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material("s.light = 0.0; ignoreIntersection();"), {"M"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material("if (opacity < 0.5) { s.light = 0.0; terminateRay(); } s.light = "
                                 "1.0; terminateRay();"),
                        {"M"}),
            invoke | first | inOrder);
  // An array is written at a place that is not known.
  EXPECT_EQ(howToSearch(material("s.parts[int(opacity)] = vec2(1.0); terminateRay();"), {"M"}),
            invoke | first | inOrder);
  // So does another class, in the same way or in another; or it accepts without an `anyHit`.
  const std::string other = "class N : rt_Material { void anyHit(inout Shadow s) {";
  EXPECT_EQ(howToSearch(material(end) + other + end + "} };", {"M", "N"}), invoke | first);
  EXPECT_EQ(howToSearch(material(end) + other +
                            "s.light = 0.5; s.parts[1] = vec2(1.0); terminateRay(); } };",
                        {"M", "N"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material(end) + "class N : rt_Material { void shade() {} };", {"M", "N"}),
            invoke | first | inOrder);
  EXPECT_EQ(howToSearch(material(end) + "class N : rt_Material { void shade() {} };", {"M"}),
            invoke | first);
}

TEST(RayTypes, ARayTypeWithoutProgramsIsAWarning) {
  Linked linked(R"(
struct Lost { float x; };
class Eye : rt_RayGeneration {
  void generate() { Lost l = Lost(0.5); trace(vec3(0.0), vec3(1.0), 0.0, 1.0, l); rt_SampleColor = color(l.x); }
};)",
                {{"Eye"}, {}, {}, {}, {}, {}, true, runtime::Engine::Programs});
  EXPECT_TRUE(linked.succeeded);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u) << renderText(linked.diagnostics, false);
  EXPECT_EQ(linked.diagnostics.all()[0].code, Code::rayTypeUnanswered);
  EXPECT_EQ(linked.diagnostics.sources().text(linked.diagnostics.all()[0].range), "Lost");
}

TEST(RayTypes, AMaterialThatNoDefaultClassFitsIsAWarning) {
  Linked linked(
      R"(
struct Seen { float x; };
default class Reflects : rt_Material { void BSDF(); void evaluatePDF(); void closestHit(inout Seen s) {} };
default class Surface : rt_Material { void answer(); void closestHit(inout Seen s) { answer(); } };
default class Scatters : Surface { void sampleBSDF(); void answer() {} };
default class Both : rt_Material { void sampleBSDF(); void shade(); void closestHit(inout Seen s) {} };
default class Leaves : rt_Miss { void miss(); void miss(inout Seen s) {} };
class Lost : rt_Material { void shade() { rt_SampleColor = color(1.0); } };
class Unused : rt_Material { void shade() { rt_SampleColor = color(1.0); } };
class Own : rt_Material { void closestHit(inout Seen s) { s.x = 1.0; } };
class Fits : rt_Material { void sampleBSDF() { rt_PDF = 0.0; } };
class Eye : rt_RayGeneration {
  void generate() { Seen s = Seen(0.5); trace(vec3(0.0), vec3(1.0), 0.0, 1.0, s); rt_SampleColor = color(s.x); }
};)",
      {{"Eye", "Lost", "Own", "Fits"}, {}, {}, {}, {}, {}, true, runtime::Engine::Programs});
  EXPECT_TRUE(linked.succeeded);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u) << renderText(linked.diagnostics, false);
  EXPECT_EQ(linked.diagnostics.all()[0].code, Code::materialUnanswered);
  EXPECT_EQ(linked.diagnostics.sources().text(linked.diagnostics.all()[0].range), "Lost");
  EXPECT_EQ(linked.diagnostics.all()[0].message,
            "rays with the payload `Seen` do nothing where they hit `Lost`, which does not define "
            "`BSDF` and `evaluatePDF`, nor `sampleBSDF`");
}

TEST(RayTypes, DefaultClassesThatAreKeptAreNoMaterials) {
  LinkRequest request{{"Eye", "Own"}, {}, {}, {}, {}, {}, true, runtime::Engine::Programs};
  request.keep = ItemSet::all();
  Linked linked(R"(
struct Seen { float x; };
default class Surface : rt_Material { void shade(); void closestHit(inout Seen s) {} };
default class Scatters : rt_Material { void sampleBSDF(); };
class Own : rt_Material { void shade() {} };
class Eye : rt_RayGeneration {
  void generate() { Seen s = Seen(0.5); trace(vec3(0.0), vec3(1.0), 0.0, 1.0, s); rt_SampleColor = color(s.x); }
};)",
                request);
  EXPECT_TRUE(linked.succeeded);
  EXPECT_TRUE(linked.diagnostics.all().empty()) << renderText(linked.diagnostics, false);
}

TEST(RayTypes, EachTypeHasItsPrograms) {
  Linked linked(R"(
struct A { float x; };
struct B { float x; };
class Eye : rt_RayGeneration {
  void generate() {
    A a = A(0.0);
    B b = B(0.0);
    trace(vec3(0.0), vec3(1.0), 0.0, 1.0, a);
    trace(vec3(0.0), vec3(1.0), 0.0, 1.0, b);
  }
};
class M : rt_Material {
  void closestHit(inout A a) { a.x = 1.0; }
  void anyHit(inout B b) { ignoreIntersection(); }
};
class N : rt_Material {
  void closestHit(inout A a) { a.x = 2.0; }
  void closestHit(inout B b) { b.x = 3.0; }
};)",
                {{"Eye", "M", "N"}, {}, {}, {}, {}, {}, true, runtime::Engine::Programs});
  ASSERT_TRUE(linked.succeeded);
  EXPECT_EQ(linked.callees("rtsl_rt_Material_closestHit_payload"),
            (std::vector<std::string>{"dispatch.rt_Material.closestHit.A",
                                      "dispatch.rt_Material.closestHit.B"}));
  EXPECT_EQ(linked.callees("dispatch.rt_Material.closestHit.A"),
            (std::vector<std::string>{"M.closestHit.A", "N.closestHit.A"}));
  EXPECT_EQ(linked.callees("dispatch.rt_Material.closestHit.B"),
            (std::vector<std::string>{"N.closestHit.B"}));
  EXPECT_EQ(linked.callees("rtsl_rt_Material_anyHit_payload"),
            (std::vector<std::string>{"dispatch.rt_Material.anyHit.B"}));
  EXPECT_TRUE(linked.callees("rtsl_rt_Miss_miss_payload").empty());
  EXPECT_EQ(linked.classInfo("M").anyHit, rtslRayTypeBit(2));
  EXPECT_EQ(linked.classInfo("N").anyHit, 0u);
}

} // namespace
} // namespace rtsl
