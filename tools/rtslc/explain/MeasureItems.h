//===- MeasureItems.h - measuring what leaving items out saves ------------===//
#pragma once

#include "codegen/driver/SceneProgram.h"
#include "runtime/render/RenderOptions.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

/// A scene rendered with everything left out that it does not need, and with one item kept, in
/// turn.
struct ItemMeasurement {
  std::string kept; // the item, or "all"
  unsigned pairs = 0;
  double seconds = 0; // processor time of a rendering with everything left out, the median
  /// How much longer a rendering takes with the item kept: the median of all pairs, and an interval
  /// that holds the median with a probability of at least 95 % (order statistics; no distribution
  /// is assumed).
  double slower = 0, slowerLow = 0, slowerHigh = 0;
  /// Instructions that a rendering runs with everything left out, and with the item kept. Nothing
  /// if the machine does not say.
  std::optional<std::uint64_t> instructions, instructionsKept;
  bool isSameImage = true; // bit for bit
};

/// What is measured, and how.
struct MeasureRequest {
  const typed::Module &module;
  const LinkRequest &request;
  const CompileOptions &compile;
  const BuildScene &buildScene;
  runtime::RenderOptions render; // on one thread
  std::vector<ItemSet> kept;
  std::vector<std::string> names; // of these
  unsigned pairs = 11;
  std::function<void(double)> progress; // the share that is done
};

/// Nothing if there were errors.
std::optional<std::vector<ItemMeasurement>> measureItems(const MeasureRequest &what,
                                                         Diagnostics &diagnostics);

/// Ranks from 0 whose values enclose the median of `count` independent ones with at least 95 %
/// (David and Nagaraja, "Order Statistics", 2003, section 7.1). The smallest and the largest if
/// there are too few.
std::pair<std::size_t, std::size_t> medianRanks(std::size_t count);

} // namespace rtsl::tool
