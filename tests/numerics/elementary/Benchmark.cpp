#include "Benchmark.h"

#include <chrono>
#include <random>
#include <vector>

namespace rtsl::elementary {

namespace {

constexpr int argumentCount = 4096, repetitions = 256, attempts = 5;

std::vector<float> argumentsIn(float low, float high, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> distribution(low, high);
  std::vector<float> arguments(argumentCount);
  for (float &x : arguments)
    x = distribution(generator);
  return arguments;
}

/// The best of several attempts, because other programs only ever make a loop slower.
template <typename Call>
double nanosecondsPerCall(Call call) {
  double best = 1e30;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    auto start = std::chrono::steady_clock::now();
    double sum = 0.0;
    for (int repetition = 0; repetition < repetitions; ++repetition)
      for (int i = 0; i < argumentCount; ++i)
        sum += call(static_cast<std::size_t>(i));
    volatile double sink = sum;
    static_cast<void>(sink);
    std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
    best = std::min(best, elapsed.count() / (double(repetitions) * argumentCount));
  }
  return best;
}

} // namespace

Timing time(const Unary &function) {
  std::vector<float> x = argumentsIn(function.low, function.high, 1);
  return {nanosecondsPerCall([&](std::size_t i) { return function.ours(x[i]); }),
          nanosecondsPerCall([&](std::size_t i) { return function.system(x[i]); }),
          nanosecondsPerCall([&](std::size_t i) { return function.systemDouble(x[i]); })};
}

Timing time(const Binary &function) {
  std::vector<float> x = argumentsIn(function.low, function.high, 1);
  std::vector<float> y = argumentsIn(-function.high, function.high, 2);
  return {nanosecondsPerCall([&](std::size_t i) { return function.ours(x[i], y[i]); }),
          nanosecondsPerCall([&](std::size_t i) { return function.system(x[i], y[i]); }),
          nanosecondsPerCall([&](std::size_t i) { return function.systemDouble(x[i], y[i]); })};
}

} // namespace rtsl::elementary
