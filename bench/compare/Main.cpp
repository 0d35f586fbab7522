//===- Main.cpp - how far two pictures are apart --------------------------===//
//
// bench-compare A B: writes the mean of each channel of both pictures and their difference to
// standard output, as JSON.
//
//===----------------------------------------------------------------------===//
#include "runtime/Image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <vector>

namespace runtime = rtsl::runtime;

namespace {

/// One mean a channel.
std::vector<double> means(const runtime::Image &image) {
  std::vector<double> sums(image.channels, 0.0);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    sums[i % image.channels] += image.pixels[i];
  for (double &sum : sums)
    sum /= double(image.width) * image.height;
  return sums;
}

} // namespace

int main(int argc, char **argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: bench-compare A.exr B.exr\n");
    return 2;
  }
  try {
    const runtime::Image a = runtime::readImage(argv[1]), b = runtime::readImage(argv[2]);
    const runtime::ImageDifference difference = runtime::compareImages(a, b);
    const nlohmann::ordered_json document = {{"means", {means(a), means(b)}},
                                             {"rootMeanSquare", difference.rootMeanSquare},
                                             {"largest", difference.largest},
                                             {"pixels", std::size_t(a.width) * a.height},
                                             {"pixelsThatDiffer", difference.pixelsThatDiffer}};
    fmt::print("{}\n", document.dump(2));
    return 0;
  } catch (const std::exception &error) {
    fmt::print(stderr, "bench-compare: {}\n", error.what());
    return 1;
  }
}
