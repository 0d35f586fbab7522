// elementary-device: proves that the elementary functions give the same bits on a CUDA device as on
// the host. Exit status 77, which CTest shows as skipped: there is no device.
#include "Arguments.h"
#include "Functions.h"

#include "runtime/gpu/CudaDevice.h"
#include "support/Error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

using namespace rtsl::elementary;
namespace runtime = rtsl::runtime;

namespace {

constexpr std::uint64_t chunkSize = std::uint64_t(1) << 24;
constexpr unsigned threadsPerBlock = 256;

struct Options {
  std::string ptxFile, function = "all";
  std::uint64_t chunks = 256;
  unsigned threads = 1;
};

/// Calls body(i) for i = 0 .. chunkSize - 1 on several threads.
template <typename Body>
void forEachOfChunk(unsigned threadCount, Body body) {
  auto part = [&](unsigned thread) {
    for (std::uint64_t i = chunkSize * thread / threadCount;
         i < chunkSize * (thread + 1) / threadCount; ++i)
      body(i);
  };
  std::vector<std::thread> threads;
  for (unsigned thread = 1; thread < threadCount; ++thread)
    threads.emplace_back(part, thread);
  part(0);
  for (std::thread &thread : threads)
    thread.join();
}

struct Comparison {
  std::atomic<std::uint64_t> mismatches{0}, firstMismatch{0};
  double deviceSeconds = 0.0;

  void compare(float host, float device, std::uint64_t number) {
    if (bitsOf(host) != bitsOf(device) && mismatches++ == 0)
      firstMismatch = number;
  }
};

class DeviceTest {
public:
  DeviceTest(const std::string &ptx, const Options &chosen) : options(chosen), results(chunkSize) {
    code = device.compile(ptx.c_str());
    deviceResults = device.allocate(chunkSize * sizeof(float), "results");
  }

  /// Chunk c of n starts with argument number c 2^32 / n.
  bool run(const Unary &function) {
    Comparison comparison;
    for (std::uint64_t chunk = 0; chunk < options.chunks; ++chunk) {
      auto first = static_cast<std::uint32_t>((std::uint64_t(1) << 32) * chunk / options.chunks);
      launch(function.name, &first, comparison);
      forEachOfChunk(options.threads, [&](std::uint64_t i) {
        auto bits = first + static_cast<std::uint32_t>(i);
        comparison.compare(function.ours(floatOf(bits)), results[i], bits);
      });
    }
    return report(function.name, comparison);
  }

  bool run(const Binary &function) {
    Comparison comparison;
    std::vector<Pair> pairs(chunkSize);
    const runtime::CudaDevice::Address arguments =
        device.allocate(chunkSize * sizeof(Pair), "arguments");
    for (std::uint64_t chunk = 0; chunk < options.chunks; ++chunk) {
      std::uint64_t first = chunk * chunkSize;
      forEachOfChunk(options.threads,
                     [&](std::uint64_t i) { pairs[i] = argumentPair(function.name, first + i); });
      device.upload(arguments, pairs.data(), chunkSize * sizeof(Pair));
      runtime::CudaDevice::Address argument = arguments;
      launch(function.name, &argument, comparison);
      forEachOfChunk(options.threads, [&](std::uint64_t i) {
        comparison.compare(function.ours(pairs[i].first, pairs[i].second), results[i], first + i);
      });
    }
    return report(function.name, comparison);
  }

private:
  void launch(const char *name, void *argument, Comparison &comparison) {
    auto start = std::chrono::steady_clock::now();
    void *arguments[] = {argument, &deviceResults};
    device.launch(device.kernel(fmt::format("evaluate_{}", name).c_str(), code),
                  static_cast<unsigned>(chunkSize / threadsPerBlock), threadsPerBlock, arguments);
    std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    comparison.deviceSeconds += elapsed.count();
    device.download(results.data(), deviceResults, chunkSize * sizeof(float));
  }

  bool report(const char *name, const Comparison &comparison) {
    double calls = static_cast<double>(options.chunks * chunkSize);
    fmt::print("{:<12} {:.0f} arguments, {} differ from the host, {:.1f} ps a call on the device\n",
               name, calls, comparison.mismatches.load(), comparison.deviceSeconds / calls * 1e12);
    if (comparison.mismatches > 0)
      fmt::print("  first: number {:#x}\n", comparison.firstMismatch.load());
    std::fflush(stdout);
    return comparison.mismatches == 0;
  }

  runtime::CudaDevice device;
  runtime::CudaDevice::Module code;
  const Options &options;
  std::vector<float> results;
  runtime::CudaDevice::Address deviceResults = 0;
};

bool runAll(const Options &options) {
  std::ifstream file(options.ptxFile);
  std::stringstream ptx;
  ptx << file.rdbuf();
  DeviceTest test(ptx.str(), options);
  bool right = true;
  auto runIfWanted = [&](const auto &function) {
    if (options.function == "all" || options.function == function.name)
      right = test.run(function) && right;
  };
  for (const Unary &function : unaryFunctions())
    runIfWanted(function);
  for (const Binary &function : binaryFunctions())
    runIfWanted(function);
  return right;
}

} // namespace

int main(int argc, char **argv) {
  Options options;
  CLI::App app("Compares the elementary functions on a CUDA device with the host, bit by bit.");
  app.add_option("ptx", options.ptxFile, "DeviceKernels.ptx")->required()->check(CLI::ExistingFile);
  app.add_option("function", options.function, "a function's name, or `all`");
  app.add_option("--chunks", options.chunks, "how many times 2^24 arguments; 256 are all floats")
      ->check(CLI::Range(1, 256));
  app.add_option("--threads", options.threads, "how many host threads")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    return runAll(options) ? 0 : 1;
  } catch (const rtsl::Error &error) {
    const bool isMissing = error.code == rtsl::ErrorCode::NoDevice;
    fmt::print(stderr, "{}: {}\n", isMissing ? "skipped" : "error", error.what());
    return isMissing ? 77 : 2;
  } catch (const std::exception &error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
