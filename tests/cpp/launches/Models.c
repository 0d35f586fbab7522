/* Models.c SCENE PICTURE [tree]: renders a scene whose model has materials of the library; with
 * `tree`, lights are chosen by a light tree. Models.c --build PICTURE: makes the scene of
 * built.json by itself, and prints the messages of mistakes. */
#include <rtsl/rtsl.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const RtslShaders *library_shaders(void);

static void need(int good, const char *what) {
  if (good)
    return;
  fprintf(stderr, "%s: %s\n", what, rtslError());
  exit(1);
}

static void place(RtslScene *scene, double x, double z, double tx, double ty, double tz) {
  const double columns[12] = {x, 0, 0, 0, 1, 0, 0, 0, z, tx, ty, tz};
  need(rtslPlace(scene, columns, ~0u), "a place");
}

static void mistakes(RtslScene *scene, const RtslAnimation *good) {
  const double two[] = {1, 2};
  const RtslAnimation strange = {"Jump", 12, 5}, backwards = {"Turn", -1, 5};
  const RtslPlacementKey keys[] = {{{1, 1, 1}, {0, 0, 0, 1}, {0, 0, 0}, 0},
                                   {{1, 1, 1}, {0, 0, 0, 1}, {1, 0, 0}, 1}};
#define EXPECT_FAILURE(call)                                                                       \
  need(!(call), #call);                                                                            \
  printf("%s\n", rtslError())
  EXPECT_FAILURE(rtslSceneAddModel(scene, "nowhere.gltf", NULL));
  EXPECT_FAILURE(rtslSceneAddModel(scene, "broken.gltf", NULL));
  EXPECT_FAILURE(rtslSceneAddModel(scene, "room.gltf", &strange));
  EXPECT_FAILURE(rtslSceneAddModel(scene, "room.gltf", &backwards));
  EXPECT_FAILURE(rtslSceneAddModel(scene, "glass.obj", NULL));
  EXPECT_FAILURE(rtslSceneAddModel(scene, "late.gltf", NULL)); /* of which a part is good */
  EXPECT_FAILURE(rtslSceneAddModelCamera(scene, "room.gltf", "Back", good));
  EXPECT_FAILURE(rtslSceneAddNodeLight(scene, "Emitter"));
  EXPECT_FAILURE(rtslMember(scene, "position", two, 2) &&
                 rtslSceneAddNodeLight(scene, "PointLight"));
  EXPECT_FAILURE(rtslPlaceTurning(scene, keys, 2, ~0u) &&
                 rtslSceneAddNodeLight(scene, "PointLight"));
  EXPECT_FAILURE(rtslPlaceTurning(scene, keys, 2, ~0u) &&
                 rtslSceneAddModelCamera(scene, "room.gltf", "Front", good));
}

/* The light of built.json in a node. */
static void lamp(RtslScene *scene) {
  const double position[] = {1, 2, 0.5}, intensity[] = {9, 8, 6};
  need(rtslMember(scene, "position", position, 3) && rtslMember(scene, "intensity", intensity, 3) &&
           rtslSceneAddNodeLight(scene, "PointLight"),
       "a light in a node");
  place(scene, 1, 1, 0, 1, 0);
  need(rtslMember(scene, "intensity", intensity, 3) && rtslSceneAddNodeLight(scene, "SpotLight"),
       "another one");
}

static void build(const char *file) {
  const RtslAnimation turn = {"Turn", 12, 5};
  const double sky[] = {0.5, 0.6, 0.8};
  RtslScene *scene = rtslSceneCreate(library_shaders());
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslNode table;
  RtslObject camera;
  need(scene && rtslSceneSetShutter(scene, 0, 1), "a shutter");
  mistakes(scene, &turn);
  place(scene, 1, 1, 0, 0.25, 1);
  need((camera = rtslSceneAddModelCamera(scene, "room.gltf", "Front", &turn)) &&
           rtslSceneSetCamera(scene, camera),
       "a camera of a model");
  place(scene, 1.25, 0.5, -0.3, 0.1, 0.2);
  need((table = rtslEnter(scene)) != 0, "a node");
  place(scene, 1, 1, 0.5, 0, 0.1);
  need(rtslSceneAddModel(scene, "room.gltf", &turn), "a model that moves");
  need(rtslSceneAddModel(scene, "model.obj", NULL), "a model");
  lamp(scene);
  place(scene, 1, 1, 0, 7, 0);
  need(rtslMoveNode(scene, table), "a node that is moved");
  place(scene, 1.25, 0.5, -0.3, 0.1, 0.2);
  need(rtslMoveNode(scene, table), "and back");
  need(rtslLeave(scene), "leaving");
  need(rtslMember(scene, "radiance", sky, 3) &&
           rtslSceneSetBackground(scene, rtslSceneAddObject(scene, "UniformSky")) &&
           rtslSceneSetRayGeneration(scene, rtslSceneAddObject(scene, "PathTracer")),
       "an engine");
  settings.width = 48, settings.height = 32, settings.samplesPerPixel = 4;
  need(rtslRenderToFile(scene, &settings, file), file);
  rtslSceneDestroy(scene);
}

static void load(int count, char **arguments) {
  RtslScene *scene = rtslSceneLoad(library_shaders(), arguments[1], NULL, 0);
  RtslRenderSettings settings;
  need(scene != NULL, arguments[1]);
  settings = rtslSceneSettings(scene);
  if (count > 3 && strcmp(arguments[3], "tree") == 0)
    need(rtslSceneSetLightSampler(scene, RTSL_LIGHTS_BY_TREE), "a light tree");
  need(rtslRenderToFile(scene, &settings, arguments[2]), arguments[2]);
  rtslSceneDestroy(scene);
}

int main(int count, char **arguments) {
  if (count < 3)
    return fprintf(stderr, "usage: %s SCENE PICTURE [tree]\n", arguments[0]), 2;
  if (strcmp(arguments[1], "--build") == 0)
    build(arguments[2]);
  else
    load(count, arguments);
  return 0;
}
