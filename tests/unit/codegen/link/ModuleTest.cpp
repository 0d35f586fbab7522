//===- ModuleTest.cpp - what is known of a module without a scene ---------===//
#include "codegen/ir/Rtsl.h"
#include "codegen/link/LinkModule.h"
#include "codegen/lower/Lower.h"
#include "frontend/syntax/Parser.h"
#include "runtime/device/ray/Abi.h"
#include "sema/Sema.h"

#include "mlir/IR/MLIRContext.h"

#include <gtest/gtest.h>

namespace rtsl {
namespace {

/// RTSL text, lowered and linked as the whole of a program.
class LinkedModule {
public:
  explicit LinkedModule(std::string source) {
    unit = parse(sources.add("test.rtsl", std::move(source)), diagnostics);
    module =
        check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    EXPECT_FALSE(diagnostics.hasErrors()) << renderText(diagnostics, false);
    LowerOptions options;
    options.diagnostics = &diagnostics;
    mlir::MLIRContext context;
    const auto ir = lower(*module, options, context);
    EXPECT_TRUE(ir) << renderText(diagnostics, false);
    facts = linkModule(*ir, *module, diagnostics, FloatingPoint::Strict);
  }

  const typed::Class &find(const std::string &name) const {
    for (const auto &definition : module->classes)
      if (definition->name == name)
        return *definition;
    throw std::out_of_range(name);
  }
  std::uint32_t needsOf(const std::string &name) const {
    return facts->needsOfClass.at(&find(name));
  }
  /// Where a scratch member lies; -1: it has no place.
  int wordOf(const std::string &className, const std::string &name) const {
    for (const auto &member : find(className).members)
      if (const auto found = facts->attributeWords.find(member.get());
          member->name == name && found != facts->attributeWords.end())
        return static_cast<int>(found->second);
    return -1;
  }
  std::vector<std::string> rayTypes() const {
    std::vector<std::string> names;
    for (const RayTypeFacts &type : facts->rayTypes)
      names.push_back(type.payload->name);
    return names;
  }

  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  std::optional<ModuleFacts> facts;
};

TEST(LinkModule, EachClassNeedsWhatItsOwnMethodsRead) {
  const LinkedModule linked(R"(
class Stripes : rt_Texture { void lookup() { rt_TextureColor = color(rt_TextureUV.x); } };
class Matte : rt_Material {
  public rt_Texture albedo;
  void shade() { rt_SampleColor = albedo.lookup(); }
};
class Mirror : rt_Material {
  void shade() { rt_SampleColor = trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal)); }
};
class Lamp : rt_Light { void illumination() { rt_LightColor = color(rt_Time); } };
class Lit : rt_Material {
  void shade() { illuminance (rt_HitPoint) rt_SampleColor += rt_LightColor; }
};
)");
  const std::uint32_t ofRays = RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS;
  EXPECT_EQ(linked.needsOf("Stripes"), RTSL_NEEDS_TEXTURE_COORDINATES);
  EXPECT_EQ(linked.needsOf("Matte"), 0u); // the scene determines the textures
  EXPECT_EQ(linked.needsOf("Mirror"), ofRays);
  EXPECT_EQ(linked.needsOf("Lit"), ofRays | RTSL_NEEDS_TIME);
  EXPECT_EQ(linked.facts->needs, RTSL_NEEDS_TEXTURE_COORDINATES | RTSL_NEEDS_TIME | ofRays);
}

TEST(LinkModule, NothingIsLeftOut) {
  // No ray starts any of this, and no reference leads to it.
  const LinkedModule linked(R"(
struct Glow { color light; };
class Alone : rt_Material {
  public Alone other;
  void closestHit(inout Glow g) { g.light = color(rt_Time); }
  float height() { return rt_dPdu.x; }
};
class Below : Alone { float depth() { return other.height(); } };
)");
  EXPECT_EQ(linked.needsOf("Alone"), RTSL_NEEDS_TIME | RTSL_NEEDS_DERIVATIVES);
  EXPECT_EQ(linked.rayTypes(), std::vector<std::string>{"Glow"});
}

TEST(LinkModule, RaysThatAreTracedHaveTheFirstNumbers) {
  const LinkedModule linked(R"(
struct Answered { float a; };
struct Traced { float a; };
class M : rt_Material {
  void closestHit(inout Answered a) { a.a = 1.0; }
  void anyHit(inout Traced t) { if (rt_HitDistance < 1.0) ignoreIntersection(); }
};
class Eye : rt_RayGeneration {
  void generate() {
    Traced t = Traced(0.0);
    trace(vec3(0.0), vec3(1.0), 0.0, 1.0, t);
    rt_SampleColor = color(t.a);
  }
};
)");
  EXPECT_EQ(linked.rayTypes(), (std::vector<std::string>{"Traced", "Answered"}));
  EXPECT_EQ(linked.facts->rayTypes[0].search, RTSL_FIRST_HIT | RTSL_INVOKE_ANY_HIT);
  EXPECT_EQ(linked.facts->rayTypes[1].search, 0u);
  EXPECT_EQ(linked.facts->needs & RTSL_NEEDS_ANY_HIT, RTSL_NEEDS_ANY_HIT);
  EXPECT_TRUE(linked.diagnostics.all().empty());
}

TEST(LinkModule, ClassesOfOneFamilyShareNoAttribute) {
  const LinkedModule linked(R"(
class Base : rt_Primitive {
  scratch vec3 n;
  void intersect() { n = rt_RayDirection; hit(1.0); }
  void computeNormal() { rt_GeometricNormal = n; }
};
class One : Base { scratch float a; void intersect() { a = 1.0; hit(1.0); } };
class Two : Base { scratch float b; void intersect() { b = 1.0; hit(1.0); } };
class Other : rt_Primitive { scratch float a, c; void intersect() { a = 1.0; c = 2.0; hit(1.0); } };
class Reads : rt_Material { scratch float a; void shade() { rt_SampleColor = color(a); } };
)");
  EXPECT_EQ(linked.wordOf("One", "a"), linked.wordOf("Other", "a"));
  EXPECT_EQ(linked.wordOf("One", "a"), linked.wordOf("Reads", "a"));
  const std::set<int> ofFamily = {linked.wordOf("Base", "n"), linked.wordOf("One", "a"),
                                  linked.wordOf("Two", "b")};
  EXPECT_EQ(ofFamily.size(), 3u);
  EXPECT_GE(*ofFamily.begin(), 0);
  EXPECT_NE(linked.wordOf("Other", "c"), linked.wordOf("Other", "a"));
}

constexpr const char *wide = R"(
class Wide : rt_Primitive {
  scratch mat4 unread, a, b;
  void intersect() { unread = mat4(1.0); a = unread; b = a; hit(1.0); }
};
)";

TEST(LinkModule, UnreadOutputsAreRemoved) {
  const LinkedModule linked(std::string(wide) + R"(
class Reads : rt_Material {
  scratch mat4 a, b;
  void shade() { rt_SampleColor = color(a[0].x + b[0].x); }
};
)");
  ASSERT_TRUE(linked.facts);
  EXPECT_EQ(linked.wordOf("Wide", "unread"), -1);
  EXPECT_EQ(std::min(linked.wordOf("Wide", "a"), linked.wordOf("Wide", "b")), 0);
}

TEST(LinkModule, MoreAttributesThanARayCarriesAreRefusedWhereTheyStand) {
  const LinkedModule linked(std::string(wide) + R"(
class Reads : rt_Material {
  scratch mat4 unread, a, b;
  void shade() { rt_SampleColor = color(a[0].x + b[0].x + unread[0].x); }
};
)");
  EXPECT_FALSE(linked.facts);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u);
  EXPECT_EQ(linked.diagnostics.all().front().code, Code::attributesTooLarge);
  EXPECT_TRUE(linked.diagnostics.all().front().range.isValid());
}

} // namespace
} // namespace rtsl
