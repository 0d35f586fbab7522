/* Materials that refer to other ones, which are replaced between launches: by those that read what
 * the first ones did not. What is seen must be what a scene shows that was made so. */
#include "Launches.h"

#include <string.h>

enum { width = 5, height = 4, rays = width * height, kinds = 4 };
static const char *const names[kinds] = {"Shown", "ShownCoordinate", "ShownHeat", "ShownPlace"};

typedef struct Wrapping {
  RtslScene *scene;
  RtslObject outer, inner, shown[kinds];
  RtslBufferNumber found;
} Wrapping;

static RtslObject wrapped(RtslScene *scene, RtslObject object) {
  need(rtslMemberObject(scene, "inner", object), "a member");
  return rtslSceneAddObject(scene, "Wrapped");
}

/* A mesh of a material that refers to one that refers to one of `kind`. */
static Wrapping makeWrapping(int kind) {
  const float positions[] = {-2, -2, 0, 2, -2, 0, 0, 2, 1}, heats[] = {0.5f, 4, 0.125f};
  const double from[] = {-1, -1.5, 20}, columns[12] = {0.9, 0, 0, 0, 0.9, 0, 0, 0, 1, 0.1, 0, 0};
  const uint32_t indices[] = {0, 1, 2}, one[] = {1}, all[] = {1, height, width};
  Wrapping made;
  RtslScene *scene = made.scene = rtslSceneCreate(launches_shaders());
  RtslBufferNumber steps, hits;
  float *step;
  int i;
  need(scene != NULL, "a scene");
  steps = rtslSceneAddBuffer(scene, 1);
  made.found = rtslSceneAddBuffer(scene, 2 * rays);
  hits = rtslSceneAddBuffer(scene, 1);
  need((step = (float *)rtslMapBuffer(scene, steps)) != NULL, "mapping");
  *step = 0.5f;
  need(rtslMember(scene, "from", from, 3) && rtslMemberBuffer(scene, "steps", steps, one, 1) &&
           rtslMemberBuffer(scene, "found", made.found, all, 3) &&
           rtslMemberBuffer(scene, "hits", hits, one, 1) &&
           rtslSceneSetRayGeneration(scene, rtslSceneAddObject(scene, "Measure")),
       "a ray generation");
  for (i = 0; i < kinds; ++i)
    need((made.shown[i] = rtslSceneAddObject(scene, names[i])) != 0, names[i]);
  made.inner = wrapped(scene, made.shown[kind]);
  made.outer = wrapped(scene, made.inner);
  need(rtslPlace(scene, columns, ~0u) && rtslSetBarycentric(scene, 1) &&
           rtslMeshAttribute(scene, "heat", 1, heats, 3, 0, RTSL_NUMBERS) &&
           rtslSceneAddTriangles(scene, positions, 3, indices, 1, made.outer),
       "a mesh");
  return made;
}

static const float *look(const Wrapping *made) {
  RtslRenderSettings settings = rtslRenderDefaults();
  settings.width = width, settings.height = height, settings.samplesPerPixel = 1;
  need(rtslLaunch(made->scene, &settings), "a launch");
  return (const float *)rtslMapBuffer(made->scene, made->found);
}

/* Is what is found what a fresh scene finds? The marks of a constant are all the same. */
static void compareWith(const Wrapping *made, int kind, int isConstant) {
  const Wrapping fresh = makeWrapping(kind);
  const float *found = look(made), *expected = look(&fresh);
  int i, hits = 0, differing = 0;
  float first = 0;
  for (i = 0; i < rays; ++i) {
    if (found[2 * i] < 0)
      continue;
    if (hits++ == 0)
      first = found[2 * i + 1];
    differing += found[2 * i + 1] != first;
  }
  need(hits > 3 && (differing == 0) == isConstant, "marks");
  need(memcmp(found, expected, 2 * rays * sizeof *found) == 0, names[kind]);
  rtslSceneDestroy(fresh.scene);
}

void references(void) {
  int kind;
  for (kind = 1; kind < kinds; ++kind) {
    const Wrapping made = makeWrapping(0);
    compareWith(&made, 0, 1);
    need(rtslSetMemberObject(made.scene, made.inner, "inner", made.shown[kind]), "the inner one");
    compareWith(&made, kind, 0);
    need(rtslSetMemberObject(made.scene, made.inner, "inner", made.shown[0]), "as it was");
    compareWith(&made, 0, 1);
    need(rtslSetMemberObject(made.scene, made.outer, "inner",
                             wrapped(made.scene, made.shown[kind])),
         "the outer one");
    compareWith(&made, kind, 0);
    rtslSceneDestroy(made.scene);
  }
}
