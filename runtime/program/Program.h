//===- Program.h - compiled shaders for the runtime -----------------------===//
//
// A program is code plus a description of its classes. It may come from the compiler in process or
// be linked in ahead of time; the runtime treats both alike.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/Range.h"
#include "runtime/device/ray/Abi.h"
#include "support/Error.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct RtslJob;

namespace rtsl::runtime {

/// The types that a scene can set. A vector has `rows` components, a matrix `columns` x `rows`,
/// stored by columns.
struct ValueType {
  enum class Kind : std::uint8_t { Float, Int, UInt, Bool, Color, Reference, Struct };
  Kind kind = Kind::Float;
  std::uint8_t rows = 1;
  std::uint8_t columns = 1;
  std::uint8_t bufferRank = 0; // 1 to 3: an unsized array of the above, an RtslBuffer in the record
  bool isOutput = false;       // a buffer that the program writes
  std::vector<std::uint32_t> arraySizes; // fixed-length dimensions, outermost first
  std::string className;                 // Reference: the required base or class
  std::string name;              // as spelled in the source, for messages: "vec3", "float[4]"
  std::uint32_t size = 4;        // bytes in total; for a buffer: of the RtslBuffer
  std::uint32_t elementSize = 0; // for a buffer: bytes from element to element
  std::vector<struct MemberInfo> fields; // Struct: its members, with offsets from its start
};

struct MemberInfo {
  std::string name;
  ValueType type;
  std::uint32_t offset =
      0; // bytes from the start of the record (members) or of the packed arguments (parameters)
  bool isPublic = false;       // the scene may set it
  bool hasDefault = false;     // for a reference: it may be empty
  bool isRequired = false;     // no object may be without a value (codegen/link/RequiredMembers.h)
  bool isRead = true;          // by some function of the program
  std::optional<Range> values; // which each of its components may have
  /// For a member that refers to images: which channels the program reads, bits 0 to 3 for red,
  /// green, blue and alpha.
  static constexpr std::uint32_t allChannels = 15;
  std::uint32_t imageChannels = allChannels;
};

/// A scratch member that materials read of meshes: one of their named attributes.
struct AttributeInfo {
  std::string name;
  ValueType type;
  /// Offsets in RtslState::attributes, in words: of the value, and of its changes along dPdx and
  /// dPdy.
  std::uint32_t offset = RTSL_NOT_READ;
  std::uint32_t changes[2] = {RTSL_NOT_READ, RTSL_NOT_READ};
};

/// A member of a class, by their names.
struct MemberName {
  std::string className, member;
};

struct ClassInfo {
  std::string name;
  std::string base; // "rt_Primitive", or another user class
  /// The user classes above `base`, which need not be in the program themselves.
  std::vector<std::string> ancestors;
  std::string root;                // the rt_ class at the end of the chain
  std::uint32_t id = 0;            // first word of a record; from 1
  std::uint32_t recordSize = 4;    // bytes, multiple of 4
  std::vector<MemberInfo> members; // inherited ones first
  bool hasConstructor = false;
  std::vector<MemberInfo> parameters; // of the constructor
  std::uint32_t parameterSize = 0;    // bytes of the packed arguments
  std::vector<std::string> methods; // defined or inherited; with a payload: `closestHit(Radiance)`
  /// The parts of a hit that its methods read (for a material: methods that run at hits, and the
  /// lights), without calls on objects that they refer to.
  std::uint32_t needs = RTSL_NEEDS_ALL;
  /// Of a material: which of Program::meshAttributes its methods read, as bits.
  std::uint32_t attributes = 0;
  std::uint32_t anyHit =
      0; // of a material: rtslRayTypeBit of the payloads for which it has `anyHit`
  /// Of a material: if all of these are 0, in the object and those that it refers to, no light of
  /// the scene's lights passes it. Nothing: some may.
  std::optional<std::vector<MemberName>> opaqueIfZero;
  /// Writes member defaults into the record at `object`. Null: there are none.
  void (*initialize)(RtslState *state, RtslRef object) = nullptr;
  /// Runs the constructor on the record at `object`. Null: there is none.
  void (*construct)(RtslState *state, RtslRef object, const void *arguments) = nullptr;
  /// For a primitive: its own `intersect`. Null: the slot is called.
  void (*intersect)(RtslState *state, RtslRef object) = nullptr;
};

/// An item of a `print`: a text, or a value with the name of its type.
struct PrintItem {
  std::string text;
  ValueType::Kind kind = ValueType::Kind::Float; // of the words of a value
  std::uint32_t words = 0;                       // 0: a text
};
using PrintFormat = std::vector<PrintItem>;

/// Facts about a scene that the compiler may use after its objects are created.
struct SceneFacts {
  /// A scene with more instances does not list them.
  static constexpr std::size_t mostInstances = 64;
  struct Object {
    std::string className;
    const std::uint8_t *record; // of the class's recordSize bytes
  };
  std::vector<Object> objects;
  /// The records of all objects, at their references; null: not known.
  const std::uint8_t *records = nullptr;
  std::size_t recordBytes = 0;
  /// Whether some records have buffers, whose addresses are those of this process.
  bool hasBuffers = false;
  std::vector<RtslInstance> instances; // empty: not known, or more than mostInstances
  std::size_t instanceCount = 0;       // of the scene, listed or not
  /// Those of the launch, if the instances are listed; null: not known.
  std::optional<std::vector<RtslEmitter>> emitters;
  std::uint32_t lightCount = 0;
  std::vector<float> ambient; // one number per component of a color
  std::uint32_t needs = 0;    // RTSL_HAS_*
  /// The longest chain of references from object to object; the maximum value: not known.
  std::uint32_t referenceChain = ~0u;
};

/// The start of a sample: the camera ray, or `generate`. Either: `generate` if the scene has a ray
/// generation.
enum class Engine : std::uint8_t { Classic, Programs, Either };

/// Self-contained code that renders a flat scene (runtime/device/organisations/Megakernel.h); null
/// if there is none.
struct MegakernelCode {
  std::uint64_t (*laneBytes)(std::uint32_t maxDepth, std::uint32_t referenceChain) = nullptr;
  void (*runLane)(const RtslJob *, std::uint32_t lane) = nullptr;
  std::uint64_t stackBytes = 0; // of the calling thread
};

/// Facts of a wavefront or of persistent blocks for a GPU
/// (runtime/device/organisations/Wavefront.h, Persistent.h).
struct WaveFacts {
  std::uint32_t states = 0;  // of a wavefront each has a kernel; 0: it is a megakernel
  std::uint32_t groups = 0;  // of four words, in the record of a sample in flight
  bool hasStacks = false;    // otherwise the only level of its rays is in the record
  bool isPersistent = false; // one kernel of persistent blocks
};

/// Whether shaders send rays from hits: none; rays that depend on the hit alone; or rays that are
/// chosen at random.
enum class Paths : std::uint8_t { Single, Alike, Random };

struct Program {
  Engine engine = Engine::Classic;
  std::vector<ClassInfo> classes;
  std::uint32_t colorComponents = 3;
  std::vector<AttributeInfo> meshAttributes; // at most 32

  /// Entries of Slots.def and SamplingSlots.def; a slot that no class of the scene defines may be
  /// null.
  struct Slots {
#define RTSL_SLOT(base, method) void (*base##_##method)(RtslState *, RtslRef) = nullptr;
#include "language/Slots.def"
#define RTSL_PAYLOAD_SLOT(base, method)                                                            \
  void (*base##_##method##_payload)(RtslState *, RtslRef) = nullptr;
#include "language/PayloadSlots.def"
#define RTSL_SAMPLING_SLOT(base, method) void (*base##_##method)(RtslState *, RtslRef) = nullptr;
#include "language/SamplingSlots.def"

    /// For shaders in C++ that were split at their traces: the functions of the machine
    /// (runtime/device/engines/Machine.h). Without `run` traces are calls.
    struct States {
      std::int32_t (*run)(RtslState *, std::int32_t number, RtslRef object, void *frame) = nullptr;
      std::int32_t frameSize = 0; // bytes of the largest frame of a method that the runtime starts
      std::uint32_t calledMethods = 0;   // called through references, with frames of their own
      std::uint32_t calledFrameSize = 0; // bytes of the largest of these, a multiple of 8
      // The first states of methods; 0: there is none.
      std::int32_t shadeFirst = 0, missFirst = 0, closestHitFirst = 0, missWithPayloadFirst = 0,
                   generateFirst = 0;
    } states;

    std::uint32_t features = 0; // the result of rtsl_features, RTSL_FEATURE_*
  } slots;

  /// The program's rtsl_emitted_power; null if it does not choose points on surfaces that shine.
  float (*emittedPower)(const RtslLaunch *, std::uint32_t instance, std::uint32_t part,
                        std::uint32_t sample, float *normal) = nullptr;

  /// RTSL_NEEDS_*: the state that the methods of the program's classes read.
  std::uint32_t needs = RTSL_NEEDS_ALL;
  Paths paths = Paths::Random;
  bool raysLeaveHits = true; // shaders of hits send rays; otherwise only `generate` does
  /// `generate` sends rays in a loop, or such that end at any hit, so that some samples take far
  /// longer than others.
  bool samplesDiffer = true;
  bool lightPasses = true;      // the light of lights passes some materials
  bool hasPrimitives = true;    // of classes, beside triangles
  bool raysLeavePlanes = false; // no ray leaves a primitive of a class that it may meet again
  /// Methods other than those of the camera and `generate` read LaunchIndex or LaunchSize.
  bool raysReadLaunch = true;
  /// RTSL_HAS_*: what the scenes that it renders may have.
  std::uint32_t sceneNeeds = RTSL_HAS_ALL;
  /// Keep normals and texture coordinates of meshes, and named attributes, even if nothing reads
  /// them.
  bool keepsMeshes = true, keepsMeshAttributes = true;
  /// The program's rtsl_sample, or rtsl_generate.
  void (*sample)(const RtslLaunch *, std::uint32_t x, std::uint32_t y, std::uint32_t sample,
                 float *color) = nullptr;
  MegakernelCode megakernel;
  /// Bytes of stack that the frames of `sample` take at most, for a depth limit and
  /// RtslLaunch::referenceChain. Empty: not known.
  std::function<std::uint64_t(std::uint32_t maxDepth, std::uint32_t referenceChain)> stackBytes;
  /// The source positions of the numbers that rtsl_check_number checks, by place (NumberCheck.h).
  std::vector<Place> numberPlaces;

  std::vector<PrintFormat> prints; // by number
  /// The names of the machine's states, from number 1; empty: it has none, or its names are not
  /// known.
  std::vector<std::string> stateNames;

  std::shared_ptr<void> code; // keeps the code alive

  const ClassInfo *find(const std::string &name) const {
    for (const ClassInfo &info : classes)
      if (info.name == name)
        return &info;
    return nullptr;
  }
};

} // namespace rtsl::runtime
