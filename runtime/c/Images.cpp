//===- Images.cpp - images for samplers, for C ----------------------------===//
#include "runtime/c/Handle.h"
#include "runtime/image/Texels.h"
#include "runtime/scene/Samplers.h"
#include "scenefile/Models.h"
#include "scenefile/gltf/Textures.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace runtime = rtsl::runtime;
using rtsl::c::guarded;
using rtsl::c::requireChoice;

namespace {

runtime::Sampling samplingOf(const RtslSampling &given) {
  runtime::Sampling sampling;
  requireChoice(given.filter, RTSL_ANISOTROPIC + 1, "filter");
  sampling.filter = static_cast<runtime::Filter>(given.filter);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    requireChoice(given.wrap[axis], RTSL_BLACK + 1, "wrap");
    sampling.wrap[axis] = static_cast<runtime::Wrap>(given.wrap[axis]);
  }
  sampling.anisotropy = std::clamp(given.anisotropy, 1u, 256u);
  return sampling;
}

runtime::ColorSpace colorSpaceOf(const RtslSampling &given) {
  requireChoice(given.colorSpace, RTSL_SRGB + 1, "color space");
  return static_cast<runtime::ColorSpace>(given.colorSpace);
}

/// Of the last image of this thread.
std::uint64_t &numbersNotFinite() {
  static thread_local std::uint64_t numbers = 0;
  return numbers;
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
  numbersNotFinite() = runtime::dropNotFinite(texels).count;
  if (sampling.filter >= runtime::Filter::Trilinear && isRead("levelStarts"))
    runtime::addLevels(texels);
  return scene->scene.addObject(
      className,
      runtime::samplerValues(std::move(texels), sampling, isVolume, isRead("directionChances")));
}

/// Texels of a shape, without their words.
runtime::Texels texelsOf(const RtslTexelShape &shape) {
  constexpr runtime::TexelFormat formats[] = {
      runtime::TexelFormat::Unorm8, runtime::TexelFormat::Unorm16, runtime::TexelFormat::Float16,
      runtime::TexelFormat::Float32};
  requireChoice(shape.format, unsigned(std::size(formats)), "format of texels");
  const std::uint32_t channels = shape.channels;
  if (shape.width < 1 || shape.height < 1 || (channels != 1 && channels != 2 && channels != 4))
    throw rtsl::Error(rtsl::message::texelShape(shape.width, shape.height, channels));
  runtime::Texels texels;
  texels.format = formats[shape.format];
  texels.width = shape.width;
  texels.height = shape.height;
  texels.depth = std::max(shape.depth, 1u);
  texels.channels = channels;
  return texels;
}

} // namespace

extern "C" {

RtslSampling rtslSamplingDefaults(void) {
  const runtime::Sampling defaults;
  return {RTSL_TRILINEAR, {RTSL_REPEAT, RTSL_REPEAT, RTSL_REPEAT}, RTSL_AUTO, defaults.anisotropy};
}

RtslObject rtslSceneAddImage(RtslScene *scene, const char *const *files, size_t count, int isVolume,
                             const RtslSampling *sampling) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {files, "files"}}, [&] {
    if (count < 1 || (count > 1 && !isVolume))
      throw rtsl::Error(rtsl::message::imageFileCount(count));
    const RtslSampling given = sampling ? *sampling : rtslSamplingDefaults();
    std::vector<runtime::Pixels> slices;
    for (std::size_t i = 0; i < count; ++i)
      slices.push_back(runtime::readPixels(files[i], colorSpaceOf(given)));
    return addImage(scene, runtime::texelsOf(slices), given, isVolume != 0);
  });
}

RtslObject rtslSceneAddImagePart(RtslScene *scene, const char *path, const char *part,
                                 const RtslSampling *sampling) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {path, "path"}, {part, "part"}}, [&] {
    const RtslSampling given = sampling ? *sampling : rtslSamplingDefaults();
    const runtime::Pixels pixels =
        rtsl::scene::gltf::readImage(scene->openModels()->open(path), part, colorSpaceOf(given));
    return addImage(scene, runtime::texelsOf({pixels}), given, false);
  });
}

RtslObject rtslSceneAddRawImage(RtslScene *scene, const char *file, const RtslTexelShape *shape,
                                const RtslSampling *sampling) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {file, "file"}, {shape, "shape"}}, [&] {
    return addImage(scene, runtime::readRawTexels(file, texelsOf(*shape)),
                    sampling ? *sampling : rtslSamplingDefaults(), shape->depth != 0);
  });
}

RtslObject rtslSceneAddRawTexels(RtslScene *scene, const void *texels, const RtslTexelShape *shape,
                                 const RtslSampling *sampling) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {texels, "texels"}, {shape, "shape"}}, [&] {
    return addImage(scene, runtime::texelsOfBytes(texels, texelsOf(*shape)),
                    sampling ? *sampling : rtslSamplingDefaults(), shape->depth != 0);
  });
}

RtslObject rtslSceneAddTexels(RtslScene *scene, const float *numbers, uint32_t width,
                              uint32_t height, uint32_t depth, uint32_t channels,
                              const RtslSampling *sampling) {
  const RtslTexelShape shape = {RTSL_FLOAT32, width, height, depth, channels};
  return rtslSceneAddRawTexels(scene, numbers, &shape, sampling);
}

uint64_t rtslImageNumbersNotFinite(void) {
  return numbersNotFinite();
}

} // extern "C"
