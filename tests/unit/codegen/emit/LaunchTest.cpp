// What a shader reads from the launch, by way of its ray's state.
#include "codegen/emit/Jit.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "runtime/device/ray/State.h"
#include "tests/unit/codegen/emit/MakeContext.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/Parser/Parser.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/Linker/Linker.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <string>

using namespace rtsl::codegen;

namespace {

/// A shader that returns the number of lights.
constexpr const char *shader = "func.func @lights() -> i32 attributes {rtsl.export} {\n"
                               "  %n = rtsl.light_count\n  return %n : i32\n}\n";

/// Its caller, which has a state of its own, as the device code has: a copy of `parent`.
std::string caller() {
  const std::string size = std::to_string(sizeof(RtslState));
  return "declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)\n"
         "declare i32 @lights(ptr)\n"
         "define i32 @f(ptr %parent, ptr %use) {\n"
         "  %state = alloca [" +
         size +
         " x i8], align 8\n"
         "  call void @llvm.memcpy.p0.p0.i64(ptr %state, ptr %parent, i64 " +
         size +
         ", i1 false)\n"
         "  %n = call i32 @lights(ptr %state)\n"
         "  call void %use(ptr %state)\n"
         "  ret i32 %n\n}\n";
}

void use(RtslState *) {}

/// f at a level of optimisation.
std::uint32_t lightsOfCopy(RtslState &parent, unsigned optimization) {
  const auto mlirContext = makeContext();
  auto ir = mlir::parseSourceString<mlir::ModuleOp>(shader, mlirContext.get());
  mlir::PassManager passes(mlirContext.get());
  buildLlvmPipeline(passes);
  EXPECT_TRUE(mlir::succeeded(passes.run(*ir)));
  MachineOptions options;
  options.optimization = optimization;
  auto machine = llvm::cantFail(createTargetMachine(options));
  auto context = std::make_unique<llvm::LLVMContext>();
  auto module = llvm::cantFail(translateToLlvm(*ir, *context, *machine));
  auto device = parseLlvm(caller(), *context);
  device->setTargetTriple(module->getTargetTriple());
  device->setDataLayout(module->getDataLayout());
  EXPECT_FALSE(llvm::Linker::linkModules(*module, std::move(device)));
  // With the same attributes, or the call is not inlined.
  module->getFunction("f")->addFnAttrs(
      llvm::AttrBuilder(*context, module->getFunction("lights")->getAttributes().getFnAttrs()));
  optimize(*module, *machine, options);
  const auto jit =
      llvm::cantFail(Jit::create(std::move(context), std::move(module), std::move(machine), {}));
  using Function = std::uint32_t (*)(RtslState *, void (*)(RtslState *));
  return reinterpret_cast<Function>(jit->lookup("f"))(&parent, use);
}

} // namespace

// A load of the state's launch must not move before the copy that writes it.
TEST(Launch, IsReadAfterItIsWritten) {
  RtslLaunch launch = {};
  launch.lightCount = 17;
  RtslState state = {};
  state.launch = &launch;
  for (const unsigned optimization : {0u, 1u, 2u, 3u})
    EXPECT_EQ(lightsOfCopy(state, optimization), 17u) << "-O" << optimization;
}
