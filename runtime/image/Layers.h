//===- Layers.h - several pictures in one EXR file -------------------------===//
#pragma once

#include "runtime/image/Image.h"

#include <string>
#include <vector>

namespace rtsl::runtime {

/// A picture that lies beside another one in its file.
struct Layer {
  std::string name;
  std::vector<std::string> channels; // their names in the layer; empty: those of a picture
  Image image;
};

/// Whether writeImage(path, ..., format) writes an EXR file, which can have layers.
bool isExr(const std::string &path, PictureFormat format);

/// As writeImage(), to an EXR file in which channel `C` of a layer is called `layer.C`. All have
/// the size and the place of `image`.
void writeLayers(const std::string &path, const Image &image, const std::vector<Layer> &layers);

} // namespace rtsl::runtime
