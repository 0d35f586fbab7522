//===- SeveralDevices.h - one picture on several devices ------------------===//
//
// Each device has the scene, its program, and a thread of the host. The devices take rows of the
// picture, so many at once that all of them end at nearly the same time: a share of what is left,
// and less and less. In a rendering in passes each device keeps its rows, whose sums stay there
// until the picture is wanted, and stripes of rows move from slow devices to others between passes.
// A pixel is rendered by one device at a time, which adds its samples in their order, so the
// picture has the bits of one device.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/render/Megakernel.h"
#include "runtime/render/Stripes.h"

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
  /// `make(i)` makes the backend of device i, for the same options; it is called for all devices at
  /// once, by a thread for each. Throws what it throws.
  using Make = std::function<std::unique_ptr<Megakernel>(std::size_t)>;
  SeveralDevices(std::size_t devices, const Make &make, const RenderOptions &options);

  /// The number of samples that device i has rendered in the last run.
  std::uint64_t samplesOf(std::size_t i) const { return devices[i].samples; }

  PassSizes passSizes() const override { return devices.front().backend->passSizes(); }

private:
  struct Device {
    std::unique_ptr<Megakernel> backend;
    // Of the run:
    double pixelsBefore = 0, pixelsDone = 0; // without, and with a share of what it has begun
    double seconds = 0, kernelSeconds = 0;
    std::uint64_t samples = 0;
  };

  std::uint32_t channels() const override { return devices.front().backend->channels(); }
  void begin() override;
  void run(Watch &watch) override;
  RenderStatistics finish() override { return met; }
  void uploadSums(const SampleCounts &counts) override;
  void fetchSums() override;

  Megakernel &on(std::size_t i);
  void moveStripes();
  void runDevice(std::size_t i, Watch &watch);
  Window takeRows();
  void add(Device &device, RenderStatistics &&part);
  double shareDone() const;

  std::vector<Device> devices;
  std::mutex mutex; // for the next two, and for what the devices have done
  RowsLeft rowsLeft;
  RenderStatistics met; // of the run

  Stripes stripes;      // of the rows that are rendered
  bool mayMove = false; // the last run was a whole pass
};

} // namespace rtsl::runtime
