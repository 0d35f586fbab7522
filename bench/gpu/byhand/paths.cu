// paths.cu - bench/gpu/paths by hand: 16 parallelograms in constant memory, tested one after the
// other, and a loop over the segments of a path. A thread begins its next sample when a path ends,
// while others of its warp are on theirs.
#include "Hand.cuh"

struct Side {
  Vec n;
  float d; // n.p = d
  Vec v1;
  float a1; // v1.p - a1 in [0, 1]
  Vec v2;
  float a2;
};
constexpr int sides = 16, lamp = 15, segments = 10;
__constant__ Side scene[sides];
__constant__ Vec albedo[sides];

static const float corners[sides][9] = {
    {0, 0, 0, 0, 0, 559.2f, 556, 0, 0},
    {0, 548.8f, 0, 556, 0, 0, 0, 0, 559.2f},
    {0, 0, 559.2f, 0, 548.8f, 0, 556, 0, 0},
    {0, 0, 0, 0, 548.8f, 0, 0, 0, 559.2f},
    {556, 0, 0, 0, 0, 559.2f, 0, 548.8f, 0},
    {130, 165, 65, -48, 0, 160, 160, 0, 49},
    {290, 0, 114, 0, 165, 0, -50, 0, 158},
    {130, 0, 65, 0, 165, 0, 160, 0, 49},
    {82, 0, 225, 0, 165, 0, 48, 0, -160},
    {240, 0, 272, 0, 165, 0, -158, 0, -47},
    {423, 330, 247, -158, 0, 49, 49, 0, 159},
    {423, 0, 247, 0, 330, 0, 49, 0, 159},
    {472, 0, 406, 0, 330, 0, -158, 0, 50},
    {314, 0, 456, 0, 330, 0, -49, 0, -160},
    {265, 0, 296, 0, 330, 0, 158, 0, -49},
    {343, 548.6f, 227, -130, 0, 0, 0, 0, 105},
};

struct Path {
  Vec origin, direction, weight;
  int segment;
};

__device__ Path begin(int x, int y, Random &random) {
  constexpr float halfWidth = 0.31529878887f;
  const float u = 2 * (x + random()) / width - 1, v = 1 - 2 * (y + random()) / height;
  return {{278, 273, -800}, normalize({u * halfWidth, v * halfWidth, 1}), {1, 1, 1}, 0};
}

__global__ void render(Vec *pixels) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  Vec sum = {0, 0, 0};
  int sample = 0;
  Random random(y * width + x, sample);
  Path path = begin(x, y, random);
  for (;;) {
    float nearest = 1e30f;
    int hit = -1;
    for (int i = 0; i < sides; ++i) {
      const Side &side = scene[i];
      const float t = (side.d - dot(side.n, path.origin)) / dot(side.n, path.direction);
      const Vec p = path.origin + t * path.direction;
      const float a1 = dot(side.v1, p) - side.a1, a2 = dot(side.v2, p) - side.a2;
      if (t > 0.01f && t < nearest && a1 >= 0 && a1 <= 1 && a2 >= 0 && a2 <= 1) {
        nearest = t;
        hit = i;
      }
    }
    const bool ends = hit < 0 || hit == lamp || path.segment + 1 == segments;
    if (hit == lamp)
      sum = sum + path.weight * Vec{15, 15, 5};
    if (ends) {
      if (++sample == samplesPerPixel)
        break;
      random = Random(y * width + x, sample);
      path = begin(x, y, random);
      continue;
    }
    Vec w = scene[hit].n;
    if (dot(w, path.direction) > 0)
      w = -1.0f * w;
    const Vec u = normalize(cross(fabsf(w.x) > 0.5f ? Vec{0, 1, 0} : Vec{1, 0, 0}, w));
    const Vec v = cross(w, u);
    const float radius2 = random(), radius = sqrtf(radius2);
    float sine, cosine;
    sincosf(6.2831853f * random(), &sine, &cosine);
    path.origin = path.origin + nearest * path.direction;
    path.direction = radius * cosine * u + radius * sine * v + sqrtf(1 - radius2) * w;
    path.weight = path.weight * albedo[hit];
    ++path.segment;
  }
  pixels[y * width + x] = (1.0f / samplesPerPixel) * sum;
}

int main() {
  Side placed[sides];
  Vec colors[sides];
  for (int i = 0; i < sides; ++i) {
    const float *c = corners[i];
    const Vec a = {c[0], c[1], c[2]}, e1 = {c[3], c[4], c[5]}, e2 = {c[6], c[7], c[8]};
    Side &side = placed[i];
    side.n = normalize(cross(e1, e2));
    side.d = dot(side.n, a);
    side.v1 = (1 / dot(e1, e1)) * e1;
    side.v2 = (1 / dot(e2, e2)) * e2;
    side.a1 = dot(side.v1, a);
    side.a2 = dot(side.v2, a);
    colors[i] = i == 3   ? Vec{0.05f, 0.8f, 0.05f}
                : i == 4 ? Vec{0.8f, 0.05f, 0.05f}
                         : Vec{0.8f, 0.8f, 0.8f};
  }
  check(cudaMemcpyToSymbol(scene, placed, sizeof placed), "the scene");
  check(cudaMemcpyToSymbol(albedo, colors, sizeof colors), "the colors");
  return measure("paths", render);
}
