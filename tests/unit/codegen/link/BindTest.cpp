//===- BindTest.cpp - programs linked for the objects of a scene ----------===//
#include "Linked.h"
#include "codegen/ir/Attributes.h"

#include "codegen/link/BindScene.h"
#include "codegen/passes/BindMembers.h"

#include <cstring>

namespace rtsl {
namespace {

const std::string lenses = R"(
class Lens : rt_Material {
  public float index = 1.5;
  private vec3 axis;
  public rt_Texture coat;
  void constructor(vec3 a) { axis = normalize(a); }
  void shade() { rt_SampleColor = color(index * axis.x); }
};
class Thick : Lens {
  public float depth;
  void shade() { rt_SampleColor = color(index + depth); }
};
class Ball : rt_Primitive {
  void intersect() { hit(1.0); }
  void computeBounds() { rt_BoundMin = vec3(-1.0); rt_BoundMax = vec3(1.0); }
};
)";

/// Records of objects as a runtime would have them: class id, index, axis, coat and, of Thick,
/// depth.
struct Records {
  std::vector<std::vector<float>> words;
  runtime::SceneFacts facts;

  void add(const std::string &className, std::vector<float> values) {
    values.insert(values.begin(), 0.0f); // the class id, which is not read
    words.push_back(std::move(values));
    facts.objects.push_back(
        {className, reinterpret_cast<const std::uint8_t *>(words.back().data())});
  }
};

/// The words noted on a member; nothing if it is not bound.
std::vector<float> boundTo(Linked &linked, const std::string &className,
                           const std::string &member) {
  auto declaration = linked.ir->lookupSymbol<ir::ClassOp>(className).findMember(member);
  auto words = ir::attr::bound.of(declaration);
  std::vector<float> values(words ? static_cast<std::size_t>(words.size()) : 0);
  if (words)
    std::memcpy(values.data(), words.asArrayRef().data(), values.size() * sizeof(float));
  return values;
}

TEST(Bind, AMemberOfOneObjectIsWhatItIs) {
  Linked linked(lenses, {{"Lens"}, {}});
  Records records;
  records.add("Lens", {1.25f, 0, 0, 1, 0});
  bindScene(*linked.ir, records.facts);
  EXPECT_EQ(boundTo(linked, "Lens", "index"), std::vector<float>{1.25f});
  EXPECT_EQ(boundTo(linked, "Lens", "axis"), (std::vector<float>{0, 0, 1}));
}

TEST(Bind, WhereObjectsDifferNothingIsBound) {
  Linked linked(lenses, {{"Lens"}, {}});
  Records records;
  records.add("Lens", {1.25f, 0, 0, 1, 0});
  records.add("Lens", {1.25f, 0, 1, 0, 0});
  records.add("Lens", {1.25f, 0, 0, 1, 0});
  bindScene(*linked.ir, records.facts);
  EXPECT_EQ(boundTo(linked, "Lens", "index"), std::vector<float>{1.25f});
  EXPECT_TRUE(boundTo(linked, "Lens", "axis").empty());
}

TEST(Bind, BitsDecideNotValues) {
  Linked linked(lenses, {{"Lens"}, {}});
  Records records;
  records.add("Lens", {0.0f, 0, 0, 1, 0});
  records.add("Lens", {-0.0f, 0, 0, 1, 0});
  bindScene(*linked.ir, records.facts);
  EXPECT_TRUE(boundTo(linked, "Lens", "index").empty());
}

TEST(Bind, AReferenceToABaseMayLeadBelowIt) {
  Linked linked(lenses, {{"Lens", "Thick"}, {}});
  Records records;
  records.add("Lens", {1.25f, 0, 0, 1, 0});
  records.add("Thick", {1.5f, 0, 0, 1, 0, 7});
  bindScene(*linked.ir, records.facts);
  EXPECT_TRUE(boundTo(linked, "Lens", "index").empty());
  EXPECT_EQ(boundTo(linked, "Lens", "axis"), (std::vector<float>{0, 0, 1}));
  EXPECT_EQ(boundTo(linked, "Thick", "index"), std::vector<float>{1.5f});
  EXPECT_EQ(boundTo(linked, "Thick", "depth"), std::vector<float>{7});
}

TEST(Bind, ABaseWithoutObjectsIsBoundByThoseBelow) {
  Linked linked(lenses, {{"Thick"}, {}});
  Records records;
  records.add("Thick", {1.5f, 0, 0, 1, 0, 7});
  bindScene(*linked.ir, records.facts);
  EXPECT_EQ(boundTo(linked, "Lens", "index"), std::vector<float>{1.5f});
}

RtslInstance instanceOf(RtslRef primitive) {
  RtslInstance instance{};
  instance.primitive = primitive;
  return instance;
}

TEST(Bind, TheTablesOfASmallSceneAreInTheProgram) {
  Linked linked(lenses, {{"Lens", "Ball"}, {}});
  const std::vector<std::uint8_t> bytes(48, 1);
  runtime::SceneFacts facts;
  facts.records = bytes.data();
  facts.recordBytes = bytes.size();
  facts.instances = {instanceOf(16), instanceOf(32)};
  Findings findings;
  bindScene(*linked.ir, facts, {}, &findings);
  EXPECT_EQ(ir::attr::records.of(*linked.ir).size(), 12);
  EXPECT_EQ(ir::attr::instances.of(*linked.ir).size() * 4, int64_t(2 * sizeof(RtslInstance)));
  EXPECT_EQ(ir::attr::listedBoxes.of(*linked.ir).size() * 4, int64_t(2 * sizeof(RtslListedBox)));
  const auto tree = llvm::find_if(findings, [](const auto &one) { return one.item == Item::Tree; });
  ASSERT_NE(tree, findings.end());
  EXPECT_FALSE(tree->isNeeded);
  EXPECT_EQ(tree->reason, "2 primitives, tested one after the other");
}

TEST(Bind, EmittersAreInTheProgramUnlessTheyMayChange) {
  runtime::SceneFacts facts;
  facts.instances = {instanceOf(16), instanceOf(32)};
  const auto words = [&](const LinkRequest &request) {
    Linked linked(lenses, {{"Lens", "Ball"}, {}});
    bindScene(*linked.ir, facts, request);
    const auto emitters = ir::attr::emitters.of(*linked.ir);
    return emitters ? std::optional(emitters.size()) : std::nullopt;
  };
  EXPECT_EQ(words({}), std::nullopt);
  facts.emitters.emplace();
  EXPECT_EQ(words({}), 0);
  facts.emitters->push_back({1, 0, 1.0f, 0, 0});
  EXPECT_EQ(words({}), int64_t(sizeof(RtslEmitter) / 4));
  LinkRequest request;
  request.editable = {"Lens"};
  EXPECT_EQ(words(request), std::nullopt);
  request.editable = {};
  for (const Item item : {Item::Lights, Item::Parameters}) {
    request.keep = ItemSet::only(item);
    EXPECT_EQ(words(request), std::nullopt);
  }
}

TEST(Bind, AMeshNeedsTheTree) {
  Linked linked(lenses, {{"Lens", "Ball"}, {}});
  runtime::SceneFacts facts;
  facts.instances = {instanceOf(16), instanceOf(0)};
  bindScene(*linked.ir, facts);
  EXPECT_TRUE(ir::attr::instances.of(*linked.ir));
  EXPECT_FALSE(ir::attr::listedBoxes.of(*linked.ir));
}

TEST(Bind, AnObjectOfSeveralPrimitivesNeedsTheTree) {
  Linked linked(lenses, {{"Lens", "Ball"}, {}});
  runtime::SceneFacts facts;
  facts.instances = {instanceOf(16), instanceOf(32)};
  facts.instances[1].boxCount = 2;
  bindScene(*linked.ir, facts);
  EXPECT_FALSE(ir::attr::listedBoxes.of(*linked.ir));
}

TEST(Bind, ManyPrimitivesNeedTheTree) {
  Linked linked(lenses, {{"Lens", "Ball"}, {}});
  runtime::SceneFacts facts;
  facts.instances.assign(33, instanceOf(16));
  bindScene(*linked.ir, facts);
  EXPECT_FALSE(ir::attr::listedBoxes.of(*linked.ir));
}

TEST(Bind, RecordsWithBuffersOrManyRecordsStayInTheScene) {
  const std::vector<std::uint8_t> bytes(8192, 1);
  for (const bool hasBuffers : {false, true}) {
    Linked linked(lenses, {{"Lens", "Ball"}, {}});
    runtime::SceneFacts facts;
    facts.records = bytes.data();
    facts.recordBytes = hasBuffers ? 48 : bytes.size();
    facts.hasBuffers = hasBuffers;
    bindScene(*linked.ir, facts);
    EXPECT_FALSE(ir::attr::records.of(*linked.ir));
  }
}

TEST(Bind, WhatIsKeptIsNotInTheTables) {
  const std::vector<std::uint8_t> bytes(48, 1);
  runtime::SceneFacts facts;
  facts.records = bytes.data();
  facts.recordBytes = bytes.size();
  facts.instances = {instanceOf(16)};
  Linked parameters(lenses, {{"Lens", "Ball"}, {}}), tree(lenses, {{"Lens", "Ball"}, {}});
  LinkRequest request;
  request.keep = ItemSet::only(Item::Parameters);
  bindScene(*parameters.ir, facts, request);
  EXPECT_FALSE(ir::attr::records.of(*parameters.ir));
  EXPECT_FALSE(ir::attr::instances.of(*parameters.ir));
  request.keep = ItemSet::only(Item::Tree);
  bindScene(*tree.ir, facts, request);
  EXPECT_TRUE(ir::attr::records.of(*tree.ir));
  EXPECT_FALSE(ir::attr::listedBoxes.of(*tree.ir));
}

TEST(Bind, WhatMakesObjectsAndWhatRendersArePartedFromEachOther) {
  Linked linked(lenses, {{"Lens", "Ball"}, {}});
  const mlir::OwningOpRef<mlir::ModuleOp> constructors = linked.ir->clone();
  keepConstructors(*constructors, /*withEmission=*/false);
  Records records;
  records.add("Lens", {1.25f, 0, 0, 1, 0});
  bindScene(*linked.ir, records.facts);
  const auto isPublic = [](mlir::ModuleOp ir, const char *name) {
    auto function = ir.lookupSymbol<mlir::func::FuncOp>(name);
    return function && function.isPublic();
  };
  for (const char *name :
       {"Lens.initialize", "Lens.construct", "rtsl_rt_Primitive_computeBounds"}) {
    EXPECT_TRUE(isPublic(*constructors, name)) << name;
    EXPECT_FALSE(isPublic(*linked.ir, name)) << name;
  }
  for (const char *name :
       {"rtsl_rt_Material_shade", "rtsl_rt_Primitive_intersect", "Ball.intersect"}) {
    EXPECT_FALSE(isPublic(*constructors, name)) << name;
    EXPECT_TRUE(isPublic(*linked.ir, name)) << name;
  }
}

} // namespace
} // namespace rtsl
