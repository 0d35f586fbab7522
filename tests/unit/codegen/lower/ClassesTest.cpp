//===- ClassesTest.cpp - what classes become ------------------------------===//
#include "tests/unit/codegen/lower/Shader.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace rtsl::test {
namespace {

const char *const sphere = R"(
class Sphere : rt_Primitive {
  public vec3 center;
  public float radius = 1.0;
  scratch vec3 hitNormal;
  scratch float list[2];

  float nearest(float b, float d) { return -b - sqrt(d); }
  bool report(float t) {
    hitNormal = rt_RayOrigin + t * rt_RayDirection - center;
    return hit(t);
  }
  void intersect() {
    vec3 f = rt_RayOrigin - center;
    float b = dot(f, rt_RayDirection);
    float d = b * b - dot(f, f) + radius * radius;
    if (d < 0.0)
      return;
    list[1] = d;
    if (!report(nearest(b, d)))
      report(-b + sqrt(d));
  }
  void computeNormal() {
    rt_GeometricNormal = normalize(hitNormal) * list[1];
    rt_ShadingNormal = rt_GeometricNormal;
  }
  void computeBounds() {
    rt_BoundMin = center - vec3(radius);
    rt_BoundMax = center + vec3(radius);
  }
};
)";

TEST(Classes, ScratchMembersAreVariablesOfOneIntersection) {
  Lowered lowered(sphere);
  ASSERT_TRUE(lowered.succeeded());
  // Two returns, each stores both scratch members if a hit was accepted.
  EXPECT_EQ(lowered.count("Sphere.intersect", "rtsl.attribute \"hitNormal\""), 2u);
  EXPECT_EQ(lowered.count("Sphere.intersect", "rtsl.attribute \"list\""), 2u);
  EXPECT_EQ(lowered.count("Sphere.intersect", "rtsl.var \"hitNormal\""), 1u);
  EXPECT_EQ(lowered.count("Sphere.intersect", "rtsl.var \"accepted\""), 1u);
  EXPECT_EQ(lowered.count("Sphere.intersect", "call @Sphere.report.intersect"), 2u);
  EXPECT_EQ(lowered.count("Sphere.intersect", "call @Sphere.nearest("), 1u)
      << "a helper that has nothing to do with it takes no more parameters";
  EXPECT_EQ(lowered.count("Sphere.report.intersect", "rtsl.attribute"), 0u);
  EXPECT_EQ(lowered.count("Sphere.report.intersect", "rtsl.hit"), 1u);
  EXPECT_EQ(lowered.count("Sphere.report.intersect", "!rtsl.ptr<i1>"), 3u)
      << "parameter, load, store";
  EXPECT_FALSE(lowered.hasFunction("Sphere.report"));
  EXPECT_EQ(lowered.count("Sphere.computeNormal", "rtsl.attribute \"hitNormal\""), 1u);
}

TEST(Classes, DeclareTheirMembersInheritedOnesFirst) {
  Lowered lowered(R"(
class A : rt_Material {
  public float first = 2.0, second;
  private int third;
  const int fixed = 3;
  scratch vec3 n;
  void constructor(float value) { third = int(value) + fixed; }
  float helper() { return first; }
  void shade() { rt_SampleColor = color(helper() + n.x); }
};
class B : A {
  public vec2 fourth = vec2(1, 2);
  float helper() { return second; }
};
)");
  ASSERT_TRUE(lowered.succeeded());
  std::string text = lowered.text("B");
  std::size_t last = 0;
  for (const char *member :
       {"@first : f32 access \"public\"", "@second : f32 access \"public\"",
        "@third : i32 access \"private\"", "@n : vector<3xf32> access \"scratch\"",
        "@fourth : vector<2xf32> access \"public\""}) {
    std::size_t at = text.find(member);
    ASSERT_NE(at, std::string::npos) << member << " in\n" << text;
    EXPECT_GT(at, last);
    last = at;
  }
  EXPECT_EQ(text.find("fixed"), std::string::npos);
  EXPECT_NE(text.find("root \"rt_Material\" base @A"), std::string::npos);
  // Methods are lowered for each class, so that calls on the object itself are known.
  EXPECT_EQ(lowered.count("A.shade", "call @A.helper"), 1u);
  EXPECT_EQ(lowered.count("B.shade", "call @B.helper"), 1u);
  EXPECT_EQ(lowered.count("B.shade", "rtsl.method = \"shade\""), 1u);
  EXPECT_EQ(lowered.count("B.constructor", "rtsl.constructor"), 1u);
  EXPECT_EQ(lowered.count("A.initialize", "rtsl.member"), 1u);
  EXPECT_EQ(lowered.count("B.initialize", "rtsl.member"), 2u);
}

TEST(Classes, CallsThroughReferencesAreSlots) {
  Lowered lowered(R"(
class Base : rt_Texture {
  public rt_Texture other;
  public Base next;
  float weight(float x) { return x; }
  vec2 weight(vec2 x) { return x; }
  void lookup() {
    rt_TextureColor = other.lookup() * next.weight(2.0) * next.weight(vec2(1)).x;
    rt_FloatTextureValue = other.lookupFloat();
  }
};
)");
  ASSERT_TRUE(lowered.succeeded());
  EXPECT_EQ(lowered.count("Base.lookup", "rtsl.call_method \"lookup\" on"), 2u);
  EXPECT_EQ(lowered.count("Base.lookup", "rtsl.call_method \"weight.float\" on"), 1u);
  EXPECT_EQ(lowered.count("Base.lookup", "rtsl.call_method \"weight.vec2\" on"), 1u);
  EXPECT_TRUE(lowered.hasFunction("Base.weight.float"));
}

TEST(Classes, MaterialsTraceAndAreLit) {
  Options options;
  options.colorComponents = 4;
  Lowered lowered(R"(
class Glass : rt_Material {
  public float eta = 1.5;
  public color tint = color(1, 0.9, 0.8);
  void shade() {
    vec3 n = faceforward(rt_ShadingNormal, rt_RayDirection, rt_GeometricNormal);
    color sum = trace(rt_HitPoint, reflect(rt_RayDirection, n));
    sum += tint * trace(rt_HitPoint, refract(rt_RayDirection, n, 1.0 / eta));
    illuminance (rt_HitPoint, n, 1.5707) {
      if (luminance(rt_LightColor) < 0.01)
        continue;
      sum += rt_LightColor * max(dot(n, rt_LightDirection), 0.0);
    }
    illuminance (rt_HitPoint)
      sum += rt_LightColor;
    rt_SampleColor = sum + ambient() * rand();
  }
};
)",
                  options);
  ASSERT_TRUE(lowered.succeeded());
  EXPECT_EQ(lowered.count("Glass.shade", "rtsl.trace"), 2u);
  EXPECT_EQ(lowered.count("Glass.shade", "rtsl.illuminance"), 2u);
  EXPECT_EQ(lowered.count("Glass.shade", "normal %"), 1u);
  EXPECT_EQ(lowered.count("Glass.shade", "rtsl.continue"), 1u);
  EXPECT_EQ(lowered.count("Glass.shade", "rtsl.ambient : vector<4xf32>"), 1u);
  EXPECT_EQ(lowered.count("Glass.shade", "rtsl.rand"), 1u);
}

TEST(Classes, BuffersAreReadWithinTheirBounds) {
  Lowered lowered(R"(
class Mesh : rt_Primitive {
  public vec3 vertices[];
  public float grid[][];
  void intersect() {
    hit(vertices[rt_PrimitiveIndex].x + grid[1][2] + float(vertices.length() + grid.length() + grid[0].length()));
  }
  void computeBounds() {
    rt_BoundMin = vec3(0);
    rt_BoundMax = vec3(1);
  }
};
)");
  ASSERT_TRUE(lowered.succeeded());
  EXPECT_EQ(lowered.count("Mesh.intersect", "rtsl.buffer_element"), 2u);
  EXPECT_EQ(lowered.count("Mesh.intersect", "rtsl.buffer_length"), 6u);
  EXPECT_EQ(lowered.count("Mesh.intersect", "rtsl.if"), 2u) << "a buffer may be empty";
}

TEST(Classes, OnlyThoseRequested) {
  Options options;
  options.classes = {"A"};
  Lowered lowered(R"(
float used(float x) { return x; }
float unused(float x) { return x; }
class A : rt_Material { void shade() { rt_SampleColor = color(used(1.0)); } };
class B : rt_Material { void shade() { rt_SampleColor = color(unused(1.0)); } };
)",
                  options);
  EXPECT_TRUE(lowered.hasFunction("A.shade"));
  EXPECT_TRUE(lowered.hasFunction("used"));
  EXPECT_FALSE(lowered.hasFunction("B.shade"));
  EXPECT_FALSE(lowered.hasFunction("unused"));
}

TEST(Classes, LocationsAreThoseOfTheSource) {
  Lowered lowered("float twice(float x) {\n  return x * 2.0;\n}\n");
  std::string text = lowered.text("", /*withLocations=*/true);
  EXPECT_NE(text.find("\"test.rtsl\":2:"), std::string::npos) << text;
}

//===----------------------------------------------------------------------===//
// Methods that run
//===----------------------------------------------------------------------===//

/// Records of objects, as the runtime lays them out: the class id, then the members.
struct Record {
  std::vector<std::uint32_t> words{0, 1}; // offset 0 is no object; the class id at offset 4
  RtslRef object() const { return 4; }
  void add(std::initializer_list<float> values) {
    for (float value : values) {
      std::uint32_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      words.push_back(bits);
    }
  }
};

float attribute(const Shader &shader, unsigned word) {
  float value;
  std::memcpy(&value, &shader.state.attributes[word], sizeof value);
  return value;
}

TEST(Classes, IntersectionStoresScratchOfAcceptedHitsOnly) {
  Shader shader(sphere);
  Record record;
  record.add({0, 0, 5, 1}); // center and radius
  shader.launch.records = reinterpret_cast<std::uint8_t *>(record.words.data());
  shader.state.candidateFar = INFINITY;
  auto intersect = [&](float x, float farthest, float epsilon = 0.0F) {
    shader.state.RayOrigin[0] = x;
    shader.state.RayDirection[2] = 1;
    shader.state.Epsilon = epsilon;
    shader.state.HitDistance = farthest;
    shader.state.nearest = farthest;
    shader.state.instance = RTSL_NO_HIT;
    for (std::uint32_t &word : shader.state.attributes)
      word = 0;
    shader.callMethod("Sphere.intersect", record.object());
    return shader.state.HitDistance;
  };
  EXPECT_EQ(intersect(0.0F, 100.0F), 4.0F);
  EXPECT_EQ(attribute(shader, 2), -1.0F) << "hitNormal.z";
  EXPECT_EQ(attribute(shader, 4), 1.0F) << "list[1]";
  EXPECT_EQ(intersect(2.0F, 100.0F), 100.0F) << "a miss";
  EXPECT_EQ(attribute(shader, 4), 0.0F);
  EXPECT_EQ(intersect(0.0F, 3.0F), 3.0F) << "behind the ray's end";
  EXPECT_EQ(attribute(shader, 2), 0.0F);
  EXPECT_EQ(intersect(0.0F, 100.0F, 5.0F), 6.0F)
      << "the second root, reported by the helper's second call";
  EXPECT_EQ(attribute(shader, 2), 1.0F);

  shader.callMethod("Sphere.computeNormal", record.object());
  EXPECT_EQ(shader.state.GeometricNormal[2], 1.0F);
  shader.callMethod("Sphere.computeBounds", record.object());
  EXPECT_EQ(shader.state.BoundMin[0], -1.0F);
  EXPECT_EQ(shader.state.BoundMax[2], 6.0F);
}

TEST(Classes, ConstructorsAndDefaultsWriteTheRecord) {
  Shader shader(R"(
struct Pair { float a; int b; };
class A : rt_Texture {
  public float x = 2.0, y;
  private Pair pairs[2];
  public bool flag = true;
  private mat2 m = mat2(1, 2, 3, 4);
  void constructor(float v, bool f) { y = v; pairs[1] = Pair(v * 2.0, 7); flag = f; m[1].x += x; scale(3.0); }
  void scale(float by) { pairs[0].a = y * by; }
  void lookup() { rt_FloatTextureValue = pairs[1].a + m[1].x + (flag ? 100.0 : 0.0); }
};
)");
  Record record;
  record.words.resize(2 + 2 + 4 + 1 + 4);
  shader.launch.records = reinterpret_cast<std::uint8_t *>(record.words.data());
  shader.callMethod("A.initialize", record.object());
  auto word = [&](std::size_t i) {
    float value;
    std::memcpy(&value, &record.words[2 + i], sizeof value);
    return value;
  };
  EXPECT_EQ(word(0), 2.0F);
  EXPECT_EQ(record.words[2 + 6], 1u) << "a bool is 0 or 1 in memory";
  EXPECT_EQ(word(7 + 2), 3.0F);
  shader.callMethod("A.constructor", record.object(), 5.0F, false);
  EXPECT_EQ(word(1), 5.0F);
  EXPECT_EQ(word(2), 15.0F);
  EXPECT_EQ(word(4), 10.0F);
  EXPECT_EQ(record.words[2 + 5], 7u);
  EXPECT_EQ(record.words[2 + 6], 0u);
  EXPECT_EQ(word(7 + 2), 5.0F);
  shader.callMethod("A.lookup", record.object());
  EXPECT_EQ(shader.state.FloatTextureValue, 15.0F);
}

TEST(Classes, BuffersReadZeroWhereThereIsNothing) {
  Shader shader(R"(
struct Item { float a; vec2 b; };
class T : rt_Texture {
  public float list[];
  public Item grid[][];
  void lookup() {
    int i = int(rt_TextureUV.x), j = int(rt_TextureUV.y);
    rt_FloatTextureValue = list[i] + 1000.0 * grid[i][j].b.y;
    rt_TextureColor = color(float(list.length()), float(grid.length()), float(grid[0].length()));
  }
};
)");
  float list[3] = {1, 2, 3};
  float grid[2 * 2 * 3] = {0, 0, 10, 0, 0, 11, 0, 0, 12, 0, 0, 13};
  Record record;
  auto addBuffer = [&](const void *address, std::initializer_list<std::uint32_t> sizes) {
    auto bits = reinterpret_cast<std::uintptr_t>(address);
    record.words.push_back(static_cast<std::uint32_t>(bits));
    record.words.push_back(static_cast<std::uint32_t>(bits >> 32));
    record.words.insert(record.words.end(), sizes);
  };
  addBuffer(list, {3, 1, 1});
  addBuffer(grid, {2, 2, 1});
  shader.launch.records = reinterpret_cast<std::uint8_t *>(record.words.data());
  auto lookup = [&](float i, float j) {
    shader.state.TextureUV[0] = i;
    shader.state.TextureUV[1] = j;
    shader.callMethod("T.lookup", record.object());
    return shader.state.FloatTextureValue;
  };
  EXPECT_EQ(lookup(1, 0), 2 + 12000.0F);
  EXPECT_EQ(lookup(0, 1), 1 + 11000.0F);
  EXPECT_EQ(lookup(99, 99), 3 + 13000.0F) << "indices are clamped";
  EXPECT_EQ(lookup(-99, -99), 1 + 10000.0F);
  EXPECT_EQ(shader.state.TextureColor[0], 3.0F);
  EXPECT_EQ(shader.state.TextureColor[2], 2.0F);
  record.words[2] = record.words[3] = record.words[4] = 0; // no elements, no memory
  EXPECT_EQ(lookup(1, 1), 13000.0F);
  EXPECT_EQ(shader.state.TextureColor[0], 0.0F);
  record.words[2 + 5] = record.words[2 + 6] = 0;
  record.words[2 + 5 + 3] = 0;
  EXPECT_EQ(lookup(1, 1), 0.0F) << "one empty dimension is enough";
}

TEST(Examples, AreLowered) {
  std::size_t number = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(RTSL_ROOT "/examples")) {
    if (entry.path().extension() != ".rtsl")
      continue;
    std::ifstream file(entry.path());
    std::stringstream text;
    text << file.rdbuf();
    if (text.str().find("import ") != std::string::npos)
      continue; // needs other files; the image tests lower it
    SCOPED_TRACE(entry.path().string());
    EXPECT_TRUE(Lowered(text.str()).succeeded());
    ++number;
  }
  EXPECT_GE(number, 5u);
}

TEST(Classes, HitsOfFreeFunctionsCountToo) {
  Shader shader(R"(
bool report(float t) { return hit(t); }
class P : rt_Primitive {
  scratch float best;
  void intersect() {
    best = 7.0;
    if (rt_RayOrigin.x > 0.0)
      report(rt_RayOrigin.x);
  }
  void computeBounds() { rt_BoundMin = vec3(0); rt_BoundMax = vec3(1); }
};
)");
  shader.state.HitDistance = shader.state.nearest = shader.state.candidateFar = 10;
  shader.state.instance = RTSL_NO_HIT;
  shader.callMethod("P.intersect", 0u);
  EXPECT_EQ(attribute(shader, 0), 0.0F);
  shader.state.RayOrigin[0] = 3;
  shader.callMethod("P.intersect", 0u);
  EXPECT_EQ(attribute(shader, 0), 7.0F);
  EXPECT_EQ(shader.state.HitDistance, 3.0F);
}

} // namespace
} // namespace rtsl::test
