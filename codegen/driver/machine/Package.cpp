//===- Package.cpp - the program of a package -----------------------------===//
#include "codegen/driver/machine/LlvmSteps.h"
#include "codegen/driver/machine/MachineStages.h"
#include "codegen/emit/NativeImage.h"
#include "runtime/program/DeviceBitcode.h"

namespace rtsl {

using namespace driver;

/// Machine code for this processor without library calls: it has its own `memcpy`.
static runtime::NativeImage hostImage(const Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  LlvmCode code = translate(*compilation.ir, machineOptions(options, /*hostCpu=*/false));
  defineFacts(code, compilation.options, *compilation.program);
  std::vector<std::string> kept = {"memcpy", "memmove", "memset"};
  kept.insert(kept.end(), hostEntries().begin(), hostEntries().end());
  std::vector<std::string_view> bitcodes = megakernelCode(/*forGpu=*/false);
  bitcodes.push_back(runtime::hostMemoryBitcode());
  linkDeviceCode(code, bitcodes, kept);
  code.options.isMegakernel = true;
  codegen::NativeImage image =
      take(codegen::makeNativeImage(toObject(std::move(code), options), hostEntries()));
  return {std::move(image.bytes), image.entries[0], image.entries[1],
          static_cast<std::uint32_t>(image.stackBytes)};
}

bool compilePackage(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, Diagnostics &diagnostics,
                    const MakeObjects &makeObjects, runtime::Package &package) {
  CompileInput input;
  input.module = &module;
  input.scene = &request;
  input.makeObjects = makeObjects;
  input.machineCode = &machineCode();
  Compilation compilation(input, options, diagnostics);
  if (!reachGpuMachine(compilation))
    return false;
  package.frameBytes = compilation.report.frameSize();
  package.stateCount = compilation.report.stateCount();
  LlvmCode code = gpuKernel(compilation);
  const Organisation organisation = code.organisation;
  package.registers = code.registers;
  package.ptx = toPtx(std::move(code), options, &package.wave);
  if (organisation != Organisation::Megakernel) {
    package.wave.states = std::uint32_t(compilation.program->stateNames.size());
    package.wave.isPersistent = organisation == Organisation::Persistent;
  }
  package.stateNames = compilation.program->stateNames;
  package.host = hostImage(compilation);
  return true;
}

} // namespace rtsl
