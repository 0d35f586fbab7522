//===- Compiler.h - the compiler as a library -----------------------------===//
//
// From a checked module to a program in this process, to a package, to C++, and to reports.
// Stages.h has the stages in between.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/FloatingPoint.h"
#include "codegen/link/LinkRequest.h"
#include "frontend/diagnostics/Diagnostics.h"
#include "runtime/package/Package.h"
#include "runtime/program/Program.h"
#include "sema/typed/TypedAst.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl {

class CodeCache;

/// How `trace` runs: as a call, or as the end of one state and the beginning of another, without
/// recursion (docs/continuations.md). The picture is the same, bit for bit.
enum class TraceMode : std::uint8_t { Recurse, Split };

/// The code that renders a scene in this process: the runtime with its own traversals, or the GPU's
/// whole program, compiled for the CPU. The picture is the same, bit for bit, if the runtime
/// traverses like a GPU.
enum class Target : std::uint8_t { Host, HostMegakernel };

/// How the lanes of a warp choose the next step (runtime/device/organisations/Schedule.h).
enum class Schedule : std::uint32_t {
  Majority = RTSL_SCHEDULE_MAJORITY,
  Prioritized = RTSL_SCHEDULE_PRIORITIZED,
  RoundRobin = RTSL_SCHEDULE_ROUND_ROBIN,
  Naive = RTSL_SCHEDULE_NAIVE,
  LeastWaste = RTSL_SCHEDULE_LEAST_WASTE,
};

/// How the steps of samples are organised on a GPU: all in one kernel, each lane with a sample of
/// its own (runtime/device/organisations/Megakernel.h); a kernel for each step, with many more
/// samples in flight than lanes (runtime/device/organisations/Wavefront.h); or all in one kernel,
/// and each block of lanes has samples of its own in shared memory
/// (runtime/device/organisations/Persistent.h). The picture is the same, bit for bit.
enum class Organisation : std::uint8_t { Megakernel, Wavefront, Persistent };

/// Which states of a wavefront have a kernel that looks for lights before the one that shades
/// (runtime/device/engines/KnownLights.h): large ones, all that call `illuminate`, or none. The
/// picture is the same, bit for bit.
enum class LightKernels : std::uint8_t { Auto, Always, Never };

struct CompileOptions {
  std::uint32_t colorComponents = 3; // 1 to RTSL_MAX_COLOR
  bool checkIndices = true;
  unsigned optimization = 2; // of machine code, 0 to 3; up to 2 the parts of a large program have 1
  // 1: only the caller's thread. Otherwise large programs are compiled on all cores
  unsigned threads = 0;
  TraceMode trace = TraceMode::Recurse; // for Target::Host; other targets never recurse
  Target target = Target::Host;
  /// States save all values live across a trace and recompute none: for comparison.
  bool savesAllThatIsLive = false;
  /// The threshold of -Wlive-state, in bytes: half of the registers that a GPU thread of a ray
  /// tracer has, 32 of 64.
  std::uint32_t largeLiveState = 128;
  /// Check numbers, to find where they stop being finite (runtime/program/NumberCheck.h). The bits
  /// are the same.
  bool checksNumbers = false;
  /// Restructure everything to level 1 and lower it again, with TraceMode::Split: for tests, which
  /// check that this changes nothing.
  bool restructure = false;
  FloatingPoint floatingPoint = FloatingPoint::Strict;
  /// The oldest NVIDIA GPU that PTX is for. The default runs on all since 2018.
  std::string gpu = "sm_75";
  /// The schedule of PTX for a scene. None: chosen by the kind of program, like the organisation
  /// (docs/gpu.md).
  std::optional<Schedule> schedule;
  /// The organisation of programs for GPUs and for Target::HostMegakernel; for the latter, none
  /// means Megakernel.
  std::optional<Organisation> organisation;
  LightKernels lightKernels = LightKernels::Auto;
  /// Samples have a color that is wanted, and not only output buffers.
  bool rendersPicture = true;
  /// Megakernels count the steps of warps (runtime/device/organisations/StepCounts.h).
  bool countsSteps = false;
  /// RTSL_FEATURE_SAMPLER_*, or 0, in place of the scene's: what the numbers that samples draw are.
  std::optional<std::uint32_t> sampler = {};
  /// RTSL_FEATURE_UNDEFINED_*: fill uninitialised memory with a pattern. For tests.
  std::uint32_t undefined = 0;
  /// Code that earlier programs had is used again; null: none is kept.
  std::shared_ptr<CodeCache> codeCache = {};
};

/// For CompileOptions::codeCache: with the code of earlier runs, if the user keeps it. Defined in
/// rtslMachineCode.
std::shared_ptr<CodeCache> keptCode();

/// Makes the objects of a scene with a program that contains only constructors, defaults and
/// bounds.
using MakeObjects = std::function<runtime::SceneFacts(std::shared_ptr<const runtime::Program>)>;

/// Requests that `items` are kept. For Item::Events: index checks, and exceptions that are recorded
/// but end no sample.
void keep(ItemSet items, LinkRequest &request, CompileOptions &options);

/// How a module is printed as one file of C++17 on GLM and rtsl/shader.h (docs/cpp-output.md).
struct CppRequest {
  std::string name; // becomes its namespace, and `<name>_shaders` what it exports
  bool lineDirectives = false;
  /// How methods that trace are printed: as states, or with calls where they trace. If not given:
  /// as states, or with calls if such a method cannot be printed as states.
  std::optional<TraceMode> trace = std::nullopt;
  std::uint32_t features = 0; // RTSL_FEATURE_* of the program
};

/// The format of a report: for users, for other programs, for Graphviz, or drawn.
enum class ReportFormat : std::uint8_t { Text, Json, Dot, Svg };

/// The values that splitting at `trace` saves and recomputes in each function that traces, and the
/// resulting states. Nothing if there were errors.
std::optional<std::string> explainStates(const typed::Module &module, const CompileOptions &options,
                                         ReportFormat format, Diagnostics &diagnostics);

/// The same for the linked program of a scene, with its depth limit.
std::optional<std::string> explainSceneStates(const typed::Module &module,
                                              const LinkRequest &request, std::uint32_t maxDepth,
                                              const CompileOptions &options, ReportFormat format,
                                              Diagnostics &diagnostics);

/// The size of a scene's program.
struct ProgramSize {
  std::uint64_t instructions = 0;  // of the GPU's whole program, as optimised LLVM IR
  std::uint64_t constantBytes = 0; // tables beside the code
  std::uint32_t frameBytes = 0;    // of the largest frame, saved over a `trace`
  std::uint32_t states = 0;        // of all shaders
};

/// The items that a scene's program contains and omits, and the savings.
struct SceneExplanation {
  Findings findings;
  ProgramSize size;
  std::map<Item, ProgramSize> sizeKeeping; // if this one item were kept
  bool hasSavings = true;                  // sizeKeeping was measured
  /// The linked program without code: needed to determine the objects to keep.
  std::shared_ptr<const runtime::Program> program;
};

/// Compiles a scene's program, and, with savings, once more for each item with that item kept.
/// Nothing if there were errors.
std::optional<SceneExplanation>
explainScene(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
             Diagnostics &diagnostics, const MakeObjects &makeObjects, bool withSavings = true);

/// Splits the module at `trace` and warns where more than CompileOptions::largeLiveState bytes are
/// saved: -Wlive-state. Does nothing if that warning is off, or if the module cannot be lowered.
void checkLiveState(const typed::Module &module, const CompileOptions &options,
                    Diagnostics &diagnostics);

/// Compiles and links the module for scenes, in this process. Null if there were errors. With
/// `makeObjects` it is bound to the scene that this makes (codegen/link/BindScene.h), and cannot
/// render any other. SceneProgram.h combines both.
std::shared_ptr<const runtime::Program> compileProgram(const typed::Module &module,
                                                       const LinkRequest &request,
                                                       const CompileOptions &options,
                                                       Diagnostics &diagnostics,
                                                       const MakeObjects &makeObjects = nullptr);

/// Compiles the program of a package, bound to a scene (runtime/package/Package.h): everything
/// except the scene and its options. False if there were errors.
bool compilePackage(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, Diagnostics &diagnostics,
                    const MakeObjects &makeObjects, runtime::Package &package);

} // namespace rtsl
