//===- CompareCommand.cpp - rtslc compare ---------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "runtime/Image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace rtsl::tool {

namespace {

struct CompareOptions {
  CommonOptions common;
  std::string first, second;
  double threshold = 0;
  bool json = false;
};

void print(const CompareOptions &options, const runtime::ImageDifference &difference, bool isEqualEnough) {
  if (options.json) {
    const nlohmann::ordered_json document = {{"version", 1},
                                             {"rmse", difference.rootMeanSquare},
                                             {"largest", difference.largest},
                                             {"pixelsThatDiffer", difference.pixelsThatDiffer},
                                             {"threshold", options.threshold},
                                             {"equalEnough", isEqualEnough}};
    fmt::print("{}\n", document.dump(2));
    return;
  }
  if (difference.pixelsThatDiffer == 0)
    fmt::print("the pictures are the same, bit for bit\n");
  else
    fmt::print("RMSE {:.6g}, largest difference {:.6g}, {} pixels differ\n", difference.rootMeanSquare,
               difference.largest, difference.pixelsThatDiffer);
}

int compare(const CompareOptions &options) {
  Messages messages(options.common);
  try {
    const runtime::Image first = runtime::readImage(options.first);
    const runtime::Image second = runtime::readImage(options.second);
    const runtime::ImageDifference difference = runtime::compareImages(first, second);
    // A threshold of 0 asks for the same bits; a difference that is not a number is never small enough.
    const bool isEqualEnough = options.threshold == 0 ? difference.pixelsThatDiffer == 0
                                                      : difference.rootMeanSquare <= options.threshold;
    print(options, difference, isEqualEnough);
    return isEqualEnough ? Fine : Diagnosed;
  } catch (const runtime::Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addCompareCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App *command = app.add_subcommand(compareSummary.command, compareSummary.text);
  command->add_option("A", options->first, "a picture, .png or .exr")->required();
  command->add_option("B", options->second, "another of the same size")->required();
  command->add_option("--threshold", options->threshold, "largest root mean square error; 0: the same bits")
      ->check(CLI::NonNegativeNumber)
      ->type_name("X");
  command->add_flag("--json", options->json, "write the figures as JSON");
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc compare embree.exr device.exr --threshold 1e-4");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

} // namespace rtsl::tool
