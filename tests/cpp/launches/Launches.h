/* Launches.h - what the files of the test of launches have in common. */
#ifndef LAUNCHES_H
#define LAUNCHES_H

#include <rtsl/rtsl.h>

#include <stdio.h>
#include <stdlib.h>

const RtslShaders *launches_shaders(void);

/* Ends the program unless it is good. */
void need(int good, const char *what);

/* Prints the message of a call that must fail. */
#define EXPECT_FAILURE(call)                                                                       \
  if (call) {                                                                                      \
    fprintf(stderr, "%s succeeds\n", #call);                                                       \
    exit(1);                                                                                       \
  }                                                                                                \
  printf("%s\n", rtslError())

/* Given.c: references, colors and integers that a scene gives to objects. */
void values(void);

/* References.c: objects that others refer to, and that are replaced. */
void references(void);

/* Sources.c: values of files and of key frames. */
void sources(void);
void mistakesOfSources(RtslScene *scene);

#endif
