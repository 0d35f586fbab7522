// crystal.cu - bench/gpu/crystal by hand: glass spheres, with recursion on the hardware's stack.
#include "Hand.cuh"

constexpr int spheres = 6, maxDepth = 8;
__constant__ Vec centers[spheres] = {{-2.2f, 1, 0},  {0, 1, 0},     {2.2f, 1, 0},
                                     {-1.1f, 1, -2}, {1.1f, 1, -2}, {0, 2.8f, -1}};

__device__ Vec mix(Vec a, Vec b, float w) {
  return (1 - w) * a + w * b;
}

/// The color that arrives at `origin` against `direction`.
__device__ Vec trace(Vec origin, Vec direction, int depth) {
  constexpr float tMin = 1e-4f;
  float nearest = 1e30f;
  int hit = -1;
  const float a = dot(direction, direction);
  for (int i = 0; i < spheres; ++i) {
    const Vec f = origin - centers[i];
    const float b = -dot(f, direction);
    const Vec closest = f + (b / a) * direction;
    const float discriminant = 1 - dot(closest, closest);
    if (discriminant < 0)
      continue;
    const float root = sqrtf(a * discriminant), q = b < 0 ? b - root : b + root;
    const float t0 = (dot(f, f) - 1) / q, t1 = q / a;
    const float first = fminf(t0, t1), t = first > tMin ? first : fmaxf(t0, t1);
    if (t > tMin && t < nearest) {
      nearest = t;
      hit = i;
    }
  }
  const float floor = -origin.y / direction.y;
  if (floor > tMin && floor < nearest) {
    const Vec p = origin + floor * direction;
    if (fabsf(p.x) <= 20 && p.z <= 10 && p.z >= -30) {
      const bool isOdd = int(floorf(p.x) + floorf(p.z)) & 1;
      return isOdd ? Vec{0.15f, 0.2f, 0.3f} : Vec{0.85f, 0.8f, 0.7f};
    }
  }
  if (hit < 0) {
    const float up = fminf(fmaxf(normalize(direction).y, 0.0f), 1.0f);
    return mix({0.9f, 0.6f, 0.4f}, {0.1f, 0.2f, 0.5f}, up);
  }
  if (depth == maxDepth)
    return {0, 0, 0};
  const Vec p = origin + nearest * direction, d = normalize(direction);
  Vec n = p - centers[hit];
  float cosine = -dot(d, n), ratio = 1 / 1.5f;
  if (cosine < 0) {
    n = -1.0f * n;
    cosine = -cosine;
    ratio = 1.5f;
  }
  const Vec reflected = d + (2 * cosine) * n;
  const float k = 1 - ratio * ratio * (1 - cosine * cosine);
  if (k < 0)
    return trace(p, reflected, depth + 1);
  const float inner = sqrtf(k);
  const Vec refracted = ratio * d + (ratio * cosine - inner) * n;
  const float outerCosine = ratio > 1 ? inner : cosine;
  const float edge = (1 - ratio) / (1 + ratio), head = edge * edge, tail = 1 - outerCosine;
  const float tail2 = tail * tail, reflectance = head + (1 - head) * tail2 * tail2 * tail;
  return reflectance * trace(p, reflected, depth + 1) +
         (1 - reflectance) * trace(p, refracted, depth + 1);
}

__global__ void render(Vec *pixels) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  Vec sum = {0, 0, 0};
  for (int sample = 0; sample < samplesPerPixel; ++sample) {
    Random random(y * width + x, sample);
    const float atX = 2 * (x + random()) / width - 1, atY = 1 - 2 * (y + random()) / height;
    sum = sum + trace({0, 2, 7}, {0.5f * atX, 0.5f * atY - 0.15f, -1}, 0);
  }
  pixels[y * width + x] = (1.0f / samplesPerPixel) * sum;
}

int main() {
  check(cudaDeviceSetLimit(cudaLimitStackSize, 4096), "the stack");
  return measure("crystal", render);
}
