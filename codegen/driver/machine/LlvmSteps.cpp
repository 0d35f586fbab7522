//===- LlvmSteps.cpp - the steps to LLVM IR, PTX and machine code ---------===//
#include "codegen/driver/machine/LlvmSteps.h"

#include "codegen/driver/Compilation.h"
#include "codegen/driver/Steps.h"
#include "codegen/driver/machine/CodeCache.h"
#include "codegen/emit/Ptx.h"
#include "codegen/emit/SceneTables.h"
#include "codegen/emit/StepCosts.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/emit/rewrites/PackRecords.h"
#include "codegen/emit/rewrites/WaveStates.h"
#include "codegen/emit/rewrites/arithmetic/CheckNumbers.h"
#include "codegen/emit/rewrites/arithmetic/DoublePrecision.h"
#include "codegen/emit/rewrites/arithmetic/FastMath.h"
#include "codegen/emit/rewrites/gpu/AlignMembers.h"
#include "codegen/link/Link.h"
#include "runtime/program/DeviceBitcode.h"

#include "llvm/ADT/StringExtras.h"
#include "llvm/Bitcode/BitcodeWriter.h"
#include "llvm/Support/SHA256.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>

namespace rtsl::driver {

void fail(const std::string &message) {
  if (message.find(std::strerror(ENOMEM)) != std::string::npos)
    throw std::bad_alloc();
  throw std::logic_error(message);
}

LlvmCode translate(mlir::ModuleOp ir, const codegen::MachineOptions &options,
                   std::vector<Place> *numberPlaces) {
  LlvmCode code;
  code.kept = keptFunctions(ir);
  run(ir, codegen::buildLlvmPipeline);
  if (numberPlaces)
    codegen::checkNumbers(ir, *numberPlaces);
  code.options = options;
  code.machine = take(codegen::createTargetMachine(options));
  code.module = take(codegen::translateToLlvm(ir, *code.context, *code.machine));
  if (options.floatingPoint == FloatingPoint::Fast)
    codegen::relaxArithmetic(*code.module);
  else if (options.floatingPoint == FloatingPoint::Double)
    codegen::widenArithmetic(*code.module);
  return code;
}

void defineFacts(LlvmCode &code, const CompileOptions &options, const runtime::Program &program) {
  codegen::defineConstant(*code.module, "rtsl_needs", program.needs | program.sceneNeeds);
  codegen::defineConstant(*code.module, "rtsl_color_components", program.colorComponents);
  codegen::defineConstant(*code.module, "rtsl_counts_steps", options.countsSteps);
  if (program.engine != runtime::Engine::Either)
    codegen::defineConstant(*code.module, "rtsl_generates",
                            program.engine == runtime::Engine::Programs);
  codegen::defineConstant(*code.module, "rtsl_rays_leave_hits", program.raysLeaveHits);
  codegen::defineConstant(*code.module, "rtsl_light_passes", program.lightPasses);
  codegen::defineConstant(*code.module, "rtsl_has_primitives", program.hasPrimitives);
  codegen::defineConstant(*code.module, "rtsl_rays_read_launch", program.raysReadLaunch);
  codegen::defineConstant(*code.module, "rtsl_rays_leave_planes", program.raysLeavePlanes);
  codegen::defineConstant(*code.module, "rtsl_is_fast",
                          options.floatingPoint == FloatingPoint::Fast);
}

const std::vector<std::string_view> &megakernelCode(bool forGpu) {
  // They use functions of each other; what is not used is not linked.
  static const std::vector<std::string_view> host = {
      runtime::deviceBitcode(), runtime::wavefrontBitcode(), runtime::persistentBitcode(),
      runtime::megakernelBitcode(), runtime::deviceBitcode()};
  static const std::vector<std::string_view> gpu = {
      runtime::gpuDeviceBitcode(), runtime::gpuWavefrontBitcode(), runtime::gpuPersistentBitcode(),
      runtime::gpuMegakernelBitcode(), runtime::gpuDeviceBitcode()};
  return forGpu ? gpu : host;
}

/// The number of "sm_80" and the like.
static unsigned architecture(const std::string &gpu) {
  return unsigned(std::strtoul(gpu.c_str() + std::strlen("sm_"), nullptr, 10));
}

/// Whether rays are chosen at random, and only `generate` waits for them.
static bool followsPaths(const runtime::Program &program, const llvm::Module &module) {
  return program.paths == runtime::Paths::Random &&
         codegen::knownConstant(module, "rtsl_rays_wait_once").value_or(0) != 0;
}

static bool hasTree(const llvm::Module &module) {
  return codegen::knownConstant(module, "rtsl_listed_instances").value_or(0) == 0;
}

/// Whether the states of a program send rays. Without `generate` cameras do.
static bool statesSendRays(const runtime::Program &program, const llvm::Module &module) {
  return program.engine != runtime::Engine::Programs ||
         llvm::any_of(std::array{"rtsl_spawn", "rtsl_spawn_last", "rtsl_spawn_payload",
                                 "rtsl_spawn_last_payload"},
                      [&](const char *name) { return module.getFunction(name); });
}

bool hasList(const LlvmCode &code) {
  return !hasTree(*code.module);
}

/// docs/gpu.md compares the schedules.
static Schedule scheduleFor(const CompileOptions &options, const runtime::Program &program,
                            const llvm::Module &module) {
  if (options.schedule)
    return *options.schedule;
  if (program.paths != runtime::Paths::Random)
    return Schedule::Prioritized;
  const bool replace = codegen::knownConstant(module, "rtsl_rays_replace").value_or(0) != 0;
  const bool isLit = program.needs & (RTSL_NEEDS_EMITTERS | RTSL_NEEDS_SAMPLING);
  return followsPaths(program, module) && replace && !isLit && !hasTree(module)
             ? Schedule::LeastWaste
             : Schedule::Majority;
}

/// Without a tree, a wavefront is faster from this number of instructions on: those of the shaders
/// before optimisation.
constexpr unsigned largeShaders = 3500;

/// docs/gpu.md compares the organisations. Where light passes surfaces, its rays go from one to the
/// next, some lanes more often than others.
static Organisation organisationFor(const CompileOptions &options, const runtime::Program &program,
                                    const llvm::Module &module) {
  if (options.organisation)
    return *options.organisation;
  if (options.countsSteps)
    return Organisation::Megakernel;
  const bool isLarge =
      hasTree(module) || program.lightPasses || module.getInstructionCount() >= largeShaders;
  return followsPaths(program, module) && isLarge ? Organisation::Wavefront
                                                  : Organisation::Megakernel;
}

static bool hasShortShaders(const llvm::Module &module) {
  return module.getInstructionCount() < 600; // before optimisation
}

/// How many samples a warp takes at once. To take several for each lane costs less, but then the
/// warps that run at the same time are further apart in the picture, and need more of the program:
/// a gain only for short shaders (docs/gpu.md).
static std::uint32_t samplesAtOnce(const llvm::Module &module) {
  return hasShortShaders(module) ? 128 : 32;
}

/// A gain if what this saves is much of a sample, and if the lanes of a warp, which then have other
/// pixels, still do the same. In programs with states, searching a tree takes the registers that
/// the sums would need.
void decideWhetherLanesTakePixels(LlvmCode &code, const CompileOptions &options,
                                  const runtime::Program &program) {
  const llvm::Module &module = *code.module;
  code.takesPixels = options.rendersPicture && code.organisation == Organisation::Megakernel &&
                     program.paths == runtime::Paths::Single && hasShortShaders(module) &&
                     (code.isWhole || !hasTree(module) || !statesSendRays(program, module));
  codegen::defineConstant(*code.module, "rtsl_takes_pixels", code.takesPixels);
}

/// So many instructions of `intersect` cost less than a test of its box, in a scene of one
/// primitive: a sphere takes 150, a parallelogram 110 (docs/gpu.md).
constexpr std::uint64_t cheapIntersect = 200;

/// Is it faster to test all primitives of a list, in an unrolled loop, than those whose boxes a ray
/// enters? If the lanes of a warp stay together, boxes leave out most, and the cache of
/// instructions has to hold the rest of a larger program, too. docs/gpu.md has the figures.
static bool gainsFromTestingAll(const llvm::Module &module, const runtime::Program &program,
                                std::uint64_t listed, std::uint64_t cost) {
  constexpr std::uint64_t longestIntersect = 400, longestList = 6400, largestAlike = 1500;
  return listed > 1 && !(program.sceneNeeds & RTSL_HAS_TRANSFORMS) && cost <= longestIntersect &&
         listed * cost <= longestList &&
         (program.paths == runtime::Paths::Random || module.getInstructionCount() < largestAlike);
}

void decideListedTests(LlvmCode &code, const CompileOptions &options,
                       const runtime::Program &program) {
  llvm::Module &module = *code.module;
  const std::uint64_t listed = codegen::knownConstant(module, "rtsl_listed_instances").value_or(0);
  const std::optional<std::uint64_t> cost = codegen::intersectCost(module);
  // Tests of boxes that a ray does not enter must not print or raise an exception.
  const bool mayTestAll = options.floatingPoint == FloatingPoint::Fast &&
                          !(program.slots.features & RTSL_FEATURE_EVENTS);
  code.testsAllListed = mayTestAll && codegen::hasConstantRecords(module) && cost &&
                        gainsFromTestingAll(module, program, listed, *cost);
  codegen::defineConstant(module, "rtsl_tests_all_listed", code.testsAllListed);
  codegen::defineConstant(module, "rtsl_is_intersect_cheap", cost && *cost <= cheapIntersect);
}

/// Do shaders write to the buffers of a scene?
static bool writesBuffers(const runtime::Program &program) {
  return llvm::any_of(program.classes, [](const runtime::ClassInfo &info) {
    return llvm::any_of(info.members, [](const auto &member) { return member.type.isOutput; });
  });
}

/// A state that runs twice must do nothing else that is seen.
void decideKnownLights(LlvmCode &code, const CompileOptions &options,
                       const runtime::Program &program) {
  code.knowsLights = code.organisation == Organisation::Wavefront &&
                     options.lightKernels != LightKernels::Never &&
                     !(program.slots.features & RTSL_FEATURE_EVENTS) && !writesBuffers(program);
  codegen::defineConstant(*code.module, "rtsl_knows_lights", code.knowsLights);
}

/// How the lanes of a warp choose their steps.
static void defineSchedule(llvm::Module &module, const CompileOptions &options,
                           const runtime::Program &program) {
  const Schedule schedule = scheduleFor(options, program, module);
  codegen::defineConstant(module, "rtsl_schedule", std::uint32_t(schedule));
  if (schedule == Schedule::LeastWaste) {
    const std::uint64_t costs = codegen::stepCosts(module);
    codegen::defineConstant(module, "rtsl_step_costs_low", std::uint32_t(costs));
    codegen::defineConstant(module, "rtsl_step_costs_high", std::uint32_t(costs >> 32));
  }
  // With --schedule, or Majority, a warp chooses before each state, so that lanes gather for it.
  const bool runsOn = !options.schedule && schedule != Schedule::Majority;
  codegen::defineConstant(module, "rtsl_states_run_on", std::uint32_t(runsOn));
  codegen::defineConstant(module, "rtsl_samples_at_once", samplesAtOnce(module));
  codegen::defineConstant(module, "rtsl_has_half_pairs", architecture(options.gpu) >= 80);
  codegen::defineForward(module, "rtsl_least_of_warp",
                         architecture(options.gpu) >= 80 ? "rtsl_least_by_instruction"
                                                         : "rtsl_least_by_exchange");
}

/// The kernels of a program, and what the host asks them for.
static std::vector<std::string> kernels(const LlvmCode &code) {
  if (code.takesPixels && code.isWhole)
    return {"rtsl_render_pixels", "rtsl_sum"};
  if (code.hasThreadOfSample)
    return {"rtsl_render_samples", "rtsl_sum"};
  if (code.isWhole)
    return {"rtsl_render_whole", "rtsl_sum"};
  if (code.organisation == Organisation::Megakernel)
    return {"rtsl_render", "rtsl_sum"};
  if (code.organisation == Organisation::Persistent)
    return {"rtsl_persistent", "rtsl_block_state", "rtsl_sum", "rtsl_slots_have_stacks",
            "rtsl_record_groups"};
  std::vector<std::string> names = {
      "rtsl_wave_begin", "rtsl_wave_sample",       "rtsl_wave_trace",   "rtsl_wave_state",
      "rtsl_sum",        "rtsl_slots_have_stacks", "rtsl_record_groups"};
  if (code.knowsLights)
    names.push_back("rtsl_wave_light");
  return names;
}

/// What a program exports on a GPU.
static std::vector<std::string> gpuEntries(const LlvmCode &code) {
  std::vector<std::string> entries = kernels(code);
  entries.push_back("rtsl_launch");
  return entries;
}

static LlvmCode makeKernel(mlir::ModuleOp ir, const CompileOptions &options,
                           const runtime::Program &program, bool forGpu, bool isWhole) {
  LlvmCode code =
      translate(ir, forGpu ? gpuOptions(options) : machineOptions(options, /*hostCpu=*/false));
  defineFacts(code, options, program);
  code.isWhole = isWhole;
  code.hasThreadOfSample = isWhole && !program.samplesDiffer;
  code.organisation = forGpu ? organisationFor(options, program, *code.module)
                             : options.organisation.value_or(Organisation::Megakernel);
  decideWhetherLanesTakePixels(code, options, program);
  decideListedTests(code, options, program);
  decideKnownLights(code, options, program);
  if (forGpu) {
    codegen::alignMembers(*code.module);
    defineSchedule(*code.module, options, program);
  }
  const bool keepsRecords = code.organisation != Organisation::Megakernel;
  if (keepsRecords)
    beginRecords(code, program);
  linkDeviceCode(code, megakernelCode(forGpu),
                 forGpu ? gpuEntries(code) : hostEntries(code.organisation));
  if (llvm::Function *whole = code.module->getFunction("rtsl_render_whole"))
    whole->setName("rtsl_render");
  if (keepsRecords)
    endRecords(code, options, program);
  code.options.isMegakernel = true;
  return code;
}

LlvmCode megakernel(mlir::ModuleOp ir, const CompileOptions &options,
                    const runtime::Program &program, bool forGpu) {
  return makeKernel(ir, options, program, forGpu, /*isWhole=*/false);
}

/// More registers are better than more warps if rays wait for others and the lanes of a warp stay
/// together, and if a kernel has only one step or its shared memory leaves room for only a few
/// warps. docs/gpu.md has the figures.
static std::uint32_t registersFor(const LlvmCode &code, const runtime::Program &program) {
  const runtime::Paths paths = program.paths;
  if (code.organisation != Organisation::Megakernel)
    return 168;
  if (code.isWhole || code.takesPixels)
    return 64;
  if (paths == runtime::Paths::Alike)
    return 128;
  if (hasList(code) && program.needs & RTSL_NEEDS_EMITTERS)
    return 96;
  return paths == runtime::Paths::Single && !hasList(code) ? 80 : 72;
}

LlvmCode gpuKernel(Compilation &compilation) {
  // Translation consumes a module, and the program for the host needs the one with states.
  const bool isWhole = bool(compilation.whole);
  const mlir::OwningOpRef<mlir::ModuleOp> ir =
      isWhole ? std::move(compilation.whole) : mlir::ModuleOp(*compilation.ir).clone();
  LlvmCode code =
      makeKernel(*ir, compilation.options, *compilation.program, /*forGpu=*/true, isWhole);
  code.registers = registersFor(code, *compilation.program);
  return code;
}

void beginRecords(LlvmCode &code, const runtime::Program &program) {
  constexpr std::size_t besideStates = 2; // traversal, and the beginning of samples
  codegen::defineConstant(*code.module, "rtsl_wave_steps",
                          std::uint32_t(program.stateNames.size() + besideStates));
}

/// From this number of instructions on, before optimisation and without those of the runtime, the
/// kernel of a state that shades is so large that a kernel of its own for its rays to lights is a
/// gain (docs/gpu.md).
constexpr unsigned largeState = 1800;

void endRecords(LlvmCode &code, const CompileOptions &options, const runtime::Program &program) {
  const unsigned litFrom = !code.knowsLights                              ? ~0u
                           : options.lightKernels == LightKernels::Always ? 0
                                                                          : largeState;
  codegen::makeWaveStates(*code.module, unsigned(program.stateNames.size()), litFrom);
  codegen::declareRecords(*code.module);
}

const std::vector<std::string> &hostEntries(std::optional<Organisation> organisation) {
  static const std::vector<std::string> lanes = {"rtsl_lane_bytes", "rtsl_run_lane"};
  static const std::vector<std::string> waves = {"rtsl_wave_bytes", "rtsl_run_wave",
                                                 "rtsl_wave_state", "rtsl_wave_light"};
  static const std::vector<std::string> blocks = {"rtsl_block_bytes", "rtsl_run_block",
                                                  "rtsl_block_state"};
  return organisation == Organisation::Wavefront    ? waves
         : organisation == Organisation::Persistent ? blocks
                                                    : lanes;
}

void linkDeviceCode(LlvmCode &code, llvm::ArrayRef<std::string_view> bitcodes,
                    std::vector<std::string> exports) {
  exports.insert(exports.end(), code.kept.begin(), code.kept.end());
  if (llvm::Error error = codegen::linkDeviceCode(*code.module, bitcodes, exports))
    throw std::logic_error(llvm::toString(std::move(error)));
}

codegen::MachineOptions machineOptions(const CompileOptions &options, bool hostCpu) {
  codegen::MachineOptions machine;
  machine.optimization = options.optimization;
  machine.hostCpu = hostCpu;
  machine.floatingPoint = options.floatingPoint;
  return machine;
}

codegen::MachineOptions gpuOptions(const CompileOptions &options) {
  codegen::MachineOptions machine;
  machine.optimization = options.optimization;
  machine.gpu = options.gpu;
  machine.floatingPoint = options.floatingPoint;
  return machine;
}

void optimize(LlvmCode &code) {
  codegen::optimize(*code.module, *code.machine, code.options);
}

/// All that decides what a module becomes: its bits, and how it is compiled.
static std::string identityOf(const LlvmCode &code) {
  llvm::SmallVector<char, 0> bits;
  llvm::raw_svector_ostream stream(bits);
  llvm::WriteBitcodeToFile(*code.module, stream);
  llvm::SHA256 hash;
  hash.update(llvm::StringRef(bits.data(), bits.size()));
  const codegen::MachineOptions &options = code.options;
  return fmt::format("{} {} {} {} {} {}", llvm::toHex(hash.final()), options.optimization,
                     options.isMegakernel, int(options.floatingPoint),
                     code.machine->getTargetCPU().str(),
                     code.machine->getTargetFeatureString().str());
}

std::string madeOf(const LlvmCode &code, const char *kind, const CompileOptions &options,
                   const std::function<std::string()> &make) {
  if (!options.codeCache)
    return make();
  return options.codeCache->codeOf(fmt::format("{} {}", kind, identityOf(code)), make);
}

codegen::ObjectCode toObject(LlvmCode code, const CompileOptions &options) {
  const std::string text = madeOf(code, "object", options, [&] {
    optimize(code);
    return codegen::textOf(take(codegen::makeObjectCode(*code.module, *code.machine)));
  });
  return codegen::readObjectCode(text).value();
}

// The facts of a wavefront are in a line before its PTX.
std::string toPtx(LlvmCode code, const CompileOptions &options, runtime::WaveFacts *facts) {
  const bool hasFacts = facts && code.organisation != Organisation::Megakernel;
  codegen::nameForPtx(*code.module);
  std::string text = madeOf(code, hasFacts ? "wavefront" : "ptx", options, [&] {
    optimize(code);
    std::string line;
    if (hasFacts)
      line = fmt::format(
          "{} {}\n", codegen::takeConstant(*code.module, "rtsl_record_groups").value(),
          // Not known of code that is not optimised.
          int(codegen::takeConstant(*code.module, "rtsl_slots_have_stacks").value_or(1) != 0));
    return line + take(codegen::printPtx(*code.module, *code.machine));
  });
  if (!hasFacts)
    return text;
  const auto [line, ptx] = llvm::StringRef(text).split('\n');
  const auto [groups, hasStacks] = line.split(' ');
  groups.getAsInteger(10, facts->groups);
  facts->hasStacks = hasStacks == "1";
  return ptx.str();
}

} // namespace rtsl::driver
