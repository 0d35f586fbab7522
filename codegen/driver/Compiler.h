//===- Compiler.h - the compiler as a library -----------------------------===//
//
// From a checked module to a program that runs in this process, to a package, to C++, and to what
// is said of them. Stages.h has the stages in between.
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

/// How `trace` runs: as a call, or as the end of one state and the beginning of another, without
/// recursion (docs/continuations.md). The picture is the same, bit for bit.
enum class TraceMode : std::uint8_t { Recurse, Split };

/// What renders a scene in this process: the runtime with its own traversals, or the GPU's whole
/// program, compiled for the CPU. The picture is the same, bit for bit, if the runtime traverses as
/// GPUs do.
enum class Target : std::uint8_t { Host, HostMegakernel };

struct CompileOptions {
  std::uint32_t colorComponents = 3; // 1 to RTSL_MAX_COLOR
  bool checkIndices = true;
  unsigned optimization = 2; // of machine code, 0 to 3; up to 2 the parts of a large program have 1
  // 1: none but the caller's. Otherwise large programs are compiled on all cores
  unsigned threads = 0;
  TraceMode trace = TraceMode::Recurse; // of Target::Host; there is no recursion elsewhere
  Target target = Target::Host;
  /// States save all that is live over a trace, and nothing is computed again: to compare with.
  bool savesAllThatIsLive = false;
  /// What -Wlive-state calls much, in bytes: half of the registers that a GPU thread of a ray
  /// tracer has, 32 of 64.
  std::uint32_t largeLiveState = 128;
  /// Numbers go through checks, to find where they stop being finite
  /// (runtime/program/NumberCheck.h). The bits are the same.
  bool checksNumbers = false;
  /// Bring everything back to level 1 and down again, with TraceMode::Split: for tests, which ask
  /// that this changes nothing.
  bool restructure = false;
  FloatingPoint floatingPoint = FloatingPoint::Strict;
  /// The oldest NVIDIA GPU that PTX is for. The default runs on all since 2018.
  std::string gpu = "sm_75";
  /// RTSL_FEATURE_UNDEFINED_*: what nobody has written is filled with a pattern. For tests.
  std::uint32_t undefined = 0;
};

/// Makes objects of a scene by a program that has what this takes, constructors, defaults and
/// bounds, and nothing else.
using MakeObjects = std::function<runtime::SceneFacts(std::shared_ptr<const runtime::Program>)>;

/// Asks for `items` to be kept. Of Item::Events that are checks of indices, and exceptions that are
/// noted and end no sample.
void keep(ItemSet items, LinkRequest &request, CompileOptions &options);

/// How C++ is printed.
struct CppRequest {
  std::string name; // becomes its namespace, and `<name>_shaders` what it exports
  bool lineDirectives = false;
  /// What becomes of a method that traces: its states, or a call where it traces. Without it
  /// states, or calls if something in such a method cannot be printed as states.
  std::optional<TraceMode> trace = std::nullopt;
  std::uint32_t features = 0; // RTSL_FEATURE_* of the program
};

/// The module as one file of C++17 on GLM and rtsl/shader.h (docs/cpp-output.md). `name` becomes
/// its namespace, and `<name>_shaders` what it exports. Nothing if there were errors.
///
/// `trace`: what becomes of a method that traces: its states, or a call where it traces. Without it
/// states, or calls if something in such a method cannot be printed as states. `features`:
/// RTSL_FEATURE_* of the program.
std::optional<std::string> emitCpp(const typed::Module &module, const std::string &name,
                                   bool lineDirectives, std::optional<TraceMode> trace,
                                   std::uint32_t features, const CompileOptions &options,
                                   Diagnostics &diagnostics);

/// How a report is written: for people, for programs, for Graphviz, or drawn.
enum class ReportFormat : std::uint8_t { Text, Json, Dot, Svg };

/// What splitting at `trace` saves and recomputes in each function that traces, and the states that
/// it makes. Nothing if there were errors.
std::optional<std::string> explainStates(const typed::Module &module, const CompileOptions &options,
                                         ReportFormat format, Diagnostics &diagnostics);

/// The same for the linked program of a scene, with its limit of depth.
std::optional<std::string> explainSceneStates(const typed::Module &module,
                                              const LinkRequest &request, std::uint32_t maxDepth,
                                              const CompileOptions &options, ReportFormat format,
                                              Diagnostics &diagnostics);

/// What a program of a scene takes.
struct ProgramSize {
  std::uint64_t instructions = 0;  // of the GPU's whole program, as optimised LLVM IR
  std::uint64_t constantBytes = 0; // tables beside the code
  std::uint32_t frameBytes = 0;    // of the largest frame, saved over a `trace`
  std::uint32_t states = 0;        // that shaders were cut into
};

/// What the program of a scene has, what it does without, and what that saves.
struct SceneExplanation {
  Findings findings;
  ProgramSize size;
  std::map<Item, ProgramSize> sizeKeeping; // if this one item were kept
  /// The linked program without code: what a scene needs to be told what to keep.
  std::shared_ptr<const runtime::Program> program;
};

/// Compiles a scene's program, and once more for each item with that item kept. Nothing if there
/// were errors.
std::optional<SceneExplanation>
explainScene(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
             Diagnostics &diagnostics, const MakeObjects &makeObjects);

/// Splits the module at `trace` and warns where more than CompileOptions::largeLiveState bytes are
/// saved: -Wlive-state. Does nothing if that warning is off, or if the module cannot be lowered.
void checkLiveState(const typed::Module &module, const CompileOptions &options,
                    Diagnostics &diagnostics);

/// Compiles and links the module for scenes, in this process. Null if there were errors. With
/// `makeObjects` it is bound to the scene that this makes (codegen/link/BindScene.h), and renders
/// no other. SceneProgram.h puts both together.
std::shared_ptr<const runtime::Program> compileProgram(const typed::Module &module,
                                                       const LinkRequest &request,
                                                       const CompileOptions &options,
                                                       Diagnostics &diagnostics,
                                                       const MakeObjects &makeObjects = nullptr);

/// What a package needs of a program bound to a scene (runtime/package/Package.h): everything but
/// the scene and its options. False if there were errors.
bool compilePackage(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, Diagnostics &diagnostics,
                    const MakeObjects &makeObjects, runtime::Package &package);

} // namespace rtsl
