/*===- rtsl.h - the runtime for C -------------------------------------------===*\
 *
 * Builds a scene of compiled shaders, renders it, and writes the image: the C++ interface
 * (rtsl/runtime.h) with handles in place of classes. Shaders come from `rtslc compile --emit=cpp`,
 * which exports `const RtslShaders *name_shaders(void)`.
 *
 * A function that fails returns 0 (or a null pointer), and rtslError returns the reason. Pointers
 * that are not said to be optional must not be null, unless they are to 0 elements: that is an
 * error, too. Handles may be used by one thread at a time.
 *
\*===------------------------------------------------------------------------===*/
#ifndef RTSL_RTSL_H
#define RTSL_RTSL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct RtslShaders RtslShaders;
typedef struct RtslScene RtslScene;

/* An object of the scene; 0 is none. */
typedef uint32_t RtslObject;
/* A node, and memory for a buffer; 0 is none. */
typedef uint32_t RtslNode;
typedef uint32_t RtslBufferNumber;

/* The error of the last function that failed in this thread; "" if none did. Valid until the next
 * call. */
const char *rtslError(void);

RtslScene *rtslSceneCreate(const RtslShaders *shaders);
void rtslSceneDestroy(RtslScene *scene);

/* The scene of a scene file (docs/scene-format.md) with all that belongs to it: files that it
 * includes, models (glTF, OBJ), meshes, images and buffers. Its classes are those of the shaders.
 * `settings` are `count` values that replace those of the file, as --set of `rtslc render` gives
 * them: "camera=side" is one of its cameras by name, "frame=12" the frame that its key frames are
 * of, "nodes.car.transform.translate=[0, 1, 0]" any other value. More can be added to the scene.
 * Of a file with `passes`, the first is what is launched (rtslSceneSetPass).
 *
 * Models become objects of classes of the library, and so do engines such as `path`; the shaders
 * must have been compiled with those that the scene needs, by the names of their modules:
 * rtsl_add_shaders(... SHADERS std.materials.Principled std.engines.PathTracer ...). The error for
 * those that are missing lists them. They are, of glTF files:
 *   materials: Principled Emitter NormalMap Cutout Dielectric MixMaterial
 *   materials: VertexColorPrincipled VertexColorEmitter VertexColorCutout
 *   textures:  ImageTexture ImageChannel ImageSlope Threshold TransformedPattern Product Scaled
 *   lights:    PointLight SpotLight DistantLight
 *   cameras:   PerspectiveCamera OrthographicCamera
 * and of OBJ and PLY files:
 *   materials: Lambert Principled Dielectric ThinGlass NormalMap BumpMap Cutout
 *   materials: VertexColorLambert VertexColorPrincipled
 *   textures:  ImageTexture ImageChannel ImageSlope TransformedPattern ExponentRoughness
 *   cameras:   PerspectiveCamera
 * and for images std.images.sampler2D and std.images.sampler3D. */
RtslScene *rtslSceneLoad(const RtslShaders *shaders, const char *file, const char *const *settings,
                         size_t count);
/* Reads the file of the scene again, with these settings in place of those before, such as the next
 * frame. What was added to it since, and its numbers of objects and the like, are no longer valid.
 * Nothing is compiled; and where the meshes and instances are as many as before, trees keep their
 * shapes. If it fails, the scene is as it was. */
int rtslSceneReload(RtslScene *scene, const char *const *settings, size_t count);

/* Sets, by name, constructor arguments and public members for the next rtslSceneAddObject. A
 * value is `count` numbers (a vector, a color, a matrix by columns, an array), or an object. */
int rtslArgument(RtslScene *scene, const char *parameter, const double *numbers, size_t count);
int rtslArgumentObject(RtslScene *scene, const char *parameter, RtslObject object);
int rtslMember(RtslScene *scene, const char *member, const double *numbers, size_t count);
int rtslMemberObject(RtslScene *scene, const char *member, RtslObject object);

/* Creates an object of the class with these values, which are then cleared. */
RtslObject rtslSceneAddObject(RtslScene *scene, const char *className);

/* Memory of `words` 32-bit words, initially 0, for buffers of members. Launches read and write it
 * where it is: nothing is copied. */
RtslBufferNumber rtslSceneAddBuffer(RtslScene *scene, size_t words);
/* The words, between launches: they stay where they are as long as the scene. */
void *rtslMapBuffer(RtslScene *scene, RtslBufferNumber buffer);
/* The launches that follow see what was written. */
int rtslUnmapBuffer(RtslScene *scene, RtslBufferNumber buffer);
/* Sets a member of the next rtslSceneAddObject, a buffer of 1 to 3 dimensions of these sizes, which
 * must fill the memory. Several members may share a buffer unless one of them is an output; those
 * of two ray generations always may, of which each launch runs one (rtslSceneSetRayGeneration). */
int rtslMemberBuffer(RtslScene *scene, const char *member, RtslBufferNumber buffer,
                     const uint32_t *sizes, uint32_t dimensions);

/* What of a file a buffer is; what does not fit its format is an error. Null and 0: all of it. */
typedef struct RtslBufferFile {
  const char *element;        /* of a .ply: whose columns; null: "vertex" */
  const char *const *columns; /* of a .csv or .ply, by name */
  uint32_t columnCount;
  const uint32_t *shape; /* of a file without a format: the size of each dimension */
  uint32_t dimensions;
} RtslBufferFile;
/* Reads a file (.npy, columns of .csv or .ply, or elements as they lie in memory) for a member of a
 * class, with whose type its numbers must agree. Gives the sizes for rtslMemberBuffer, of as many
 * dimensions as the member has; the others are 1. `file` null: all of it. */
RtslBufferNumber rtslSceneLoadBuffer(RtslScene *scene, const char *path, const char *className,
                                     const char *member, const RtslBufferFile *file,
                                     uint32_t sizes[3]);

/* The numbers at a frame of values that change from frame to frame, for whatever takes numbers:
 * `count` for each of `keys` >= 1 keys, whose `frames` ascend. Outside of them they are those of
 * the first or last key; between two keys they are interpolated, or, with RTSL_STEP_FRAMES, those
 * of the key before. */
typedef enum RtslInterpolation { RTSL_LINEAR_FRAMES, RTSL_STEP_FRAMES } RtslInterpolation;
int rtslAtFrame(double frame, const double *frames, const double *numbers, uint32_t keys,
                size_t count, RtslInterpolation interpolation, double *result);

/* How images are read: as a scene file says with the same names (docs/scene-format.md). */
typedef enum RtslFilter {
  RTSL_NEAREST,
  RTSL_BILINEAR,
  RTSL_TRILINEAR,
  RTSL_ANISOTROPIC
} RtslFilter;
typedef enum RtslWrap { RTSL_REPEAT, RTSL_MIRROR, RTSL_CLAMP, RTSL_BLACK } RtslWrap;
typedef enum RtslColorSpace { RTSL_AUTO, RTSL_LINEAR, RTSL_SRGB } RtslColorSpace;
typedef struct RtslSampling {
  RtslFilter filter;
  RtslWrap wrap[3]; /* by axis */
  RtslColorSpace colorSpace;
  uint32_t anisotropy; /* the most lookups along a footprint, 1 to 256 */
} RtslSampling;
/* Trilinear, repeated, RTSL_AUTO, 16. */
RtslSampling rtslSamplingDefaults(void);

/* An image of files, for rtslMemberObject and rtslArgumentObject: a sampler2D of one file, or a
 * sampler3D of one or more slices, from front to back. `sampling` null: the defaults. */
RtslObject rtslSceneAddImage(RtslScene *scene, const char *const *files, size_t count, int isVolume,
                             const RtslSampling *sampling);
/* The same of an image in a glTF file, such as "images.0". */
RtslObject rtslSceneAddImagePart(RtslScene *scene, const char *path, const char *part,
                                 const RtslSampling *sampling);
/* Texels without a file format: `channels` (1, 2 or 4) side by side, little-endian, rows from the
 * bottom, slices from the front; they are linear. `depth` 0: a sampler2D. */
typedef enum RtslTexelFormat {
  RTSL_UNORM8,
  RTSL_UNORM16,
  RTSL_FLOAT16,
  RTSL_FLOAT32
} RtslTexelFormat;
typedef struct RtslTexelShape {
  RtslTexelFormat format;
  uint32_t width, height, depth, channels;
} RtslTexelShape;
/* An image of such a file, which must be as long as its shape; and of memory, which is copied. */
RtslObject rtslSceneAddRawImage(RtslScene *scene, const char *file, const RtslTexelShape *shape,
                                const RtslSampling *sampling);
RtslObject rtslSceneAddRawTexels(RtslScene *scene, const void *texels, const RtslTexelShape *shape,
                                 const RtslSampling *sampling);
/* The same of floats in memory, which are copied: `channels` (1, 2 or 4) side by side, rows
 * from the bottom, slices from the front; `depth` 0: a sampler2D. */
RtslObject rtslSceneAddTexels(RtslScene *scene, const float *numbers, uint32_t width,
                              uint32_t height, uint32_t depth, uint32_t channels,
                              const RtslSampling *sampling);
/* How many numbers of the image that this thread has added last were infinite or not a number:
 * they are 0 in it. */
uint64_t rtslImageNumbersNotFinite(void);

/* Sets the `transform` from object to world space (12 numbers, four columns of three; null: none)
 * and the mask of the next instance that is added. Rays whose mask has no bit in common with it do
 * not hit the instance; so all rays can hit one whose mask is ~0u, and none one whose mask is 0.
 * Fails if a number is not finite. */
int rtslPlace(RtslScene *scene, const double *transform, uint32_t mask);
/* The same for an instance that moves: its transform at `count` >= 2 times, which ascend in [0, 1].
 * Between them the numbers are interpolated linearly. */
int rtslPlaceMoving(RtslScene *scene, const double *transforms, const float *times, uint32_t count,
                    uint32_t mask);
/* The same by keys of scale, rotation (a quaternion x, y, z, w, of any length but 0) and
 * translation, applied in this order. Rotations take the shortest turn from each key to the next.
 * */
typedef struct RtslPlacementKey {
  double scale[3], rotation[4], translation[3];
  float time;
} RtslPlacementKey;
int rtslPlaceTurning(RtslScene *scene, const RtslPlacementKey *keys, uint32_t count, uint32_t mask);
/* Sets rt_InstanceId of the next instance that is added, and the `selection` (rtslSceneAddSelector)
 * below which it is; 0: none. */
int rtslMark(RtslScene *scene, int32_t id, uint32_t selection);
/* Rays that enter at root r see the instances that are added next if bit r is set; 1 unless it is
 * set: the rays that name no root. Fails for 0. */
int rtslSetRoots(RtslScene *scene, uint32_t roots);
/* Whether rays meet triangles of the meshes that are added next along rt_GeometricNormal; 1 unless
 * it is set. */
int rtslSetBackFaces(RtslScene *scene, int areHit);
/* Whether texture coordinates of the meshes that are loaded next are (0,0), (1,0), (0,1) in each
 * triangle, in place of those of their files; 0 unless it is set. */
int rtslSetBarycentric(RtslScene *scene, int areBarycentric);

/* Enters a new node, whose transform is what rtslPlace, rtslPlaceMoving or rtslPlaceTurning has
 * set. Instances and selectors that are added from here on are in its space, and so are nodes that
 * are entered in it, up to rtslLeave. Meshes and objects are shared by all nodes. */
RtslNode rtslEnter(RtslScene *scene);
int rtslLeave(RtslScene *scene);
/* A variable of the node that is entered, or of the scene: objects that are created in it, without
 * constructor arguments, take the nearest one for a public member of its name that is not set. */
int rtslVariable(RtslScene *scene, const char *name, const double *numbers, size_t count);
int rtslVariableObject(RtslScene *scene, const char *name, RtslObject object);

/* Adds a selector with as many children, in the space of `transform` (as above; null: world space).
 * Returns the selection of child 0; those of the others follow. `above`: that of the selector
 * itself; 0: none. */
uint32_t rtslSceneAddSelector(RtslScene *scene, RtslObject selector, uint32_t children,
                              const double *transform, uint32_t above);

/* Sets an attribute of the next mesh that is added or loaded, which materials read as a scratch
 * member of this name: `count` times as many floats as it has components, for each vertex, or with
 * `ofFaces` for each face, in the order of the file. `space` is how a transform changes them. */
typedef enum RtslAttributeSpace {
  RTSL_NUMBERS, /* not at all */
  RTSL_POINT,   /* 3 components */
  RTSL_VECTOR,  /* 3 components */
  RTSL_NORMAL,  /* 3 components */
  RTSL_TANGENT  /* 4 components: a vector, and the side on which the bitangent is */
} RtslAttributeSpace;
int rtslMeshAttribute(RtslScene *scene, const char *name, uint32_t components, const float *values,
                      size_t count, int ofFaces, RtslAttributeSpace space);
/* The same with an integer for each face. */
int rtslMeshAttributeInts(RtslScene *scene, const char *name, const int32_t *values, size_t count);

/* Geometry that rays can hit: an instance of a primitive's object. */
int rtslSceneAddPrimitive(RtslScene *scene, RtslObject primitive, RtslObject material);
/* The same for an object that holds `count` primitives, numbered by rt_PrimitiveIndex. */
int rtslSceneAddPrimitives(RtslScene *scene, RtslObject primitive, uint32_t count,
                           RtslObject material);
/* An instance of a mesh file (OBJ, PLY, glTF). Its vertices are first transformed by `transform`:
 * 12 numbers, four columns of three, or null. */
int rtslSceneAddMeshFile(RtslScene *scene, const char *path, const double *transform,
                         RtslObject material);
/* An instance of triangles: 3 floats per vertex, 3 indices per triangle. */
int rtslSceneAddTriangles(RtslScene *scene, const float *positions, size_t vertexCount,
                          const uint32_t *indices, size_t triangleCount, RtslObject material);

/* Loads a mesh file for instances that share it; returns its number, or -1. */
int32_t rtslSceneLoadMesh(RtslScene *scene, const char *path);
/* The same for a mesh that moves: files with the same triangles at `count` >= 2 times, which ascend
 * in [0, 1]. Between them its vertices are interpolated linearly. */
int32_t rtslSceneLoadMovingMesh(RtslScene *scene, const char *const *paths, const float *times,
                                uint32_t count);
/* Loads a primitive of a glTF file, such as "meshes.0.primitives.1", without its material, for
 * instances that share it; returns its number, or -1. `weights`: one for each of its morph targets;
 * null and 0: all are 0. */
int32_t rtslSceneLoadMeshPart(RtslScene *scene, const char *path, const char *part,
                              const double *weights, size_t targets);
/* The same for one that moves: `targets` weights for each of `count` >= 2 times, which ascend in
 * [0, 1]. Between them its vertices are interpolated linearly. */
int32_t rtslSceneLoadMovingMeshPart(RtslScene *scene, const char *path, const char *part,
                                    const double *weights, size_t targets, const float *times,
                                    uint32_t count);
/* A model: the meshes, materials and lights of a glTF file, or of an OBJ file with its MTL files,
 * as instances where rtslPlace and its like, rtslMark and rtslSetRoots say, below the node that is
 * entered. Its materials are classes of the library (rtslSceneLoad lists them). The nodes of the
 * file move while the shutter is open if rtslSceneSetShutter was called before. Lights stay where
 * they are when a node is moved. If it fails, nothing is added. */
typedef struct RtslAnimation {
  const char *name;       /* null: the first one of the file */
  double framesPerSecond; /* 0: 24 */
  double frame;
} RtslAnimation;
/* `animation` null: the first one at frame 0. */
int rtslSceneAddModel(RtslScene *scene, const char *path, const RtslAnimation *animation);
/* A camera of a model, by its name (null: the first), for rtslSceneSetCamera, in the space that
 * rtslPlace and the nodes that are entered give. */
RtslObject rtslSceneAddModelCamera(RtslScene *scene, const char *path, const char *name,
                                   const RtslAnimation *animation);
/* Another instance of a mesh: of rtslSceneLoadMesh's, or of the n-th that was added, from 0. */
int rtslSceneAddMeshInstance(RtslScene *scene, int32_t mesh, RtslObject material);

/* Between renderings: what has moved is seen where it is now, and nothing is compiled. Trees keep
 * their shapes as long as that is good enough, which is several times faster than building them.
 *
 * Gives an instance, by its number in the order of addition from 0, or a node the transform that
 * rtslPlace, rtslPlaceMoving or rtslPlaceTurning has set. */
int rtslMoveInstance(RtslScene *scene, uint32_t instance);
int rtslMoveNode(RtslScene *scene, RtslNode node);
/* The positions of a mesh, 3 floats per vertex, to be changed; the scene sees them when they are
 * unmapped, and renders only when all are. If one is not finite, rtslUnmapVertices fails and the
 * mesh stays as it was. */
float *rtslMapVertices(RtslScene *scene, int32_t mesh);
int rtslUnmapVertices(RtslScene *scene, int32_t mesh);
/* The first object of this name: an image, texture, material or helper of a scene file, or of the
 * class, if it was created without a name. */
RtslObject rtslSceneFind(const RtslScene *scene, const char *name);
/* Sets a public member of an object that exists. If the value is not in the member's range, or the
 * bounds of a primitive, which are computed anew, are wrong, it fails and the member stays as it
 * was. */
int rtslSetMember(RtslScene *scene, RtslObject object, const char *member, const double *numbers,
                  size_t count);
int rtslSetMemberObject(RtslScene *scene, RtslObject object, const char *member, RtslObject value);

int rtslSceneAddLight(RtslScene *scene, RtslObject light);
/* Creates and adds a light whose points and directions (rtslMember) are in the space of rtslPlace
 * and the node that is entered: a DistantLight, PointLight, RectangleLight or SpotLight of the
 * library. It stays where it is when the node is moved. */
RtslObject rtslSceneAddNodeLight(RtslScene *scene, const char *className);
/* How `illuminate(P)` chooses one of the surfaces that shine: by power, by a light tree, or by a
 * tree where there are many; RTSL_LIGHTS_AUTO unless it is set. */
typedef enum RtslLightSampler {
  RTSL_LIGHTS_AUTO,
  RTSL_LIGHTS_BY_POWER,
  RTSL_LIGHTS_BY_TREE
} RtslLightSampler;
int rtslSceneSetLightSampler(RtslScene *scene, RtslLightSampler sampler);
/* The random numbers of samples: independent of each other, or spread evenly among the samples of a
 * pixel by the sequence R2, or by Sobol's with Owen's scrambling; as the shaders were compiled
 * unless it is set. */
typedef enum RtslSampler { RTSL_INDEPENDENT, RTSL_R2, RTSL_SOBOL } RtslSampler;
int rtslSceneSetSampler(RtslScene *scene, RtslSampler sampler);
int rtslSceneSetCamera(RtslScene *scene, RtslObject camera);
/* Samples have times between these two, 0 <= open <= close <= 1. Without it they have times from 0
 * to 1 if something moves. */
int rtslSceneSetShutter(RtslScene *scene, float open, float close);
/* Replaces the camera: its `generate` computes the samples. Several launches in order, each with a
 * ray generation of its own over the same buffers, are what a scene file calls passes. */
int rtslSceneSetRayGeneration(RtslScene *scene, RtslObject rayGeneration);
/* Handles samples with an exception, in shaders compiled with --exceptions. */
int rtslSceneSetException(RtslScene *scene, RtslObject exception);
int rtslSceneSetBackground(RtslScene *scene, RtslObject miss);
int rtslSceneSetBackgroundColor(RtslScene *scene, const float *color, size_t count);
int rtslSceneSetAmbient(RtslScene *scene, const float *color, size_t count);

typedef struct RtslRenderSettings {
  uint32_t width, height;
  uint32_t samplesPerPixel;
  uint32_t maxDepth; /* 0: camera rays only */
  uint32_t seed;
  uint32_t threads; /* 0: all cores */
  uint32_t slices;  /* of a launch of three dimensions: each has `height` rows. 0 is 1 */
} RtslRenderSettings;

/* 960 x 540, 16 samples, depth 8, seed 1, all cores, one slice. */
RtslRenderSettings rtslRenderDefaults(void);

/* The same but for what the file of the scene (rtslSceneLoad) says. A pass that says nothing has 1
 * sample. */
RtslRenderSettings rtslSceneSettings(const RtslScene *scene);

/* How many launches the file of the scene has: its passes, or one. 0 for a scene of no file. */
uint32_t rtslScenePasses(const RtslScene *scene);
/* Makes a pass of the file, by its number from 0, what is launched: its ray generation, which
 * rtslSceneFind finds as "passes.0" and so on, and its settings (rtslSceneSettings). All passes
 * share the buffers that the file names. */
int rtslSceneSetPass(RtslScene *scene, uint32_t pass);

/* Runs the ray generation once for each sample, and makes no picture: what it computes is in its
 * output buffers, which have the memory that rtslMemberBuffer gave them. `settings` null, here and
 * below: the defaults. One rendering of a scene after the other uses the trees of the one before.
 */
int rtslLaunch(const RtslScene *scene, const RtslRenderSettings *settings);

/* Renders into `pixels`: width * height * slices * channels floats of linear light, rows from the
 * top, with as many channels as the shaders' colors have (rtslSceneChannels). */
int rtslRender(const RtslScene *scene, const RtslRenderSettings *settings, float *pixels);
uint32_t rtslSceneChannels(const RtslScene *scene);
/* The elements of an output buffer of the ray generation, which launches write, and its three
 * sizes; those that it does not have are 1. They stay where they are as long as the scene. */
void *rtslSceneOutput(RtslScene *scene, const char *member, uint32_t sizes[3]);
/* Renders and writes an .exr or .png. */
int rtslRenderToFile(const RtslScene *scene, const RtslRenderSettings *settings, const char *path);

/* Statistics of the last rendering of this thread. Samples that are infinite or not a number are
 * left out of the means of their pixels, and rays deeper than maxDepth are not sent: neither stops
 * a rendering. */
typedef struct RtslRenderFacts {
  uint64_t samples;
  uint64_t samplesNotFinite,
      pixelsWithoutSample; /* black, because none of their samples was finite */
  uint64_t raysTooDeep, badRays;
} RtslRenderFacts;
RtslRenderFacts rtslLastRendering(void);

/* Calls `take` with each line that shaders (compiled with --print) have printed since the last
 * call, in the order of pixels. */
int rtslTakePrinted(const RtslScene *scene, void (*take)(const char *line, void *context),
                    void *context);

/* Rays of an application's own against triangles, without shaders: what `rtslc trace` does, on
 * arrays, which are read and written where they are. Queries may run in several threads. `threads`
 * 0: all cores, for each query. */
typedef struct RtslQuery RtslQuery;
/* Hits at tMin < t < tMax, in units of the direction's length. */
typedef struct RtslQueryRay {
  float origin[3], tMin, direction[3], tMax;
} RtslQueryRay;
/* u and v: barycentric coordinates at the second and third vertex. Nothing is hit: -1, -1, 0, 0. */
typedef struct RtslQueryHit {
  float t;
  int32_t triangle;
  float u, v;
} RtslQueryHit;
RtslQuery *rtslQueryCreate(const float *positions, size_t vertices, const uint32_t *indices,
                           size_t triangles, uint32_t threads);
RtslQuery *rtslQueryLoad(const char *path, uint32_t threads);
void rtslQueryDestroy(RtslQuery *query);
int rtslQueryNearest(const RtslQuery *query, const RtslQueryRay *rays, size_t count,
                     RtslQueryHit *hits);
/* 1 for each ray that hits something, otherwise 0. */
int rtslQueryAny(const RtslQuery *query, const RtslQueryRay *rays, size_t count, uint8_t *hits);
/* Other positions of as many vertices. Not while queries run. */
int rtslQueryMove(RtslQuery *query, const float *positions, size_t vertices);

#ifdef __cplusplus
}
#endif

#endif
