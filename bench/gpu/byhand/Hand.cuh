// Hand.cuh - what the programs written by hand share: vectors, random numbers, and the measurement.
//
// Each program is one kernel, `render`, for one sample count: a thread takes a pixel and adds the
// samples of it, one after the other. It prints JSON: the median time of its launches, the
// samples per second, the mean color, and what the compiler made of the kernel.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

constexpr int width = 1024, height = 1024, samplesPerPixel = 64, launches = 9;

struct Vec {
  float x, y, z;
};
__host__ __device__ inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
__host__ __device__ inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
__host__ __device__ inline Vec operator*(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
__host__ __device__ inline Vec operator*(float s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
__host__ __device__ inline float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
__host__ __device__ inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
__host__ __device__ inline Vec normalize(Vec a) { return (1.0f / sqrtf(dot(a, a))) * a; }

/// PCG (O'Neill 2014), one sequence for each sample.
struct Random {
  unsigned state;
  __device__ Random(unsigned pixel, unsigned sample) : state(pixel * 9781u + sample * 6271u + 1u) {
    next();
  }
  __device__ unsigned next() {
    state = state * 747796405u + 2891336453u;
    const unsigned word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
  }
  __device__ float operator()() { return float(next() >> 8) * 0x1p-24f; }
};

inline void check(cudaError_t error, const char *what) {
  if (error == cudaSuccess)
    return;
  std::fprintf(stderr, "%s: %s\n", what, cudaGetErrorString(error));
  std::exit(1);
}

/// Launches `kernel(pixels)`, and prints what it took.
template <typename Kernel> int measure(const char *name, Kernel kernel) {
  Vec *pixels = nullptr;
  const std::size_t count = std::size_t(width) * height;
  check(cudaMalloc(&pixels, count * sizeof(Vec)), "memory for the picture");
  cudaEvent_t start, end;
  check(cudaEventCreate(&start), "an event");
  check(cudaEventCreate(&end), "an event");
  const dim3 block(8, 16), grid(width / block.x, height / block.y);
  std::vector<float> times;
  for (int launch = 0; launch <= launches; ++launch) {
    cudaEventRecord(start);
    kernel<<<grid, block>>>(pixels);
    cudaEventRecord(end);
    check(cudaEventSynchronize(end), "the kernel");
    float milliseconds = 0;
    cudaEventElapsedTime(&milliseconds, start, end);
    if (launch > 0) // the first one loads the code
      times.push_back(milliseconds);
  }
  std::sort(times.begin(), times.end());
  std::vector<Vec> picture(count);
  check(cudaMemcpy(picture.data(), pixels, count * sizeof(Vec), cudaMemcpyDeviceToHost), "a copy");
  double mean[3] = {};
  for (const Vec &pixel : picture) {
    mean[0] += pixel.x;
    mean[1] += pixel.y;
    mean[2] += pixel.z;
  }
  cudaFuncAttributes attributes;
  check(cudaFuncGetAttributes(&attributes, kernel), "the kernel's attributes");
  const double seconds = times[times.size() / 2] / 1e3;
  const std::size_t samples = count * samplesPerPixel;
  for (double &channel : mean)
    channel /= double(count);
  std::printf("{\"program\": \"%s\", \"launches\": %d, \"samples\": %zu, ", name, launches + 1,
              samples);
  std::printf("\"kernelSeconds\": %.6f, \"samplesPerSecond\": %.6g, ", seconds,
              double(samples) / seconds);
  std::printf("\"mean\": [%.6f, %.6f, %.6f], \"registers\": %d, \"localBytes\": %zu}\n", mean[0],
              mean[1], mean[2], attributes.numRegs, attributes.localSizeBytes);
  return 0;
}
