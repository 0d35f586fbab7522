//===- Textures.h - textures and images of a glTF file --------------------===//
#pragma once

#include "runtime/image/Texels.h"
#include "scenefile/gltf/File.h"
#include "scenefile/gltf/Parts.h"

#include <string>
#include <vector>

namespace rtsl::scene::gltf {

/// How paths are written in the scene file that the parts are for.
struct Mention {
  std::string path;            // of the glTF file, as written there
  bool isFromOverride = false; // then paths are relative to the working directory

  /// The path of a file beside it.
  std::string beside(const std::string &path) const;
};

/// What a texture is read for.
enum class Use : std::uint8_t {
  Color, // in sRGB
  Red,   // a channel, linear
  Green,
  Blue,
  Alpha,  // of an image whose other channels are in sRGB
  SlopeU, // of a map of normals, along u
  SlopeV
};

class Textures {
public:
  Textures(const File &file, const Mention &mention, Modules &modules,
           std::vector<Warning> &warnings)
      : file(file), mention(mention), modules(modules), warnings(warnings) {}

  /// The object of a scene for a `textureInfo`. What it needs is added to `modules`.
  JsonValue texture(const JsonValue &info, const std::string &what, Use use);

private:
  JsonValue image(const JsonValue &info, const std::string &what, bool isColor);
  void setWrapAndFilter(JsonValue &image, const JsonValue &texture, const std::string &what) const;
  JsonValue transformed(JsonValue pattern, const JsonValue &transform, const std::string &what);

  const File &file;
  const Mention &mention;
  Modules &modules;
  std::vector<Warning> &warnings;
};

/// `images.N`.
std::string partOfImage(std::size_t image);

/// The pixels of an image in the file, by the name of its part. Throws UnknownName, BadImage,
/// BadBuffer.
runtime::Pixels readImage(const File &file, const std::string &part, runtime::ColorSpace space);

} // namespace rtsl::scene::gltf
