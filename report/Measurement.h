//===- Measurement.h - the cost and the error of one picture --------------===//
#pragma once

#include "support/Error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::report {

/// One picture of a study. Errors are NaN if the reference cannot be compared with.
struct Measurement {
  std::string configuration;
  std::uint32_t samplesPerPixel = 0;
  std::uint32_t run = 0;  // from 0: the number of the run among those with this number of samples
  std::uint32_t seed = 0; // of the random numbers
  double buildSeconds = 0, renderSeconds = 0;
  double rmse = 0, relMse = 0, bias = 0, flip = 0, flipHdr = 0;
  std::uint64_t nanPixels = 0, infinitePixels = 0;
  std::uint64_t samplesNotFinite = 0; // left out of the means of their pixels
  std::uint64_t raysTooDeep = 0;      // not sent because of the depth limit
  std::uint64_t pictureHash = 0;      // equal for the same bits
  double pairVariance = 0; // of this picture and that of the run before: unbiased, mean over pixels
                           // and channels; 0 for run 0
};

/// The results of all runs of a configuration with one number of samples.
struct LevelVariance {
  std::string configuration;
  std::uint32_t samplesPerPixel = 0;
  double variance = 0;    // of a picture over the runs, mean over pixels and channels: the mean of
                          // Measurement::pairVariance, unbiased
  double meanSeconds = 0; // of rendering one picture
  double efficiency = 0;  // 1 / (variance x time); not finite if the variance is 0
};

/// Tables with a header line that grow by whole lines, so that an interrupted study can be
/// continued. Reading ignores a truncated last line. Writing throws FileUnwritable; reading returns
/// nothing for a missing file and throws BadImage for a file that is not such a table.
std::vector<Measurement> readMeasurements(const std::string &path);
void appendMeasurement(const std::string &path, const Measurement &measurement);
/// A whole table.
void writeLevels(const std::string &path, const std::vector<LevelVariance> &levels);

/// FNV-1a.
std::uint64_t hashOf(std::string_view bytes);
/// The same over the bits of pixels.
std::uint64_t hashOf(const std::vector<float> &pixels);

} // namespace rtsl::report
