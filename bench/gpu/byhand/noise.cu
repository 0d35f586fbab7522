// noise.cu - bench/gpu/noise by hand: six octaves of gradient noise (Perlin 2002) at each sample.
#include "Hand.cuh"

__device__ unsigned hashCell(int x, int y, int z) {
  unsigned h = unsigned(x) * 0x8da6b343u ^ unsigned(y) * 0xd8163841u ^ unsigned(z) * 0xcb1ab31fu;
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return h ^ h >> 16;
}

__device__ float gradientAt(int i, int j, int k, float x, float y, float z) {
  const unsigned h = hashCell(i, j, k) & 15u;
  const float u = h < 8u ? x : y, v = h < 4u ? y : h == 12u || h == 14u ? x : z;
  return (h & 1u ? -u : u) + (h & 2u ? -v : v);
}

__device__ float fade(float f) {
  return f * f * f * (f * (6 * f - 15) + 10);
}

__device__ float mix(float a, float b, float w) {
  return a + w * (b - a);
}

__device__ float gradientNoise(Vec p) {
  const float cx = floorf(p.x), cy = floorf(p.y), cz = floorf(p.z);
  const float x = p.x - cx, y = p.y - cy, z = p.z - cz;
  const float wx = fade(x), wy = fade(y), wz = fade(z);
  const int i = int(cx), j = int(cy), k = int(cz);
  float plane[2];
#pragma unroll
  for (int dz = 0; dz < 2; ++dz)
    plane[dz] = mix(mix(gradientAt(i, j, k + dz, x, y, z - dz),
                        gradientAt(i + 1, j, k + dz, x - 1, y, z - dz), wx),
                    mix(gradientAt(i, j + 1, k + dz, x, y - 1, z - dz),
                        gradientAt(i + 1, j + 1, k + dz, x - 1, y - 1, z - dz), wx),
                    wy);
  return mix(plane[0], plane[1], wz);
}

__global__ void render(Vec *pixels) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  float sum = 0;
  for (int sample = 0; sample < samplesPerPixel; ++sample) {
    Random random(y * width + x, sample);
    Vec p = {16 * (x + random()) / width, 16 * (y + random()) / height, 0.37f};
    float octaves = 0, strength = 1;
    for (int octave = 0; octave < 6; ++octave) {
      octaves += strength * gradientNoise(p);
      strength *= 0.5f;
      p = {2 * p.x + 17.3f, 2 * p.y + 5.7f, 2 * p.z + 11.1f};
    }
    sum += 0.5f + 0.5f * octaves;
  }
  sum *= 1.0f / samplesPerPixel;
  pixels[y * width + x] = {sum, sum, sum};
}

int main() {
  return measure("noise", render);
}
