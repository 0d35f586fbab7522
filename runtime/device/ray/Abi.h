//===- Abi.h - the interface between compiled shaders and runtime ---------===//
//
// Plain C layouts, the same for the host and the GPU, included by the runtime, by the code that is
// linked into shaders and by the compiler, which takes every offset from here with offsetof. A vecN
// is N floats with alignment 4, a matrix its columns one after the other, a color up to
// RTSL_MAX_COLOR floats of which the first N are used, a bool a 32-bit 0 or 1.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stddef.h>
#include <stdint.h>

#define RTSL_MAX_COLOR 16
#define RTSL_MAX_ATTRIBUTE_WORDS 32

/// A reference to an object of the scene: byte offset of its record from RtslLaunch::records. 0 is
/// "none".
typedef uint32_t RtslRef;

/// A buffer member (`public vec3 vertices[];`) as stored in a record. Elements are packed with
/// alignment 4. Rank 1 uses size[0] alone; the first index of the source varies slowest.
typedef struct RtslBuffer {
  uint32_t addressLow, addressHigh; // of element 0
  uint32_t size[3];
} RtslBuffer;

/// Something that can be hit: a geometry with a material. `primitive` is an RTSL object, or 0 for a
/// triangle mesh.
typedef struct RtslInstance {
  RtslRef primitive;
  RtslRef material;
  // index into RtslLaunch::meshes when primitive is 0; of an object that holds several primitives,
  // its number among such objects
  uint32_t mesh;
  uint32_t needs;     // RTSL_NEEDS_* of its material, and RTSL_HAS_NO_BACKS of the instance
  uint32_t mask;      // visible to rays whose mask has a common bit
  uint32_t anyHit;    // rtslRayTypeBit of the payloads for which its material has `anyHit`
  uint32_t transform; // index into RtslLaunch::transforms; 0: object space is world space
  uint32_t roots;     // bit r: rays that enter at root r can see it
  // the first of RtslLaunch::boxes of an object that holds several primitives, and their number;
  // any other object is one primitive, and has 0 and 0
  uint32_t firstBox, boxCount;
  int32_t id;         // the scene's number for it, rt_InstanceId
  uint32_t selection; // of RtslLaunch::selections: rays see it if this one is visited; 0: always
  float boundMin[3], boundMax[3]; // of an RTSL primitive, from `computeBounds`, in object space
  // the box for traversal in world space, slightly larger; not of a mesh without a transform
  float lower[3], upper[3];
} RtslInstance;

/// The bounds of one primitive of several, from `computeBounds`, in object space.
typedef struct RtslBox {
  float lower[3], upper[3];
} RtslBox;

/// The path through a selector to one of its children. A ray follows it if it has reached the
/// selector and `visit` calls visitChild with the number of the child.
typedef struct RtslSelection {
  RtslRef selector;
  int32_t child;
  uint32_t transform; // of the space of the selector; as RtslInstance::transform
  uint32_t above;     // the selection that leads to the selector; 0: none
} RtslSelection;

/// The transform of an instance: p -> linear p + translation, from object to world space. Matrices
/// are stored as columns. `inverse` is the inverse of exactly these floats, rounded to double. If
/// it moves, these are its values at time 0.
typedef struct RtslTransform {
  float linear[9], translation[3];
  double inverse[9]; // of `linear`; with squaredScale > 0 of what `linear` rounds
  /// For a rotation with a uniform scale s, at all times: s squared; `inverse` is the transpose of
  /// the linear part divided by it. 1: it is rigid. Negative: it scales alike along all axes, and
  /// does not turn. 0: any other.
  double squaredScale;
  uint32_t motion; // of RtslLaunch::motions; 0: it does not move
  uint32_t unused;
} RtslTransform;

/// A transform that depends on time: a product of factors, of which the first is applied first.
typedef struct RtslMotion {
  uint32_t firstFactor, factorCount;
} RtslMotion;

/// A factor of a motion: an affine map between whose keys the numbers are interpolated linearly, or
/// a rotation that turns steadily from one key to the next. Before its first key and after its last
/// one it rests. A single key is a constant; rotations have at least two.
typedef struct RtslMotionFactor {
  uint32_t firstKey, keyCount; // of RtslLaunch::motionKeys; times ascend
  uint32_t isRotation;
} RtslMotionFactor;

/// A key of a factor. Of an affine map: the columns of the linear part, then the translation. Of a
/// rotation: the unit quaternion (w, x, y, z) at the key; a unit quaternion q perpendicular to it;
/// and an angle a in quarter turns. Up to the next key, after a share s of the time, the rotation
/// is cos(s a) times the first plus sin(s a) times q. It turns by twice the angle.
typedef struct RtslMotionKey {
  double numbers[12];
  float time; // in [0, 1]
  uint32_t unused;
} RtslMotionKey;

/// How a transform changes the numbers of a named attribute of a mesh.
#define RTSL_ATTRIBUTE_NUMBERS 0u // not at all
#define RTSL_ATTRIBUTE_POINT 1u
#define RTSL_ATTRIBUTE_VECTOR 2u
#define RTSL_ATTRIBUTE_NORMAL 3u  // by the inverse transpose; the result has length 1
#define RTSL_ATTRIBUTE_TANGENT 4u // a vector, and the side on which the bitangent is: 1 or -1

/// The values of a named attribute of a mesh: as many words as RtslMeshAttribute::words for each
/// vertex or triangle. Those of vertices are floats.
typedef struct RtslMeshValues {
  const uint32_t *values; // null: the mesh does not have the attribute
  uint32_t ofTriangles;   // 1: for each triangle; 0: for each vertex
  uint32_t space;         // RTSL_ATTRIBUTE_*
} RtslMeshValues;

/// A scratch member that some material reads of meshes: places in RtslState::attributes, or
/// RTSL_NOT_READ. `changes` are those of its changes along dPdx and dPdy; on a primitive, which has
/// no such changes, they are 0.
typedef struct RtslMeshAttribute {
  uint32_t offset, words;
  uint32_t changes[2];
} RtslMeshAttribute;
#define RTSL_NOT_READ 0xffffffffu

/// An indexed triangle mesh in object space. `normals` and `uvs` may be null. If it has several
/// keys, the positions of all vertices at the first one are followed by those at the next, and so
/// are the normals; between keys they are interpolated linearly.
typedef struct RtslMesh {
  const float *positions;           // 3 a vertex
  const float *normals;             // 3 a vertex
  const float *uvs;                 // 2 a vertex
  const uint32_t *indices;          // 3 a triangle
  const float *keyTimes;            // ascending, in [0, 1]; null: it has one key, and does not move
  const RtslMeshValues *attributes; // by number of RtslLaunch::meshAttributes; null: none
  uint32_t vertexCount, triangleCount;
  uint32_t keyCount, unused;
} RtslMesh;

/// A node of the tree: up to eight children, in slots. Their boxes are on a grid of the node's own,
/// rounded outwards, so that a child has 10 bytes (Ylitie, Karras, Laine, "Efficient Incoherent Ray
/// Traversal on GPUs Through Compressed Wide BVHs", HPG 2017). An empty slot has a box that no ray
/// enters, from 255 to 0, and a `child` of 0.
typedef struct RtslBvhNode {
  float origin[3];     // a corner of the grid, exactly
  uint8_t exponent[3]; // a step of the grid along an axis is 2^(exponent - 127); 1 to 254
  uint8_t inner;       // bit s: the child in slot s is a node. Others have items
  uint32_t firstNode;  // of the children that are nodes, in the order of their slots
  uint32_t firstItem;  // of the children that have items
  uint8_t child[8];    // RTSL_INNER_CHILD + slot, or RTSL_LEAF(first item - firstItem, count)
  uint8_t lower[3][8], upper[3][8]; // by axis and slot: steps from the origin
} RtslBvhNode;

/// The items of a child: one to RTSL_MOST_LEAF_ITEMS. The three upper bits are as many ones, the
/// five lower ones are the position of these ones in a set of 24 bits, one for each item of a node.
#define RTSL_MOST_LEAF_ITEMS 3u
#define RTSL_LEAF(first, count) ((uint8_t)(((1u << (count)) - 1u) << 5 | (first)))
#define RTSL_INNER_CHILD 0x38u // one bit, from position 24 on

/// A primitive of an instance.
typedef struct RtslLeafItem {
  uint32_t instance, primitive;
} RtslLeafItem;

/// An item of a tree. Its triangle is here, too, so that a traversal reads nothing else.
typedef struct RtslTreeItem {
  float vertices[9];            // in the space of the tree
  uint32_t instance, primitive; // instance: RTSL_NO_HIT in the tree of a mesh or of an object
  uint32_t hasVertices;         // 1: it is a triangle. 0: it is what the instance is
} RtslTreeItem;

/// An instance that emits light: its material has `emission`, and points on it can be chosen.
typedef struct RtslEmitter {
  uint32_t instance;
  // for a mesh or an object with several primitives: of the first of these parts in
  // RtslLaunch::partChances
  uint32_t firstPart;
  // the probability that this one or one before it is chosen; of the last: 1
  float chances;
  // with a light tree: of RtslLaunch::lightLeaves, the leaf of this emitter, or if it is divided,
  // those of its parts
  uint32_t firstLeaf, isDivided;
} RtslEmitter;

/// A node of the light tree: the emitters below it. A lamp is an emitter, or one of its parts. The
/// first node is the root.
typedef struct RtslLightNode {
  float middle[3], squareRadius; // a ball around the boxes of its lamps
  float axis[3], cosine;         // a cone of the normals of its lamps; -1: all directions
  float power;                   // its share of that of the root
  uint32_t parent;               // and RTSL_SHINES_ON_BOTH_SIDES
  // of an inner node: its two children, first and first + 1; of a leaf: its emitter
  uint32_t first;
  uint32_t part; // RTSL_INNER_LIGHT_NODE, RTSL_WHOLE_EMITTER, or the number of the emitter's part
} RtslLightNode;

#define RTSL_SHINES_ON_BOTH_SIDES 0x80000000u
#define RTSL_INNER_LIGHT_NODE 0xffffffffu
#define RTSL_WHOLE_EMITTER 0xfffffffeu
#define RTSL_NO_LIGHT_LEAF 0xffffffffu

/// Divides by a number without a division (runtime/device/ray/Divisor.h).
typedef struct RtslDivisor {
  uint32_t multiplier, increment, shift;
} RtslDivisor;

/// What all rays of a launch share.
typedef struct RtslLaunch {
  uint8_t *records; // object records; the first 4 bytes of each are its class id
  const RtslInstance *instances;
  const RtslMesh *meshes;
  const RtslMeshAttribute *meshAttributes;
  const RtslTransform *transforms; // the first is the identity
  const RtslMotion *motions;       // the first is unused
  const RtslMotionFactor *motionFactors;
  const RtslMotionKey *motionKeys;
  const RtslBox *boxes;
  const RtslSelection *selections; // the first is unused
  const RtslRef *lights;
  RtslRef camera;        // of the classic engine
  RtslRef rayGeneration; // of the programs engine
  RtslRef background;    // an rt_Miss object; 0: backgroundColor
  RtslRef exception;     // an rt_Exception object; 0: exceptionColor (Events.h) is used
  float backgroundColor[RTSL_MAX_COLOR];
  float ambient[RTSL_MAX_COLOR];
  uint32_t instanceCount, meshCount, transformCount, lightCount;
  uint32_t boxCount, selectionCount;
  uint32_t meshAttributeCount;
  uint32_t motionCount, motionFactorCount, motionKeyCount;
  float shutterOpen, shutterClose; // of RTSL_HAS_SHUTTER: the times of samples, in [0, 1]
  uint32_t colorComponents;
  uint32_t maxDepth; // 0: camera rays only
  // the maximum number of references from one object to the next, in a chain
  uint32_t referenceChain;
  uint32_t width, height;
  uint32_t slices; // of three dimensions: as many parts of `height` rows, one after the other
  RtslDivisor byHeight;
  float inverseWidth, inverseHeight; // rounded to nearest
  uint32_t seed;
  uint32_t needs;           // RTSL_NEEDS_*: what the classes of the scene read
  const RtslBvhNode *nodes; // device traversal, the root first; null if the host's own is used
  const RtslTreeItem *treeItems;
  // by mesh: the root of the tree of a mesh that has instances with transforms, in its object
  // space; then those of objects that hold several primitives, likewise
  const uint32_t *meshTrees;
  const RtslEmitter *emitters; // in the order of their instances
  // of the triangles of an emitter's mesh, or of its primitives: the probability that this one or
  // one before it is chosen
  const float *partChances;
  const RtslLightNode *lightNodes; // null: emitters are chosen by their power alone
  const uint32_t *lightLeaves;     // numbers of nodes; RTSL_NO_LIGHT_LEAF: it does not shine
  uint32_t emitterCount, partChanceCount;
  uint32_t lightNodeCount, lightLeafCount;
  uint32_t nodeCount;
  const void *host; // the host's own (for example its Embree scene); never read by device code
  struct RtslStatus
      *status; // of the job or the rendering that runs the launch; null while a scene is built
} RtslLaunch;

// What may go wrong in a sample. The first exception ends it (docs/language.md, "Exceptions").
#define RTSL_EXCEPTION_NONE 0u
#define RTSL_EXCEPTION_STACK_OVERFLOW 1u // a ray deeper than the launch allows
#define RTSL_EXCEPTION_BAD_RAY 2u        // not finite, or without a direction
#define RTSL_EXCEPTION_INDEX 3u          // an index out of range
#define RTSL_EXCEPTIONS 4u

/// How many of the samples that are not finite a status records: the first in the order of the
/// image.
#define RTSL_FIRST_NOT_FINITE 8

/// The lines that `print` has written on a device since the host took them
/// (runtime/device/engines/PrintedLines.h).
typedef struct RtslPrintedLines {
  uint64_t capacity; // of `words`
  uint64_t reserved; // words for all lines, also for those that did not fit
  uint64_t lost;     // lines that did not fit
  uint32_t *words;
} RtslPrintedLines;

/// What searches of the trees visit, of programs that count their steps.
typedef struct RtslTreeVisits {
  uint64_t rays;         // searches from the root of the world
  uint64_t nodes, items; // of all of them, also in the trees of meshes
} RtslTreeVisits;

/// What all lanes of a job write, atomically. The host clears it before the job.
typedef struct RtslStatus {
  uint64_t nextSample;          // the first of the slice that no lane has taken
  uint64_t badRays;             // not finite, or without a direction: their color is 0
  uint64_t raysTooDeep;         // deeper than the launch allows: they were not sent
  uint64_t samplesNotFinite;    // left out of the means of their pixels
  uint64_t pixelsWithoutSample; // black, because none of their samples was finite
  uint64_t firstNotFinite[RTSL_FIRST_NOT_FINITE]; // ~(sample + pixel * 2^32), descending; 0: none
  uint64_t exceptions[RTSL_EXCEPTIONS];           // samples that ended with each exception
  RtslTreeVisits visits;
  uint32_t stop;    // set by the host or a lane: no lane takes samples any more
  uint32_t problem; // RTSL_PROBLEM_*
  RtslPrintedLines
      *printed; // null: the program prints nothing, or the host takes each line at once
} RtslStatus;

#define RTSL_PROBLEM_NONE 0u
#define RTSL_PROBLEM_STACK 1u // laneBytes is less than rtsl_lane_bytes: no lane was started

/// The sums of the samples of each pixel, row by row, to which slices are added. The samples of an
/// adaptive rendering (runtime/render/passes/Adaptive.h) are in two halves: there each pixel has
/// two of everything but `taken` and `closed`, for its first half and for its second. Otherwise the
/// last three are null.
typedef struct RtslPixelSums {
  double *colors;     // colorComponents per pixel
  double *squares;    // of the values of samples, the means of their components; null: not wanted
  uint32_t *counted;  // finite samples in `colors`
  uint32_t *taken;    // all samples
  double *values;     // of the samples in `squares`
  uint32_t *deciding; // their number
  uint32_t *closed;   // bit h: half h is complete. Its colors take no sample any more, and the
                      // squares and values of the other half, which decided that, take none either
} RtslPixelSums;

/// How often warps took a step, and how many of their lanes took part.
typedef struct RtslStepCount {
  uint64_t steps, lanes;
} RtslStepCount;

/// A slice of a rendering for the megakernel (runtime/device/organisations/Megakernel.h): some
/// samples of each pixel in a window of the launch. They are numbered pixel by pixel, in the order
/// of runtime/device/organisations/Slice.h; there are less than 2^31. Lanes take them in order.
typedef struct RtslJob {
  const RtslLaunch *launch;
  RtslStatus *status;
  uint8_t *lanes;     // memory for the rays of each lane, aligned to 16 bytes
  uint64_t laneBytes; // a multiple of 16; of a wavefront on a GPU, of the stack of a slot
  // Of a wavefront on a GPU (runtime/device/organisations/WaveMemory.h), or of a persistent block.
  uint32_t slots;
  uint32_t left, top, width, height;
  uint32_t samplesPerPixel;          // of all slices
  uint32_t firstSample, sampleCount; // of each pixel in this slice
  // by sampleCount, and by the pixels of a band (runtime/device/organisations/Slice.h)
  RtslDivisor bySampleCount, byBand;
  float *samples;     // colorComponents for each sample of the slice; null: not wanted
  RtslPixelSums sums; // of the samples before this slice; all null: there are none
  // the places of the pixels that take samples, ascending, and their number; null: all pixels
  const uint32_t *places;
  uint32_t placeCount;
  const uint32_t *taken; // sums.taken, if some pixels have samples of the slice already; or null
  float *pixels;         // the means, colorComponents per pixel, row by row; null: not wanted
  // By step (runtime/device/organisations/StepCounts.h), if they are counted.
  RtslStepCount *stepCounts;
} RtslJob;

/// What happens in a sample, apart from its color.
typedef struct RtslEvents {
  uint32_t x, y, sample; // which sample, as rtsl_sample takes it
  uint32_t exception;    // RTSL_EXCEPTION_*: the first one
  uint32_t printed;      // how many times `print` has run
} RtslEvents;

/// The state of one ray. Parent and child ray have one each.
typedef struct RtslState {
  const RtslLaunch *launch;
  // of its sample; only programs with rtsl_features have events. Null while a scene is built
  RtslEvents *events;

  // The hit so far (committed), and what is being tested (candidate).
  uint32_t instance, primitive; // of the hit so far; RTSL_NO_HIT: none
  uint32_t candidateInstance, candidatePrimitive;
  float u, v;               // barycentrics of vertices 1 and 2 of a triangle hit
  float hitPointError;      // bound of the distance of HitPoint from the surface that was hit
  float hitError;           // bound of the error of HitDistance on a primitive; below 0: not known
  uint32_t leaves;          // the instance whose surface the ray starts on; RTSL_NO_HIT: none
  uint32_t leavesPrimitive; // and which of its primitives, if objects may hold several
  uint32_t isEasy; // 1: every traversal is known to handle the ray (isEasySpawn in Spawn.h)

  // What the ray carries (docs/language.md, "Tracing and light").
  void *payload; // the struct of the ray's type; undefined if rayType is 0
  // 0: the built-in payload of `shade`; others are numbered when a program is linked
  uint32_t rayType;
  uint32_t rayMask; // instances that have no common bit with it are invisible
  int32_t rayRoot;  // the root of the scene where it enters: RtslInstance::roots
  // RTSL_ACCEPT...: the answer of `anyHit` for the candidate; outside of it RTSL_ACCEPT
  uint32_t hitAnswer;

  // The width of the ray's cone where it starts (Footprint.h); ConeWidth is that at the hit.
  float coneAtOrigin;

  // Counter-based random numbers: (pixel, sample) form the key, `dimension` counts the draws.
  uint32_t randomKey[2];
  uint32_t dimension;

#define RTSL_TYPE_float(n) float n
#define RTSL_TYPE_int(n) int32_t n
#define RTSL_TYPE_uint3(n) uint32_t n[3]
#define RTSL_TYPE_vec2(n) float n[2]
#define RTSL_TYPE_vec3(n) float n[3]
#define RTSL_TYPE_mat4(n) float n[16]
#define RTSL_TYPE_color(n) float n[RTSL_MAX_COLOR]
#define RTSL_STATE_VARIABLE(name, type, ...) RTSL_TYPE_##type(name);
#include "language/StateVariables.def"

  // What `intersect` wrote to scratch members for the hit so far; of a mesh its named attributes.
  uint32_t attributes[RTSL_MAX_ATTRIBUTE_WORDS];

  // Temporary values of a traversal (Hit.h).
  float foundDistance; // t of the hit so far
  float nearest;       // t that candidates are compared with; without a hit, the end of the ray
  float candidateNear,
      candidateFar; // range of the ray in the box of the RTSL primitive that is being tested
  uint32_t areAttributesLost; // 1: a hit that lost has overwritten those of the hit so far
  int32_t wantedChild;        // while `visit` of a selector runs: which child leads on,
  uint32_t isChildVisited;    // and 1: visitChild was called with it
  // Of the triangle that is the hit so far, where the traversal has read its vertices; null: not
  // known. Never read on a GPU.
  const float *vertices; // coordinate `axis` of vertex i: (3 i + axis) * RTSL_VERTEX_STRIDE
} RtslState;

#define RTSL_NO_HIT 0xffffffffu
#define RTSL_VERTEX_STRIDE 8

/// The bit of a ray type in RtslInstance::anyHit. If two types share a bit, `anyHit` may be called
/// without effect.
static inline uint32_t rtslRayTypeBit(uint32_t rayType) {
  return 1u << (rayType & 31u);
}

// RtslState::hitAnswer.
#define RTSL_ACCEPT 0u
#define RTSL_IGNORE 1u    // ignoreIntersection()
#define RTSL_TERMINATE 2u // terminateRay()

// How rtsl_traverse searches. Without any: the nearest hit, without calling `anyHit`.
#define RTSL_FIRST_HIT 1u // only whether there is a hit at all; the committed hit is meaningless
#define RTSL_INVOKE_ANY_HIT 2u // `anyHit` of the material may reject a hit, in any order of hits
#define RTSL_IN_ORDER 4u // ... called in the order of (t, instance, primitive), until one accepts

// RtslLaunch::needs: state that some method of the scene reads. RtslInstance::needs: what its
// material's `shade` or its callees read. The rest is not computed.
#define RTSL_NEEDS_TEXTURE_COORDINATES 1u // TextureUV TextureUVW
#define RTSL_NEEDS_DERIVATIVES 2u         // dPdu dPdv dsdu dsdv dtdu dtdv
#define RTSL_NEEDS_TRANSFORMS 4u          // ObjectToWorld WorldToObject
#define RTSL_NEEDS_INVERSE_DIRECTION 8u   // InverseRayDirection
#define RTSL_NEEDS_SAMPLING 16u           // EmissionColor BSDFValue BSDFSeed PDF du dv
#define RTSL_NEEDS_TIME 32u               // Time TimeSeed
#define RTSL_NEEDS_LAUNCH 64u             // LaunchIndex LaunchSize
#define RTSL_NEEDS_LENS 128u              // LensCoord
#define RTSL_NEEDS_NORMALS 256u // GeometricNormal ShadingNormal; also used to send rays from hits
#define RTSL_NEEDS_ANY_HIT 512u // no state: some ray's hits may be rejected
#define RTSL_NEEDS_CANDIDATE                                                                       \
  1024u // BoundMin BoundMax; in `intersect` PrimitiveIndex InstanceIndex and transforms
#define RTSL_NEEDS_HIT_ERRORS 2048u     // no state: rays leave hits, so the error of t matters
#define RTSL_NEEDS_ATTRIBUTES 4096u     // no state: scratch members of the hit
#define RTSL_NEEDS_INSTANCE_ID 32768u   // InstanceId
#define RTSL_NEEDS_CAMERA_RAY 65536u    // RayOrigin RayDirection in `generate`
#define RTSL_NEEDS_EMITTERS 131072u     // no state: points are lit by surfaces that shine
#define RTSL_NEEDS_FOOTPRINT 536870912u // ConeWidth ConeSpread dPdx dPdy dUVdx dUVdy dUVWdx dUVWdy
#define RTSL_NEEDS_NORMAL_CHANGES 2147483648u // dNdx dNdy; with RTSL_NEEDS_FOOTPRINT
#define RTSL_NEEDS_ALL                                                                             \
  (8191u | RTSL_NEEDS_INSTANCE_ID | RTSL_NEEDS_CAMERA_RAY | RTSL_NEEDS_EMITTERS |                  \
   RTSL_NEEDS_FOOTPRINT | RTSL_NEEDS_NORMAL_CHANGES)
// RtslLaunch::needs only, and not in RTSL_NEEDS_ALL: properties of the scene, not of its classes.
#define RTSL_HAS_TRANSFORMS 8192u   // some instance has a transform
#define RTSL_HAS_ROOTS 16384u       // some instance is not below root 0, or below another one
#define RTSL_HAS_COUNTS 262144u     // some object holds several primitives
#define RTSL_HAS_SELECTORS 524288u  // some instance is below a selector
#define RTSL_HAS_MOTION 1048576u    // some transform moves
#define RTSL_HAS_MESH_KEYS 2097152u // some mesh has several keys
#define RTSL_HAS_SHUTTER 4194304u   // each sample has a time of its own; otherwise the time is 0
#define RTSL_HAS_SAMPLED_BACKGROUND 8388608u // directions of the background can be chosen
#define RTSL_HAS_NO_BACKS 16777216u          // some mesh's back faces are left out
#define RTSL_HAS_LIGHT_TREE 33554432u        // emitters are chosen by a light tree
#define RTSL_HAS_MASKS 67108864u             // some instance is invisible to rays of some masks
#define RTSL_HAS_SCALE 134217728u    // some transform is not rigid, or scales along the axes
#define RTSL_HAS_TURNS 268435456u    // some transform is more than a scale and a translation
#define RTSL_HAS_STRETCH 1073741824u // some transform is no rotation with a uniform scale
// Some transform is more than a translation.
#define RTSL_HAS_LINEAR (RTSL_HAS_SCALE | RTSL_HAS_TURNS | RTSL_HAS_STRETCH)
#define RTSL_HAS_ALL                                                                               \
  (RTSL_HAS_TRANSFORMS | RTSL_HAS_ROOTS | RTSL_HAS_COUNTS | RTSL_HAS_SELECTORS | RTSL_HAS_MOTION | \
   RTSL_HAS_MESH_KEYS | RTSL_HAS_SHUTTER | RTSL_HAS_SAMPLED_BACKGROUND | RTSL_HAS_NO_BACKS |       \
   RTSL_HAS_LIGHT_TREE | RTSL_HAS_MASKS | RTSL_HAS_LINEAR)

// Results of rtsl_traverse.
#define RTSL_MISS 0u
#define RTSL_HIT 1u
#define RTSL_BAD_RAY 2u // not finite, or no direction: it is not traced

#ifdef __cplusplus
extern "C" {
#endif

//===----------------------------------------------------------------------===//
// Defined by the compiled program: one entry point per method slot, a switch over the classes that
// the scene uses (one class: a direct call). `object` must be of a class derived from the slot's
// base. For a class that does not define the method it does nothing.
//===----------------------------------------------------------------------===//
#define RTSL_SLOT(base, method) void rtsl_##base##_##method(RtslState *state, RtslRef object);
#include "language/Slots.def"
#define RTSL_SAMPLING_SLOT(base, method)                                                           \
  void rtsl_##base##_##method(RtslState *state, RtslRef object);
#include "language/SamplingSlots.def"
/// The same for methods that take the payload of state's ray type.
#define RTSL_PAYLOAD_SLOT(base, method)                                                            \
  void rtsl_##base##_##method##_payload(RtslState *state, RtslRef object);
#include "language/PayloadSlots.def"

// Features of programs that were compiled with them. Others cost nothing.
#define RTSL_FEATURE_EXCEPTIONS 1u
#define RTSL_FEATURE_PRINT 2u
#define RTSL_FEATURE_UNHEEDED 4u // exceptions are recorded, but do not end samples
#define RTSL_FEATURE_EVENTS 7u   // any of these: states have RtslState::events
// For tests: uninitialised state is filled with a pattern (Undefined.h).
#define RTSL_FEATURE_UNDEFINED_BYTES 8u
#define RTSL_FEATURE_UNDEFINED_NAN 16u
// What random numbers are (Sampler.h); without any of these they are independent.
#define RTSL_FEATURE_SAMPLER_R2 32u
#define RTSL_FEATURE_SAMPLER_SOBOL 64u

/// A set of RTSL_FEATURE_*; a constant.
uint32_t rtsl_features(RtslState *state);

/// What all launches of a program share: RtslLaunch::needs, or a superset, and
/// RtslLaunch::colorComponents.
/// runtime/device defines them weakly, from the launch. A compiled program defines them as
/// constants, so that what it does not need is folded away.
uint32_t rtsl_needs(const RtslLaunch *launch);
uint32_t rtsl_color_components(const RtslLaunch *launch);
/// RtslLaunch::instances. A program that was bound to a scene of few instances has a copy of them,
/// so that what it loads from there at a constant index is a constant.
const RtslInstance *rtsl_instances(const RtslLaunch *launch);
/// RtslLaunch::meshAttributes and meshAttributeCount. A compiled program has a copy of them.
const RtslMeshAttribute *rtsl_mesh_attributes(const RtslLaunch *launch);
uint32_t rtsl_mesh_attribute_count(const RtslLaunch *launch);
/// The number of instances of such a scene if each of them is one primitive: the project's own
/// traversal tests them one after the other. Otherwise 0, and it searches the tree.
uint32_t rtsl_listed_instances(const RtslLaunch *launch);
/// The boxes of these instances (runtime/device/ray/ListedBox.h).
typedef struct RtslListedBox {
  float middle[3], unused0; // 16 bytes are loaded at once
  float half[3], unused1;   // of the size
} RtslListedBox;
const RtslListedBox *rtsl_listed_boxes(const RtslLaunch *launch);
/// Whether samples begin with `generate`: RtslLaunch::rayGeneration is not null.
uint32_t rtsl_generates(const RtslLaunch *launch);
/// Whether the program was compiled with --fp=fast.
uint32_t rtsl_is_fast(void);
/// RTSL_SCHEDULE_*: how the lanes of a warp choose the next step.
#define RTSL_SCHEDULE_MAJORITY 0u
#define RTSL_SCHEDULE_PRIORITIZED 1u
#define RTSL_SCHEDULE_ROUND_ROBIN 2u
#define RTSL_SCHEDULE_NAIVE 3u
#define RTSL_SCHEDULE_LEAST_WASTE 4u
uint32_t rtsl_schedule(const RtslLaunch *launch);
/// Whether a lane runs its states one after the other, until it traces a ray or its sample is over:
/// then warps only choose between traversal and new samples.
uint32_t rtsl_states_run_on(const RtslLaunch *launch);
/// How many samples a warp takes at once while many are left.
uint32_t rtsl_samples_at_once(const RtslLaunch *launch);
/// What the steps of the megakernel cost, as powers of two: 4 bits for each of traversal, the
/// beginning of samples, and the states in the order of their numbers; the last for all that
/// follow. Of RTSL_SCHEDULE_LEAST_WASTE only.
uint32_t rtsl_step_costs_low(const RtslLaunch *launch);
uint32_t rtsl_step_costs_high(const RtslLaunch *launch);
/// The least number of the lanes of a warp, which call together. Of GPUs only: by the instruction
/// for it, or without (runtime/device/ray/Warp.h).
uint32_t rtsl_least_of_warp(const RtslLaunch *launch, uint32_t number);
/// Whether RtslJob::stepCounts is written. For a measurement: it takes time.
uint32_t rtsl_counts_steps(const RtslLaunch *launch);

//===----------------------------------------------------------------------===//
// Defined by the runtime, called by compiled programs.
//===----------------------------------------------------------------------===//

/// Finds the nearest hit with Epsilon < t < HitDistance along state's ray and commits it
/// (HitDistance, instance, primitive, u, v, attributes); instance must be RTSL_NO_HIT before. `how`
/// is a set of RTSL_FIRST_HIT, RTSL_INVOKE_ANY_HIT and RTSL_IN_ORDER. Returns RTSL_MISS, RTSL_HIT
/// or RTSL_BAD_RAY.
uint32_t rtsl_traverse(RtslState *state, uint32_t how);

/// `hit(t)` of the language; the rule is in docs/language.md. Returns 1 if t is the candidate's
/// nearest hit, and commits it if the candidate wins.
uint32_t rtsl_hit(RtslState *state, float t);
/// `hit(t, error)`: t is within `error` of the surface.
uint32_t rtsl_hit_within(RtslState *state, float t, float error);

/// `trace(origin, direction)`: the color that arrives at `origin` against `direction`. Writes
/// colorComponents floats.
void rtsl_trace(RtslState *parent, float ox, float oy, float oz, float dx, float dy, float dz,
                float *color);

/// `trace(origin, direction, tmin, tmax, payload, root, mask, time)`. `how` is that of
/// rtsl_traverse.
void rtsl_trace_payload(RtslState *parent, float ox, float oy, float oz, float dx, float dy,
                        float dz, float tmin, float tmax, void *payload, int32_t root,
                        uint32_t mask, float time, uint32_t rayType, uint32_t how);

#define RTSL_NO_SHADOWS (-3.0f)

/// One step of `illuminance (P [, N, angle])`: light number `index`. Writes LightDirection,
/// LightDistance and LightColor of `state`; returns 1 if light arrives (in the cone, not black, not
/// in shadow) and the body is to run. Without a cone pass cosAngle = -2; RTSL_NO_SHADOWS: without a
/// cone and without shadows. 0 if there is no such light.
uint32_t rtsl_illuminance(RtslState *state, uint32_t index, float px, float py, float pz, float nx,
                          float ny, float nz, float cosAngle);

/// `illuminate(P [, N])`: lights a point by one of the surfaces that shine. Sets LightDirection,
/// LightDistance, LightColor and PDF of the state, and returns whether light arrives: from no point
/// behind the plane of the normal, which is 0 if all of them count.
uint32_t rtsl_illuminate_by_surface(RtslState *state, float px, float py, float pz, float nx,
                                    float ny, float nz);

/// What an instance sends out, to choose emitters by: for a primitive the radiance at a point of
/// its own choice times the area that the point stands for; for a mesh the radiance at a point of
/// the triangle. `part` is the triangle, or one of the primitives of an object. The mean of the
/// color's components; not finite: unknown. `sample` numbers the points; odd ones are seen from
/// behind. Writes the normal there, of length 1 in world space: three floats.
float rtsl_emitted_power(const RtslLaunch *launch, uint32_t instance, uint32_t part,
                         uint32_t sample, float *normal);

/// `rand()`: uniform in [0, 1).
float rtsl_rand(RtslState *state);
/// `randOpen()`: uniform in (0, 1).
float rtsl_rand_open(RtslState *state);

/// `visitChild(child)` of the language.
void rtsl_visit_child(RtslState *state, int32_t child);

/// Records that the sample has met an exception.
void rtsl_raise(RtslState *state, uint32_t exception);

/// Has an exception ended the sample? Then it no longer writes to output buffers.
uint32_t rtsl_is_abandoned(RtslState *state);

/// `print` number `format` of the program, with the words of its values. Defined by the host if it
/// can be called, and else by the device code.
void rtsl_print(RtslState *state, uint32_t format, const uint32_t *words, uint32_t count);

/// One sample of one pixel of the classic engine: camera ray, trace, color. Writes colorComponents
/// floats. Numbers from RTSL_SECOND_HALF on are those of a second, independent sequence of samples
/// (Slice.h: numberInHalf).
#define RTSL_SECOND_HALF 0x80000000u
void rtsl_sample(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample, float *color);

/// The same for the programs engine: runs `generate` of the launch's rayGeneration.
void rtsl_generate(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample, float *color);

//===----------------------------------------------------------------------===//
// Programs whose shaders were split at their traces (runtime/device/engines/Machine.h). A state is
// a piece of a method between two traces; numbers start at 1.
//===----------------------------------------------------------------------===//

/// Defined by the compiled program: runs a state on the frame of its ray. Returns the next step: 0,
/// the method is over; n > 0, trace the ray that was spawned, then run state n; -n < 0, run state n
/// at once; RTSL_NEXT_LAST, trace the ray that was spawned in place of this one, which is over.
#define RTSL_NEXT_LAST (-2147483647 - 1)
int32_t rtsl_run_state(RtslState *state, int32_t number, RtslRef object, void *frame);

/// Defined by the compiled program: bytes of its largest frame, a multiple of 4, including the
/// frames of calls above it. `chain` is RtslLaunch::referenceChain.
int32_t rtsl_frame_size(RtslState *state, int32_t chain);

// Some calls have a frame of their own, above that of the caller. It begins with these words.
#define RTSL_CALL_RESUME 0u  // the state in which the caller continues
#define RTSL_CALL_OBJECT 4u  // the caller's
#define RTSL_CALL_BELOW 8u   // bytes from the beginning of the caller's frame to this one
#define RTSL_CALL_HEADER 16u // arguments and results follow
/// Defined by the compiled program, a constant: whether there are such calls.
int32_t rtsl_calls(RtslState *state);
/// The ray continues with `object`, on a frame this many bytes further up.
void rtsl_move_frame(RtslState *state, int32_t bytes, RtslRef object);

/// Defined by the compiled program: the first states of the methods that the runtime starts and
/// that may trace. 0: there is no such method.
int32_t rtsl_rt_Material_shade_first(RtslState *state);
int32_t rtsl_rt_Miss_miss_first(RtslState *state);
int32_t rtsl_rt_Material_closestHit_payload_first(RtslState *state);
int32_t rtsl_rt_Miss_miss_payload_first(RtslState *state);
int32_t rtsl_rt_RayGeneration_generate_first(RtslState *state);
/// The state to begin with instead of `number`, which is one of those: if that state would only
/// jump to the state of the object's method, the latter.
int32_t rtsl_first_state(RtslState *state, int32_t number, RtslRef object);

/// First half of `trace(origin, direction)`: prepares the ray, which is traced when the state
/// returns.
void rtsl_spawn(RtslState *parent, float ox, float oy, float oz, float dx, float dy, float dz);

/// The same for a ray with a payload, which is not moved until the ray is back.
void rtsl_spawn_payload(RtslState *parent, float ox, float oy, float oz, float dx, float dy,
                        float dz, float tmin, float tmax, void *payload, int32_t root,
                        uint32_t mask, float time, uint32_t rayType, uint32_t how);

/// The same for a tail trace: the ray replaces the one that sends it.
void rtsl_spawn_last(RtslState *ray, float ox, float oy, float oz, float dx, float dy, float dz);
void rtsl_spawn_last_payload(RtslState *ray, float ox, float oy, float oz, float dx, float dy,
                             float dz, float tmin, float tmax, void *payload, int32_t root,
                             uint32_t mask, float time, uint32_t rayType, uint32_t how);

/// Defined by the compiled program, for the bound of the stack
/// (runtime/device/engines/StackBound.h): the number of kinds of rays, at most RTSL_MAX_RAY_KINDS.
/// Rays without a payload are kind 0, those of payload type n kind n; `generate`, if the program
/// has it, is the last kind. The other two functions return sets of kinds, as bits: those that the
/// methods for a kind may send and wait for, and those that they may send by a tail trace.
#define RTSL_MAX_RAY_KINDS 32
int32_t rtsl_ray_kinds(RtslState *state);
int32_t rtsl_rays_sent(RtslState *state, int32_t kind);
int32_t rtsl_rays_sent_last(RtslState *state, int32_t kind);

/// Second half: the color that came back, colorComponents floats.
const float *rtsl_trace_result(RtslState *parent);

/// Defined by the host: memory for the rays of one sample, aligned to 16 bytes, owned by the
/// calling thread until its next call. Null if there is not enough memory.
void *rtsl_machine_stack(uint64_t bytes);

/// rtsl_sample, or rtsl_generate, by the machine: the same color, bit for bit. Black if there is no
/// memory for the stack.
void rtsl_sample_split(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                       float *color);

//===----------------------------------------------------------------------===//
// The megakernel: programs with their own traversal and no external references.
//===----------------------------------------------------------------------===//

/// Bytes that a lane needs for rays up to this depth, a multiple of 16, in scenes with reference
/// chains of this length. Exact: no shader can need more.
uint64_t rtsl_lane_bytes(uint32_t maxDepth, uint32_t referenceChain);

/// Renders samples of the job until none is left, in the lane's own memory. Lanes with different
/// numbers may run at the same time.
void rtsl_run_lane(const RtslJob *job, uint32_t lane);

#ifdef __cplusplus
}
#endif
