//===- FrameSequence.h - rtslc render --frame and --frames ----------------===//
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace rtsl::tool {

/// Frames `first` to `last`.
struct Frames {
  std::uint32_t first = 0, last = 0;
};

/// Adds --frame N and --frames A..B.
void addFrameOptions(CLI::App &command, std::optional<double> &frame,
                     std::optional<Frames> &frames);

/// Throws unless the file name of `option` has one place for the number of the frame: `%d`, or
/// `%04d` for four digits.
void checkFrameName(const std::string &option, const std::string &name);

/// The name with the number in its place.
std::string nameOfFrame(const std::string &name, std::uint32_t frame);

} // namespace rtsl::tool
