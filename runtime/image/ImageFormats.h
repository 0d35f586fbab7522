//===- ImageFormats.h - pictures in file formats, in memory ---------------===//
#pragma once

#include "runtime/image/Image.h"

#include <string>

namespace rtsl::runtime {

std::string encodePng(const Image &image, const std::string &path);
Image decodePng(const std::string &bytes, const std::string &path);

std::string encodeExr(const Image &image, const std::string &path);
Image decodeExr(const std::string &bytes, const std::string &path);

} // namespace rtsl::runtime
