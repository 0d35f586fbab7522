//===- Images.cpp - images for samplers, for C ----------------------------===//
#include "runtime/c/Handle.h"
#include "runtime/image/Texels.h"
#include "runtime/scene/Samplers.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cstring>

namespace runtime = rtsl::runtime;
using rtsl::c::guarded;

namespace {

runtime::Sampling samplingOf(const RtslSampling &given) {
  runtime::Sampling sampling;
  sampling.filter = static_cast<runtime::Filter>(given.filter);
  for (std::size_t axis = 0; axis < 3; ++axis)
    sampling.wrap[axis] = static_cast<runtime::Wrap>(given.wrap[axis]);
  sampling.anisotropy = std::clamp(given.anisotropy, 1u, 256u);
  return sampling;
}

RtslObject addImage(RtslScene *scene, runtime::Texels texels, const RtslSampling &given,
                    bool isVolume) {
  const char *className = isVolume ? "sampler3D" : "sampler2D";
  const runtime::ClassInfo *info = scene->scene.program().find(className);
  if (!info)
    throw rtsl::Error(rtsl::message::noSamplersInShaders(className));
  const auto isRead = [&](const char *name) {
    return std::any_of(info->members.begin(), info->members.end(),
                       [&](const auto &member) { return member.name == name && member.isRead; });
  };
  const runtime::Sampling sampling = samplingOf(given);
  runtime::dropNotFinite(texels);
  if (sampling.filter >= runtime::Filter::Trilinear && isRead("levelStarts"))
    runtime::addLevels(texels);
  return scene->scene.addObject(
      className,
      runtime::samplerValues(std::move(texels), sampling, isVolume, isRead("directionChances")));
}

} // namespace

extern "C" {

RtslSampling rtslSamplingDefaults(void) {
  const runtime::Sampling defaults;
  return {RTSL_TRILINEAR, {RTSL_REPEAT, RTSL_REPEAT, RTSL_REPEAT}, RTSL_AUTO, defaults.anisotropy};
}

RtslObject rtslSceneAddImage(RtslScene *scene, const char *const *files, size_t count, int isVolume,
                             const RtslSampling *sampling) {
  return guarded<RtslObject>(0, [&] {
    if (count < 1 || (count > 1 && !isVolume))
      throw rtsl::Error(rtsl::message::imageFileCount(count));
    const RtslSampling given = sampling ? *sampling : rtslSamplingDefaults();
    std::vector<runtime::Pixels> slices;
    for (std::size_t i = 0; i < count; ++i)
      slices.push_back(
          runtime::readPixels(files[i], static_cast<runtime::ColorSpace>(given.colorSpace)));
    return addImage(scene, runtime::texelsOf(slices), given, isVolume != 0);
  });
}

RtslObject rtslSceneAddTexels(RtslScene *scene, const float *numbers, uint32_t width,
                              uint32_t height, uint32_t depth, uint32_t channels,
                              const RtslSampling *sampling) {
  return guarded<RtslObject>(0, [&] {
    if (width < 1 || height < 1 || (channels != 1 && channels != 2 && channels != 4))
      throw rtsl::Error(rtsl::message::texelShape(width, height, channels));
    runtime::Texels texels;
    texels.width = width;
    texels.height = height;
    texels.depth = std::max(depth, 1u);
    texels.channels = channels;
    const double words = double(width) * height * texels.depth * channels;
    if (words > 2147483647)
      throw rtsl::Error(rtsl::message::texelsTooMany(width, height, texels.depth));
    texels.words.resize(std::size_t(words));
    std::memcpy(texels.words.data(), numbers, 4 * texels.words.size());
    return addImage(scene, std::move(texels), sampling ? *sampling : rtslSamplingDefaults(),
                    depth != 0);
  });
}

} // extern "C"
