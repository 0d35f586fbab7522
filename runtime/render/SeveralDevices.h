//===- SeveralDevices.h - one picture on several devices ------------------===//
//
// Each device has the scene, its program, and a thread of the host. The devices take rows of the
// picture, so many at once that all of them end at nearly the same time: a share of what is left,
// and less and less. A pixel is rendered by one device, which adds its samples in their order, so
// the picture has the bits of one device.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/render/Megakernel.h"

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace rtsl::runtime {

/// Takes rows of a picture from the top.
class RowsLeft {
public:
  RowsLeft(const Window &whole, std::size_t devices, std::uint64_t mostPixels)
      : whole(whole), devices(devices), mostPixels(mostPixels) {}

  /// The next rows for one of the devices; without pixels: none are left. Not safe for concurrent
  /// calls.
  Window take();

private:
  Window whole;
  std::size_t devices;
  std::uint64_t mostPixels; // at once, if they are more than a few rows
  std::uint32_t taken = 0;
};

class SeveralDevices final : public Backend {
public:
  /// Options for the backend of each device: those of a part, which has the most rows that a device
  /// takes at once.
  static RenderOptions optionsOfPart(const RenderOptions &options, std::size_t devices);

  /// `make(i, options)` makes the backend of device i, with these options; it is called for all
  /// devices at once, by a thread for each. Throws what it throws.
  using Make =
      std::function<std::unique_ptr<Megakernel>(std::size_t, const RenderOptions &optionsOfPart)>;
  SeveralDevices(std::size_t devices, const Make &make, const RenderOptions &options);

  /// The number of samples that device i has rendered in the last run.
  std::uint64_t samplesOf(std::size_t i) const { return devices[i].samples; }

  PassSizes passSizes() const override { return devices.front().backend->passSizes(); }

private:
  struct Device {
    std::unique_ptr<Megakernel> backend;
    // Of the run:
    double pixelsDone = 0; // with a share of the rows that it has begun
    double kernelSeconds = 0;
    std::uint64_t samples = 0;
  };

  std::uint32_t channels() const override { return devices.front().backend->channels(); }
  void begin() override;
  void run(Watch &watch) override;
  RenderStatistics finish() override { return met; }

  void runDevice(Device &device, Watch &watch);
  Window takeRows();
  void renderRows(Device &device, const Window &rows, Watch &watch);
  void add(Device &device, RenderStatistics &&part);
  double shareDone() const;

  std::vector<Device> devices;
  std::mutex mutex; // for what follows, and for Device::pixelsDone
  RowsLeft rowsLeft;
  RenderStatistics met; // of the run
};

} // namespace rtsl::runtime
