//===- Types.h - types that GLM does not have -----------------------------===//
//
// Everything that a scene can set is aligned to 4 bytes and packed, as in
// runtime/device/ray/Launch.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/ColorBasis.h"
#include "rtsl/shader/FloatingPoint.h"
#include "runtime/device/ray/Launch.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace rtsl {
inline namespace RTSL_VARIANT {

using uint = std::uint32_t;

/// A bool in memory: 32 bits. `{}` is false; the default constructor leaves it uninitialised, as
/// GLM's vectors require of their elements.
struct Bool {
  std::uint32_t value;

  Bool() = default;
  constexpr explicit Bool(bool value) : value(value ? 1u : 0u) {}
  constexpr Bool &operator=(bool other) {
    value = other ? 1u : 0u;
    return *this;
  }
  constexpr operator bool() const { return value != 0; }
};

/// An index, clamped into [0, count - 1]; 0 if count is 0.
constexpr uint clampIndex(int index, uint count) {
  return index < 0 || count == 0 ? 0u : std::min(static_cast<uint>(index), count - 1);
}
constexpr uint clampIndex(uint index, uint count) {
  return count == 0 ? 0u : std::min(index, count - 1);
}

// With RTSL_UNCHECKED indices into arrays, vectors, matrices and buffers are not clamped.
#ifdef RTSL_UNCHECKED
template <typename Index>
constexpr Index elementIndex(Index index, uint) {
  return index;
}
#else
template <typename Index>
constexpr uint elementIndex(Index index, uint count) {
  return clampIndex(index, count);
}
#endif

/// `T[N]`, as a value.
template <typename T, uint N>
struct array {
  T elements[N];

  template <typename Index>
  constexpr T &operator[](Index index) {
    return elements[elementIndex(index, N)];
  }
  template <typename Index>
  constexpr const T &operator[](Index index) const {
    return elements[elementIndex(index, N)];
  }
  friend constexpr bool operator==(const array &a, const array &b) {
    for (uint i = 0; i < N; ++i)
      if (!(a.elements[i] == b.elements[i]))
        return false;
    return true;
  }
  friend constexpr bool operator!=(const array &a, const array &b) { return !(a == b); }
};

/// A color of N components: opaque, with the operations of RTSL.
template <int N>
struct Color {
  float components[N] = {};

  constexpr Color() = default;
  /// The same value in every component.
  constexpr explicit Color(float value) {
    for (float &component : components)
      component = value;
  }
  /// Red, green and blue, if the color has these.
  constexpr Color(float red, float green, float blue) : components{red, green, blue} {
    static_assert(N == 3, "use rgb<N>");
  }
};

//===----------------------------------------------------------------------===//
// One operation in every component
//===----------------------------------------------------------------------===//

/// Components of a vector or color; 0 for a scalar.
template <typename T>
inline constexpr int width = 0;
template <int L, typename T, glm::qualifier Q>
inline constexpr int width<glm::vec<L, T, Q>> = L;
template <int N>
inline constexpr int width<Color<N>> = N;

template <typename T>
inline constexpr bool isColor = false;
template <int N>
inline constexpr bool isColor<Color<N>> = true;

/// float for vec3; a scalar type for itself.
template <typename T>
struct ScalarOf {
  using type = T;
};
template <int L, typename T, glm::qualifier Q>
struct ScalarOf<glm::vec<L, T, Q>> {
  using type = T;
};
template <int N>
struct ScalarOf<Color<N>> {
  using type = float;
};
template <typename T>
using Scalar = typename ScalarOf<T>::type;

/// The type of a scalar that is not in memory.
template <typename T>
using Value = std::conditional_t<std::is_same_v<T, Bool>, bool, T>;

/// Component I; a scalar is its own component for every I.
template <int I, typename T>
constexpr auto part(const T &value) {
  if constexpr (isColor<T>)
    return value.components[I];
  else if constexpr (width<T> == 0)
    return value;
  else if constexpr (I == 0)
    return value.x;
  else if constexpr (I == 1)
    return value.y;
  else if constexpr (I == 2)
    return value.z;
  else
    return value.w;
}

template <bool Colors, typename Function, int... I, typename... T>
constexpr auto eachOf(Function function, std::integer_sequence<int, I...>, const T &...operands) {
  auto at = [&](auto index) { return function(part<decltype(index)::value>(operands)...); };
  using Result = Value<decltype(at(std::integral_constant<int, 0>()))>;
  if constexpr (Colors) {
    Color<int(sizeof...(I))> result;
    ((result.components[I] = at(std::integral_constant<int, I>())), ...);
    return result;
  } else {
    return glm::vec<int(sizeof...(I)), Result>(at(std::integral_constant<int, I>())...);
  }
}

/// `function` of the operands, by component; scalars are broadcast.
template <typename Function, typename... T>
constexpr auto each(Function function, const T &...operands) {
  constexpr int count = std::max({width<T>...});
  if constexpr (count == 0)
    return function(operands...);
  else
    return eachOf<(isColor<T> || ...)>(function, std::make_integer_sequence<int, count>(),
                                       operands...);
}

//===----------------------------------------------------------------------===//
// Colors
//===----------------------------------------------------------------------===//

#define RTSL_COLOR_OPERATOR(op)                                                                    \
  template <int N>                                                                                 \
  constexpr Color<N> operator op(const Color<N> &a, const Color<N> &b) {                           \
    return each([](float x, float y) { return x op y; }, a, b);                                    \
  }
RTSL_COLOR_OPERATOR(+)
RTSL_COLOR_OPERATOR(-)
RTSL_COLOR_OPERATOR(*)
RTSL_COLOR_OPERATOR(/)
#undef RTSL_COLOR_OPERATOR

template <int N>
constexpr Color<N> operator*(const Color<N> &a, float b) {
  return each([](float x, float y) { return x * y; }, a, b);
}
template <int N>
constexpr Color<N> operator*(float a, const Color<N> &b) {
  return each([](float x, float y) { return x * y; }, a, b);
}
template <int N>
constexpr Color<N> operator/(const Color<N> &a, float b) {
  return each([](float x, float y) { return x / y; }, a, b);
}
template <int N>
constexpr Color<N> operator/(float a, const Color<N> &b) {
  return each([](float x, float y) { return x / y; }, a, b);
}
template <int N>
constexpr Color<N> operator-(const Color<N> &a) {
  return each([](float x) { return -x; }, a);
}
template <int N>
constexpr Color<N> &operator+=(Color<N> &a, const Color<N> &b) {
  return a = a + b;
}
template <int N>
constexpr Color<N> &operator-=(Color<N> &a, const Color<N> &b) {
  return a = a - b;
}
template <int N>
constexpr Color<N> &operator*=(Color<N> &a, const Color<N> &b) {
  return a = a * b;
}
template <int N>
constexpr Color<N> &operator/=(Color<N> &a, const Color<N> &b) {
  return a = a / b;
}
template <int N>
constexpr Color<N> &operator*=(Color<N> &a, float b) {
  return a = a * b;
}
template <int N>
constexpr Color<N> &operator/=(Color<N> &a, float b) {
  return a = a / b;
}

/// Red, green and blue in a color of N components (language/ColorBasis.h).
template <int N>
inline Color<N> rgb(float red, float green, float blue) {
  if constexpr (N == 3) {
    return Color<N>(red, green, blue);
  } else {
    static const ColorBasis basis = makeColorBasis(N);
    Color<N> color;
    for (std::size_t i = 0; i < N; ++i) {
      const auto at = [&](std::size_t band) { return static_cast<float>(basis.toColor[i][band]); };
      color.components[i] = (red * at(0) + green * at(1)) + blue * at(2);
    }
    return color;
  }
}

template <int N>
inline float luminance(const Color<N> &color) {
  if constexpr (N == 1) {
    return color.components[0];
  } else {
    static const array<float, N> weights = [] {
      const ColorBasis basis = makeColorBasis(N);
      array<float, N> sums{};
      for (std::size_t i = 0; i < N; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < 3; ++j)
          sum += luminanceWeights[j] * basis.toRgb[j][i];
        sums.elements[i] = static_cast<float>(sum);
      }
      return sums;
    }();
    float sum = color.components[0] * weights.elements[0];
    for (int i = 1; i < N; ++i)
      sum = sum + color.components[i] * weights.elements[i];
    return sum;
  }
}

//===----------------------------------------------------------------------===//
// Parts of vectors
//===----------------------------------------------------------------------===//

/// `v.zx` is swizzle<2, 0>(v).
template <int... I, typename T>
constexpr auto swizzle(const T &value) {
  return glm::vec<int(sizeof...(I)), Value<Scalar<T>>>(part<I>(value)...);
}

/// `vector` with component I replaced.
template <int I, int L, typename T, glm::qualifier Q>
constexpr glm::vec<L, T, Q> with(glm::vec<L, T, Q> vector, Value<T> value) {
  vector[I] = value;
  return vector;
}
/// The same for component `index`, clamped to the valid range.
template <int L, typename T, glm::qualifier Q, typename Index>
constexpr glm::vec<L, T, Q> with(glm::vec<L, T, Q> vector, Index index, Value<T> value) {
  vector[static_cast<int>(elementIndex(index, uint(L)))] = value;
  return vector;
}

/// Component or column `index`, clamped to the valid range.
template <int L, typename T, glm::qualifier Q, typename Index>
constexpr T &at(glm::vec<L, T, Q> &vector, Index index) {
  return vector[static_cast<int>(elementIndex(index, uint(L)))];
}
template <int L, typename T, glm::qualifier Q, typename Index>
constexpr T at(const glm::vec<L, T, Q> &vector, Index index) {
  return vector[static_cast<int>(elementIndex(index, uint(L)))];
}
template <int C, int R, typename T, glm::qualifier Q, typename Index>
constexpr glm::vec<R, T, Q> &at(glm::mat<C, R, T, Q> &matrix, Index index) {
  return matrix[static_cast<int>(elementIndex(index, uint(C)))];
}
template <int C, int R, typename T, glm::qualifier Q, typename Index>
constexpr glm::vec<R, T, Q> at(const glm::mat<C, R, T, Q> &matrix, Index index) {
  return matrix[static_cast<int>(elementIndex(index, uint(C)))];
}

//===----------------------------------------------------------------------===//
// References and buffers
//===----------------------------------------------------------------------===//

/// An object of the scene; 0 is none. Generated code derives a type for each class whose methods
/// are called through references.
struct Reference {
  RtslRef object = 0;

  constexpr Reference() = default;
  constexpr explicit Reference(RtslRef object) : object(object) {}
  friend constexpr bool operator==(Reference a, Reference b) { return a.object == b.object; }
  friend constexpr bool operator!=(Reference a, Reference b) { return a.object != b.object; }
};

/// `T name[]`, `[][]` or `[][][]`: set by the scene. An index is clamped; an element of an empty
/// buffer is zero.
template <typename T, int Rank = 1>
class Buffer {
public:
  /// Length in the given dimension.
  int length(int dimension = 0) const { return static_cast<int>(buffer.size[dimension]); }

  template <typename... Index>
  T at(Index... indices) const {
    const T *element = find(indices...);
    return element ? *element : T();
  }
  template <typename Index>
  T operator[](Index index) const {
    return at(index);
  }

protected:
  /// Null if the buffer is empty.
  template <typename... Index>
  const T *find(Index... indices) const {
    static_assert(sizeof...(Index) == Rank);
    std::size_t element = 0;
    int dimension = 0;
    bool exists = true;
    auto enter = [&](auto index) {
      const uint count = buffer.size[dimension++];
      exists = exists && count != 0;
      element = element * count + static_cast<std::size_t>(elementIndex(index, count));
    };
    (enter(indices), ...);
    const auto address = static_cast<std::uintptr_t>(buffer.addressHigh) << 32 | buffer.addressLow;
    return exists ? reinterpret_cast<const T *>(address) + element : nullptr;
  }

private:
  RtslBuffer buffer = {};
};

} // namespace RTSL_VARIANT
} // namespace rtsl
