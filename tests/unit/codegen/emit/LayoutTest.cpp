// Layout.h: sizes and offsets against the C layouts that the runtime uses.
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "runtime/device/ray/Launch.h"

#include "mlir/AsmParser/AsmParser.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/Parser/Parser.h"

#include <gtest/gtest.h>

using namespace rtsl;

namespace {

struct LayoutTest : testing::Test {
  LayoutTest() { context.loadDialect<ir::RtslDialect>(); }
  uint32_t size(const char *type) {
    mlir::Type parsed = mlir::parseType(type, &context);
    EXPECT_TRUE(parsed) << type;
    return ir::sizeInBytes(parsed);
  }
  mlir::MLIRContext context{mlir::MLIRContext::Threading::DISABLED};
};

TEST_F(LayoutTest, SizesAreMultiplesOfFour) {
  EXPECT_EQ(size("f32"), 4u);
  EXPECT_EQ(size("i1"), 4u);
  EXPECT_EQ(size("vector<3xi1>"), 12u);
  EXPECT_EQ(size("vector<3xf32>"), 12u);
  EXPECT_EQ(size("vector<16xf32>"), 64u);
  EXPECT_EQ(size("!rtsl.ref<\"rt_Texture\">"), sizeof(RtslRef));
  EXPECT_EQ(size("!rtsl.buffer<vector<3xf32>, 2>"), sizeof(RtslBuffer));
  EXPECT_EQ(size("!rtsl.array<4 x vector<3xf32>>"), 48u);
  EXPECT_EQ(size("!rtsl.array<2 x !rtsl.array<3 x i1>>"), 24u);
}

TEST_F(LayoutTest, FieldsFollowEachOther) {
  struct C {
    float a;
    float b[3];
    int32_t c;
    float d[2][2];
    RtslBuffer e;
  };
  auto type = mlir::cast<ir::StructType>(mlir::parseType(
      "!rtsl.struct<\"C\", {a: f32, b: vector<3xf32>, c: i1, d: !rtsl.array<2 x vector<2xf32>>, "
      "e: !rtsl.buffer<f32, 1>}>",
      &context));
  EXPECT_EQ(ir::fieldOffset(type, 0), offsetof(C, a));
  EXPECT_EQ(ir::fieldOffset(type, 1), offsetof(C, b));
  EXPECT_EQ(ir::fieldOffset(type, 2), offsetof(C, c));
  EXPECT_EQ(ir::fieldOffset(type, 3), offsetof(C, d));
  EXPECT_EQ(ir::fieldOffset(type, 4), offsetof(C, e));
  EXPECT_EQ(ir::sizeInBytes(type), sizeof(C));
}

TEST_F(LayoutTest, RecordsBeginWithTheClassIdAndLeaveOutScratch) {
  auto module = mlir::parseSourceString<mlir::ModuleOp>(R"(
    rtsl.class @A root "rt_Primitive" {
      rtsl.member_decl @n : vector<3xf32> access "scratch"
      rtsl.member_decl @radius : f32 access "public"
      rtsl.member_decl @inside : i1 access "private"
      rtsl.member_decl @center : vector<3xf32> access "public"
    }
    rtsl.class @Empty root "rt_Light" {
    })",
                                                        &context);
  auto a = module->lookupSymbol<ir::ClassOp>("A");
  EXPECT_EQ(ir::memberOffset(a, "radius"), 4u);
  EXPECT_EQ(ir::memberOffset(a, "inside"), 8u);
  EXPECT_EQ(ir::memberOffset(a, "center"), 12u);
  EXPECT_EQ(ir::memberOffset(a, "n"), std::nullopt);
  EXPECT_EQ(ir::memberOffset(a, "color"), std::nullopt);
  EXPECT_EQ(ir::recordSize(a), 24u);
  EXPECT_EQ(ir::recordSize(module->lookupSymbol<ir::ClassOp>("Empty")), 4u);
}

} // namespace
