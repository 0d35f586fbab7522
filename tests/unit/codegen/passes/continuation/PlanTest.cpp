// Plans of functions with more values than a BitVector holds in itself, for AddressSanitizer too:
// what a trace saves depends only on what comes after it.
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/save/Steps.h"
#include "codegen/passes/continuation/suspend/Steps.h"

#include "mlir/IR/MLIRContext.h"
#include "mlir/Parser/Parser.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::continuation;

namespace {

/// A hundred tables are read before the trace, and three hundred values made; after it eight sums
/// are needed that can be rematerialised from a member.
std::string functionWithManyValues() {
  std::string text = "rtsl.class @M root \"rt_Material\" {\n"
                     "  rtsl.member_decl @a : f32 access \"public\"\n"
                     "}\n"
                     "func.func @f(%self: !rtsl.ref<\"M\">, %o: vector<3xf32>, %i: i32) -> (f32, "
                     "f32, f32, f32, f32, f32, f32, f32) {\n"
                     "  %x0 = arith.constant 1.0 : f32\n";
  for (int i = 0; i != 100; ++i)
    text += fmt::format("  %t{0} = rtsl.var \"t{0}\" : !rtsl.ptr<!rtsl.array<4 x f32>>\n"
                        "  %e{0} = rtsl.element %t{0}[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> "
                        "!rtsl.ptr<f32>\n",
                        i);
  for (int i = 0; i != 300; ++i)
    text += fmt::format("  %x{} = arith.addf %x{}, %x{} : f32\n", i + 1, i, i);
  for (int i = 0; i != 100; ++i)
    text += fmt::format("  rtsl.store %x300, %e{} : !rtsl.ptr<f32>\n", i);
  text += "  %p = rtsl.member %self[\"a\"] : !rtsl.ref<\"M\"> -> !rtsl.ptr<f32>\n"
          "  %s0 = rtsl.load %p : !rtsl.ptr<f32>\n";
  for (int i = 0; i != 8; ++i)
    text += fmt::format("  %s{} = arith.addf %s{}, %s0 : f32\n", i + 1, i);
  return text + "  %c = rtsl.trace %o, %o : vector<3xf32>\n"
                "  return %s1, %s2, %s3, %s4, %s5, %s6, %s7, %s8 : f32, f32, f32, f32, f32, f32, "
                "f32, f32\n"
                "}\n";
}

TEST(Plan, HoldsNothingOfWhatIsNotNeeded) {
  mlir::DialectRegistry registry;
  codegen::registerPassDependencies(registry);
  mlir::MLIRContext context(registry, mlir::MLIRContext::Threading::DISABLED);
  context.loadAllAvailableDialects();
  auto ir = mlir::parseSourceString<mlir::ModuleOp>(functionWithManyValues(), &context);
  ASSERT_TRUE(ir);
  auto function = ir->lookupSymbol<FuncOp>("f");
  insertSuspends(function);
  auto plans = planContinuations(function, {});
  ASSERT_TRUE(mlir::succeeded(plans));
  ASSERT_EQ(plans->size(), 1u);
  EXPECT_TRUE((*plans)[0].saved.empty());
  EXPECT_EQ((*plans)[0].recomputed.size(), 10u); // the member's address, its load, and the sums
}

} // namespace
