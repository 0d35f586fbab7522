#include "runtime/scene/Samplers.h"

#include "runtime/scene/lights/DirectionChances.h"

#include <cstring>
#include <memory>
#include <utility>

namespace rtsl::runtime {

ObjectValues samplerValues(Texels texels, const Sampling &sampling, bool isVolume,
                           bool withDirections) {
  using Words = Value::Words;
  ObjectValues values;
  const auto set = [&](const char *name, Value value) {
    values.members.push_back({name, std::move(value)});
  };
  set("format", unsigned(texels.format));
  set("channels", texels.channels);
  set("width", texels.width);
  set("height", texels.height);
  if (isVolume)
    set("depth", texels.depth);
  set("wrapU", unsigned(sampling.wrap[0]));
  set("wrapV", unsigned(sampling.wrap[1]));
  if (isVolume)
    set("wrapW", unsigned(sampling.wrap[2]));
  set("filter", unsigned(sampling.filter));
  if (!isVolume)
    set("anisotropy", sampling.anisotropy);
  if (withDirections) {
    const std::vector<float> chances = directionChances(texels, sampling);
    auto words = std::make_shared<Words>(chances.size());
    if (!chances.empty())
      std::memcpy(words->data(), chances.data(), 4 * chances.size());
    set("directionChances", Value::block(std::move(words)));
  }
  set("levelCount", unsigned(texels.levelStarts.size()));
  set("levelStarts", Value::block(std::make_shared<Words>(std::move(texels.levelStarts))));
  set("texels", Value::block(std::make_shared<Words>(std::move(texels.words))));
  return values;
}

} // namespace rtsl::runtime
