#include "Sweep.h"

#include "Arguments.h"
#include "Oracle.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

namespace rtsl::elementary {

namespace {

/// |result - exact| in units of the last place of result; 0 for infinities and NaNs.
double errorInUlp(float result, double exact) {
  if (!std::isfinite(result) || !std::isfinite(exact))
    return 0.0;
  int exponent = 0;
  std::frexp(result, &exponent);
  return std::ldexp(std::fabs(result - exact), 24 - std::max(exponent, -125));
}

bool isRight(float result, float right) {
  return bitsOf(result) == bitsOf(right);
}

/// The C library may return any NaN.
bool isRightForSystem(float result, float right) {
  return isRight(result, right) || (std::isnan(result) && std::isnan(right));
}

double relativeError(float result, double exact) {
  if (!std::isfinite(result) || !std::isfinite(exact))
    return 0.0;
  return std::fabs(result - exact) / std::max(std::fabs(exact), 0x1p-126);
}

/// For approximations. Near the largest float an infinity may be off by less than the bound.
bool isWithin(double bound, float result, double exact) {
  if (std::isinf(bound) || std::isnan(exact))
    return std::isinf(bound) || std::isnan(result);
  if (std::isinf(result))
    return std::fabs(exact) * (1.0 + bound) >= 0x1.ffffffp127 && (result > 0.0f) == (exact > 0.0);
  return std::fabs(result - exact) <= bound * std::max(std::fabs(exact), 0x1p-126);
}

double boundOf(const Unary &function, float) {
  return function.bound;
}

double boundOf(const Binary &function, float x, float y) {
  return function.bound == nullptr ? 0.0 : function.bound(x, y);
}

constexpr std::size_t shownMismatches = 32;

void note(Report &report, std::vector<float> arguments, float result, Oracle::Answer answer,
          double error) {
  Mismatch mismatch{std::move(arguments), result, answer.rounded, error};
  if (report.mismatches++ == 0 || error > report.worst.error)
    report.worst = mismatch;
  if (report.first.size() < shownMismatches)
    report.first.push_back(std::move(mismatch));
}

void merge(Report &total, const Report &part, std::size_t hardest) {
  total.tested += part.tested;
  total.askedMpfr += part.askedMpfr;
  total.worstError = std::max(total.worstError, part.worstError);
  total.worstRelativeError = std::max(total.worstRelativeError, part.worstRelativeError);
  if (part.mismatches > 0 && (total.mismatches == 0 || part.worst.error > total.worst.error))
    total.worst = part.worst;
  total.mismatches += part.mismatches;
  for (const Mismatch &mismatch : part.first)
    if (total.first.size() < shownMismatches)
      total.first.push_back(mismatch);
  total.hardest.insert(total.hardest.end(), part.hardest.begin(), part.hardest.end());
  std::sort(total.hardest.begin(), total.hardest.end(),
            [](const HardArgument &a, const HardArgument &b) { return a.distance < b.distance; });
  total.hardest.resize(std::min(total.hardest.size(), hardest));
}

/// Tests one call; `arguments` are one float or two.
template <typename Function, typename... Floats>
void check(const Function &function, bool testSystem, Oracle &oracle, Report &report,
           Floats... arguments) {
  float result = testSystem ? function.system(arguments...) : function.ours(arguments...);
  Oracle::Answer answer = oracle(function, arguments...);
  ++report.tested;
  double error = errorInUlp(result, answer.unrounded);
  report.worstError = std::max(report.worstError, error);
  double bound = boundOf(function, arguments...);
  if (!std::isinf(bound))
    report.worstRelativeError =
        std::max(report.worstRelativeError, relativeError(result, answer.unrounded));
  bool right = testSystem    ? isRightForSystem(result, answer.rounded)
               : bound > 0.0 ? isWithin(bound, result, answer.unrounded)
                             : isRight(result, answer.rounded);
  if (!right)
    note(report, {arguments...}, result, answer, error);
}

/// Calls `checkOne(number, oracle, report)` for the numbers 0, step, 2 step, ... below 2^32, in
/// pieces that the threads take in turn, and then `checkSpecials(oracle, report)` once.
template <typename CheckOne, typename CheckSpecials>
Report runSweep(const char *name, const SweepOptions &options, CheckOne checkOne,
                CheckSpecials checkSpecials) {
  constexpr std::uint64_t pieces = 1024, end = std::uint64_t(1) << 32;
  auto start = std::chrono::steady_clock::now();
  Report total;
  total.function = name;
  std::atomic<std::uint64_t> next{0};
  std::mutex mutex;
  std::uint64_t count = (end + options.step - 1) / options.step;

  auto work = [&] {
    Oracle oracle;
    Report report;
    for (std::uint64_t piece; (piece = next++) < pieces;) {
      for (std::uint64_t i = count * piece / pieces; i < count * (piece + 1) / pieces; ++i)
        checkOne(i * options.step, oracle, report);
      if (piece == 0)
        checkSpecials(oracle, report);
      std::lock_guard<std::mutex> lock(mutex);
      options.progress(static_cast<double>(piece) / pieces);
    }
    report.askedMpfr = oracle.timesAsked();
    std::lock_guard<std::mutex> lock(mutex);
    merge(total, report, options.hardest);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < options.threads; ++i)
    threads.emplace_back(work);
  work();
  for (std::thread &thread : threads)
    thread.join();

  total.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return total;
}

} // namespace

Report sweep(const Unary &function, const SweepOptions &options) {
  return runSweep(
      function.name, options,
      [&](std::uint64_t number, Oracle &oracle, Report &report) {
        float x = floatOf(static_cast<std::uint32_t>(number));
        std::uint64_t askedBefore = oracle.timesAsked();
        check(function, options.testSystem, oracle, report, x);
        if (options.hardest > 0 && oracle.timesAsked() != askedBefore &&
            std::isnormal(function.ours(x)))
          report.hardest.push_back({oracle.distanceToMidpoint(function, x), x});
      },
      [&](Oracle &oracle, Report &report) {
        for (float x : hardArguments(function.name))
          check(function, options.testSystem, oracle, report, x);
        for (float x : specialArguments())
          check(function, options.testSystem, oracle, report, x);
      });
}

Report sweep(const Binary &function, const SweepOptions &options) {
  return runSweep(
      function.name, options,
      [&](std::uint64_t number, Oracle &oracle, Report &report) {
        Pair pair = argumentPair(function.name, number);
        check(function, options.testSystem, oracle, report, pair.first, pair.second);
      },
      [&](Oracle &oracle, Report &report) {
        const float values[] = {0.0f,         1.0f,          2.0f,
                                3.0f,         0.5f,          1.5f,
                                0x1p-149f,    0x1p-126f,     0x1.fffffep127f,
                                0x1p24f,      0x1.000002p0f, HUGE_VALF,
                                std::nanf("")};
        for (float x : values)
          for (float y : values)
            for (float signX : {1.0f, -1.0f})
              for (float signY : {1.0f, -1.0f})
                check(function, options.testSystem, oracle, report, signX * x, signY * y);
      });
}

} // namespace rtsl::elementary
