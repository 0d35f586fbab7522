/* A knot on a turntable, through the C interface. The scene is made once and never compiled; from
 * picture to picture the knot turns, and the trees follow it. */
#include <rtsl/rtsl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const RtslShaders *glass_shaders(void); /* of glass.cpp, which rtslc --emit=cpp has written */

static RtslScene *scene;

/* What a function returns is 0 if it failed. */
static uint32_t need(uint32_t result) {
  if (!result)
    fprintf(stderr, "%s\n", rtslError()), exit(1);
  return result;
}

static void argument(const char *parameter, size_t count, double x, double y, double z) {
  const double numbers[] = {x, y, z};
  need((uint32_t)rtslArgument(scene, parameter, numbers, count));
}

static void member(const char *name, double x, double y, double z) {
  const double numbers[] = {x, y, z};
  need((uint32_t)rtslMember(scene, name, numbers, 3));
}

static RtslObject lambert(double red, double green, double blue) {
  member("value", red, green, blue);
  rtslMemberObject(scene, "albedo", need(rtslSceneAddObject(scene, "Solid")));
  return need(rtslSceneAddObject(scene, "Lambert"));
}

/* Places the next node, or the one that is moved: turned about the vertical axis. */
static void turn(double degrees) {
  const double c = cos(degrees * 0.0174532925), s = sin(degrees * 0.0174532925);
  const double columns[12] = {c, 0, -s, 0, 1, 0, s, 0, c, 0, 1.15, 0};
  need((uint32_t)rtslPlace(scene, columns, ~0u));
}

int main(int count, char **arguments) {
  const float ambient[] = {0.12f, 0.13f, 0.16f};
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslObject ground;
  RtslNode table;
  char path[4096];
  int i;
  if (count != 5)
    return fprintf(stderr, "usage: %s KNOT.obj FOLDER FRAMES WIDTH\n", arguments[0]), 2;
  scene = rtslSceneCreate(glass_shaders());
  argument("eye", 3, 0, 2.2, 7.5), argument("up", 3, 0, 1, 0), argument("gaze", 3, 0, -0.19, -1);
  argument("uv0", 2, -1.6, -0.9, 0), argument("uv1", 2, 1.6, 0.9, 0), argument("d", 1, 4, 0, 0);
  need((uint32_t)rtslSceneSetCamera(scene, need(rtslSceneAddObject(scene, "PinholeCamera"))));
  argument("anchor_", 3, -8, 0, 8), argument("e1", 3, 16, 0, 0), argument("e2", 3, 0, 0, -16);
  ground = need(rtslSceneAddObject(scene, "Parallelogram"));
  rtslSceneAddPrimitive(scene, ground, lambert(0.7, 0.7, 0.65));
  turn(0);
  table = need(rtslEnter(scene)); /* what is added from here on stands on it */
  need((uint32_t)rtslSceneAddMeshFile(scene, arguments[1], NULL, lambert(0.8, 0.35, 0.2)));
  rtslLeave(scene);
  member("position", 4, 6, 4), member("intensity", 38, 36, 33);
  need((uint32_t)rtslSceneAddLight(scene, need(rtslSceneAddObject(scene, "BallLight"))));
  rtslSceneSetAmbient(scene, ambient, 3);
  rtslSceneSetBackground(scene, need(rtslSceneAddObject(scene, "Sky")));
  settings.width = (uint32_t)atoi(arguments[4]), settings.height = settings.width * 9 / 16;
  for (i = 0; i < atoi(arguments[3]); ++i) {
    turn(360.0 * i / atoi(arguments[3]));
    need((uint32_t)rtslMoveNode(scene, table));
    snprintf(path, sizeof path, "%s/turn%d.png", arguments[2], i);
    need((uint32_t)rtslRenderToFile(scene, &settings, path));
  }
  rtslSceneDestroy(scene);
  return 0;
}
