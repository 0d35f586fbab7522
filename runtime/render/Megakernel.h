//===- Megakernel.h - backends that run the megakernel --------------------===//
//
// The common part of running the megakernel (runtime/device/organisations/Megakernel.h) on a CPU
// and on a GPU: a scene in one block of bytes, a status, memory for the rays of each lane, and the
// job that points to them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/DeviceTrees.h"
#include "runtime/accel/FlatScene.h"
#include "runtime/render/Backend.h"
#include "runtime/render/Stripes.h"
#include "runtime/render/passes/PixelSums.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace rtsl::runtime {

/// Sets the size, depth and seed of the scene's launch, and its status.
void setOptions(FlatScene &scene, const RenderOptions &options, RtslStatus *status);

/// What rays and samples have met, by the status of a job that renders the window. Throws Internal
/// if the lanes had too little memory.
RenderStatistics readStatus(const RtslStatus &status, const RenderOptions &options,
                            const Window &window);

class Megakernel : public Backend {
public:
  /// Renders rows of the picture, with so many samples of each pixel, and writes the pixels to
  /// `to`: the share of one of several devices (SeveralDevices.h). Throws as Backend::render, but
  /// not Cancelled.
  RenderStatistics renderPart(const Window &part, std::uint32_t samplesOfPixel, float *to,
                              Watch &watch);

  // The share of one of several devices in a rendering in passes: rows from the top of what is
  // rendered, each of them whole bands (device::rowsOfBand), whose sums stay on the device.
  /// Begins with `all`, the sums of all rows, of which uploadSums() takes these.
  void keepSums(PixelSums &all, std::vector<Rows> rows);
  /// Keeps other rows from now on. Between passes that are done, after fetchRows() by the device
  /// that had them, and uploadRows().
  void keepRows(std::vector<Rows> rows);
  /// Renders until each pixel of these rows has so many samples. Throws as renderPart.
  RenderStatistics renderKept(std::uint32_t samplesOfPixel, Watch &watch);
  void uploadSums(const SampleCounts &counts) final;
  void fetchSums() final;
  void uploadRows(const Rows &rows);
  void fetchRows(const Rows &rows);

  /// A thread calls it before these, unless it made the backend.
  virtual void enterThread() {}
  /// How many samples it renders before it adds them up.
  std::uint64_t samplesInMemory() const { return mostInMemory; }
  /// The components of the program's colors.
  std::uint32_t channels() const final { return colorComponents; }
  double secondsToPrepare() const { return buildSeconds; }
  const std::optional<TreeFigures> &builtTrees() const { return trees; }
  /// For the next picture's backend on the same device, which may follow to its scene. Null: the
  /// scene came with trees.
  const std::shared_ptr<DeviceTrees> &treesOnDevice() const { return deviceTrees; }

protected:
  /// An address in the device's memory.
  using Address = std::uint64_t;

  /// Takes a scene that is not relocated, and trees of another one on the same device, or null.
  /// Constructors of devices call prepare() once their memory and program are available.
  Megakernel(FlatScene scene, const RenderOptions &options, std::shared_ptr<DeviceTrees> kept);

  /// The scene's launch, before prepare().
  RtslLaunch launch() const { return scene.launch(); }
  /// Copies the scene and the job to the device. Throws OutOfMemory.
  void prepare();

  /// Where the rays of all lanes are, after prepare().
  Address raysAddress() const { return reinterpret_cast<Address>(job.lanes); }
  Address launchAddress() const { return reinterpret_cast<Address>(job.launch); }
  /// Floats of the pixels that are rendered.
  std::uint64_t pixelFloats() const { return windowPixels * colorComponents; }
  float *pixels = nullptr; // where finish() leaves them

private:
  /// The result of rtsl_lane_bytes for this launch, a multiple of 16.
  virtual std::uint64_t laneBytes(const RtslLaunch &launch) = 0;
  /// The bytes of memory for the rays of all lanes, limited by work and memory. Of a wavefront it
  /// sets RtslJob::slots.
  virtual std::uint64_t raysBytes(RtslJob &job) = 0;
  // The device's memory. `what` names the contents in messages.
  virtual Address allocate(std::uint64_t bytes, const char *what) = 0;
  virtual void upload(Address to, const void *from, std::uint64_t bytes) = 0;
  virtual void download(void *to, Address from, std::uint64_t bytes) = 0;
  /// Builds trees in the memory of the device, and may outlive the backend.
  virtual std::unique_ptr<BuildDevice> buildDevice() = 0;
  /// The address of the pixels on the device, which are set to 0.
  virtual Address clearedPixels() = 0;
  /// Copies them to `pixels`.
  virtual void fetchPixels() = 0;
  /// How many samples are in flight at once, after raysBytes().
  virtual std::uint64_t samplesInFlight() const = 0;
  /// The bytes that the samples of a slice may take.
  virtual std::uint64_t sliceBytes() = 0;
  /// A launch takes no samples any more after this time.
  virtual double launchSeconds() const = 0;
  /// Where sums of so many pixels are on the device.
  virtual RtslPixelSums placeSums(PixelSums &sums) = 0;
  /// Set those of `count` pixels from `first` on to 0 there, copy them there, and back.
  virtual void clearSums(const PixelSums &sums, std::size_t first, std::size_t count) = 0;
  virtual void uploadSums(const PixelSums &sums, std::size_t first, std::size_t count) = 0;
  virtual void fetchSums(PixelSums &sums, std::size_t first, std::size_t count) = 0;
  /// The addresses of sums on the device without samples, and without squares.
  virtual RtslPixelSums clearedSums(std::uint64_t pixels) = 0;
  /// Run all lanes of the job and wait for them: for its samples, and to add these to the sums.
  /// Return RenderStatistics::kernelSeconds.
  virtual double runLanes(const RtslJob &job) = 0;
  virtual double addSamples(const RtslJob &job) = 0; // unless the lanes have done so
  // Read and write a number in the status while lanes run, from another thread.
  virtual std::uint64_t get(Address number) = 0;
  virtual void set(Address number, std::uint32_t value) = 0;

  void begin() final;
  void beginAt(float *to);
  void run(Watch &watch) final;
  RenderStatistics finish() final;
  void setWindow(const Window &window);
  /// `share` gives what is done of the run, for a number of samples of the slice.
  void runSlice(Watch &watch, const std::function<double(std::uint64_t)> &share);
  std::size_t firstPixel(const Rows &rows) const { return std::size_t(rows.y0) * job.width; }
  std::size_t pixelsOf(const Rows &rows) const { return std::size_t(rows.height()) * job.width; }
  void placeOpenPixels();
  void allocatePrinted();
  void takePrinted();
  std::uint32_t samplesAtOnce(std::uint64_t pixels) const;
  void followTreesTo(Address sceneAddress);

  FlatScene scene; // empty after prepare()
  std::shared_ptr<DeviceTrees> deviceTrees;
  std::vector<FlatScene::Output> outputs;
  const std::uint32_t colorComponents;
  Address statusAddress = 0, placesAddress = 0;
  Address printedAddress = 0; // if the program prints
  RtslPrintedLines printed{}; // what is there at the beginning of a launch
  RtslJob job{};
  std::uint64_t windowPixels = 0; // of the job
  std::uint64_t mostInMemory = 1; // samples of a slice
  RtslPixelSums placedSums{};
  std::vector<Rows> keptRows; // those with sums
  // Of the run: its pixels, those that take samples, how many each of these has, and whether some
  // have more.
  std::uint64_t ownPixels = 0, openPixels = 0;
  std::uint32_t leastTaken = 0;
  bool isUneven = false;
  // Of the last run:
  double kernelSeconds = 0;
  std::uint64_t samplesOfSlice = 0;      // that were rendered
  std::vector<RtslStepCount> stepCounts; // empty: they are not counted
};

} // namespace rtsl::runtime
