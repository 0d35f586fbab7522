//===- PictureSize.h - "960x540" ------------------------------------------===//
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>

namespace rtsl::tool {

struct PictureSize {
  std::uint32_t width, height; // in pixels
};

/// Adds --size WxH, each from 1 to 65536.
void addSizeOption(CLI::App &command, std::optional<PictureSize> &size);

} // namespace rtsl::tool
