/* Models.c SCENE PICTURE: renders a scene whose model has materials of the library. */
#include <rtsl/rtsl.h>

#include <stdio.h>

const RtslShaders *library_shaders(void);

int main(int count, char **arguments) {
  RtslScene *scene = count == 3 ? rtslSceneLoad(library_shaders(), arguments[1], NULL, 0) : NULL;
  RtslRenderSettings settings;
  int good = scene != NULL;
  if (good) {
    settings = rtslSceneSettings(scene);
    good = rtslRenderToFile(scene, &settings, arguments[2]);
    rtslSceneDestroy(scene);
  }
  if (!good)
    fprintf(stderr, "%s\n", rtslError());
  return !good;
}
