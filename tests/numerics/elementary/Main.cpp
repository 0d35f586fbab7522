// elementary-exhaustive: proves that the elementary functions are correctly rounded.
#include "Benchmark.h"
#include "Bounds.h"
#include "Sweep.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cmath>

using namespace rtsl::elementary;
using nlohmann::json;

namespace {

struct Options {
  std::string function;
  std::uint64_t step = 1;
  unsigned threads = 1;
  bool asJson = false, testSystem = false, bench = false;
  std::uint64_t bounds = 0;
  std::size_t hardest = 0;
};

std::string inHex(const Mismatch &mismatch, const std::string &function) {
  std::string arguments;
  for (float x : mismatch.arguments)
    arguments +=
        fmt::format("{}{:#010x}", arguments.empty() ? "" : ", ", __builtin_bit_cast(unsigned, x));
  return fmt::format("{}({}) = {:#010x}, right is {:#010x}, error {:.6f} ulp", function, arguments,
                     __builtin_bit_cast(unsigned, mismatch.result),
                     __builtin_bit_cast(unsigned, mismatch.right), mismatch.error);
}

json asJson(const Report &report) {
  json result = {{"function", report.function},
                 {"tested", report.tested},
                 {"mismatches", report.mismatches},
                 {"worstErrorUlp", report.worstError},
                 {"worstRelativeError", report.worstRelativeError},
                 {"askedMpfr", report.askedMpfr},
                 {"seconds", report.seconds}};
  if (report.mismatches > 0)
    result["worst"] = inHex(report.worst, report.function);
  return result;
}

void print(const Report &report) {
  fmt::print("{:<12} {:>10} tested, {} wrong, worst error {:.8f} ulp, 2^{:.2f}, MPFR called {} "
             "times, {:.1f} s\n",
             report.function, report.tested, report.mismatches, report.worstError,
             std::log2(report.worstRelativeError), report.askedMpfr, report.seconds);
  if (report.mismatches == 0)
    return;
  fmt::print("  worst: {}\n", inHex(report.worst, report.function));
  for (const Mismatch &mismatch : report.first)
    fmt::print("  {}\n", inHex(mismatch, report.function));
}

/// As an entry of HardArguments.h.
void printHardest(const Report &report) {
  fmt::print("    {{\"{}\",\n     {{", report.function);
  const char *separator = "";
  for (const HardArgument &hard : report.hardest) {
    fmt::print("{}{:#010x}", separator, __builtin_bit_cast(unsigned, hard.argument));
    separator = ", ";
  }
  fmt::print("}}}},\n");
  fmt::print(stderr, "{}: {} wrong, closest 2^{:.2f}\n", report.function, report.mismatches,
             report.hardest.empty() ? 0.0 : std::log2(report.hardest.front().distance));
}

SweepOptions sweepOptions(const Options &options, const char *name) {
  SweepOptions result;
  result.step = options.step;
  result.threads = options.threads;
  result.testSystem = options.testSystem;
  result.hardest = options.hardest;
  if (isatty(STDERR_FILENO) != 0)
    result.progress = [name](double fraction) {
      fmt::print(stderr, "\r{} {:3.0f} % ", name, 100.0 * fraction);
    };
  return result;
}

/// Returns whether all is right.
template <typename Function>
bool runSweep(const Function &function, const Options &options) {
  Report report = sweep(function, sweepOptions(options, function.name));
  if (isatty(STDERR_FILENO) != 0)
    fmt::print(stderr, "\r{:40}\r", "");
  if (options.hardest > 0)
    printHardest(report);
  else if (options.asJson)
    fmt::print("{}\n", asJson(report).dump());
  else
    print(report);
  std::fflush(stdout);
  return report.mismatches == 0;
}

template <typename Function>
void runBenchmark(const Function &function, const Options &options) {
  Timing timing = time(function);
  if (options.asJson)
    fmt::print("{}\n", json{{"function", function.name},
                            {"nsStrict", timing.ours},
                            {"nsSystem", timing.system},
                            {"nsSystemDouble", timing.systemDouble}}
                           .dump());
  else
    fmt::print("{:<12} strict {:5.1f} ns, system {:5.1f} ns, system in double {:5.1f} ns\n",
               function.name, timing.ours, timing.system, timing.systemDouble);
}

bool runBounds(const char *function, const Options &options) {
  MeasuredBounds bounds = measureBounds(function, options.bounds);
  if (options.asJson)
    fmt::print("{}\n", json{{"function", function},
                            {"measured", bounds.measured},
                            {"fastLog2", bounds.fast},
                            {"accurateLog2", bounds.accurate}}
                           .dump());
  else
    fmt::print("{:<6} {} pairs: fast path 2^{:.2f} (bound 2^{:.0f}), accurate path 2^{:.2f} (bound "
               "2^{:.0f})\n",
               function, bounds.measured, bounds.fast, bounds.fastBound, bounds.accurate,
               bounds.accurateBound);
  return bounds.hold();
}

/// Returns whether the function was found, and in `right` whether all is right.
bool runAll(const Options &options, bool &right) {
  bool found = false;
  auto wanted = [&](const char *name) {
    bool isFast = std::string_view(name).substr(0, 5) == "fast.";
    bool match = options.function == (isFast ? "fast" : "all") || options.function == name;
    found = found || match;
    return match;
  };
  auto run = [&](const auto &function) {
    if (options.bench)
      runBenchmark(function, options);
    else if (!runSweep(function, options))
      right = false;
  };
  for (const auto *functions : {&unaryFunctions(), &fastUnaryFunctions()})
    for (const Unary &function : *functions)
      if (wanted(function.name) && options.bounds == 0)
        run(function);
  for (const auto *functions : {&binaryFunctions(), &laneFunctions(), &fastBinaryFunctions()})
    for (const Binary &function : *functions)
      if (wanted(function.name) && options.bounds == 0)
        run(function);
  for (const Binary &function : binaryFunctions())
    if (options.bounds != 0 && wanted(function.name) && !runBounds(function.name, options))
      right = false;
  return found;
}

} // namespace

int main(int argc, char **argv) {
  Options options;
  CLI::App app(
      "Compares the elementary functions with MPFR over all 2^32 arguments, or (pow, atan2) "
      "over 2^32 random and directed pairs. Exit status 1: some result is wrong.");
  app.add_option("function", options.function,
                 "a function's name, or `all`, or `fast` for all approximations")
      ->required();
  app.add_option("--sample", options.step, "test only every Nth argument, and the special ones")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "how many threads")->check(CLI::PositiveNumber);
  app.add_flag("--json", options.asJson, "one line of JSON a function");
  app.add_flag("--system", options.testSystem, "test the C library's functions instead of ours");
  app.add_flag("--bench", options.bench, "measure the time of a call");
  app.add_option("--bounds", options.bounds,
                 "measure the error of pow's and atan2's two paths over N pairs");
  app.add_option("--hardest", options.hardest,
                 "print the N arguments that are hardest to round, for HardArguments.h");
  CLI11_PARSE(app, argc, argv);

  bool right = true;
  if (!runAll(options, right)) {
    fmt::print(stderr, "error: no function `{}`\n", options.function);
    return 2;
  }
  return right ? 0 : 1;
}
