//===- Launch.h - what all rays of a launch share -------------------------===//
//
// The records of a scene in memory, and the launch, which leads to all of them. Plain C layouts,
// the same for the host and the GPU, included by the runtime, by the code that is linked into
// shaders and by the compiler, which takes every offset from here with offsetof. A vecN is N floats
// with alignment 4, a matrix its columns one after the other, a color up to RTSL_MAX_COLOR floats
// of which the first N are used, a bool a 32-bit 0 or 1.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

#define RTSL_MAX_COLOR 16

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
  // RTSL_NEEDS_* and RTSL_IS_OPAQUE of its material, and RTSL_HAS_NO_BACKS of the instance
  uint32_t needs;
  uint32_t mask;      // visible to rays whose mask has a common bit
  uint32_t anyHit;    // rtslRayTypeBit of the payloads for which its material has `anyHit`
  uint32_t transform; // index into RtslLaunch::transforms; 0: object space is world space
  uint32_t roots;     // bit r: rays that enter at root r can see it
  // the first of RtslLaunch::boxes of an object that holds several primitives, and their number;
  // any other object is one primitive, and has 0 and 0. For a mesh with vertices that were
  // transformed to world space, `firstBox` is the index of that transform, for rt_ObjectToWorld
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
  int32_t child;      // from 0; the selections of a selector follow each other in this order
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
