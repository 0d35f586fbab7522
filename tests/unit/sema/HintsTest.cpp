//===- HintsTest.cpp - labels, notes and fixes ----------------------------===//
//
// What stands beside a message: where else to look, what was expected, and edits that mend the
// mistake. Each fix is applied, and the text that comes out is checked again.
//
//===----------------------------------------------------------------------===//
#include "Harness.h"

#include "sema/check/Suggest.h"
#include "sema/model/ClassModel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace rtsl;
using namespace rtsl::test;

namespace {

/// The text after the first fix of its only message.
std::string fixed(const std::string &text) {
  const std::unique_ptr<Checked> checked = checkText(text);
  if (checked->diagnostics.all().size() != 1 || checked->diagnostics.all()[0].fixes.empty())
    return "no single fix:\n" + render(*checked);
  const Fix &fix = checked->diagnostics.all()[0].fixes[0];
  std::string result = text;
  return result.replace(fix.range.begin, fix.range.end - fix.range.begin, fix.replacement);
}

void expectFix(const std::string &before, const std::string &after) {
  EXPECT_EQ(fixed(before), after);
  EXPECT_EQ(render(*checkText(after)), "");
}

/// Everything in the first message except its text.
std::string hints(const std::string &text) {
  const std::unique_ptr<Checked> checked = checkText(text);
  std::string result;
  for (const Diagnostic &diagnostic : checked->diagnostics.all()) {
    for (const Label &label : diagnostic.labels)
      result += std::string(checked->sources.text(label.range)) + ": " + label.text + "\n";
    for (const std::string &note : diagnostic.notes)
      result += note + "\n";
  }
  return result;
}

/// The text with all sure fixes of all messages applied, which leaves nothing to fix.
std::string mended(const std::string &text) {
  const std::unique_ptr<Checked> checked = checkText(text);
  const FixedText result = applyFixes(checked->diagnostics, checked->files.at("main.rtsl"));
  EXPECT_EQ(result.skipped, 0u);
  const std::unique_ptr<Checked> again = checkText(result.text);
  EXPECT_EQ(applyFixes(again->diagnostics, again->files.at("main.rtsl")).text, result.text)
      << "not at once";
  return result.text;
}

/// `check --fix` turns one into the other, which is right.
void expectMended(const std::string &before, const std::string &after) {
  EXPECT_EQ(mended(before + "\n"), after + "\n");
  EXPECT_EQ(render(*checkText(after)), "");
}

/// `check --fix` does not touch what is only a guess.
void expectLeft(const std::string &text) {
  EXPECT_TRUE(checkText(text)->diagnostics.hasErrors());
  EXPECT_EQ(mended(text + "\n"), text + "\n");
}

TEST(Hints, MistypedNamesAreMended) {
  expectFix("float f(float radius) { return radus; }", "float f(float radius) { return radius; }");
  expectFix("struct Ray { vec3 origin; };\nvec3 f(Ray r) { return r.orign; }",
            "struct Ray { vec3 origin; };\nvec3 f(Ray r) { return r.origin; }");
  expectFix("class A : rt_Primitiv { };", "class A : rt_Primitive { };");
  expectFix("class A : Light { };", "class A : rt_Light { };");
  expectFix("class C : rt_Light; vec3 f() { return HitPoint; }",
            "class C : rt_Light; vec3 f() { return rt_HitPoint; }");
  expectFix("float f(float x) { return Sqrt(x); }", "float f(float x) { return sqrt(x); }");
}

TEST(Hints, OtherLanguagesAreTranslated) {
  expectFix("float f(float3 v) { return v.x; }", "float f(vec3 v) { return v.x; }");
  expectFix("vec3 f(vec3 a) { return lerp(a, a, 0.5); }",
            "vec3 f(vec3 a) { return mix(a, a, 0.5); }");
  expectFix("vec3 f(vec3 a) { return make_float3(1.0, 2.0, 3.0); }",
            "vec3 f(vec3 a) { return vec3(1.0, 2.0, 3.0); }");
  expectFix("float f(float y) { return atan2(y, 2.0); }",
            "float f(float y) { return atan(y, 2.0); }");
  expectFix("double f() { return 1.0; }", "float f() { return 1.0; }");
  EXPECT_EQ(hints("vec3 f(vec3 a) { return saturate(a); }"), "write `clamp(x, 0.0, 1.0)`\n");
  EXPECT_EQ(hints("vec3 f(mat3 m, vec3 a) { return mul(m, a); }"),
            "write `a * b`: it is the product of linear algebra\n");
}

/// A module is added only where it is missing, be it imported by this file or by another one.
TEST(Hints, ModulesAreNotAddedTwice) {
  const std::string noise = "float f(vec3 p) { return noise(p); }\n";
  EXPECT_EQ(hints(noise), "add `import std.noise;`: it has `gradientNoise`, `fractalNoise` and "
                          "`worleyNoise`\n");
  const std::string imported = "`std.noise`, which is imported, has ";
  EXPECT_EQ(hints("import std.noise;\n" + noise +
                  "//=== std.noise\nfloat fractalNoise(vec3 p) { return p.x; }\n"),
            imported + "`gradientNoise`, `fractalNoise` and `worleyNoise`\n");
  EXPECT_EQ(hints("import \"b.rtsl\";\nfloat f(vec3 p) { return fbm(p); }\n"
                  "//=== b.rtsl\nimport std.noise;\nfloat x(vec3 p) { return p.x; }\n"
                  "//=== std.noise\nfloat fractalNoise(vec3 p) { return p.x; }\n"),
            imported + "`fractalNoise`\n");
}

TEST(Hints, WhatCannotStandThereIsNotSuggested) {
  EXPECT_EQ(
      hints("class A : rt_Material { void shade() { discard; rt_SampleColor = color(1.0); } };"),
      "`ignoreIntersection()`, which may be meant, is allowed only in `anyHit` of an "
      "rt_Material\n");
  expectFix(
      "struct P { float x; };\nclass A : rt_Material { void anyHit(inout P p) { discard; } };",
      "struct P { float x; };\nclass A : rt_Material { void anyHit(inout P p) { "
      "ignoreIntersection(); } };");
  EXPECT_EQ(hints("class C : rt_Camera { void generateRay() { rt_RayOrigin = N; } };"),
            "`rt_ShadingNormal`, which may be meant, belongs to rt_Primitive, rt_Material and "
            "rt_Light\n");
  EXPECT_EQ(hints("class C : rt_Camera { void generateRay() { rt_RayOrigin = rt_HitPont; } };"),
            "");
}

TEST(Hints, AuthorsRememberAPartOfAName) {
  const auto shade = [](const std::string &value) {
    return "class A : rt_Material { void shade() { rt_SampleColor = color(" + value + "); } };";
  };
  EXPECT_EQ(hints(shade("rt_Normal.x")), "there are `rt_GeometricNormal`, `rt_ShadingNormal`\n");
  EXPECT_EQ(hints(shade("rt_UV.x")),
            "there are `rt_TextureUV`, `rt_TextureUVW`, `rt_dUVdx`, `rt_dUVdy`, `rt_dUVWdx`, "
            "`rt_dUVWdy`\n");
  EXPECT_EQ(hints(shade("rt_RayDir.x")), "there are `rt_RayDirection`, `rt_InverseRayDirection`\n");
  expectFix(shade("rt_Inverse.x"), shade("rt_InverseRayDirection.x"));
  EXPECT_EQ(hints(shade("rt_Whatever.x")), "");
}

TEST(Hints, ACallWithTooManyArgumentsShowsAllCandidates) {
  EXPECT_EQ(hints("vec3 f(vec3 a) { return reflect(a, a, 1.0); }"),
            "candidate: `float reflect(float, float)`\n"
            "candidate: `vec2 reflect(vec2, vec2)`\n"
            "candidate: `vec3 reflect(vec3, vec3)`\n"
            "candidate: `vec4 reflect(vec4, vec4)`\n");
}

/// The text after every fix of every message, sure or not.
std::string withAllFixes(const Checked &checked, const std::string &text) {
  std::vector<Fix> fixes;
  for (const Diagnostic &diagnostic : checked.diagnostics.all())
    fixes.insert(fixes.end(), diagnostic.fixes.begin(), diagnostic.fixes.end());
  std::stable_sort(fixes.begin(), fixes.end(),
                   [](const Fix &a, const Fix &b) { return a.range.begin > b.range.begin; });
  std::string result = text;
  for (const Fix &fix : fixes)
    result.replace(fix.range.begin, fix.range.end - fix.range.begin, fix.replacement);
  return result;
}

/// Whatever word of another language stands in whatever method: what is suggested in its place may
/// stand there.
TEST(Hints, NoSuggestionIsMisplaced) {
  const std::set<Code> misplaced = {Code::stateNotVisible, Code::stateWithoutRay,
                                    Code::misplacedTrace,  Code::misplacedIlluminance,
                                    Code::misplacedLookup, Code::misplacedCall,
                                    Code::unknownName,     Code::unknownState};
  std::vector<std::string> words = foreignNames();
  for (const std::string &state : stateVariableNames())
    words.insert(words.end(), {state.substr(3), state + "x"});
  for (const char *call :
       {"tracee", "hitt", "ignoreIntersections", "terminateray", "visitChildren", "ramd"})
    words.push_back(call);
  std::size_t suggestions = 0;
  for (const RootModel &root : rootModels())
    for (const MethodModel &method : root.methods)
      for (const std::string &word : words)
        for (const char *form : {"  int unused = int(*);\n", "  *();\n"}) {
          std::string use = form;
          use.replace(use.find('*'), 1, word);
          const bool takesPayload = method.payload == MethodModel::Payload::Required;
          const std::string text = "struct P_ { float x; };\nclass A : " + root.name + " {\nvoid " +
                                   method.name + (takesPayload ? "(inout P_ p)" : "()") + " {\n" +
                                   use + "}\n};\n";
          const std::unique_ptr<Checked> before = checkText(text);
          const std::string after = withAllFixes(*before, text);
          if (after == text)
            continue;
          ++suggestions;
          const std::unique_ptr<Checked> fixed = checkText(after);
          for (const Diagnostic &diagnostic : fixed->diagnostics.all())
            EXPECT_EQ(misplaced.count(diagnostic.code), 0u) << text << after << render(*fixed);
        }
  EXPECT_GT(suggestions, 1000u);
}

/// A declaration with these qualifiers, in one place of each kind.
std::vector<std::string> declarations(const std::string &qualifiers) {
  const bool isConst = qualifiers.find("const") != std::string::npos;
  const std::string value = isConst ? " = 1.0;" : ";", material = "class M : rt_Material";
  return {qualifiers + "float k" + value + "\n",
          material + ";\n" + qualifiers + "float k" + value + "\n",
          material + ";\nvoid shade() { " + qualifiers + "float k = 1.0; k; }\n",
          "struct S { " + qualifiers + "float k; };\n",
          "float f(" + qualifiers + "float k) { return k; }\n",
          qualifiers + "float f(float k) { return k; }\n"};
}

/// Whatever qualifiers stand before whatever declaration: no fix makes another one necessary, or
/// contradicts it.
TEST(Hints, FixesOfQualifiersAgree) {
  std::vector<std::string> all = {""};
  const std::vector<std::string> words = {"public",   "private", "scratch",   "const",
                                          "optional", "in",      "out",       "inout",
                                          "static",   "uniform", "attribute", "constexpr"};
  for (const std::string &first : words) {
    all.push_back(first + " ");
    for (const std::string &second : words)
      all.push_back(first + " " + second + " ");
  }
  const auto countErrors = [](const Checked &checked, const auto &isCounted) {
    const std::vector<Diagnostic> &found = checked.diagnostics.all();
    return std::count_if(found.begin(), found.end(), [&](const Diagnostic &one) {
      return one.severity == Severity::Error && isCounted(one);
    });
  };
  for (const std::string &qualifiers : all)
    for (const std::string &text : declarations(qualifiers)) {
      const std::unique_ptr<Checked> before = checkText(text);
      const std::string after = withAllFixes(*before, text);
      const std::unique_ptr<Checked> fixed = checkText(after);
      const auto withoutFix =
          countErrors(*before, [](const auto &one) { return one.fixes.empty(); });
      EXPECT_LE(countErrors(*fixed, [](const auto &) { return true; }), withoutFix)
          << text << render(*before) << after << render(*fixed);
    }
}

TEST(Hints, ConversionsAreWrittenOut) {
  expectFix("int f(float x) { return x; }", "int f(float x) { return int(x); }");
  expectFix("vec2 f(vec4 v) { return v; }", "vec2 f(vec4 v) { return v.xy; }");
  expectFix("vec3 f(float x) { return x; }", "vec3 f(float x) { return vec3(x); }");
  expectFix("color f(float x) { return x; }", "color f(float x) { return color(x); }");
  expectFix("color f() { return (0.8, 0.5, 0.2); }", "color f() { return color(0.8, 0.5, 0.2); }");
  expectFix("vec3 f() { return (0.8, 0.5, 0.2); }", "vec3 f() { return vec3(0.8, 0.5, 0.2); }");
  expectFix("color f(vec3 v) { return v; }", "color f(vec3 v) { return color(v.r, v.g, v.b); }");
  expectFix("color f(vec3 v) { return color(v); }",
            "color f(vec3 v) { return color(v.r, v.g, v.b); }");
  expectFix("float f(color c) { return c; }", "float f(color c) { return luminance(c); }");
  expectFix("float f(color c) { return float(c); }",
            "float f(color c) { return float(luminance(c)); }");
  expectFix("color f(color c) { return c + 1.0; }", "color f(color c) { return c + color(1.0); }");
  expectFix("float f(float a[3], float x) { return a[x]; }",
            "float f(float a[3], float x) { return a[int(x)]; }");
  expectFix("bool f(int i) { return i ? true : false; }",
            "bool f(int i) { return i != 0 ? true : false; }");
  expectFix("uint f() { return 4000000000; }", "uint f() { return 4000000000u; }");
  expectFix("int f(float a[3]) { return a.size(); }", "int f(float a[3]) { return a.length(); }");
  expectFix("class L : rt_Light;\nfloat x;", "class L : rt_Light;\nprivate float x;");
}

TEST(Hints, QuotientsKeepTheirFraction) {
  expectFix("float f(int a, int b) { return a / b; }",
            "float f(int a, int b) { return float(a) / b; }");
  expectFix("vec2 f(uvec2 a, uvec2 b) { return (a + b) / a; }",
            "vec2 f(uvec2 a, uvec2 b) { return vec2((a + b)) / a; }");
  EXPECT_EQ(hints("float f(int a, int b) { return a / b; }"),
            "if that is meant, write `float(...)` around the quotient\n");
  const std::string unsure = "float f(int a, int b) { return a / b; }\n"; // it may be meant
  EXPECT_EQ(mended(unsure), unsure);
}

TEST(Hints, CandidatesAreListed) {
  EXPECT_EQ(hints("float g(float a, int b) { return a; }\nfloat g(int a, float b) { return b; }\n"
                  "float f() { return g(1, 2); }"),
            "g: candidate: `float g(float, int)`\ng: candidate: `float g(int, float)`\n");
  EXPECT_EQ(hints("float f() { return dot(vec2(1.0), vec3(1.0)); }"),
            "candidate: `float dot(float, float)`\ncandidate: `float dot(vec2, vec2)`\n"
            "candidate: `float dot(vec3, vec3)`\ncandidate: `float dot(vec4, vec4)`\n");
}

TEST(Hints, CallersOfHelpersAreNamed) {
  EXPECT_EQ(
      hints("class A : rt_Primitive {\n  color look() { return trace(vec3(0.0), vec3(1.0)); }\n"
            "  void intersect() { hit(luminance(look())); }\n};"),
      "intersect: reached from `intersect` of an rt_Primitive\n"
      "`trace` is allowed only in `shade` and `closestHit` of an rt_Material, `generate` of an "
      "rt_RayGeneration and "
      "`miss` of an rt_Miss, and in functions that these call\n");
}

TEST(Hints, CyclesAreShown) {
  EXPECT_EQ(hints("float a(float x) { return b(x); }\nfloat b(float x) { return a(x); }"),
            "b: `a` calls `b` here\n`a` calls `b`, which calls `a`\nonly `trace` and calls "
            "through members may be recursive: `member.function()`\n");
}

TEST(Hints, ExpectedMethodsAreShown) {
  EXPECT_EQ(hints("class A : rt_Primitive { bool intersect() { return true; } };"),
            "expected `void intersect()`\n");
  EXPECT_EQ(hints("class S : rt_Miss { void miss(float x) { } };"),
            "expected `void miss()` or `void miss(inout P)`, where P is a struct, the "
            "payload of the ray\n");
  EXPECT_EQ(hints("class L : rt_Light { void shade() { } };"), "an rt_Light has `illumination`\n");
  EXPECT_EQ(
      hints("class L : rt_Light { void generateSample() { rt_PDF = 1.0; } };"),
      "an rt_Light has `illumination`\na light source with an area is an object whose material has "
      "`emission`: a mesh, or an rt_Primitive with `generateSample` and `samplePDF`\n");
}

TEST(Hints, StateListsTheClassesThatReadIt) {
  EXPECT_EQ(hints("class C : rt_Camera; void generateRay() { rt_RayOrigin = "
                  "vec3(luminance(rt_LightColor)); }"),
            "`rt_LightColor` belongs to rt_Material and rt_Light\n");
}

TEST(SureFixes, SpellingsOfHlslAndCuda) {
  expectMended("float3 f(float2 v, uint3 n) { return float3(v, 1.0) * lerp(2.0, 3.0, frac(v.x)); }",
               "vec3 f(vec2 v, uvec3 n) { return vec3(v, 1.0) * mix(2.0, 3.0, fract(v.x)); }");
  expectMended("half4 f(half x) { return make_float4(x, 0.0, rsqrt(x), sinf(x)); }",
               "vec4 f(float x) { return vec4(x, 0.0, inversesqrt(x), sin(x)); }");
  expectMended("vec3 f(vec3 c) { return saturate(c * 2.0); }",
               "vec3 f(vec3 c) { return clamp(c * 2.0, 0.0, 1.0); }");
  expectMended(
      "float f(float x) { return saturate(rcp(x + 1.0) + saturate(x)); }",
      "float f(float x) { return clamp((1.0 / (x + 1.0)) + clamp(x, 0.0, 1.0), 0.0, 1.0); }");
  expectMended("float f(float x) { return sqr(x) + log10(x) + fmaf(x, powf(x, 2.0), fabsf(x)); }",
               "float f(float x) { return pow(x, 2) + (log(x) / log(10.0)) + fma(x, pow(x, 2.0), "
               "abs(x)); }");
  expectMended(
      "float f(float y, float x) { return atan2(y, x) + float(asuint(x)) + fmaxf(x, y); }",
      "float f(float y, float x) { return atan(y, x) + float(floatBitsToUint(x)) + max(x, y); }");
}

TEST(SureFixes, SpellingsOfOptix) {
  expectMended("struct P { float x; };\nclass A : rt_Material {\n  void anyHit(inout P p) {\n    "
               "if (p.x > 0.5) "
               "rtIgnoreIntersection();\n    optixTerminateRay();\n  }\n};",
               "struct P { float x; };\nclass A : rt_Material {\n  void anyHit(inout P p) {\n    "
               "if (p.x > 0.5) "
               "ignoreIntersection();\n    terminateRay();\n  }\n};");
  expectMended("class A : rt_Material { void shade() { rt_SampleColor = rtTrace(rt_HitPoint, "
               "rt_RayDirection); } };",
               "class A : rt_Material { void shade() { rt_SampleColor = trace(rt_HitPoint, "
               "rt_RayDirection); } };");
}

TEST(SureFixes, HabitsOfOtherLanguages) {
  expectMended("static float f(const vec3& a, const vec3 & b, const vec3 &c, const vec3&d)\n{ "
               "return a.x + b.x + c.x + d.x }",
               "float f(const vec3 a, const vec3 b, const vec3 c, const vec3 d)\n{ return a.x + "
               "b.x + c.x + d.x; }");
  expectMended("class A : rt_Material {\n  public float k;\n  void shade() { rt_SampleColor = "
               "color(this.k); }\n};",
               "class A : rt_Material {\n  public float k;\n  void shade() { rt_SampleColor = "
               "color(k); }\n};");
  expectMended("unsigned int f(unsigned x, const unsigned int y, signed int z)\n{ unsigned int k = "
               "x; return k + y + uint(z); }",
               "uint f(uint x, const uint y, int z)\n{ uint k = x; return k + y + uint(z); }");
}

TEST(SureFixes, NumbersThatDoNotConvertByThemselves) {
  expectMended(
      "int f(float x) { int i = x; i = x * 2.0; uint u = 3.0; return u; }",
      "int f(float x) { int i = int(x); i = int(x * 2.0); uint u = uint(3.0); return int(u); }");
  expectMended("ivec3 f(vec3 x) { return x; }", "ivec3 f(vec3 x) { return ivec3(x); }");
}

TEST(SureFixes, AreNoGuesses) {
  expectLeft("float f(float radius) { return radus; }");
  expectLeft("double f() { return 1.0; }");
  expectLeft("unsigned long f() { return 1u; }");
  expectLeft("vec3 f(mat3 m, vec3 a) { return mul(m, a); }");
  expectLeft("float f(float x) { return fmod(x, 2.0); }");
  expectLeft("bool f(float x) { return x; }");
  expectLeft("vec2 f(vec4 v) { return v; }");
  expectLeft("color f(vec3 v) { return v; }");
  expectLeft("float4x4 f(float4x4 m) { return m; }");
}

} // namespace
