//===- SceneReader.cpp - any bytes through the reader of scene files ------===//
//
// Lines `--set PATH=VALUE` at the beginning of an input are overrides; the rest is the scene.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "scenefile/SceneFile.h"
#include "support/Error.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

using namespace rtsl;
using fuzz::require;

namespace {

std::vector<std::string> takeOverrides(std::string_view &input) {
  constexpr std::string_view option = "--set ";
  std::vector<std::string> overrides;
  while (input.substr(0, option.size()) == option) {
    const std::size_t end = std::min(input.find('\n'), input.size());
    overrides.emplace_back(input.substr(option.size(), end - option.size()));
    input.remove_prefix(std::min(end + 1, input.size()));
  }
  return overrides;
}

/// A place counts lines and columns from 1; line 0 is a file as a whole.
void checkPlace(const Place &place, std::string_view text) {
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  if (place.file == "scene.json")
    require(place.line <= lines && (place.line == 0 || place.column > 0),
            "a place lies in the scene file");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char *>(data), size);
  const std::vector<std::string> overrides = takeOverrides(text);
  try {
    const scene::SceneDescription scene =
        scene::parseScene(std::string(text), "scene.json", overrides);
    for (const std::string &name : scene::classesUsed(scene))
      require(!name.empty(), "a class has a name");
    for (const scene::LocatedName &mention : scene::classMentions(scene))
      checkPlace(mention.place, text);
    scene::renderOptions(scene.render);
  } catch (const Error &error) {
    require(error.code != ErrorCode::Internal, "an error is the author's");
    require(error.what()[0] != '\0', "an error has a message");
    if (error.place)
      checkPlace(*error.place, text);
    for (const RelatedPlace &related : error.relatedPlaces)
      checkPlace(related.place, text);
  }
  return 0;
}
