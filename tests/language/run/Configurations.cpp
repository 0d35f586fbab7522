//===- Configurations.cpp - every path that a program takes ---------------===//
#include "Configurations.h"

#include "runtime/device/ray/Abi.h"

namespace rtsl::test {

static CompileOptions options(TraceMode trace, unsigned optimization,
                              std::uint32_t colorComponents = 3, bool checkIndices = true) {
  CompileOptions options;
  options.trace = trace;
  options.optimization = optimization;
  options.colorComponents = colorComponents;
  options.checkIndices = checkIndices;
  return options;
}

static CompileOptions megakernel(unsigned optimization) {
  CompileOptions compile = options(TraceMode::Split, optimization);
  compile.target = Target::HostMegakernel;
  return compile;
}

static CompileOptions inDouble(CompileOptions compile) {
  compile.floatingPoint = FloatingPoint::Double;
  return compile;
}

static CompileOptions fast(CompileOptions compile) {
  compile.floatingPoint = FloatingPoint::Fast;
  return compile;
}

constexpr std::uint32_t asBytes = RTSL_FEATURE_UNDEFINED_BYTES, asNan = RTSL_FEATURE_UNDEFINED_NAN;

/// Uninitialized memory holds a pattern.
static CompileOptions undefined(CompileOptions compile, std::uint32_t pattern) {
  compile.undefined = pattern;
  return compile;
}

const std::vector<Configuration> &configurations() {
  using runtime::Traversal;
  static const std::vector<Configuration> table = {
      {"recurse_O2_bound", options(TraceMode::Recurse, 2), Traversal::Embree, true},
      {"recurse_O0_nan", undefined(options(TraceMode::Recurse, 0), asNan)},
      {"split_O2_mono_bytes", undefined(options(TraceMode::Split, 2, 1), asBytes),
       Traversal::Device},
      {"split_O0_spectral4_nan", undefined(options(TraceMode::Split, 0, 4), asNan)},
      {"recurse_O1_spectral16_unchecked_bytes",
       undefined(options(TraceMode::Recurse, 1, 16, false), asBytes)},
      {"split_O2_unchecked_bound", options(TraceMode::Split, 2, 3, false), Traversal::Embree, true},
      {"host_megakernel_O1_bound", megakernel(1), Traversal::Embree, true},
      {"host_megakernel_O1_bound_nan", undefined(megakernel(1), asNan), Traversal::Embree, true},
  };
  return table;
}

const std::vector<Configuration> &fastConfigurations() {
  static const std::vector<Configuration> table = {
      {"fast_recurse_O2", fast(options(TraceMode::Recurse, 2))},
      {"fast_host_megakernel_O2", fast(megakernel(2))},
  };
  return table;
}

const std::vector<Configuration> &doubleConfigurations() {
  static const std::vector<Configuration> table = {
      {"double_recurse_O2_bound", inDouble(options(TraceMode::Recurse, 2)),
       runtime::Traversal::Embree, true},
      {"double_split_O0_nan", undefined(inDouble(options(TraceMode::Split, 0)), asNan)},
  };
  return table;
}

} // namespace rtsl::test
