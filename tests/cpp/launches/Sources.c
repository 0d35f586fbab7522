/* Values that are not in the program: buffers and images of files, and key frames. What a launch
 * sees must be what the scene file gives that says the same. */
#include "Launches.h"

#include <string.h>

enum { given = 12, looks = 5 };

/* Are the numbers those that a launch of the file writes? */
static void compareWithFile(const char *file, const float *seen, size_t count) {
  const char *frame = "frame=3";
  uint32_t sizes[3];
  const float *expected;
  RtslScene *scene = rtslSceneLoad(launches_shaders(), file, &frame, 1);
  RtslRenderSettings settings;
  need(scene != NULL, file);
  settings = rtslSceneSettings(scene);
  need(rtslLaunch(scene, &settings), file);
  need((expected = (const float *)rtslSceneOutput(scene, "seen", sizes)) != NULL, "an output");
  need(sizes[0] == count && memcmp(seen, expected, count * sizeof *seen) == 0, "what it has seen");
  rtslSceneDestroy(scene);
}

/* Launches an object of the class, for the members that were set; returns what it has seen. */
static const float *launch(RtslScene *scene, const char *className, uint32_t size, uint32_t count) {
  RtslRenderSettings settings = rtslRenderDefaults();
  const RtslBufferNumber seen = rtslSceneAddBuffer(scene, count);
  settings.width = size, settings.height = settings.samplesPerPixel = 1;
  need(rtslMemberBuffer(scene, "seen", seen, &count, 1) &&
           rtslSceneSetRayGeneration(scene, rtslSceneAddObject(scene, className)) &&
           rtslLaunch(scene, &settings),
       className);
  return (const float *)rtslMapBuffer(scene, seen);
}

static void load(RtslScene *scene, const char *member, const char *file, const RtslBufferFile *what,
                 uint32_t dimensions) {
  uint32_t sizes[3];
  const RtslBufferNumber buffer =
      rtslSceneLoadBuffer(scene, file, "Sources", member, what, sizes);
  need(buffer && rtslMemberBuffer(scene, member, buffer, sizes, dimensions), file);
}

/* As sources.json has them. */
static void buffersAndFrames(void) {
  const char *second = "b", *x = "x";
  const uint32_t shape[] = {2, 2};
  const RtslBufferFile table = {NULL, &second, 1, NULL, 0}, points = {"vertex", &x, 1, NULL, 0},
                       raw = {NULL, NULL, 0, shape, 2};
  const double frames[] = {-2, 1, 4.5}, numbers[] = {9, 9, 9, 0.1, -5, 1e9, 0.7, 5, -1e-3},
               steps[] = {3, 4, 5};
  double linear[3], stepped;
  RtslScene *scene = rtslSceneCreate(launches_shaders());
  load(scene, "table", "table.csv", &table, 1);
  load(scene, "array", "array.npy", NULL, 1);
  load(scene, "points", "points.ply", &points, 1);
  load(scene, "raw", "numbers.raw", &raw, 2);
  need(rtslAtFrame(3, frames, numbers, 3, 3, RTSL_LINEAR_FRAMES, linear) &&
           rtslMember(scene, "linear", linear, 3) &&
           rtslAtFrame(3, frames, steps, 3, 1, RTSL_STEP_FRAMES, &stepped) &&
           rtslMember(scene, "stepped", &stepped, 1),
       "key frames");
  compareWithFile("sources.json", launch(scene, "Sources", 1, given), given);
  rtslSceneDestroy(scene);
}

/* As raw.json and part.json have them. */
static void images(void) {
  const RtslTexelShape shape = {RTSL_UNORM8, 2, 2, 0, 4};
  RtslSampling sampling = rtslSamplingDefaults();
  RtslScene *scene = rtslSceneCreate(launches_shaders());
  unsigned char texels[16];
  const float *seen;
  FILE *file = fopen("texels.raw", "rb");
  need(file && fread(texels, 1, sizeof texels, file) == sizeof texels, "a raw image");
  fclose(file);
  sampling.filter = RTSL_BILINEAR, sampling.wrap[0] = RTSL_MIRROR;
  need(rtslMemberObject(scene, "picture",
                        rtslSceneAddRawImage(scene, "texels.raw", &shape, &sampling)),
       rtslError());
  seen = launch(scene, "Look", looks, looks);
  compareWithFile("raw.json", seen, looks);
  need(rtslMemberObject(scene, "picture", rtslSceneAddRawTexels(scene, texels, &shape, &sampling)),
       "texels");
  need(memcmp(launch(scene, "Look", looks, looks), seen, looks * sizeof *seen) == 0, "the same");
  need(rtslMemberObject(scene, "picture",
                        rtslSceneAddImagePart(scene, "picture.gltf", "images.0", NULL)),
       "an image of a model");
  compareWithFile("part.json", launch(scene, "Look", looks, looks), looks);
  rtslSceneDestroy(scene);
}

void sources(void) {
  buffersAndFrames();
  images();
}

void mistakesOfSources(RtslScene *scene) {
  const char *nothing = "nothing";
  const uint32_t shape[] = {3, 2};
  const RtslBufferFile columns = {NULL, &nothing, 1, NULL, 0}, raw = {NULL, NULL, 0, shape, 2};
  const RtslTexelShape long_ = {RTSL_UNORM8, 3, 2, 0, 4}, odd = {RTSL_UNORM16, 2, 2, 0, 3},
                       strange = {(RtslTexelFormat)7, 2, 2, 0, 4};
  const double frames[] = {0, 2, 2}, numbers[] = {1, 2, 3};
  double result = 7;
  uint32_t sizes[3];
#define EXPECT_NO_BUFFER(...) EXPECT_FAILURE(rtslSceneLoadBuffer(scene, __VA_ARGS__, sizes))
  EXPECT_NO_BUFFER("nowhere.npy", "Sources", "array", NULL);
  EXPECT_NO_BUFFER("table.csv", "Sources", "table", &columns);
  EXPECT_NO_BUFFER("array.npy", "Sources", "array", &columns);
  EXPECT_NO_BUFFER("array.npy", "Sources", "linear", NULL);
  EXPECT_NO_BUFFER("numbers.raw", "Sources", "raw", &raw);
  EXPECT_NO_BUFFER("array.npy", "Source", "array", NULL);
  EXPECT_NO_BUFFER("array.npy", "Sources", "arrays", NULL);
  EXPECT_FAILURE(rtslSceneAddRawImage(scene, "texels.raw", &long_, NULL));
  EXPECT_FAILURE(rtslSceneAddRawImage(scene, "texels.raw", &odd, NULL));
  EXPECT_FAILURE(rtslSceneAddRawTexels(scene, numbers, &strange, NULL));
  EXPECT_FAILURE(rtslSceneAddImagePart(scene, "picture.gltf", "images.1", NULL));
  EXPECT_FAILURE(rtslAtFrame(1, frames, numbers, 3, 1, RTSL_LINEAR_FRAMES, &result));
  EXPECT_FAILURE(rtslAtFrame(1, frames, numbers, 0, 1, RTSL_LINEAR_FRAMES, &result));
  EXPECT_FAILURE(rtslAtFrame(1, frames, numbers, 2, 1, (RtslInterpolation)2, &result));
  need(result == 7, "nothing is written");
}
