//===- CompareCommand.cpp - rtslc compare ---------------------------------===//
#include "report/measures/ErrorMetrics.h"
#include "report/measures/Flip.h"
#include "runtime/image/Image.h"
#include "tools/common/OptionValues.h"
#include "tools/common/Output.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <memory>

namespace rtsl::tool {

namespace {

enum class Metric : std::uint8_t { Rmse, RelMse, Flip, FlipHdr };
const Choices<Metric> metrics = {{"rmse", Metric::Rmse},
                                 {"relmse", Metric::RelMse},
                                 {"flip", Metric::Flip},
                                 {"flip-hdr", Metric::FlipHdr}};

struct CompareOptions {
  CommonOptions common;
  std::string reference, test;
  Metric metric = Metric::Rmse;
  double threshold = 0;
  bool json = false;
};

/// Everything that is said of two pictures.
struct Comparison {
  report::ErrorMetrics error;
  report::FlipExposures exposures;
  double flip = 0, flipHdr = 0;
  bool isEqualEnough = false;

  double value(Metric metric) const {
    switch (metric) {
    case Metric::Rmse:
      return error.rmse;
    case Metric::RelMse:
      return error.relMse;
    case Metric::Flip:
      return flip;
    case Metric::FlipHdr:
      return flipHdr;
    }
    return std::numeric_limits<double>::infinity();
  }
};

/// One mean a channel, which is how scripts see that a picture has become darker.
std::vector<double> meansOf(const runtime::Image &image) {
  std::vector<double> sums(image.channels, 0.0);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    sums[i % image.channels] += image.pixels[i];
  for (double &sum : sums)
    sum /= double(image.width) * image.height;
  return sums;
}

Comparison comparePictures(const runtime::Image &reference, const runtime::Image &test,
                           const CompareOptions &options) {
  Comparison comparison;
  comparison.error = report::measureError(reference, test);
  const runtime::Image a = runtime::toRgb(reference), b = runtime::toRgb(test);
  comparison.exposures = report::exposuresFor(a);
  if (comparison.error.pixelsThatDiffer) { // otherwise both are 0, without the work
    comparison.flip = report::flip(a, b).mean();
    comparison.flipHdr = report::flipHdr(a, b, comparison.exposures).mean();
  }
  // A threshold of 0 requires the same bits; a difference that is not a number is never small
  // enough.
  comparison.isEqualEnough = options.threshold == 0
                                 ? comparison.error.pixelsThatDiffer == 0
                                 : comparison.error.incomparable == 0 &&
                                       comparison.value(options.metric) <= options.threshold;
  return comparison;
}

void printJson(const CompareOptions &options, const Comparison &comparison,
               const runtime::Image &reference, const runtime::Image &test) {
  const report::ErrorMetrics &error = comparison.error;
  const nlohmann::ordered_json document = {{"version", 2},
                                           {"size", {test.width, test.height}},
                                           {"means", {meansOf(reference), meansOf(test)}},
                                           {"rmse", error.rmse},
                                           {"relMse", error.relMse},
                                           {"bias", error.bias},
                                           {"largest", error.largest},
                                           {"flip", comparison.flip},
                                           {"flipHdr", comparison.flipHdr},
                                           {"exposures",
                                            {{"first", comparison.exposures.first},
                                             {"last", comparison.exposures.last},
                                             {"count", comparison.exposures.count}}},
                                           {"pixelsThatDiffer", error.pixelsThatDiffer},
                                           {"incomparablePixels", error.incomparable},
                                           {"nanPixels", error.nanPixels},
                                           {"infinitePixels", error.infinitePixels},
                                           {"threshold", options.threshold},
                                           {"equalEnough", comparison.isEqualEnough}};
  printOut(document.dump(2) + "\n");
}

void printText(const Comparison &comparison) {
  const report::ErrorMetrics &error = comparison.error;
  if (error.pixelsThatDiffer == 0) {
    printOut("the pictures are the same, bit for bit\n");
    return;
  }
  std::string text =
      fmt::format("RMSE      {:.6g}\nrelMSE    {:.6g}\nbias      {:+.6g}\nlargest   {:.6g}\nFLIP   "
                  "   {:.6g}\nHDR-FLIP  {:.6g} ({} "
                  "exposures, {:+.2f} to {:+.2f} stops)\n{} pixels differ\n",
                  error.rmse, error.relMse, error.bias, error.largest, comparison.flip,
                  comparison.flipHdr, comparison.exposures.count, comparison.exposures.first,
                  comparison.exposures.last, error.pixelsThatDiffer);
  if (error.nanPixels || error.infinitePixels)
    text += fmt::format("in the second picture, {} pixels are NaN and {} infinite\n",
                        error.nanPixels, error.infinitePixels);
  if (error.incomparable)
    text += fmt::format("{} pixels are not finite in one picture or both, and differ: the figures "
                        "above do not include them\n",
                        error.incomparable);
  printOut(text);
}

int compare(const CompareOptions &options) {
  Messages messages(options.common);
  try {
    const runtime::Image reference = runtime::readImage(options.reference);
    const runtime::Image test = runtime::readImage(options.test);
    const Comparison comparison = comparePictures(reference, test, options);
    if (options.json)
      printJson(options, comparison, reference, test);
    else
      printText(comparison);
    return comparison.isEqualEnough ? Fine : Diagnosed;
  } catch (const Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addCompareCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App *command = app.add_subcommand(compareSummary.command, compareSummary.text);
  command
      ->add_option("REFERENCE", options->reference, "a picture, .png or .exr; - is standard input")
      ->required();
  command->add_option("TEST", options->test, "a picture of the same size")->required();
  addNotNegative(*command, "--threshold", options->threshold,
                 "largest error allowed; 0: the same bits");
  addChoice(*command, "--metric", options->metric, metrics,
            "the error metric of the threshold; default rmse");
  command->add_flag("--json", options->json, "write the figures as JSON");
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc compare embree.exr device.exr --threshold 1e-4");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

} // namespace rtsl::tool
