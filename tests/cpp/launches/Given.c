/* What a scene gives to its objects: a reference as an argument and as a variable of a node, and
 * an integer for each triangle; with it the colors of the ambient light and the background, and the
 * sampler. The picture must be that of given.json. */
#include "Launches.h"

static RtslObject lit(RtslScene *scene, double level) {
  need(rtslMember(scene, "level", &level, 1), "a level");
  return rtslSceneAddObject(scene, "Lit");
}

static void addSquare(RtslScene *scene, double x, RtslObject material) {
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const double columns[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, x, 0, 0};
  const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
  const int32_t stripes[] = {3, -2};
  need(rtslMeshAttributeInts(scene, "stripe", stripes, 2) && rtslPlace(scene, columns, ~0u) &&
           rtslSceneAddTriangles(scene, positions, 4, indices, 2, material),
       "a square");
}

void values(void) {
  const float background[] = {0.25f, 0.5f, 0.75f}, ambient[] = {0.5f, 0.25f, 0.125f};
  RtslScene *scene = rtslSceneCreate(launches_shaders());
  RtslRenderSettings settings = rtslRenderDefaults();
  RtslObject chosen;
  need(scene && rtslSceneSetBackgroundColor(scene, background, 3) &&
           rtslSceneSetAmbient(scene, ambient, 3) &&
           rtslSceneSetCamera(scene, rtslSceneAddObject(scene, "Eye")),
       "what is around");
  need(rtslVariableObject(scene, "tone", lit(scene, 0.5)), "a variable of the scene");
  addSquare(scene, -2.5, rtslSceneAddObject(scene, "Striped"));
  need(rtslEnter(scene) && rtslVariableObject(scene, "tone", lit(scene, 2)),
       "a variable of a node");
  addSquare(scene, 0, rtslSceneAddObject(scene, "Striped"));
  need(rtslArgumentObject(scene, "chosen", lit(scene, 0.75)) &&
           (chosen = rtslSceneAddObject(scene, "Chosen")),
       "an argument");
  addSquare(scene, 2.5, chosen);
  need(rtslLeave(scene), "leaving");
  need(rtslSceneSetSampler(scene, RTSL_SOBOL), "a sampler");
  settings.width = 48, settings.height = 32, settings.samplesPerPixel = 4;
  need(rtslRenderToFile(scene, &settings, "given.exr"), "given.exr");
  rtslSceneDestroy(scene);
}
