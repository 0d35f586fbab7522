/* The C interface renders what scenes/scenes.py calls its events: scene PICTURE.exr. What shaders
 * print goes to standard output. Without an argument it says what goes wrong. */
#include <rtsl/rtsl.h>

#include <math.h>
#include <stdio.h>

const RtslShaders *events_shaders(void);

static void show(const char *line, void *count) {
  printf("%s\n", line);
  ++*(int *)count;
}

static int fail(const char *what) {
  fprintf(stderr, "%s: %s\n", what, rtslError());
  return 1;
}

static int mistakes(void) {
  const float values[] = {0.5f, 1.0f}, corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const uint32_t indices[] = {0, 1, 2};
  const double one = 1.0, center[] = {0.0, 0.0, 0.0}, infinite[12] = {HUGE_VAL};
  RtslScene *scene;
  RtslObject sphere, endless;
  if (rtslSceneCreate(NULL) != NULL)
    return fail("no shaders are shaders");
  printf("%s\n", rtslError());
  if (!(scene = rtslSceneCreate(events_shaders())))
    return fail("scene");
  if (rtslSceneAddObject(scene, "Nobody") != 0)
    return fail("a class that is not there");
  printf("%s\n", rtslError());
  rtslMember(scene, "nothing", &one, 1);
  if (rtslSceneAddObject(scene, "Eye") != 0)
    return fail("a member that is not there");
  printf("%s\n", rtslError());
  /* Objects of another kind, and none. */
  if (rtslSceneSetRayGeneration(scene, rtslSceneAddObject(scene, "Code")) != 0)
    return fail("an exception program as ray generation");
  printf("%s\n", rtslError());
  if (rtslSceneSetException(scene, 0) != 0)
    return fail("no object as exception program");
  printf("%s\n", rtslError());
  if (rtslPlace(scene, &infinite[0], 1) != 0)
    return fail("a transform that is not finite");
  printf("%s\n", rtslError());
  if (rtslSceneLoadMesh(scene, "nowhere.obj") != -1)
    return fail("a mesh that is not there");
  printf("%s\n", rtslError());
  if (rtslSceneAddMeshInstance(scene, 7, 0) != 0)
    return fail("an instance of no mesh");
  printf("%s\n", rtslError());
  if (rtslSceneAddSelector(scene, rtslSceneAddObject(scene, "Code"), 2, NULL, 0) != 0)
    return fail("an exception program as selector");
  printf("%s\n", rtslError());
  if (rtslSceneAddObject(scene, "Sphere") != 0)
    return fail("a member that is read and not set");
  printf("%s\n", rtslError());
  rtslMember(scene, "center", center, 3);
  sphere = rtslSceneAddObject(scene, "Sphere");
  endless = rtslSceneAddObject(scene, "Endless");
  if (!rtslMeshAttribute(scene, "wear", 1, values, 2, 0, RTSL_NUMBERS) ||
      rtslSceneAddTriangles(scene, corners, 3, indices, 1, endless) != 0)
    return fail("fewer values than vertices");
  printf("%s\n", rtslError());
  if (!rtslMark(scene, 3, 5) || rtslSceneAddPrimitive(scene, sphere, endless) != 0)
    return fail("an instance below no selector");
  printf("%s\n", rtslError());
  if (rtslSceneAddPrimitives(scene, sphere, 0, endless) != 0)
    return fail("no primitives");
  printf("%s\n", rtslError());
  rtslSceneDestroy(scene);
  return 0;
}

/* The sum of a picture of a triangle, of which three pixels see one side; -1 if that fails. */
static float seenOfTriangle(const uint32_t indices[3], int backFaces) {
  const double curve[] = {0.5, 0.25};
  const float positions[] = {-5, -5, 1, 0, 5, 1, 5, -5, 1};
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslScene *scene = rtslSceneCreate(events_shaders());
  float pixels[4 * 4 * 3], sum = 0.0f;
  int i;
  rtslMember(scene, "curve", curve, 2);
  settings.width = settings.height = 4;
  settings.samplesPerPixel = 1;
  if (!rtslSceneSetRayGeneration(scene, rtslSceneAddObject(scene, "Eye")) ||
      !rtslSetBackFaces(scene, backFaces) ||
      !rtslSceneAddTriangles(scene, positions, 3, indices, 1,
                             rtslSceneAddObject(scene, "Endless")) ||
      !rtslRender(scene, &settings, pixels))
    return -1.0f;
  for (i = 0; i < 4 * 4 * 3; ++i)
    sum += pixels[i];
  rtslSceneDestroy(scene);
  return sum;
}

static int triangles(void) {
  const uint32_t front[] = {0, 1, 2}, back[] = {0, 2, 1};
  const float seen = seenOfTriangle(front, 0);
  if (seen < 0.0f || seenOfTriangle(front, 1) != seen || seenOfTriangle(back, 1) != seen)
    return fail("a triangle");
  if (fabsf(seen - seenOfTriangle(back, 0) - 9 * 0.125f) > 1e-4f)
    return fail("a back face that is left out");
  return 0;
}

int main(int count, char **arguments) {
  const double curve[] = {0.5, 0.25}, center[] = {0.0, 0.0, 0.0}, radius = 2.0;
  const double identity[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const double nearer[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslObject eye, code, sphere, endless;
  uint32_t child;
  RtslScene *scene;
  float pixels[4 * 4 * 3];
  int lines = 0, again = 0;
  if (settings.width != 960 || settings.samplesPerPixel != 16)
    return fail("defaults");
  if (count != 2)
    return mistakes();
  if (!(scene = rtslSceneCreate(events_shaders())))
    return fail("scene");
  rtslMember(scene, "curve", curve, 2);
  eye = rtslSceneAddObject(scene, "Eye");
  code = rtslSceneAddObject(scene, "Code");
  rtslMember(scene, "center", center, 3);
  rtslMember(scene, "radius", &radius, 1);
  sphere = rtslSceneAddObject(scene, "Sphere");
  endless = rtslSceneAddObject(scene, "Endless");
  if (!rtslSceneSetRayGeneration(scene, eye) || !rtslSceneSetException(scene, code))
    return fail("objects");
  /* No ray sees the first one. */
  child = rtslSceneAddSelector(scene, rtslSceneAddObject(scene, "Second"), 2, NULL, 0);
  if (child == 0 || !rtslPlace(scene, nearer, ~0u) || !rtslMark(scene, 1, child) ||
      !rtslSceneAddPrimitive(scene, sphere, endless) || !rtslPlace(scene, identity, ~0u) ||
      !rtslMark(scene, 2, child + 1) || !rtslSceneAddPrimitives(scene, sphere, 1, endless))
    return fail("instances");
  settings.width = settings.height = 4;
  settings.samplesPerPixel = 2;
  settings.maxDepth = 5;
  if (!rtslRenderToFile(scene, &settings, arguments[1]) ||
      !rtslTakePrinted(scene, show, &lines) || lines == 0)
    return fail("picture");
  /* Into memory, and what it prints is there once. */
  if (rtslSceneChannels(scene) != 3 || !rtslRender(scene, &settings, pixels) || !(pixels[0] > 0.0f))
    return fail("pixels");
  /* Each sample ends in a ray that is deeper than the limit. */
  if (rtslLastRendering().samples != 32 || rtslLastRendering().samplesNotFinite != 0 ||
      rtslLastRendering().raysTooDeep == 0)
    return fail("what the rendering met");
  if (!rtslTakePrinted(scene, show, &again) || again != lines ||
      !rtslTakePrinted(scene, show, &again) || again != lines)
    return fail("printed lines");
  rtslSceneDestroy(scene);
  return triangles();
}
