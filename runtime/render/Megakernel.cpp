#include "runtime/render/Megakernel.h"

#include "runtime/device/organisations/Slice.h"
#include "runtime/program/PrintLog.h"
#include "runtime/render/Watch.h"
#include "support/Clock.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace rtsl::runtime {

/// Traversal, and the beginning of samples.
static constexpr std::size_t stepsBesideStates = 2;
/// If a slice has at least so many pixels for each lane, it costs little time that some lanes end
/// a pixel earlier than others.
static constexpr std::uint64_t pixelsOfLane = 4;
/// The numbers of samples have 32 bits, and lanes count a little beyond the last.
static constexpr std::uint64_t mostInSlice = 0x7fffffff;

void setOptions(FlatScene &scene, const RenderOptions &options, RtslStatus *status) {
  RtslLaunch launch = scene.launch();
  setLaunch(launch, options);
  launch.status = status;
  scene.setLaunch(launch);
}

RenderStatistics readStatus(const RtslStatus &status, const RenderOptions &options,
                            const Window &window) {
  if (status.problem != RTSL_PROBLEM_NONE)
    throw Error(message::rayStackOverflow(options.maxDepth));
  RenderStatistics statistics;
  statistics.samplesNotFinite = status.samplesNotFinite;
  statistics.pixelsWithoutSample = status.pixelsWithoutSample;
  for (const std::uint64_t rank : status.firstNotFinite)
    if (rank != 0 && statistics.notFinite.size() < options.mostNotFinite) {
      const std::uint64_t pixel = ~rank >> 32;
      statistics.notFinite.push_back({window.x0 + std::uint32_t(pixel % window.width()),
                                      window.y0 + std::uint32_t(pixel / window.width()),
                                      std::uint32_t(~rank)});
    }
  addEvents(status, statistics);
  return statistics;
}

Megakernel::Megakernel(FlatScene scene, const RenderOptions &options,
                       std::shared_ptr<DeviceTrees> kept)
    : Backend(options), scene(std::move(scene)), deviceTrees(std::move(kept)),
      colorComponents(this->scene.launch().colorComponents),
      keptRows{{0, windowOf(options).height()}} {}

void Megakernel::prepare() {
  const Clock::time_point start = Clock::now();
  statusAddress = allocate(sizeof(RtslStatus), "the launch");
  setOptions(scene, options, reinterpret_cast<RtslStatus *>(statusAddress));
  job.laneBytes = laneBytes(scene.launch());
  const Address sceneAddress = allocate(scene.bytes.size(), "the scene");
  scene.relocate(sceneAddress);
  upload(sceneAddress, scene.bytes.data(), scene.bytes.size());
  if (!scene.hasTrees())
    followTreesTo(sceneAddress);
  outputs = std::move(scene.outputs);
  scene = {};
  buildSeconds += secondsSince(start);

  job.launch = reinterpret_cast<const RtslLaunch *>(sceneAddress);
  job.status = reinterpret_cast<RtslStatus *>(statusAddress);
  setWindow(windowOf(options));
  clearedPixels(); // allocates them before the rays, whose number adapts to the free memory
  const std::uint64_t bytesAtOnce = pixelCount() * colorComponents * sizeof(float);
  if (pixelCount() > mostInSlice)
    throw Error(message::tooManyPixelsForTarget(pixelCount(), mostInSlice));
  const std::uint64_t mostByMemory =
      options.wantsPicture ? sliceBytes() / bytesAtOnce : mostInSlice;
  const std::uint64_t ofPixel = std::min<std::uint64_t>(
      std::clamp<std::uint64_t>(mostByMemory, 1, mostInSlice / pixelCount()),
      options.samplesPerPixel);
  mostInMemory = pixelCount() * ofPixel;
  if (options.wantsPicture)
    job.samples = reinterpret_cast<float *>(allocate(bytesAtOnce * ofPixel, "samples"));
  job.lanes = reinterpret_cast<std::uint8_t *>(allocate(raysBytes(job), "rays in flight"));
  if (options.prints)
    allocatePrinted();
  if (options.countedStates) {
    stepCounts.resize(options.countedStates + stepsBesideStates);
    job.stepCounts = reinterpret_cast<RtslStepCount *>(
        allocate(stepCounts.size() * sizeof stepCounts[0], "the counts of steps"));
  }
}

/// Allocates memory for some lines of each sample in flight.
void Megakernel::allocatePrinted() {
  constexpr std::uint64_t ofSample = 1024, least = std::uint64_t(1) << 20,
                          most = std::uint64_t(1) << 30;
  const std::uint64_t bytes = std::clamp(samplesInFlight() * ofSample, least, most);
  printedAddress = allocate(sizeof printed, "lines of `print`");
  printed.capacity = bytes / sizeof *printed.words;
  printed.words = reinterpret_cast<std::uint32_t *>(allocate(bytes, "lines of `print`"));
  upload(printedAddress, &printed, sizeof printed);
}

/// Takes the lines of a launch that is over.
void Megakernel::takePrinted() {
  RtslPrintedLines lines;
  download(&lines, printedAddress, sizeof lines);
  std::vector<std::uint32_t> words(std::min(lines.reserved, lines.capacity));
  if (words.empty())
    return;
  download(words.data(), reinterpret_cast<Address>(lines.words), words.size() * sizeof words[0]);
  upload(printedAddress, &printed, sizeof printed);
  addPrinted(lines, words.data());
}

void Megakernel::setWindow(const Window &window) {
  job.left = window.x0;
  job.top = window.y0;
  device::setWindowSize(job, window.width(), window.height());
  windowPixels = window.pixels();
}

RenderStatistics Megakernel::renderPart(const Window &part, std::uint32_t samples, float *to,
                                        Watch &watch) {
  setWindow(part);
  samplesOfPixel = samples;
  sums = nullptr;
  beginAt(to);
  run(watch);
  return finish();
}

void Megakernel::keepSums(PixelSums &all, std::vector<Rows> rows) {
  setWindow(windowOf(options));
  sums = &all;
  keptRows = std::move(rows);
}

void Megakernel::keepRows(std::vector<Rows> rows) {
  keptRows = std::move(rows);
  placeOpenPixels();
}

RenderStatistics Megakernel::renderKept(std::uint32_t samples, Watch &watch) {
  samplesOfPixel = samples;
  begin();
  run(watch);
  return finish();
}

/// Makes the trees those of a scene without trees that was copied there.
void Megakernel::followTreesTo(Address sceneAddress) {
  RtslLaunch launch = scene.launch();
  // The small ones are built of the scene's copy here, whose pointers must all lead there.
  scene.relocate(reinterpret_cast<Address>(scene.bytes.data()) - sceneAddress);
  if (!deviceTrees)
    deviceTrees = std::make_shared<DeviceTrees>(buildDevice());
  deviceTrees->follow(scene.launch(), sceneAddress, options.threads, options.tree);
  deviceTrees->install(launch);
  upload(sceneAddress, &launch, sizeof launch);
  trees = deviceTrees->treeFigures();
  isRefitted = trees->isRefitted;
}

void Megakernel::begin() {
  beginAt(picture.pixels.data());
}

void Megakernel::beginAt(float *to) {
  pixels = to;
  RtslStatus nothing{};
  nothing.printed = reinterpret_cast<RtslPrintedLines *>(printedAddress);
  upload(statusAddress, &nothing, sizeof nothing);
  if (!stepCounts.empty()) {
    stepCounts.assign(stepCounts.size(), {});
    upload(reinterpret_cast<Address>(job.stepCounts), stepCounts.data(),
           stepCounts.size() * sizeof stepCounts[0]);
  }
  job.samplesPerPixel = samplesOfPixel;
  if (sums) {
    job.pixels = nullptr;
    job.sums = placedSums;
    return;
  }
  job.pixels = reinterpret_cast<float *>(clearedPixels());
  leastTaken = 0;
  isUneven = false;
  ownPixels = openPixels = windowPixels;
  job.places = nullptr;
  if (samplesAtOnce(openPixels) < samplesOfPixel && options.wantsPicture)
    job.sums = clearedSums(windowPixels); // of a rendering that ends with its picture
  else
    job.sums = {};
}

void Megakernel::run(Watch &watch) {
  const std::uint64_t all = openPixels * (samplesOfPixel - leastTaken);
  std::uint64_t before = 0;
  kernelSeconds = 0;
  samplesOfSlice = 0;
  const auto share = [&](std::uint64_t samples) { return double(before + samples) / double(all); };
  while (leastTaken < samplesOfPixel && !watch.isStopped()) {
    job.firstSample = leastTaken;
    device::setSampleCount(job, std::min(samplesAtOnce(openPixels), samplesOfPixel - leastTaken));
    job.taken = isUneven ? job.sums.taken : nullptr;
    job.mayTakePixels = options.wantsPicture && !isUneven && !job.sums.closed &&
                        openPixels >= pixelsOfLane * samplesInFlight();
    runSlice(watch, share);
    const std::uint64_t whole = openPixels * job.sampleCount;
    before += whole;
    isUneven = isUneven || samplesOfSlice < whole;
    if (samplesOfSlice < whole)
      return;
    leastTaken += job.sampleCount;
    samplesOfSlice = 0;
  }
  isUneven = isUneven && leastTaken < samplesOfPixel;
}

/// Renders the slice of the job in short launches: a driver may abort long ones, and a GPU that
/// also drives a screen must be able to refresh it.
void Megakernel::runSlice(Watch &watch, const std::function<double(std::uint64_t)> &share) {
  const std::uint64_t none = 0, all = openPixels * job.sampleCount;
  const std::uint32_t isFalse = 0;
  const Address next = statusAddress + offsetof(RtslStatus, nextSample);
  upload(next, &none, sizeof none);
  upload(statusAddress + offsetof(RtslStatus, hasSums), &isFalse, sizeof isFalse);
  samplesOfSlice = 0;
  bool hasSums = false;
  while (samplesOfSlice < all && !watch.isStopped()) {
    upload(statusAddress + offsetof(RtslStatus, stop), &isFalse, sizeof isFalse);
    job.firstOfLaunch = std::uint32_t(samplesOfSlice);
    {
      const Watch::Poll poll(
          watch, launchSeconds(), [&] { return share(std::min(get(next), all)); },
          [&] { set(statusAddress + offsetof(RtslStatus, stop), 1); });
      kernelSeconds += runLanes(job);
    }
    if (printedAddress)
      takePrinted();
    RtslStatus status;
    download(&status, statusAddress, sizeof status);
    const std::uint64_t rendered = std::min(status.nextSample, all);
    if (status.problem != RTSL_PROBLEM_NONE)
      return; // finish() reports it
    samplesOfSlice = rendered;
    hasSums = status.hasSums;
  }
  if (options.wantsPicture && samplesOfSlice > 0 && !hasSums)
    kernelSeconds += addSamples(job);
}

RenderStatistics Megakernel::finish() {
  RtslStatus status;
  download(&status, statusAddress, sizeof status);
  RenderOptions ofRun = options;
  ofRun.samplesPerPixel = samplesOfPixel;
  const Window window = {job.left, job.top, job.left + job.width, job.top + job.height};
  RenderStatistics statistics = readStatus(status, ofRun, window);
  statistics.kernelSeconds = kernelSeconds;
  if (leastTaken == samplesOfPixel) {
    statistics.pixels = ownPixels;
    statistics.samples = openPixels * samplesOfPixel;
  } else { // pixels have samples of the slice in the order of their numbers
    statistics.samples = openPixels * leastTaken + samplesOfSlice;
    if (leastTaken + job.sampleCount == samplesOfPixel)
      statistics.pixels = ownPixels - openPixels + samplesOfSlice / job.sampleCount;
  }
  if (!stepCounts.empty()) {
    download(stepCounts.data(), reinterpret_cast<Address>(job.stepCounts),
             stepCounts.size() * sizeof stepCounts[0]);
    statistics.steps = stepCounts;
  }
  if (!sums)
    fetchPixels();
  for (const FlatScene::Output &output : outputs)
    download(output.elements, launchAddress() + output.offset, output.bytes);
  return statistics;
}

void Megakernel::uploadSums(const SampleCounts &counts) {
  placedSums = placeSums(*sums);
  for (const Rows &rows : keptRows)
    if (counts.samples == 0)
      clearSums(*sums, firstPixel(rows), pixelsOf(rows));
    else
      uploadRows(rows);
  leastTaken = counts.least;
  isUneven = counts.least < counts.most;
  placeOpenPixels();
}

void Megakernel::fetchSums() {
  for (const Rows &rows : keptRows)
    fetchRows(rows);
}

void Megakernel::uploadRows(const Rows &rows) {
  uploadSums(*sums, firstPixel(rows), pixelsOf(rows));
}

void Megakernel::fetchRows(const Rows &rows) {
  fetchSums(*sums, firstPixel(rows), pixelsOf(rows));
}

/// Lists the pixels that take samples, if others do not.
void Megakernel::placeOpenPixels() {
  job.places = nullptr;
  ownPixels = 0;
  for (const Rows &rows : keptRows)
    ownPixels += pixelsOf(rows);
  openPixels = ownPixels;
  if (ownPixels == windowPixels && !sums->isAdaptive())
    return;
  std::vector<std::uint32_t> places;
  places.reserve(ownPixels);
  for (const Rows &rows : keptRows)
    for (std::uint32_t place = rows.y0 * job.width; place < rows.y1 * job.width; ++place)
      if (!sums->isAdaptive() || sums->isOpen(device::pixelAt(job, place).number(job)))
        places.push_back(place);
  openPixels = places.size();
  if (openPixels == windowPixels || openPixels == 0)
    return;
  if (!placesAddress)
    placesAddress = allocate(pixelCount() * sizeof places[0], "the pixels that take samples");
  upload(placesAddress, places.data(), places.size() * sizeof places[0]);
  job.places = reinterpret_cast<const std::uint32_t *>(placesAddress);
  job.placeCount = std::uint32_t(places.size());
}

/// The samples of each of so many pixels in a slice. Fewer pixels leave room for more.
std::uint32_t Megakernel::samplesAtOnce(std::uint64_t pixels) const {
  const std::uint64_t most = mostInMemory / std::max<std::uint64_t>(pixels, 1);
  return std::uint32_t(std::min(most, mostInSlice));
}

} // namespace rtsl::runtime
