//===- ImageObjects.h - the images of a scene as objects of its program ---===//
#pragma once

#include "runtime/scene/Scene.h"
#include "scenefile/files/Images.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace rtsl::scene {

class ImageObjects {
public:
  /// Reads all images, with the channels and levels that the program reads.
  ImageObjects(const SceneDescription &description, runtime::Scene &scene);

  /// The object of an image, made on first use; equal images are one. Throws the errors of
  /// ImageFiles::take, at the image.
  RtslRef of(const JsonValue &image, const std::string &className, const std::string &name);

  /// What is below 0 of the image that has this object; null: nothing.
  const runtime::NegativeTexels *negativeOf(RtslRef object) const;

private:
  const SceneDescription &description;
  runtime::Scene &scene;
  ImageFiles files;
  std::map<std::size_t, RtslRef> made; // by their number in `files`
};

} // namespace rtsl::scene
