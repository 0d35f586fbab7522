//===- Images.h - the images of a scene -----------------------------------===//
//
// An object with a `file`, `slices` or `raw` is an image: an object of the built-in class sampler2D
// or sampler3D (docs/scene-format.md#images).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/image/Texels.h"
#include "runtime/scene/Samplers.h"
#include "scenefile/json/JsonValue.h"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace rtsl::scene {

struct SceneDescription;

struct ImageDescription {
  std::vector<std::string> files; // one, or the slices of a sampler3D; resolved
  std::string part;               // of a glTF file, as "images.0"
  bool isRaw = false;             // texels of this shape, without a file format
  runtime::Texels shape;
  runtime::ColorSpace colorSpace = runtime::ColorSpace::ByFile;
  runtime::Sampling sampling;
  Place place;
};

/// Is it an image, of the class sampler2D or sampler3D? For the value of a member or an argument,
/// or an element of a list.
bool isImage(const JsonValue &value);

/// `sampler2D` or `sampler3D`?
bool isImageClass(const std::string &name);

/// Visits the values within an object or list: members, elements, arguments of a constructor.
void forEachValue(const JsonValue &value, const std::function<void(const JsonValue &)> &visit);

/// The class of an image: that of its `class`, or what its keys imply.
std::string imageClass(const JsonValue &image);

/// Reads an image; `resolve` makes a path as written one to open. Throws UnknownKey, MissingKey,
/// WrongType, OutOfRange, for all mistakes in one run.
ImageDescription readImage(const JsonValue &image,
                           const std::function<std::string(const JsonValue &)> &resolve);

/// Reads the files of all images of a scene, on all cores. Equal images are read once.
class ImageFiles {
public:
  /// `withLevels`: whether the program reads levels of an image of this class. `channelsOf`: which
  /// channels it reads of the images of a member of a class, as MemberInfo::imageChannels.
  ImageFiles(const SceneDescription &description,
             const std::function<bool(const std::string &className)> &withLevels,
             const std::function<std::uint32_t(const std::string &className,
                                               const std::string &member)> &channelsOf);

  /// The number of an image. Equal images have the same.
  std::size_t numberOf(const JsonValue &image) const { return numbers.at(&image); }

  /// The texels, which can be taken once. Throws the errors of runtime::readPixels and
  /// runtime::texelsOf.
  runtime::Texels take(std::size_t number);

  /// What of an image was not finite.
  const runtime::NotFiniteTexels &notFinite(std::size_t number) const {
    return results[number].notFinite;
  }

  /// What of an image is below 0.
  const runtime::NegativeTexels &negative(std::size_t number) const {
    return results[number].negative;
  }

private:
  struct Result {
    runtime::Texels texels;
    runtime::NotFiniteTexels notFinite;
    runtime::NegativeTexels negative;
    std::exception_ptr failure;
  };
  std::map<const JsonValue *, std::size_t> numbers;
  std::vector<Result> results; // by number
};

} // namespace rtsl::scene
