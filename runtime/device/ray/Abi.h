//===- Abi.h - the interface between compiled shaders and runtime ---------===//
//
// The functions by which they call each other, the same for the host and the GPU. They take scalars
// and pointers to the layouts of Launch.h, State.h and Status.h. Those that run a whole rendering
// are in runtime/device/organisations/Job.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Needs.h"
#include "runtime/device/ray/State.h"
#include "runtime/device/ray/Status.h"

#include <stddef.h>
#include <stdint.h>

// How rtsl_traverse searches. Without any: the nearest hit, without calling `anyHit`.
#define RTSL_FIRST_HIT 1u // only whether there is a hit at all; the committed hit is meaningless
#define RTSL_INVOKE_ANY_HIT 2u // `anyHit` of the material may reject a hit, in any order of hits
#define RTSL_IN_ORDER 4u // ... called in the order of (t, instance, primitive), until one accepts

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
#define RTSL_FEATURE_SAMPLERS (RTSL_FEATURE_SAMPLER_R2 | RTSL_FEATURE_SAMPLER_SOBOL)

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
/// RtslLaunch::emitters and emitterCount. Such a program has a copy of them, too.
const RtslEmitter *rtsl_emitters(const RtslLaunch *launch);
uint32_t rtsl_emitter_count(const RtslLaunch *launch);
/// Whether one of them may be a mesh or an object with several primitives. Known, too, to be 0 in
/// such a program.
uint32_t rtsl_emitters_have_parts(const RtslLaunch *launch);
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
/// Two of the boxes in half precision, the first in the lower halves of the words
/// (runtime/device/ray/ListedPairs.h).
typedef struct RtslListedPair {
  uint32_t middle[3], half[3], unused[2]; // half: of the size
} RtslListedPair;
/// The boxes of these instances in pairs, which follow it. Their coordinates are scale x + offset.
typedef struct RtslListedPairs {
  float scale, offset[3];
} RtslListedPairs;
/// Null: the boxes of the scene would be enlarged too much.
const RtslListedPairs *rtsl_listed_pairs(const RtslLaunch *launch);
/// Whether the GPU has instructions for two numbers of half precision at once.
uint32_t rtsl_has_half_pairs(void);
/// Whether samples begin with `generate`: RtslLaunch::rayGeneration is not null.
uint32_t rtsl_generates(const RtslLaunch *launch);
/// Whether the program was compiled with --fp=fast.
uint32_t rtsl_is_fast(void);
/// Whether `intersect` of all primitives takes so few instructions that to test the box of a single
/// primitive does not pay.
uint32_t rtsl_is_intersect_cheap(void);
/// Whether rays test all primitives of a list, one after the other in an unrolled loop, instead of
/// those whose boxes they enter. With --fp=fast only, where boxes do not decide which hits count.
uint32_t rtsl_tests_all_listed(void);
/// Whether states of a wavefront may look for lights before they shade (KnownLights.h).
uint32_t rtsl_knows_lights(void);
/// Whether shaders of hits send rays; otherwise only `generate` does.
uint32_t rtsl_rays_leave_hits(void);
/// Whether the program has materials that let the light of lights pass, and such lights.
uint32_t rtsl_light_passes(const RtslLaunch *launch);
/// Whether the scene has primitives of classes; otherwise it has triangles alone.
uint32_t rtsl_has_primitives(void);
/// Whether all primitives that rays leave are planes: such a ray does not meet its own again.
uint32_t rtsl_rays_leave_planes(void);
/// Whether any method but those of the camera and `generate` reads LaunchIndex or LaunchSize.
/// Otherwise rays that shaders send do not have them.
uint32_t rtsl_rays_read_launch(void);
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
/// Whether a lane of the megakernel renders whole pixels, where a job allows it.
uint32_t rtsl_takes_pixels(const RtslLaunch *launch);
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

#ifdef __cplusplus
}
#endif
