/* Launches through the C interface: buffers that are mapped, slices, nodes, variables, roots, and
 * what moves between launches. What is launched after a change must be what a scene gives that was
 * made so. The last lines of its output are messages of mistakes. */
#include <rtsl/rtsl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "Launches.h"

enum { width = 12, height = 9, slices = 2, rays = width * height * slices };

void need(int good, const char *what) {
  if (good)
    return;
  fprintf(stderr, "%s: %s\n", what, rtslError());
  exit(1);
}

static void number(RtslScene *scene, const char *name, double value) {
  need(rtslMember(scene, name, &value, 1), name);
}

static void place(RtslScene *scene, double scale, double x, double y, double z) {
  const double columns[12] = {scale, 0, 0, 0, scale, 0, 0, 0, scale, x, y, z};
  need(rtslPlace(scene, columns, ~0u), "a place");
}

/* A scene of two nodes, one in the other, with a ball and a mesh in each, and buffers. */
typedef struct World {
  RtslScene *scene;
  RtslObject measure, marked, ball, row;
  RtslNode outer, inner;
  RtslBufferNumber steps, found, hits;
  int32_t mesh;
} World;

/* Where things are. */
typedef struct Places {
  double outer, inner, ball; /* along x, y and x */
  float corner;              /* of the mesh */
  double radius;             /* of primitives */
} Places;

static World make(const Places *places) {
  const uint32_t two[] = {2}, one[] = {1}, all[] = {slices, height, width};
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, places->corner, 0, -1, 1, 0};
  const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
  const double from[] = {-3.1, -4.1, 20}, three = 3;
  World world;
  RtslScene *scene = world.scene = rtslSceneCreate(launches_shaders());
  RtslObject own;
  need(scene != NULL, "a scene");
  world.steps = rtslSceneAddBuffer(scene, 2);
  world.found = rtslSceneAddBuffer(scene, 2 * rays);
  world.hits = rtslSceneAddBuffer(scene, 1);
  need(rtslMember(scene, "from", from, 3) &&
           rtslMemberBuffer(scene, "steps", world.steps, two, 1) &&
           rtslMemberBuffer(scene, "found", world.found, all, 3) &&
           rtslMemberBuffer(scene, "hits", world.hits, one, 1) &&
           (world.measure = rtslSceneAddObject(scene, "Measure")) &&
           rtslSceneSetRayGeneration(scene, world.measure),
       "a ray generation");
  need(rtslVariable(scene, "weight", &three, 1), "a variable");
  world.marked = rtslSceneAddObject(scene, "Marked"); /* weight 3 */
  number(scene, "radius", places->radius);
  world.ball = rtslSceneAddObject(scene, "Ball");
  number(scene, "radius", 0.5 * places->radius);
  world.row = rtslSceneAddObject(scene, "Row");
  place(scene, 1, places->outer, 0, 0);
  need((world.outer = rtslEnter(scene)) != 0, "a node");
  need(rtslSceneAddTriangles(scene, positions, 4, indices, 2, world.marked), "triangles");
  world.mesh = 0;
  place(scene, 0.5, 0, places->inner, 2);
  need((world.inner = rtslEnter(scene)) != 0, "a node in a node");
  {
    const double nine = 9;
    need(rtslVariable(scene, "weight", &nine, 1), "a variable of a node");
  }
  number(scene, "mark", 2);
  own = rtslSceneAddObject(scene, "Marked"); /* weight 9 */
  place(scene, 1, places->ball, 0, 0);
  need(rtslSceneAddPrimitive(scene, world.ball, own), "a ball");
  place(scene, 2, 4, 1, 0);
  need(rtslSceneAddMeshInstance(scene, world.mesh, own), "a mesh again");
  need(rtslLeave(scene) && rtslLeave(scene), "leaving");
  need(rtslSceneAddPrimitives(scene, world.row, 3, world.marked), "a row of balls");
  need(rtslSetRoots(scene, 2), "roots"); /* rays do not see it that enter at root 0 */
  place(scene, 10, 0, 0, 10);
  need(rtslSceneAddPrimitive(scene, world.ball, world.marked), "below another root");
  return world;
}

static const float *launch(const World *world) {
  RtslRenderSettings settings = rtslRenderDefaults();
  float *steps = (float *)rtslMapBuffer(world->scene, world->steps);
  int *hits = (int *)rtslMapBuffer(world->scene, world->hits);
  const float *found = (const float *)rtslMapBuffer(world->scene, world->found);
  int i, count = 0;
  need(steps && hits && found, "mapping");
  steps[0] = 0.5f, steps[1] = 0.75f;
  hits[0] = 0;
  need(rtslUnmapBuffer(world->scene, world->steps) && rtslUnmapBuffer(world->scene, world->hits),
       "unmapping");
  settings.width = width, settings.height = height, settings.slices = slices;
  settings.samplesPerPixel = 1;
  need(rtslLaunch(world->scene, &settings), "a launch");
  need(rtslLastRendering().samples == rays, "as many samples as rays");
  for (i = 0; i < rays; ++i)
    count += found[2 * i] >= 0;
  need(count == hits[0] && count > 0, "the hits that the launch counted");
  return found;
}

/* Is what the launch finds what it finds in a scene that was made with these places? */
static void compare(const World *world, const Places *places, const char *what) {
  const World fresh = make(places);
  const float *found = launch(world), *expected = launch(&fresh);
  need(memcmp(found, expected, 2 * rays * sizeof *found) == 0, what);
  rtslSceneDestroy(fresh.scene);
}

static int setRadius(const World *world, double radius) {
  const double half = 0.5 * radius;
  return rtslSetMember(world->scene, world->ball, "radius", &radius, 1) &&
         rtslSetMember(world->scene, world->row, "radius", &half, 1);
}

static void changes(void) {
  Places places = {0.25, 1, -1, 1.5f, 1};
  World world = make(&places);
  float before[2 * rays], *positions;
  const float *found = launch(&world);
  int i, step, weighted = 0, own = 0;
  memcpy(before, found, sizeof before);
  for (i = 0; i < rays; ++i) {
    weighted += found[2 * i + 1] == 1.5f; /* 0.5 times the scene's variable */
    own += found[2 * i + 1] == 18;        /* 2 times the node's */
    need(found[2 * i] < 0 || fabsf(found[2 * i] - 18.75f) < 1.3f, "a distance");
  }
  need(weighted > 0 && own > 0, "marks");
  compare(&world, &places, "the same again");
  for (step = 0; step < 5; ++step) {
    places.outer = -0.5 + 0.3 * step;
    place(world.scene, 1, places.outer, 0, 0);
    need(rtslMoveNode(world.scene, world.outer), "moving a node");
    compare(&world, &places, "after a node has moved");
    places.inner = 2 - 0.7 * step;
    place(world.scene, 0.5, 0, places.inner, 2);
    need(rtslMoveNode(world.scene, world.inner), "moving a node in a node");
    places.ball = 0.4 * step;
    place(world.scene, 1, places.ball, 0, 0);
    need(rtslMoveInstance(world.scene, 1), "moving an instance");
    compare(&world, &places, "after an inner node and an instance have moved");
    places.corner = 1 + 0.5f * (float)step;
    need((positions = rtslMapVertices(world.scene, world.mesh)) != NULL, "mapping vertices");
    positions[7] = places.corner;
    need(rtslUnmapVertices(world.scene, world.mesh), "unmapping vertices");
    compare(&world, &places, "after vertices have moved");
    places.radius = 1.2 - 0.2 * step;
    need(setRadius(&world, places.radius), "primitives");
    compare(&world, &places, "after primitives have grown");
  }
  need(memcmp(before, launch(&world), sizeof before) != 0, "something has moved");
  { /* Members: another root, and the weight of marks. */
    const double root = 1, seven = 7;
    int all = 1;
    need(rtslSetMember(world.scene, world.measure, "root", &root, 1) &&
             rtslSetMember(world.scene, world.marked, "weight", &seven, 1),
         "members");
    found = launch(&world);
    for (i = 0; i < rays; ++i)
      all = all && (found[2 * i] < 0 || found[2 * i + 1] == 3.5f);
    need(all, "marks of the other root");
  }
  rtslSceneDestroy(world.scene);
}

/* Two ray generations, one after the other, over one buffer. */
static void passes(void) {
  const Places places = {0.25, 1, -1, 1.5f, 1};
  const uint32_t one[] = {1}, all[] = {slices, height, width};
  const World world = make(&places);
  const float *found = launch(&world);
  const RtslBufferNumber total = rtslSceneAddBuffer(world.scene, 1);
  RtslRenderSettings settings = rtslRenderDefaults();
  float sum = 0;
  int i;
  need(rtslMemberBuffer(world.scene, "found", world.found, all, 3) &&
           rtslMemberBuffer(world.scene, "total", total, one, 1) &&
           rtslSceneSetRayGeneration(world.scene, rtslSceneAddObject(world.scene, "Total")),
       "another ray generation");
  settings.width = settings.height = settings.samplesPerPixel = 1;
  need(rtslLaunch(world.scene, &settings), "a second pass");
  for (i = 0; i < rays; ++i)
    sum += found[2 * i];
  need(sum == *(const float *)rtslMapBuffer(world.scene, total), "the sum of the first pass");
  need(rtslSceneSetRayGeneration(world.scene, world.measure) && launch(&world) == found,
       "the first pass again");
  rtslSceneDestroy(world.scene);
}

/* An image of numbers, and one of a file of `texels` columns. */
static void images(const char *file, int texels) {
  const float numbers[] = {0.5f, -2, 1e30f, 0}, strange[] = {0, -INFINITY, 1, NAN};
  const uint32_t five[] = {5};
  RtslScene *scene = rtslSceneCreate(launches_shaders());
  RtslSampling sampling = rtslSamplingDefaults();
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslObject pictures[2];
  int i, column;
  sampling.filter = RTSL_NEAREST;
  need(rtslSceneAddTexels(scene, strange, 4, 1, 0, 1, &sampling) &&
           rtslImageNumbersNotFinite() == 2,
       "numbers of an image that are not finite");
  pictures[0] = rtslSceneAddTexels(scene, numbers, 4, 1, 0, 1, &sampling);
  need(rtslImageNumbersNotFinite() == 0, "an image of finite numbers");
  pictures[1] = rtslSceneAddImage(scene, &file, 1, 0, NULL);
  settings.width = 5, settings.height = settings.samplesPerPixel = 1;
  for (i = 0; i < 2; ++i) {
    const RtslBufferNumber seen = rtslSceneAddBuffer(scene, 5);
    const float *values = (const float *)rtslMapBuffer(scene, seen);
    need(pictures[i] && rtslMemberObject(scene, "picture", pictures[i]) &&
             rtslMemberBuffer(scene, "seen", seen, five, 1) &&
             rtslSceneSetRayGeneration(scene, rtslSceneAddObject(scene, "Look")) &&
             rtslLaunch(scene, &settings),
         "a launch that looks up an image");
    for (column = 0; i == 0 && column < 4; ++column)
      need(values[column] == numbers[column], "a texel");
    for (column = 0; i == 1 && column < 4; ++column)
      need(values[column] >= 0 && values[column] <= 1, "a color");
    need(values[4] == (i == 0 ? 4 : texels), "the size of an image");
  }
  rtslSceneDestroy(scene);
}

static void picture(RtslScene *scene, const char *file) {
  const RtslRenderSettings settings = rtslSceneSettings(scene);
  need(rtslRenderToFile(scene, &settings, file), file);
}

/* A scene of a file, at two frames and by two cameras, and another one that writes a buffer. */
static void files(void) {
  const char *first[] = {"camera=side", "frame=1"},
             *second[] = {"camera=front", "frame=2", "render.sampler=r2"};
  const char *nowhere = "camera=nowhere";
  const double level = 0.25;
  uint32_t sizes[3];
  const float *found;
  RtslScene *scene = rtslSceneLoad(launches_shaders(), "scene.json", first, 2);
  RtslRenderSettings settings;
  need(scene != NULL, "a scene of a file");
  picture(scene, "first.exr");
  need(rtslSetMember(scene, rtslSceneFind(scene, "clay"), "level", &level, 1), "a named object");
  picture(scene, "level.exr");
  need(rtslSceneReload(scene, second, 3), "another frame");
  picture(scene, "second.exr");
  need(!rtslSceneReload(scene, &nowhere, 1), "a setting of a camera that is not there");
  picture(scene, "same.exr"); /* after a mistake the scene is as it was */
  rtslSceneDestroy(scene);
  need((scene = rtslSceneLoad(launches_shaders(), "rays.json", NULL, 0)) != NULL, "a launch");
  settings = rtslSceneSettings(scene);
  need(rtslLaunch(scene, &settings), "a launch of a file");
  need((found = (const float *)rtslSceneOutput(scene, "found", sizes)) != NULL, "an output");
  need(sizes[0] == 1 && sizes[1] == 2 && sizes[2] == 3, "its sizes");
  need(found[0] == 19, "a distance");
  need(rtslScenePasses(scene) == 1 && rtslSceneSetPass(scene, 0), "one launch");
  rtslSceneDestroy(scene);
}

/* A mesh that moves, as moving.json has it. */
static void movingMesh(void) {
  const char *keys[] = {"flat.obj", "bent.obj"};
  const float times[] = {0.25f, 1};
  RtslScene *scene = rtslSceneCreate(launches_shaders());
  RtslRenderSettings settings = rtslRenderDefaults();
  const int32_t mesh = rtslSceneLoadMovingMesh(scene, keys, times, 2);
  need(mesh >= 0, "a mesh that moves");
  need(rtslSceneAddMeshInstance(scene, mesh, rtslSceneAddObject(scene, "Lit")), "its instance");
  need(rtslSceneSetCamera(scene, rtslSceneAddObject(scene, "Eye")), "a camera");
  settings.width = 48, settings.height = 32, settings.samplesPerPixel = 4;
  need(rtslRenderToFile(scene, &settings, "moving.exr"), "moving.exr");
  rtslSceneDestroy(scene);
}

/* Primitives of a glTF file with morph targets, one of which moves, as parts.json has them; texture
 * coordinates of the other one are barycentric. */
static void parts(void) {
  const char *part = "meshes.0.primitives.0";
  const double still[] = {0.25, -0.5}, weights[] = {0, 0, 1, 0.5};
  const double right[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 0};
  const float times[] = {0, 1};
  RtslScene *scene = rtslSceneCreate(launches_shaders());
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslObject material;
  int32_t meshes[2];
  need(scene && (material = rtslSceneAddObject(scene, "Coordinates")), "a material");
  meshes[0] = rtslSceneLoadMovingMeshPart(scene, "morph.gltf", part, weights, 2, times, 2);
  need(meshes[0] >= 0 && rtslSceneAddMeshInstance(scene, meshes[0], material), "one that moves");
  need(rtslSetBarycentric(scene, 1), "barycentric coordinates");
  meshes[1] = rtslSceneLoadMeshPart(scene, "morph.gltf", part, still, 2);
  need(rtslPlace(scene, right, ~0u), "a place");
  need(meshes[1] >= 0 && rtslSceneAddMeshInstance(scene, meshes[1], material), "one that is still");
  need(rtslPlace(scene, NULL, 0), "a mask without bits");
  need(rtslSceneAddMeshInstance(scene, meshes[1], material), "one that no ray hits");
  need(rtslSceneSetCamera(scene, rtslSceneAddObject(scene, "Eye")), "a camera");
  settings.width = 48, settings.height = 32, settings.samplesPerPixel = 4;
  need(rtslRenderToFile(scene, &settings, "parts.exr"), "parts.exr");
  rtslSceneDestroy(scene);
}

/* Two passes of a file: the second one adds what the first one has found, and again. */
static void passesOfFile(void) {
  RtslScene *scene = rtslSceneLoad(launches_shaders(), "passes.json", NULL, 0);
  uint32_t pass, sizes[3];
  int round;
  const float *total, *found;
  need(scene != NULL && rtslScenePasses(scene) == 2, "a scene with passes");
  for (round = 0; round < 2; ++round) {
    for (pass = 0; pass < 2; ++pass) {
      RtslRenderSettings settings;
      need(rtslSceneSetPass(scene, pass), "a pass");
      settings = rtslSceneSettings(scene);
      need(settings.width == (pass == 0 ? 3 : 1), "its size");
      need(settings.samplesPerPixel == 1, "its samples");
      need(rtslLaunch(scene, &settings), "its launch");
      if (pass == 0) {
        need((found = (const float *)rtslSceneOutput(scene, "found", sizes)) != NULL, "rays");
        need(found[0] == 19 && sizes[0] == 1 && sizes[1] == 2 && sizes[2] == 3, "what they find");
      }
    }
    need((total = (const float *)rtslSceneOutput(scene, "total", sizes)) != NULL, "a sum");
    printf("total %g\n", total[0]);
    need(rtslSceneReload(scene, NULL, 0) && rtslScenePasses(scene) == 2, "the file again");
  }
  need(!rtslSceneSetPass(scene, 2), "a third pass");
  rtslSceneDestroy(scene);
}

static void mistakes(void) {
  const Places places = {0, 0, 0, 1, 1};
  const uint32_t sizes[] = {3, 1, 1};
  const double infinite[12] = {HUGE_VAL}, one = 1, minus = -1, noNumber = NAN;
  const double flat[12] = {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  RtslRenderSettings settings = rtslRenderDefaults();
  World world = make(&places);
  RtslScene *scene = world.scene;
  const char *nowhere = "nowhere.png", *setting = "camera=nowhere";
  uint32_t found[3];
  const float texel = 1;
  RtslSampling sampling = rtslSamplingDefaults();
  float *positions;
  EXPECT_FAILURE(rtslLeave(scene));
  EXPECT_FAILURE(rtslMapBuffer(scene, 9));
  EXPECT_FAILURE(rtslUnmapBuffer(scene, 0));
  EXPECT_FAILURE(rtslSceneAddBuffer(scene, (size_t)-1 / 8));
  EXPECT_FAILURE(rtslMemberBuffer(scene, "steps", world.steps, sizes, 4));
  EXPECT_FAILURE(rtslMemberBuffer(scene, "steps", world.steps, sizes, 1) &&
                 rtslSceneAddObject(scene, "Measure"));
  EXPECT_FAILURE(rtslMoveNode(scene, 7));
  EXPECT_FAILURE(rtslMoveInstance(scene, 99));
  EXPECT_FAILURE(rtslPlace(scene, infinite, ~0u));
  need(rtslPlace(scene, flat, ~0u), "a flat place");
  EXPECT_FAILURE(rtslMoveNode(scene, world.inner));
  EXPECT_FAILURE(rtslMapVertices(scene, 5));
  EXPECT_FAILURE(rtslUnmapVertices(scene, world.mesh));
  need((positions = rtslMapVertices(scene, world.mesh)) != NULL, "vertices");
  EXPECT_FAILURE(rtslLaunch(scene, &settings));
  positions[3] = HUGE_VALF;
  EXPECT_FAILURE(rtslUnmapVertices(scene, world.mesh));
  EXPECT_FAILURE(rtslSetMember(scene, world.marked, "wait", &one, 1));
  EXPECT_FAILURE(rtslSetMember(scene, world.ball, "radius", &minus, 1));
  EXPECT_FAILURE(rtslSetMember(scene, world.row, "radius", &minus, 1));
  EXPECT_FAILURE(rtslSetMember(scene, 4711, "weight", &one, 1));
  EXPECT_FAILURE(rtslSetMember(scene, world.marked, "weight", &minus, 1));
  EXPECT_FAILURE(rtslSetMember(scene, world.marked, "weight", &noNumber, 1));
  settings.width = 0;
  EXPECT_FAILURE(rtslLaunch(scene, &settings));
  settings.width = 4, settings.slices = 0x7fffffff;
  EXPECT_FAILURE(rtslLaunch(scene, &settings));
  EXPECT_FAILURE(rtslSceneAddImage(scene, &nowhere, 1, 0, NULL));
  EXPECT_FAILURE(rtslSceneAddImage(scene, &nowhere, 2, 0, NULL));
  EXPECT_FAILURE(rtslSceneAddTexels(scene, &texel, 1, 1, 0, 3, NULL));
  EXPECT_FAILURE(rtslSetRoots(scene, 0));
  EXPECT_FAILURE(rtslSceneCreate(NULL));
  EXPECT_FAILURE(rtslSceneLoad(NULL, "nowhere.json", NULL, 0));
  EXPECT_FAILURE(rtslSceneLoad(launches_shaders(), "nowhere.json", NULL, 0));
  EXPECT_FAILURE(rtslSceneSetPass(scene, 0));
  EXPECT_FAILURE(rtslSceneLoad(launches_shaders(), "scene.json", &setting, 1));
  EXPECT_FAILURE(rtslSceneReload(scene, NULL, 0));
  EXPECT_FAILURE(rtslSceneFind(scene, "nothing"));
  EXPECT_FAILURE(rtslSceneOutput(scene, "nothing", found));
  EXPECT_FAILURE(rtslSceneLoadMovingMesh(scene, &nowhere, &texel, 1) >= 0);
  EXPECT_FAILURE(rtslSceneLoadMeshPart(scene, "morph.gltf", "meshes.0", &one, 1) >= 0);
  EXPECT_FAILURE(rtslSceneLoadMeshPart(scene, "morph.gltf", "meshes.0.primitives.0", &one, 1) >= 0);
  EXPECT_FAILURE(rtslSceneSetLightSampler(scene, (RtslLightSampler)3));
  EXPECT_FAILURE(rtslSceneSetSampler(scene, (RtslSampler)3));
  EXPECT_FAILURE(rtslMeshAttribute(scene, "grain", 1, &texel, 1, 0, (RtslAttributeSpace)5));
  sampling.wrap[2] = (RtslWrap)4;
  EXPECT_FAILURE(rtslSceneAddTexels(scene, &texel, 1, 1, 0, 1, &sampling));
  EXPECT_FAILURE(rtslSceneAddObject(NULL, "Ball"));
  EXPECT_FAILURE(rtslSceneAddObject(scene, NULL));
  EXPECT_FAILURE(rtslMember(scene, "radius", NULL, 1));
  EXPECT_FAILURE(rtslMemberBuffer(scene, "steps", world.steps, NULL, 1));
  EXPECT_FAILURE(rtslSceneAddTriangles(scene, NULL, 3, sizes, 1, world.marked));
  EXPECT_FAILURE(rtslPlaceMoving(scene, flat, NULL, 2, ~0u));
  EXPECT_FAILURE(rtslLaunch(NULL, &settings));
  EXPECT_FAILURE(rtslRender(scene, &settings, NULL));
  EXPECT_FAILURE(rtslSceneChannels(NULL));
  EXPECT_FAILURE(rtslQueryNearest(NULL, NULL, 0, NULL));
  mistakesOfSources(scene);
  launch(&world); /* after all of this it is whole */
  compare(&world, &places, "nothing of that has changed the scene");
  rtslSceneDestroy(scene);
}

int main(int count, char **arguments) {
  if (count != 3)
    return fprintf(stderr, "usage: %s IMAGE COLUMNS\n", arguments[0]), 2;
  changes();
  passes();
  images(arguments[1], atoi(arguments[2]));
  files();
  movingMesh();
  parts();
  passesOfFile();
  sources();
  values();
  references();
  mistakes();
  return 0;
}
