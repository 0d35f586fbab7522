/* query MESH RAYS HITS ANY: traces the rays of a file, 8 floats each, as `rtslc trace` does, and
 * writes the hits, and a byte for each ray. Then a triangle that moves, and mistakes, a message a
 * line. */
#include <rtsl/rtsl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void need(int good, const char *what) {
  if (good)
    return;
  fprintf(stderr, "%s: %s\n", what, rtslError());
  exit(1);
}

static void write_all(const char *path, const void *bytes, size_t size) {
  FILE *file = fopen(path, "wb");
  need(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0, path);
}

int main(int count, char **arguments) {
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  float moved[] = {1, 0, 0, 2, 0, 0, 1, 1, 0};
  const uint32_t indices[] = {0, 1, 2}, wrong[] = {0, 1, 3};
  const RtslQueryRay ray = {{0.25f, 0.25f, 1}, 0, {0, 0, -1}, 10};
  RtslQueryRay *rays = NULL;
  RtslQueryHit *hits, hit;
  RtslQuery *query;
  uint8_t *any, flag;
  size_t rayCount = 0, room = 0;
  FILE *file;
  need(count == 5 && (file = fopen(arguments[2], "rb")) != NULL, "arguments");
  do {
    room += 4096;
    need((rays = realloc(rays, room * sizeof *rays)) != NULL, "memory");
    rayCount += fread(rays + rayCount, sizeof *rays, 4096, file);
  } while (rayCount == room);
  fclose(file);
  hits = malloc(rayCount * sizeof *hits);
  any = malloc(rayCount);
  need((query = rtslQueryLoad(arguments[1], 2)) != NULL, "a mesh");
  need(rtslQueryNearest(query, rays, rayCount, hits) && rtslQueryAny(query, rays, rayCount, any),
       "queries");
  write_all(arguments[3], hits, rayCount * sizeof *hits);
  write_all(arguments[4], any, rayCount);
  need(rtslQueryNearest(query, rays, 0, hits), "no rays");
  rtslQueryDestroy(query);

  if (rtslQueryLoad("nowhere.obj", 0) || rtslQueryCreate(corners, 3, wrong, 1, 0) ||
      rtslQueryCreate(corners, 3, indices, 0, 0))
    need(0, "a mistake");
  need((query = rtslQueryCreate(corners, 3, indices, 1, 1)) != NULL, "a triangle");
  need(rtslQueryNearest(query, &ray, 1, &hit) && hit.triangle == 0 && hit.t == 1 &&
           hit.u == 0.25f && hit.v == 0.25f,
       "a hit");
  need(rtslQueryMove(query, moved, 3) && rtslQueryNearest(query, &ray, 1, &hit) &&
           hit.triangle == -1 && rtslQueryAny(query, &ray, 1, &flag) && flag == 0,
       "a miss");
  if (rtslQueryMove(query, moved, 2))
    need(0, "too few vertices");
  printf("%s\n", rtslError());
  moved[3] = NAN;
  if (rtslQueryMove(query, moved, 3))
    need(0, "not a number");
  printf("%s\n", rtslError());
  need(rtslQueryMove(query, corners, 3) && rtslQueryNearest(query, &ray, 1, &hit) &&
           hit.triangle == 0,
       "a hit again");
  rtslQueryDestroy(query);
  free(rays), free(hits), free(any);
  return 0;
}
