//===- ImageFormats.h - pictures in file formats, in memory ---------------===//
#pragma once

#include "runtime/image/Image.h"
#include "runtime/image/Layers.h"
#include "runtime/image/Texels.h"

#include <string>
#include <vector>

namespace rtsl::runtime {

std::string encodePng(const Image &image, const std::string &path);
Image decodePng(const std::string &bytes, const std::string &path);
/// The pixels as the file has them, with 8 or 16 bits a channel.
Pixels decodePngPixels(const std::string &bytes, const std::string &path);

std::string encodeExr(const Image &image, const std::vector<Layer> &layers,
                      const std::string &path);
Image decodeExr(const std::string &bytes, const std::string &path);

} // namespace rtsl::runtime
