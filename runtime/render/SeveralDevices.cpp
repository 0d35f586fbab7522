#include "runtime/render/SeveralDevices.h"

#include "runtime/render/Watch.h"
#include "support/Parallel.h"
#include "support/WorkerThreads.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace rtsl::runtime {

namespace {

/// The rows of a picture are numbered in bands of so many (runtime/device/organisations/Slice.h).
constexpr std::uint32_t rowsOfBand = 4;

/// With so many samples of a pixel the lanes of a warp, which begin with consecutive samples, begin
/// with the same pixel.
constexpr std::uint32_t enoughSamples = 64;

/// Rows to take at once while so many are left: half of each device's share. A device that is
/// slower than the others, or gets what is harder to render, then takes fewer of the following.
std::uint32_t rowsAtOnce(std::uint32_t left, std::size_t devices, std::uint64_t most) {
  const std::uint64_t share = left / (2 * devices);
  const std::uint64_t wanted = (share + rowsOfBand - 1) / rowsOfBand * rowsOfBand;
  const std::uint64_t rows = std::min(wanted, std::uint64_t(left));
  const std::uint64_t fitting = rows <= most ? rows : most / rowsOfBand * rowsOfBand;
  return std::uint32_t(std::max<std::uint64_t>(fitting, std::min(left, rowsOfBand)));
}

} // namespace

Window RowsLeft::take() {
  Window rows = whole;
  rows.y0 = whole.y0 + taken;
  taken += rowsAtOnce(whole.height() - taken, devices, mostPixels / whole.width());
  rows.y1 = whole.y0 + taken;
  return rows;
}

RenderOptions SeveralDevices::optionsOfPart(const RenderOptions &options, std::size_t devices) {
  RenderOptions part = options;
  const Window whole = windowOf(options);
  part.crop = RowsLeft(whole, devices, whole.pixels()).take();
  return part;
}

SeveralDevices::SeveralDevices(std::size_t count, const Make &make, const RenderOptions &options)
    : Backend(options), devices(count), rowsLeft(windowOf(options), count, 0) {
  const RenderOptions ofPart = optionsOfPart(options, count);
  forEachInParallel(unsigned(count), count,
                    [&](std::size_t i) { devices[i].backend = make(i, ofPart); });
  for (const Device &device : devices)
    buildSeconds = std::max(buildSeconds, device.backend->secondsToPrepare());
  trees = devices.front().backend->builtTrees();
  isRefitted = trees && trees->isRefitted;
  makePicture(channels());
}

void SeveralDevices::begin() {
  met = {};
  // With sums, which are copied to the devices and back, all that is possible.
  std::uint64_t mostPixels = pixelCount();
  if (!sums)
    for (const Device &device : devices)
      mostPixels = std::min(mostPixels, device.backend->samplesInMemory() /
                                            std::min(samplesOfPixel, enoughSamples));
  rowsLeft = {windowOf(options), devices.size(), mostPixels};
  for (Device &device : devices)
    device = {std::move(device.backend)};
}

void SeveralDevices::run(Watch &watch) {
  runOnThreads(unsigned(devices.size()), 0,
               [&](unsigned number) { runDevice(devices[number], watch); });
  for (const Device &device : devices)
    met.kernelSeconds = std::max(met.kernelSeconds, device.kernelSeconds);
}

/// What the thread of a device does.
void SeveralDevices::runDevice(Device &device, Watch &watch) {
  device.backend->enterThread();
  try {
    while (!watch.isStopped()) {
      const Window rows = takeRows();
      if (rows.pixels() == 0)
        return;
      renderRows(device, rows, watch);
    }
  } catch (...) {
    watch.stop(); // the other devices
    throw;
  }
}

Window SeveralDevices::takeRows() {
  const std::lock_guard<std::mutex> lock(mutex);
  return rowsLeft.take();
}

void SeveralDevices::renderRows(Device &device, const Window &rows, Watch &watch) {
  const double before = device.pixelsDone;
  RenderOptions ofRows = options;
  ofRows.progress = [&](double share) {
    const std::lock_guard<std::mutex> lock(mutex);
    device.pixelsDone = before + share * double(rows.pixels());
    watch.report(shareDone());
  };
  Watch watchOfRows(ofRows, &watch);
  std::optional<PixelSums> sumsOfRows;
  const std::size_t first = std::size_t(rows.y0 - windowOf(options).y0) * rows.width();
  if (sums)
    sumsOfRows = sums->part(first, rows.pixels());
  RenderStatistics part =
      device.backend->renderPart(rows, samplesOfPixel, sumsOfRows ? &*sumsOfRows : nullptr,
                                 picture.pixels.data() + first * channels(), watchOfRows);
  if (sums)
    sums->putPart(first, *sumsOfRows);
  const std::lock_guard<std::mutex> lock(mutex);
  device.pixelsDone = before + double(rows.pixels());
  add(device, std::move(part));
}

/// Adds what a device has rendered and met.
void SeveralDevices::add(Device &device, RenderStatistics &&part) {
  device.kernelSeconds += part.kernelSeconds;
  device.samples += part.samples;
  met.samples += part.samples;
  met.pixels += part.pixels;
  met.samplesNotFinite += part.samplesNotFinite;
  met.pixelsWithoutSample += part.pixelsWithoutSample;
  addMet(std::move(part), options.mostNotFinite, met);
}

double SeveralDevices::shareDone() const {
  double pixels = 0;
  for (const Device &device : devices)
    pixels += device.pixelsDone;
  return pixels / double(pixelCount());
}

} // namespace rtsl::runtime
