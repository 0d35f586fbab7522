/* The C interface compiles as C, and says what is wrong. */
#include <rtsl/rtsl.h>

#include <stdio.h>

int main(void) {
  RtslRenderSettings settings = rtslRenderDefaults();
  if (settings.width != 960 || settings.samplesPerPixel != 16)
    return 1;
  if (rtslSceneCreate(NULL) != NULL)
    return 2;
  printf("%s\n", rtslError());
  return 0;
}
