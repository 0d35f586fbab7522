//===- Shader.h - RTSL text that runs in a test ---------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "runtime/device/ray/State.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace rtsl::test {

/// How to lower; as LowerOptions, without the headers that these need.
struct Options {
  std::uint32_t colorComponents = 3;
  bool checkIndices = true;
  std::set<std::string> classes;
};

/// RTSL text, checked and lowered; the IR has passed the verifier. Errors in the text fail the
/// test, but where they are `expected`.
class Lowered {
public:
  explicit Lowered(const std::string &source, Options options = {}, bool expectErrors = false);
  ~Lowered();

  bool succeeded() const;
  /// The text of one function, or of the whole module.
  std::string text(const std::string &function = "", bool withLocations = false) const;
  bool hasFunction(const std::string &function) const;
  /// How often `part` occurs in the text of a function.
  std::size_t count(const std::string &function, const std::string &part) const;
  const Diagnostics &messages() const;

private:
  friend class Shader;
  struct Parts;
  std::unique_ptr<Parts> parts;
};

/// RTSL text whose free functions can be called. Their parameters are arrays, so `inout float[4]`
/// is a `float *`.
class Shader {
public:
  explicit Shader(const std::string &source, Options options = {});
  ~Shader();

  /// Calls `void name(inout T[n], ...)`.
  template <typename... Pointers>
  void call(const std::string &name, Pointers *...arrays) {
    if (void *code = find(name))
      reinterpret_cast<void (*)(RtslState *, Pointers *...)>(code)(&state, arrays...);
  }

  /// Calls a method, a constructor or `Class.initialize` on an object of `launch.records`.
  /// Attributes lie one after the other in the order in which the text of the program mentions
  /// them.
  template <typename... Arguments>
  void callMethod(const std::string &name, RtslRef object, Arguments... arguments) {
    if (void *code = find(name))
      reinterpret_cast<void (*)(RtslState *, RtslRef, Arguments...)>(code)(&state, object,
                                                                           arguments...);
  }

  RtslState state{};
  RtslLaunch launch{};

private:
  void *find(const std::string &name);
  struct Code;
  std::unique_ptr<Code> code;
};

/// Runs `body` as that of `void run(inout float x[16], inout int n[16], inout uint u[16])` and
/// keeps the arrays.
struct Outcome {
  Outcome() = default;
  explicit Outcome(const std::string &body, std::initializer_list<float> floats = {},
                   std::initializer_list<std::int64_t> integers = {}, Options options = {});
  /// The same with other functions, structs and constants in front.
  static Outcome with(const std::string &declarations, const std::string &body,
                      std::initializer_list<float> floats = {},
                      std::initializer_list<std::int64_t> integers = {}, Options options = {});

  std::array<float, 16> x{};
  std::array<std::int32_t, 16> n{};
  std::array<std::uint32_t, 16> u{};
};

/// One function compiled once and called with many inputs: `void run(inout float x[16])`.
class FloatFunction {
public:
  explicit FloatFunction(const std::string &body, Options options = {});
  std::array<float, 16> operator()(std::initializer_list<float> inputs);
  std::array<float, 16> operator()(const std::vector<float> &inputs);

private:
  std::string source;
  unsigned calls = 0;
  Shader shader;
};

/// Distance of `value` from the exact `expected`, in units of the last place of `expected` as a
/// float. 0 for equal infinities and two NaN.
double ulps(float value, double expected);

/// Floats of all magnitudes, both signs, zeros, subnormals and the largest; the same on every run.
std::vector<float> interestingFloats();

} // namespace rtsl::test

/// The value is within `limit` units of the last place of what it should be.
#define EXPECT_ULPS(value, expected, limit)                                                        \
  EXPECT_LE(rtsl::test::ulps(value, expected), limit) << "got " << (value) << ", not " << (expected)
