//===- LinkTest.cpp - linking classes into a program ----------------------===//
#include "Linked.h"

#include "codegen/link/UnrollRecursion.h"

#include <algorithm>

namespace rtsl {
namespace {

const std::string textures = R"(
class Solid : rt_Texture {
  public color value;
  void lookup() { rt_TextureColor = value; }
};
class Stripes : rt_Texture {
  public float width = 0.5;
  void lookup() { rt_TextureColor = color(mod(rt_TextureUV.x, width)); }
};
class Matte : rt_Material {
  public rt_Texture albedo;
  void shade() { rt_SampleColor = albedo.lookup(); }
};
class Shiny : rt_Material {
  void shade() { rt_SampleColor = trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal)); }
};
)";

TEST(Link, OneClassIsCalledDirectly) {
  Linked linked(textures, {{"Solid", "Matte"}, {}});
  ASSERT_TRUE(linked.succeeded);
  EXPECT_EQ(linked.callees("Matte.shade"), std::vector<std::string>{"dispatch.rt_Texture.lookup"});
  EXPECT_EQ(linked.callees("dispatch.rt_Texture.lookup"), std::vector<std::string>{"Solid.lookup"});
  EXPECT_EQ(linked.count<ir::SwitchOp>("dispatch.rt_Texture.lookup"), 0u);
  EXPECT_EQ(linked.count<ir::CallMethodOp>("Matte.shade"), 0u);
}

TEST(Link, SeveralClassesAreASwitchOverThoseThatAreThere) {
  Linked linked(textures, {{"Solid", "Stripes", "Matte"}, {}});
  ASSERT_TRUE(linked.succeeded);
  EXPECT_EQ(linked.callees("dispatch.rt_Texture.lookup"),
            (std::vector<std::string>{"Solid.lookup", "Stripes.lookup"}));
  EXPECT_EQ(linked.count<ir::SwitchOp>("dispatch.rt_Texture.lookup"), 1u);
}

TEST(Link, ACallReachesWhatItsMemberRefersTo) {
  LinkRequest request{{"Solid", "Stripes", "Matte", "Painted"}, {}};
  request.referredClasses = {{{"Matte", "albedo"}, {"Solid"}}};
  Linked linked(textures + R"(
class Painted : rt_Material {
  public rt_Texture albedo;
  void shade() { rt_SampleColor = albedo.lookup(); }
};
)",
                request);
  ASSERT_TRUE(linked.succeeded);
  EXPECT_EQ(linked.callees("Matte.shade"),
            std::vector<std::string>{"dispatch.Matte.albedo.lookup"});
  EXPECT_EQ(linked.callees("dispatch.Matte.albedo.lookup"),
            std::vector<std::string>{"Solid.lookup"});
  // Nothing is known of the other member.
  EXPECT_EQ(linked.callees("Painted.shade"),
            std::vector<std::string>{"dispatch.rt_Texture.lookup"});
  EXPECT_EQ(linked.callees("dispatch.rt_Texture.lookup"),
            (std::vector<std::string>{"Solid.lookup", "Stripes.lookup"}));
}

TEST(Link, ObjectsOfOtherClassesInsideEndARecursion) {
  const std::string source = R"(
class Layer {
  float at(float x) { return x; }
};
class Scaled : Layer {
  public Layer inner;
  float at(float x) { return 2.0 * inner.at(x); }
};
class Shifted : Layer {
  public Layer inner;
  float at(float x) { return 1.0 + inner.at(x); }
};
class Matte : rt_Material {
  public Layer layer;
  void shade() { rt_SampleColor = color(layer.at(rt_HitDistance)); }
};
)";
  LinkRequest request{{"Layer", "Scaled", "Shifted", "Matte"}, {}};
  request.referredClasses = {{{"Matte", "layer"}, {"Scaled", "Shifted"}},
                             {{"Scaled", "inner"}, {"Shifted"}},
                             {{"Shifted", "inner"}, {"Layer"}}};
  Linked known(source, request);
  ASSERT_TRUE(known.succeeded);
  EXPECT_FALSE(recursiveFunction(*known.ir));
  EXPECT_EQ(known.callees("dispatch.Matte.layer.at"),
            (std::vector<std::string>{"Scaled.at", "Shifted.at"}));

  request.referredClasses[{"Shifted", "inner"}].insert("Scaled");
  Linked recursive(source, request);
  ASSERT_TRUE(recursive.succeeded);
  EXPECT_TRUE(recursiveFunction(*recursive.ir));
}

TEST(Link, RaysMeetOnlyMaterialsOfSurfaces) {
  const std::string source = R"(
class Layer : rt_Material {
  public optional Layer below;
  color at() { return color(0.5); }
  void shade() { rt_SampleColor = at(); }
};
class Lacquer : Layer {
  color at() { return below ? 0.9 * below.at() : color(1.0); }
};
)";
  LinkRequest request{{"Layer", "Lacquer"}, {}};
  request.surfaces = {{"", "Lacquer"}};
  Linked linked(source, request);
  ASSERT_TRUE(linked.succeeded);
  EXPECT_EQ(linked.callees("rtsl_rt_Material_shade"), std::vector<std::string>{"Lacquer.shade"});
  EXPECT_FALSE(linked.function("Layer.shade"));
  EXPECT_TRUE(linked.function("Layer.at")); // the lacquer calls it

  request.surfaces.emplace_back("", "Layer");
  Linked both(source, request);
  ASSERT_TRUE(both.succeeded);
  EXPECT_EQ(both.callees("rtsl_rt_Material_shade"),
            (std::vector<std::string>{"Layer.shade", "Lacquer.shade"}));
}

TEST(Link, ClassesWithoutObjectsDisappear) {
  Linked linked(textures, {{"Solid", "Matte"}, {}});
  ASSERT_TRUE(linked.succeeded);
  EXPECT_FALSE(linked.function("Stripes.lookup"));
  EXPECT_FALSE(linked.function("Shiny.shade"));
  EXPECT_EQ(linked.program.find("Stripes"), nullptr);
  EXPECT_EQ(linked.program.classes.size(), 2u);
}

TEST(Link, ASlotThatNoClassFillsDoesNothing) {
  Linked linked(textures, {{"Solid", "Matte"}, {}});
  ASSERT_TRUE(linked.succeeded);
  EXPECT_TRUE(linked.callees("rtsl_rt_Light_illumination").empty());
  EXPECT_TRUE(linked.function("rtsl_rt_Light_illumination").isPublic());
  EXPECT_EQ(linked.callees("rtsl_rt_Material_shade"), std::vector<std::string>{"Matte.shade"});
}

TEST(Link, OnlyEntriesAreVisible) {
  Linked linked(textures, {{"Solid", "Stripes", "Matte", "Shiny"}, {}});
  ASSERT_TRUE(linked.succeeded);
  for (auto function : linked.ir->getOps<mlir::func::FuncOp>()) {
    const llvm::StringRef name = function.getSymName();
    const bool isEntry = name.starts_with("rtsl_") || name.ends_with(".construct") ||
                         name.ends_with(".initialize") || name.ends_with(".intersect");
    EXPECT_EQ(function.isPublic(), isEntry) << name.str();
  }
}

TEST(Link, NeedsAreWhatIsRead) {
  EXPECT_EQ(Linked(textures, {{"Solid", "Matte"}, {}}).program.needs, 0u);
  EXPECT_EQ(Linked(textures, {{"Stripes", "Matte"}, {}}).program.needs,
            RTSL_NEEDS_TEXTURE_COORDINATES);
}

TEST(Link, AClassNeedsWhatItReadsItself) {
  Linked linked(textures, {{"Stripes", "Matte", "Shiny"}, {}});
  ASSERT_TRUE(linked.succeeded);
  EXPECT_EQ(linked.classInfo("Matte").needs, 0u); // the scene determines the class of `albedo`
  EXPECT_EQ(linked.classInfo("Stripes").needs, RTSL_NEEDS_TEXTURE_COORDINATES);
  // Its rays begin at hits.
  EXPECT_EQ(linked.classInfo("Shiny").needs, RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS);
}

TEST(Link, RecordsAreDescribed) {
  Linked linked(R"(
struct Pair { float a; vec3 b; };
class Base : rt_Material {
  public float first = 1.0;
  private vec3 second;
  void constructor(vec2 uv, bool on, mat2x3 m) { second = vec3(uv, on ? m[1].z : first); }
  void shade() { rt_SampleColor = color(second.x); }
};
class Derived : Base {
  public color third;
  public Pair pairs[2];
  public rt_Texture picture;
  public vec2 points[];
  void shade() { rt_SampleColor = third * pairs[1].b.y * points[0].x; }
};
)",
                {{"Derived"}, {}});
  ASSERT_TRUE(linked.succeeded);
  const runtime::ClassInfo &derived = linked.classInfo("Derived");
  EXPECT_EQ(derived.base, "Base");
  EXPECT_EQ(derived.root, "rt_Material");
  std::vector<std::string> names;
  std::vector<std::uint32_t> offsets;
  for (const runtime::MemberInfo &member : derived.members) {
    names.push_back(member.name);
    offsets.push_back(member.offset);
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"first", "second", "third", "pairs", "picture", "points"}));
  EXPECT_EQ(offsets, (std::vector<std::uint32_t>{4, 8, 20, 32, 64, 68}));
  EXPECT_EQ(derived.recordSize, 68 + sizeof(RtslBuffer));
  EXPECT_TRUE(derived.members[0].isPublic && derived.members[0].hasDefault);
  EXPECT_FALSE(derived.members[1].isPublic);
  EXPECT_EQ(derived.members[3].type.arraySizes, std::vector<std::uint32_t>{2});
  ASSERT_EQ(derived.members[3].type.fields.size(), 2u);
  EXPECT_EQ(derived.members[3].type.fields[1].offset, 4u);
  EXPECT_EQ(derived.members[5].type.bufferRank, 1);
  EXPECT_EQ(derived.members[5].type.elementSize, 8u);

  // The constructor is inherited: two floats, a bool of 4 bytes, two columns of three floats.
  ASSERT_TRUE(derived.hasConstructor);
  ASSERT_EQ(derived.parameters.size(), 3u);
  EXPECT_EQ(derived.parameters[1].offset, 8u);
  EXPECT_EQ(derived.parameters[2].offset, 12u);
  EXPECT_EQ(derived.parameterSize, 36u);
}

const std::string surfaces = R"(
class Ball : rt_Primitive {
  scratch vec3 grain;
  scratch float depth;
  scratch vec2 spare;
  void intersect() { grain = rt_RayOrigin; depth = 1.0; spare = vec2(2.0); hit(1.0); }
};
class Plate : rt_Primitive {
  scratch float depth;
  void intersect() { depth = 2.0; hit(2.0); }
};
class Wood : rt_Material {
  scratch vec3 grain;
  scratch float depth;
  void shade() { rt_SampleColor = color(grain.x * depth); }
};
class Fog : rt_Material {
  scratch float depth;
  void shade() { rt_SampleColor = color(depth); }
};
class Strange : rt_Material {
  scratch vec2 depth;
  void shade() { rt_SampleColor = color(depth.x); }
};
)";

TEST(Link, AttributesAreMatchedByNameAndHaveOnePlace) {
  Linked linked(surfaces, {{"Ball", "Plate", "Wood", "Fog"},
                           {},
                           {{"Ball", "Wood"}, {"Plate", "Fog"}, {"Ball", "Fog"}}});
  ASSERT_TRUE(linked.succeeded);
  std::map<std::string, std::set<std::int64_t>> places;
  linked.ir->walk([&](ir::AttributeOp op) {
    ASSERT_TRUE(op.getOffset().has_value());
    places[op.getName().str()].insert(*op.getOffset());
  });
  EXPECT_EQ(places.size(), 2u) << "`spare` is not read, so it is not stored";
  EXPECT_EQ(places["depth"].size(), 1u);
  EXPECT_EQ(places["grain"].size(), 1u);
  const std::int64_t grain = *places["grain"].begin(), depth = *places["depth"].begin();
  EXPECT_TRUE(depth >= grain + 3 || grain >= depth + 1) << "they must not overlap";
}

TEST(Link, AMissingAttributeIsAnErrorWithBothPlaces) {
  Linked linked(surfaces, {{"Plate", "Wood"}, {}, {{"Plate", "Wood"}}});
  EXPECT_FALSE(linked.succeeded);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u);
  const Diagnostic &error = linked.diagnostics.all().front();
  EXPECT_EQ(error.code, Code::attributeMissing);
  EXPECT_EQ(linked.sources.text(error.range), "grain");
  EXPECT_EQ(linked.sources.lineColumn(error.range.file, error.range.begin).line, 13u);
  ASSERT_EQ(error.labels.size(), 1u);
  EXPECT_EQ(linked.sources.text(error.labels.front().range), "Plate");
}

TEST(Link, AttributesThatAreReadOfMeshesDoNotOverlap) {
  Linked linked(surfaces, {{"Fog", "Strange"}, {}, {{"", "Fog"}, {"", "Strange"}}});
  ASSERT_TRUE(linked.succeeded);
  std::set<std::int64_t> offsets;
  linked.ir->walk([&](ir::AttributeOp op) { offsets.insert(*op.getOffset()); });
  EXPECT_EQ(offsets.size(), 2u) << "a mesh may have both";
}

TEST(Link, AttributesOfMeshesAreNumbersVectorsAndColors) {
  Linked linked("class Turned : rt_Material { scratch mat2 turn;"
                " void shade() { rt_SampleColor = color(turn[0].x); } };",
                {{"Turned"}, {}, {{"", "Turned"}}});
  EXPECT_FALSE(linked.succeeded);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u);
  EXPECT_EQ(linked.diagnostics.all().front().code, Code::meshAttributeType);
  EXPECT_EQ(linked.sources.text(linked.diagnostics.all().front().range), "turn");
}

TEST(Link, AnAttributeOfAnotherTypeIsAnErrorWithBothPlaces) {
  Linked linked(surfaces, {{"Ball", "Strange"}, {}, {{"Ball", "Strange"}}});
  EXPECT_FALSE(linked.succeeded);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u);
  const Diagnostic &error = linked.diagnostics.all().front();
  EXPECT_EQ(error.code, Code::attributeTypeMismatch);
  ASSERT_EQ(error.labels.size(), 1u);
  EXPECT_EQ(
      linked.sources.lineColumn(error.labels.front().range.file, error.labels.front().range.begin)
          .line,
      4u);
}

TEST(Link, AMethodThatAClassOfTheSceneLacksIsAnError) {
  Linked linked(R"(
class Empty : rt_Texture { };
class Matte : rt_Material {
  public rt_Texture albedo;
  void shade() { rt_SampleColor = albedo.lookup(); }
};
)",
                {{"Empty", "Matte"}, {}});
  EXPECT_FALSE(linked.succeeded);
  ASSERT_EQ(linked.diagnostics.all().size(), 1u);
  EXPECT_EQ(linked.diagnostics.all().front().code, Code::slotNotFilled);
}

} // namespace
} // namespace rtsl
