/* Models.c SCENE PICTURE [tree]: renders a scene whose model has materials of the library; with
 * `tree`, lights are chosen by a light tree. */
#include <rtsl/rtsl.h>

#include <stdio.h>
#include <string.h>

const RtslShaders *library_shaders(void);

int main(int count, char **arguments) {
  RtslScene *scene = count >= 3 ? rtslSceneLoad(library_shaders(), arguments[1], NULL, 0) : NULL;
  RtslRenderSettings settings;
  int good = scene != NULL;
  if (good) {
    settings = rtslSceneSettings(scene);
    if (count > 3 && strcmp(arguments[3], "tree") == 0)
      good = rtslSceneSetLightSampler(scene, RTSL_LIGHTS_BY_TREE);
    good = good && rtslRenderToFile(scene, &settings, arguments[2]);
    rtslSceneDestroy(scene);
  }
  if (!good)
    fprintf(stderr, "%s\n", rtslError());
  return !good;
}
