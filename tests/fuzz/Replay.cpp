//===- Replay.cpp - runs a fuzzer's target on files -----------------------===//
//
//   TARGET FILE-OR-FOLDER...
//
// The first input that crashes, aborts or takes longer than ten seconds of processor time ends the
// run; its name is the last line of the output. (Under sanitizers leaks fail it as well, at the
// end.)
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace fs = std::filesystem;

static std::vector<fs::path> filesIn(const fs::path &path) {
  if (!fs::is_directory(path))
    return {path};
  std::vector<fs::path> files;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file())
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// False if the file cannot be read or takes too long.
static bool replay(const fs::path &path) {
  std::printf("%s\n", path.c_str());
  std::fflush(stdout); // the name of an input that crashes must be seen
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) {
    std::printf("cannot be read\n");
    return false;
  }
  // A copy that ends where the input ends: a sanitizer sees what reads beyond it.
  const std::unique_ptr<std::uint8_t[]> bytes(new std::uint8_t[text.size()]);
  std::copy(text.begin(), text.end(), bytes.get());
  const std::clock_t begin = std::clock();
  LLVMFuzzerTestOneInput(bytes.get(), text.size());
  constexpr double limit = 10;
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (seconds > limit)
    std::printf("takes %.1f s; an input should take less than %.0f\n", seconds, limit);
  return seconds <= limit;
}

int main(int argc, char **argv) {
  try {
    std::size_t count = 0;
    for (int i = 1; i < argc; ++i)
      for (const fs::path &path : filesIn(argv[i])) {
        if (!replay(path))
          return 1;
        ++count;
      }
    std::printf("%zu inputs\n", count);
    return count == 0 ? 1 : 0;
  } catch (const std::exception &error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
