//===- State.h - the state of a ray, as shaders see it --------------------===//
#pragma once

#include "rtsl/shader/Types.h"
#include "runtime/device/ray/Abi.h"

#include <cstddef>
#include <cstring>

namespace rtsl {
inline namespace RTSL_VARIANT {

/// A color of the state: space for the most components, of which N are used.
template <int N>
struct StateColor : Color<N> {
  using Color<N>::Color;
  StateColor &operator=(const Color<N> &other) {
    Color<N>::operator=(other);
    return *this;
  }
  float unused[RTSL_MAX_COLOR - N];
};
template <>
struct StateColor<RTSL_MAX_COLOR> : Color<RTSL_MAX_COLOR> {
  using Color<RTSL_MAX_COLOR>::Color;
  StateColor &operator=(const Color<RTSL_MAX_COLOR> &other) {
    Color<RTSL_MAX_COLOR>::operator=(other);
    return *this;
  }
};

template <int N>
inline constexpr int width<StateColor<N>> = N;
template <int N>
inline constexpr bool isColor<StateColor<N>> = true;

/// RtslState (runtime/device/ray/State.h), with vectors in place of arrays; `rt_RayOrigin` is
/// `rt.RayOrigin`. The two share memory, which is declared to compilers.
template <int N>
struct [[gnu::may_alias]] State {
  const RtslLaunch *launch;
  unsigned char ofTheRuntime[offsetof(RtslState, RayOrigin) - sizeof(const RtslLaunch *)];

#define RTSL_SHADER_float float
#define RTSL_SHADER_int int
#define RTSL_SHADER_uint3 glm::uvec3
#define RTSL_SHADER_vec2 glm::vec2
#define RTSL_SHADER_vec3 glm::vec3
#define RTSL_SHADER_mat4 glm::mat4
#define RTSL_SHADER_color StateColor<N>
#define RTSL_STATE_VARIABLE(name, type, ...) RTSL_SHADER_##type name;
#include "language/StateVariables.def"

  std::uint32_t attributes[RTSL_MAX_ATTRIBUTE_WORDS];
  unsigned char ofTheTraversal[sizeof(RtslState) - offsetof(RtslState, foundDistance)];
};

/// The runtime's state as shaders see it.
template <int N>
inline State<N> &stateOf(RtslState *state) {
  static_assert(sizeof(State<N>) == sizeof(RtslState));
  return *reinterpret_cast<State<N> *>(state);
}
template <int N>
inline RtslState *rawState(State<N> &rt) {
  return reinterpret_cast<RtslState *>(&rt);
}

/// Before a texture lookup: results that the texture does not set are zero.
template <int N>
inline void clearTexture(State<N> &rt) {
  rt.TextureColor = Color<N>(0.0f);
  rt.FloatTextureValue = 0.0f;
}

/// The same for a nested lookup, which preserves the results of the outer one.
template <int N>
class NestedLookup {
public:
  explicit NestedLookup(State<N> &rt)
      : rt(rt), color(rt.TextureColor), value(rt.FloatTextureValue) {
    clearTexture(rt);
  }
  NestedLookup(const NestedLookup &) = delete;
  ~NestedLookup() {
    rt.TextureColor = color;
    rt.FloatTextureValue = value;
  }

private:
  State<N> &rt;
  const Color<N> color;
  const float value;
};

/// An index, clamped; an index out of range ends the sample (`rtslc compile --exceptions`).
template <int N, typename Index, typename Count>
inline Index checked(State<N> &rt, Index index, Count count) {
  if (static_cast<uint>(index) >= static_cast<uint>(count))
    rtsl_raise(rawState(rt), RTSL_EXCEPTION_INDEX);
  return static_cast<Index>(clampIndex(index, static_cast<uint>(count)));
}

//===----------------------------------------------------------------------===//
// Objects of the scene
//===----------------------------------------------------------------------===//

/// Bytes from the start of a record, which begins with the class's number, to the object.
template <typename Class>
inline constexpr std::size_t objectOffset = alignof(Class) < 4 ? 4 : alignof(Class);

template <typename Class, int N>
inline const Class &object(const State<N> &rt, RtslRef reference) {
  return *reinterpret_cast<const Class *>(rt.launch->records + reference + objectOffset<Class>);
}

/// The number of an object's class; 0 for no object.
template <int N>
inline std::uint32_t classOf(const State<N> &rt, RtslRef reference) {
  std::uint32_t id;
  std::memcpy(&id, rt.launch->records + reference, 4);
  return id;
}

//===----------------------------------------------------------------------===//
// Attributes: what `intersect` computes for a hit, and later methods read
//===----------------------------------------------------------------------===//

/// Base of a class's `Scratch`.
struct Scratch {
  bool accepted = false; // has this `intersect` reported a hit?

  /// Calls `at(word, value)` for each attribute that is kept.
  template <typename Visit>
  void visit(Visit) {}
};

// Base classes of shader classes.
struct Camera {};
struct Primitive {};
struct Texture {};
struct Material {};
struct Light {};
struct RayGeneration {};
struct Miss {};
struct Selector {};
struct Exception {};
struct Helper {}; // derived from no rt_ class

template <typename T, int N>
inline void loadAttribute(const State<N> &rt, int word, T &value) {
  static_assert(sizeof(T) % 4 == 0);
  // As void: a struct of the author's may have constructors, of which g++ warns.
  std::memcpy(static_cast<void *>(&value), rt.attributes + word, sizeof(T));
}
template <typename T, int N>
inline void storeAttribute(State<N> &rt, int word, const T &value) {
  static_assert(sizeof(T) % 4 == 0);
  std::memcpy(rt.attributes + word, &value, sizeof(T));
}

/// The attributes of the winning hit.
template <typename Attributes, int N>
inline Attributes loadScratch(const State<N> &rt) {
  Attributes scratch;
  scratch.visit([&](int word, auto &value) { loadAttribute(rt, word, value); });
  return scratch;
}

/// Runs the method that writes the changes of scratch members, which are attributes too.
template <typename Primitive, int N>
inline void computeChanges(State<N> &rt, const Primitive &primitive) {
  auto scratch = loadScratch<typename Primitive::Scratch>(rt);
  primitive.rt_computeChanges(rt, scratch);
  scratch.visit([&](int word, const auto &value) { storeAttribute(rt, word, value); });
}

/// Runs `intersect`; what it wrote to its scratch members is kept if it accepted a hit.
template <typename Primitive, int N>
inline void intersect(State<N> &rt, const Primitive &primitive) {
  typename Primitive::Scratch scratch;
  primitive.intersect(rt, scratch);
  if (static_cast<const Scratch &>(scratch)
          .accepted) // qualified, because a user member may have the same name
    scratch.visit([&](int word, const auto &value) { storeAttribute(rt, word, value); });
}

} // namespace RTSL_VARIANT
} // namespace rtsl
