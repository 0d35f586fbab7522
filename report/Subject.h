//===- Subject.h - what a study compares ----------------------------------===//
#pragma once

#include "runtime/image/Image.h"
#include "runtime/render/Renderer.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::report {

struct Picture {
  runtime::Image image;
  runtime::RenderStatistics statistics;
};

/// One way to render the scene. The name has no commas, for it goes into tables.
struct Subject {
  std::string name;
  // what tells it from the others: {"traversal", "embree"}
  std::vector<std::pair<std::string, std::string>> settings;
  double compileSeconds = 0;
  /// The same arguments must give the same bits, and different seeds independent pictures.
  std::function<Picture(std::uint32_t samplesPerPixel, std::uint32_t seed)> render;
};

/// Called with the share of a long piece of work that is done, in [0, 1], and what is done now.
using ProgressFunction = std::function<void(double, const std::string &)>;

} // namespace rtsl::report
