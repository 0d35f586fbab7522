//===- PictureOptions.h - options of the picture that is rendered ----------===//
#pragma once

#include "runtime/image/Image.h"
#include "runtime/image/ToneMapping.h"
#include "runtime/render/RenderOptions.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace rtsl::tool {

struct PictureSize {
  std::uint32_t width, height; // in pixels
  std::uint32_t slices = 1;    // of a launch of three dimensions

  void apply(runtime::RenderOptions &render) const {
    render.width = width;
    render.height = height * slices;
    render.slices = slices;
  }
};

/// Adds --size WxH or WxHxSLICES, each from 1 to 65536.
void addSizeOption(CLI::App &command, std::optional<PictureSize> &size);

/// Adds --crop x0,y0,x1,y1.
void addCropOption(CLI::App &command, std::optional<runtime::Window> &crop);

/// Adds -o IMAGE, which must be given, and --format.
CLI::Option *addPictureOption(CLI::App &command, std::string &output,
                              runtime::PictureFormat &format);
/// Throws where neither the name nor --format determines the format of the picture. When all
/// options are read.
void checkPictureName(const std::string &output, runtime::PictureFormat format);

/// Adds --exposure and --tone.
void addToneOptions(CLI::App &command, runtime::ToneMapping &tones);
/// Throws where one of them is given and there is no PNG picture. When all options are read.
void checkToneOptions(const CLI::App &command, const std::string &output,
                      runtime::PictureFormat format);

/// Writes a picture as its file is to show it. Throws what runtime::writeImage does.
void writePicture(const std::string &output, const runtime::Image &image,
                  runtime::PictureFormat format, const runtime::ToneMapping &tones);
/// Replaces the file of a picture that is still rendered. What fails is not reported, because it
/// fails again with the last picture, or no longer matters.
void writePictureSoFar(const std::string &output, const runtime::Image &image,
                       runtime::PictureFormat format, const runtime::ToneMapping &tones);

/// Adds --tree.
void addTreeOption(CLI::App &command, std::optional<runtime::TreeKind> &tree);

} // namespace rtsl::tool
