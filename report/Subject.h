//===- Subject.h - a configuration that a study compares ------------------===//
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

/// One way to render the scene. The name has no commas, because it is written to CSV tables.
struct Subject {
  std::string name;
  // the differences from other subjects: {"traversal", "embree"}
  std::vector<std::pair<std::string, std::string>> settings;
  double compileSeconds = 0;
  /// The same arguments must give the same bits, and different seeds independent pictures.
  std::function<Picture(std::uint32_t samplesPerPixel, std::uint32_t seed)> render;
};

/// Called with the finished share of a long piece of work, in [0, 1], and its current step.
using ProgressFunction = std::function<void(double, const std::string &)>;

} // namespace rtsl::report
