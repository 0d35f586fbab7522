//===- Accessor.h - the numbers in a glTF file's buffers ------------------===//
#pragma once

#include "scenefile/gltf/File.h"

#include <array>
#include <optional>

namespace rtsl::scene::gltf {

/// A list of vectors or numbers. Making one checks everything but the bytes of the buffers, which
/// are read on demand.
class Accessor {
public:
  /// `number` is the accessor's, `what` begins messages: "`POSITION` of `meshes.0.primitives.1`".
  /// Throws OutOfRange, WrongType, MissingKey, BadBuffer.
  Accessor(const File &file, const JsonValue &number, std::string what);

  /// Throws BadBuffer unless each element is a `type`, such as "VEC3".
  void require(const char *type) const;

  std::size_t count() const { return elementCount; }
  const JsonValue &json() const { return *value; }

  /// All numbers; normalised integers as those from 0, or -1, to 1. Throws BadBuffer, and the
  /// errors of reading buffers.
  std::vector<float> floats() const;
  /// All numbers, which must be unsigned integers.
  std::vector<std::uint32_t> integers() const;

  /// `min` and `max`, the box of the elements, which must be VEC3.
  std::array<std::vector<double>, 2> box() const;

private:
  /// Where numbers lie: `count` times `components` of a kind, `stride` bytes apart.
  struct Span {
    std::size_t buffer = 0;
    std::uint64_t offset = 0, stride = 0, count = 0;
    std::uint32_t componentType = 0, components = 1;
  };
  struct Sparse {
    Span indices, values;
  };

  Span spanOf(const JsonValue &object, std::uint64_t count, std::uint32_t componentType,
              std::uint32_t components) const;
  void readSparse(const JsonValue &sparse);
  std::string_view bytesOf(const Span &span) const;
  template <typename Number, typename Read>
  std::vector<Number> numbers(Read read) const;
  [[noreturn]] void fail(const Message &why) const;

  const File &file;
  std::string what;
  const JsonValue *value;
  std::size_t elementCount = 0;
  std::uint32_t componentType = 0, components = 0;
  bool isNormalized = false;
  std::optional<Span> span; // none: zeros
  std::optional<Sparse> sparse;
};

} // namespace rtsl::scene::gltf
