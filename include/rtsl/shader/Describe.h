//===- Describe.h - describes generated classes to the runtime ------------===//
//
// The runtime needs a program's classes, their members and constructors, and a function per method
// slot (runtime/program/Program.h). Generated code describes them with this header: it names
// classes and members, and offsets and sizes are those of the C++ compiler.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/program.h"
#include "rtsl/shader/OutputBuffer.h"
#include "rtsl/shader/State.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

extern "C" void rtsl_sample_slots(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                                  float *color);

namespace rtsl {
inline namespace RTSL_VARIANT {

//===----------------------------------------------------------------------===//
// Types
//===----------------------------------------------------------------------===//

/// The name of a user struct and its fields; generated code overloads `describeFields` for each
/// struct that a scene can set.
template <typename T>
struct StructDescription {
  std::string name;
  std::vector<runtime::MemberInfo> fields;

  template <typename F>
  void add(const char *fieldName, F T::*field);
};

namespace detail {

/// Bytes from the start of an object to a member.
template <typename Class, typename Owner, typename T>
inline std::uint32_t offsetOf(T Owner::*member) {
  const Class object{};
  return static_cast<std::uint32_t>(reinterpret_cast<const char *>(&(object.*member)) -
                                    reinterpret_cast<const char *>(&object));
}

using Kind = runtime::ValueType::Kind;

inline void describe(runtime::ValueType &type, const float *) {
  type.kind = Kind::Float, type.name = "float";
}
inline void describe(runtime::ValueType &type, const int *) {
  type.kind = Kind::Int, type.name = "int";
}
inline void describe(runtime::ValueType &type, const uint *) {
  type.kind = Kind::UInt, type.name = "uint";
}
inline void describe(runtime::ValueType &type, const Bool *) {
  type.kind = Kind::Bool, type.name = "bool";
}

template <int L, typename T>
inline void describe(runtime::ValueType &type, const glm::vec<L, T, glm::defaultp> *) {
  describe(type, static_cast<const T *>(nullptr));
  type.rows = L;
  const char *prefix = type.kind == Kind::Float  ? "vec"
                       : type.kind == Kind::Int  ? "ivec"
                       : type.kind == Kind::UInt ? "uvec"
                                                 : "bvec";
  type.name = prefix + std::to_string(L);
}
template <int C, int R>
inline void describe(runtime::ValueType &type, const glm::mat<C, R, float, glm::defaultp> *) {
  type.kind = Kind::Float;
  type.columns = C;
  type.rows = R;
  type.name = "mat" + std::to_string(C) + (C == R ? "" : "x" + std::to_string(R));
}
template <int N>
inline void describe(runtime::ValueType &type, const Color<N> *) {
  type.kind = Kind::Color;
  type.name = "color";
}
template <typename T, uint N>
inline void describe(runtime::ValueType &type, const array<T, N> *);
template <typename T, int Rank>
inline void describe(runtime::ValueType &type, const Buffer<T, Rank> *);
template <typename T, int Rank>
inline void describe(runtime::ValueType &type, const OutputBuffer<T, Rank> *);

/// A reference, or a user struct.
template <typename T>
inline auto describe(runtime::ValueType &type, const T *)
    -> std::enable_if_t<std::is_class_v<T> && std::is_base_of_v<Reference, T>> {
  type.kind = Kind::Reference;
  type.className = type.name = T::className;
}
template <typename T>
inline auto describe(runtime::ValueType &type, const T *)
    -> std::enable_if_t<std::is_class_v<T> && !std::is_base_of_v<Reference, T>> {
  StructDescription<T> description;
  describeFields(description);
  type.kind = Kind::Struct;
  type.name = description.name;
  type.fields = std::move(description.fields);
}

template <typename T, uint N>
inline void describe(runtime::ValueType &type, const array<T, N> *) {
  describe(type, static_cast<const T *>(nullptr));
  type.arraySizes.insert(type.arraySizes.begin(), N);
  const std::size_t bracket = std::min(type.name.find('['), type.name.size());
  type.name.insert(bracket, "[" + std::to_string(N) + "]");
}
template <typename T, int Rank>
inline void describe(runtime::ValueType &type, const Buffer<T, Rank> *) {
  describe(type, static_cast<const T *>(nullptr));
  type.elementSize = sizeof(T);
  type.bufferRank = Rank;
  for (int i = 0; i < Rank; ++i)
    type.name += "[]";
}

template <typename T, int Rank>
inline void describe(runtime::ValueType &type, const OutputBuffer<T, Rank> *) {
  describe(type, static_cast<const Buffer<T, Rank> *>(nullptr));
  type.isOutput = true;
}

template <typename T>
inline runtime::ValueType valueType() {
  runtime::ValueType type;
  describe(type, static_cast<const T *>(nullptr));
  type.size = sizeof(T);
  return type;
}

} // namespace detail

template <typename T>
template <typename F>
void StructDescription<T>::add(const char *fieldName, F T::*field) {
  runtime::MemberInfo info;
  info.name = fieldName;
  info.type = detail::valueType<F>();
  info.offset = detail::offsetOf<T>(field);
  fields.push_back(std::move(info));
}

//===----------------------------------------------------------------------===//
// Constructors: the runtime passes arguments packed, as they are in memory
//===----------------------------------------------------------------------===//

namespace detail {

/// The representation of a parameter in memory.
template <typename T>
struct Stored {
  using type = T;
};
template <>
struct Stored<bool> {
  using type = Bool;
};
template <int L>
struct Stored<glm::vec<L, bool, glm::defaultp>> {
  using type = glm::vec<L, Bool, glm::defaultp>;
};
template <typename T>
using StoredAs = typename Stored<std::remove_cv_t<std::remove_reference_t<T>>>::type;

template <typename T>
inline StoredAs<T> take(const unsigned char *&from) {
  StoredAs<T> value;
  std::memcpy(static_cast<void *>(&value), from, sizeof value);
  from += sizeof value;
  return value;
}

template <typename Class>
inline Class &objectAt(RtslState *state, RtslRef reference) {
  return *reinterpret_cast<Class *>(state->launch->records + reference + objectOffset<Class>);
}

template <typename Signature>
struct Constructor;

template <typename Owner, typename... Argument>
struct Constructor<void (Owner::*)(Argument...)> {
  static std::vector<runtime::ValueType> parameters() {
    return {valueType<StoredAs<Argument>>()...};
  }

  template <typename Class, auto Function>
  static void construct(RtslState *state, RtslRef reference, const void *packed) {
    auto next = static_cast<const unsigned char *>(packed);
    const std::tuple<StoredAs<Argument>...> arguments{take<Argument>(next)...};
    std::apply(
        [&](const auto &...values) { (objectAt<Class>(state, reference).*Function)(values...); },
        arguments);
    static_cast<void>(next);
  }
};

/// One that takes the state, to call methods of other objects.
template <typename Owner, int N, typename... Argument>
struct Constructor<void (Owner::*)(State<N> &, Argument...)> {
  static std::vector<runtime::ValueType> parameters() {
    return {valueType<StoredAs<Argument>>()...};
  }

  template <typename Class, auto Function>
  static void construct(RtslState *state, RtslRef reference, const void *packed) {
    auto next = static_cast<const unsigned char *>(packed);
    const std::tuple<StoredAs<Argument>...> arguments{take<Argument>(next)...};
    std::apply(
        [&](const auto &...values) {
          (objectAt<Class>(state, reference).*Function)(stateOf<N>(state), values...);
        },
        arguments);
    static_cast<void>(next);
  }
};

/// Member defaults.
template <typename Class>
inline void initialize(RtslState *state, RtslRef reference) {
  new (state->launch->records + reference + objectOffset<Class>) Class();
}

} // namespace detail

//===----------------------------------------------------------------------===//
// Classes and programs
//===----------------------------------------------------------------------===//

enum class Access { Public, Private };
enum class Default { None, Given, Required };

/// Of a constructor: its name, and the range of its argument.
struct Parameter {
  Parameter(const char *name, const std::optional<Range> &values = std::nullopt)
      : name(name), values(values) {}

  const char *name;
  std::optional<Range> values;
};

template <typename Class>
class ClassDescription {
public:
  explicit ClassDescription(runtime::ClassInfo &info) : info(info) {
    static_assert(alignof(Class) <= 16, "records are aligned to 16 bytes");
    info.recordSize = static_cast<std::uint32_t>((objectOffset<Class> + sizeof(Class) + 3) / 4 * 4);
    info.initialize = &detail::initialize<Class>;
  }

  template <typename Owner, typename T>
  ClassDescription &member(const char *name, T Owner::*member, Access access,
                           Default given = Default::None,
                           const std::optional<Range> &values = std::nullopt) {
    runtime::MemberInfo described;
    described.name = name;
    described.type = detail::valueType<T>();
    described.offset =
        static_cast<std::uint32_t>(objectOffset<Class>) + detail::offsetOf<Class>(member);
    described.isPublic = access == Access::Public;
    described.hasDefault = given == Default::Given;
    described.isRequired = given == Default::Required;
    described.values = values;
    info.members.push_back(std::move(described));
    return *this;
  }

  template <auto Function>
  ClassDescription &constructor(std::initializer_list<Parameter> parameters) {
    using Shape = detail::Constructor<decltype(Function)>;
    std::vector<runtime::ValueType> types = Shape::parameters();
    std::size_t i = 0;
    for (const Parameter &parameter : parameters) {
      runtime::MemberInfo described;
      described.name = parameter.name;
      described.type = std::move(types[i++]);
      described.offset = info.parameterSize;
      described.values = parameter.values;
      info.parameterSize += described.type.size;
      info.parameters.push_back(std::move(described));
    }
    info.hasConstructor = true;
    info.construct = &Shape::template construct<Class, Function>;
    return *this;
  }

  ClassDescription &methods(std::initializer_list<const char *> names) {
    info.methods.assign(names.begin(), names.end());
    return *this;
  }
  /// RTSL_NEEDS_*: the parts of a hit that the class's methods read.
  ClassDescription &needs(std::uint32_t what) {
    info.needs = what;
    return *this;
  }
  /// Which of the program's mesh attributes the class's methods read, as bits.
  ClassDescription &attributes(std::uint32_t which) {
    info.attributes = which;
    return *this;
  }
  /// Has `anyHit` for rays with these payloads.
  template <typename... Payload>
  ClassDescription &anyHitFor() {
    info.anyHit = (rtslRayTypeBit(Payload::rayType.number) | ...);
    return *this;
  }

private:
  runtime::ClassInfo &info;
};

/// Does the layout of the state match the runtime's, and does the compiler round each operation?
template <int N>
inline void selfTest() {
  static RtslState raw;
  [[maybe_unused]] State<N> &rt = stateOf<N>(&raw);
  auto same = [](const void *a, const void *b) {
    if (a != b)
      throw std::logic_error("generated shaders and the runtime lay out the state differently");
  };
#define RTSL_STATE_VARIABLE(name, type, ...) same(&raw.name, &rt.name);
#include "language/StateVariables.def"
  same(raw.attributes, rt.attributes);

#if !defined(RTSL_FAST)
  volatile float a = 1.0f + 0x1p-12f, b = -1.0f - 0x1p-11f;
  const float x = a, y = b;
  if (x * x + y != 0.0f) // 2^-24 if fused
    throw std::logic_error(
        "generated shaders were compiled with contraction of floating-point operations");
#endif
}

/// Builds the description that a generated file exports.
template <int N>
class Program {
public:
  Program() : result(std::make_shared<runtime::Program>()) {
    selfTest<N>();
    result->colorComponents = N;
    result->sample = &rtsl_sample_slots;
    result->emittedPower = &rtsl_emitted_power;
    result->needs = 0;
  }

  /// Adds a class; numbers count from 1. The description is valid until the next class.
  template <typename Class>
  ClassDescription<Class> add(std::uint32_t id, const char *name, const char *base,
                              const char *root) {
    runtime::ClassInfo &info = result->classes.emplace_back();
    info.id = id;
    info.name = name;
    info.base = base;
    info.root = root;
    info.needs = 0;
    return ClassDescription<Class>(info);
  }

  runtime::Program::Slots &slots() { return result->slots; }
  /// For methods that were split at their traces: the function that runs a state, and all frames.
  template <typename... Frames>
  void states(decltype(runtime::Program::Slots::States::run) run) {
    std::size_t size = 4;
    ((size = std::max(size, sizeof(Frames))), ...);
    result->slots.states.run = run;
    result->slots.states.frameSize = static_cast<std::int32_t>((size + 3) / 4 * 4);
  }
  /// The number of methods that are called through references, and their frames.
  template <typename... Frames>
  void calls(std::uint32_t methods) {
    std::size_t size = 0;
    ((size = std::max(size, sizeof(Frames))), ...);
    result->slots.states.calledMethods = methods;
    result->slots.states.calledFrameSize =
        static_cast<std::uint32_t>(RTSL_CALL_HEADER + (size + 7) / 8 * 8);
  }
  /// RTSL_NEEDS_*: the parts of a hit that the methods of the program read.
  void needs(std::uint32_t what) { result->needs = what; }
  /// A scratch member that materials may read of meshes, `offset` words after the first, and its
  /// changes across the footprint of the ray.
  template <typename T>
  void meshAttribute(const char *name, std::uint32_t offset,
                     std::uint32_t changeAlongX = RTSL_NOT_READ,
                     std::uint32_t changeAlongY = RTSL_NOT_READ) {
    result->meshAttributes.push_back(
        {name, detail::valueType<T>(), offset, {changeAlongX, changeAlongY}});
  }
  /// RTSL_FEATURE_*: side effects of samples.
  void features(std::uint32_t what) { result->slots.features = what; }
  void engine(runtime::Engine engine) { result->engine = engine; }
  RtslShaders finish() { return {std::move(result)}; }

private:
  std::shared_ptr<runtime::Program> result;
};

} // namespace RTSL_VARIANT
} // namespace rtsl
