#include "runtime/render/SeveralDevices.h"

#include "runtime/device/organisations/Slice.h"
#include "runtime/render/Watch.h"
#include "support/Clock.h"
#include "support/Parallel.h"
#include "support/WorkerThreads.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace rtsl::runtime {

namespace {

using device::rowsOfBand;

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

SeveralDevices::SeveralDevices(std::size_t count, const Make &make, const RenderOptions &options)
    : Backend(options), devices(count), rowsLeft(windowOf(options), count, 0),
      stripes(windowOf(options).height(), count) {
  forEachInParallel(unsigned(count), count, [&](std::size_t i) { devices[i].backend = make(i); });
  for (const Device &device : devices)
    buildSeconds = std::max(buildSeconds, device.backend->secondsToPrepare());
  trees = devices.front().backend->builtTrees();
  isRefitted = trees && trees->isRefitted;
  makePicture(channels());
}

void SeveralDevices::begin() {
  if (sums)
    moveStripes();
  met = {};
  std::uint64_t mostPixels = pixelCount();
  for (const Device &device : devices)
    mostPixels = std::min(mostPixels, device.backend->samplesInMemory() /
                                          std::min(samplesOfPixel, enoughSamples));
  rowsLeft = {windowOf(options), devices.size(), mostPixels};
  for (Device &device : devices)
    device = {std::move(device.backend)};
}

void SeveralDevices::run(Watch &watch) {
  std::atomic<std::size_t> next{0}; // if there are fewer threads, one of them runs two devices
  runOnThreads(unsigned(devices.size()), 0, [&](unsigned) {
    for (std::size_t i = next++; i < devices.size(); i = next++)
      runDevice(i, watch);
  });
  for (const Device &device : devices)
    met.kernelSeconds = std::max(met.kernelSeconds, device.kernelSeconds);
  mayMove = sums && met.pixels == pixelCount();
}

/// A device, for this thread.
Megakernel &SeveralDevices::on(std::size_t i) {
  devices[i].backend->enterThread();
  return *devices[i].backend;
}

/// What the thread of a device does.
void SeveralDevices::runDevice(std::size_t i, Watch &watch) {
  Device &device = devices[i];
  double pixels = 0; // of what it renders now
  RenderOptions ofPart = options;
  ofPart.cancel = nullptr; // `watch` knows when it ends what was begun
  ofPart.progress = [&](double share) {
    const std::lock_guard<std::mutex> lock(mutex);
    device.pixelsDone = device.pixelsBefore + share * pixels;
    watch.report(shareDone());
  };
  Watch watchOfPart(ofPart, &watch);
  const Clock::time_point start = Clock::now();
  Megakernel &backend = on(i);
  const auto renderKept = [&] {
    for (const Rows &rows : stripes.of(i))
      pixels += double(rows.height()) * windowOf(options).width();
    add(device, backend.renderKept(samplesOfPixel, watchOfPart));
  };
  const auto renderRows = [&](const Window &rows) {
    pixels = double(rows.pixels());
    const std::uint64_t first = std::uint64_t(rows.y0 - windowOf(options).y0) * rows.width();
    add(device, backend.renderPart(rows, samplesOfPixel, picture.pixels.data() + first * channels(),
                                   watchOfPart));
  };
  try {
    if (sums)
      renderKept();
    else
      for (Window rows = takeRows(); rows.pixels() > 0 && !watch.isStopped(); rows = takeRows())
        renderRows(rows);
  } catch (...) {
    watch.stop(); // the other devices
    throw;
  }
  device.seconds = secondsSince(start);
}

Window SeveralDevices::takeRows() {
  const std::lock_guard<std::mutex> lock(mutex);
  return rowsLeft.take();
}

void SeveralDevices::uploadSums(const SampleCounts &counts) {
  mayMove = mayMove && counts.least == counts.most;
  forEachInParallel(unsigned(devices.size()), devices.size(), [&](std::size_t i) {
    Megakernel &backend = on(i);
    backend.keepSums(*sums, stripes.of(i));
    backend.uploadSums(counts);
  });
}

void SeveralDevices::fetchSums() {
  forEachInParallel(unsigned(devices.size()), devices.size(),
                    [&](std::size_t i) { on(i).fetchSums(); });
}

/// Lets devices that took longer than others give stripes to them.
void SeveralDevices::moveStripes() {
  constexpr double longEnough = 0.05; // to be measured, and to be worth it
  std::vector<double> seconds;
  for (const Device &device : devices)
    seconds.push_back(device.seconds);
  if (!mayMove || *std::max_element(seconds.begin(), seconds.end()) < longEnough)
    return;
  const std::vector<Stripes::Move> moves = stripes.balance(seconds);
  for (const Stripes::Move &move : moves) {
    on(move.from).fetchRows(move.rows);
    on(move.to).uploadRows(move.rows);
  }
  if (!moves.empty())
    forEachInParallel(unsigned(devices.size()), devices.size(),
                      [&](std::size_t i) { on(i).keepRows(stripes.of(i)); });
}

/// Adds what a device has rendered and met.
void SeveralDevices::add(Device &device, RenderStatistics &&part) {
  const std::lock_guard<std::mutex> lock(mutex);
  device.kernelSeconds += part.kernelSeconds;
  device.samples += part.samples;
  device.pixelsDone = device.pixelsBefore += double(part.pixels);
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
