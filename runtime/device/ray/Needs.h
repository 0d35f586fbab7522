//===- Needs.h - what the classes of a scene read, and what the scene has -===//
#pragma once

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
// RtslInstance::needs only: no light of the scene's lights passes its material. Absent: some may.
#define RTSL_IS_OPAQUE RTSL_HAS_LIGHT_TREE
#define RTSL_HAS_ALL                                                                               \
  (RTSL_HAS_TRANSFORMS | RTSL_HAS_ROOTS | RTSL_HAS_COUNTS | RTSL_HAS_SELECTORS | RTSL_HAS_MOTION | \
   RTSL_HAS_MESH_KEYS | RTSL_HAS_SHUTTER | RTSL_HAS_SAMPLED_BACKGROUND | RTSL_HAS_NO_BACKS |       \
   RTSL_HAS_LIGHT_TREE | RTSL_HAS_MASKS | RTSL_HAS_LINEAR)
