//===- SettingsReader.cpp - size, samples, depth and seed -----------------===//
#include "scenefile/sections/SettingsReader.h"

#include "scenefile/files/BufferFiles.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

namespace rtsl::scene {

using Kind = JsonValue::Kind;

std::uint32_t launchSize(const std::string &buffer, std::size_t length) {
  if (length == 0 || length > runtime::mostLaunchWidth)
    throw Error(message::launchSizeOutOfRange(buffer, length, runtime::mostLaunchWidth));
  return static_cast<std::uint32_t>(length);
}

/// A launch with an index for each element of a buffer, by its name in `buffers` or as a member of
/// the ray generation. How many a file without a format has, setLaunchSizes() finds out.
static void readBufferSize(const JsonValue &name, RenderSettings &render,
                           const SceneDescription &scene, const JsonValue *rayGeneration) {
  const JsonValue *value = rayGeneration && rayGeneration->kind == Kind::Object
                               ? rayGeneration->find(name.string)
                               : nullptr;
  const std::string &called = value && value->kind == Kind::String ? value->string : name.string;
  if (const auto named = scene.buffers.find(called); named != scene.buffers.end())
    value = named->second;
  render.sizeBuffer = name.string;
  render.sizePlace = name.place();
  render.height = 1;
  if (value && value->kind == Kind::Array && !value->elements.empty()) {
    render.width = static_cast<std::uint32_t>(value->elements.size());
    return;
  }
  const auto buffer = value ? scene.bufferValues.find(value) : scene.bufferValues.end();
  if (buffer == scene.bufferValues.end())
    throw Error(message::noSuchSizeBuffer(name.string), name.place());
  try {
    if (const std::optional<std::size_t> length = lengthOf(buffer->second))
      render.width = launchSize(name.string, *length);
    else
      render.sizeFile = buffer->second.file;
  } catch (Error &error) {
    error.place = name.place();
    throw;
  }
}

/// Width, height and the number of slices of a launch of three dimensions.
static void readSlices(const JsonValue &size, RenderSettings &render) {
  readNumbers(size, 3, "`size`");
  render.width = readInteger(size.elements[0], 1, runtime::mostPixelsOfSide, "the width");
  const std::uint32_t height =
      readInteger(size.elements[1], 1, runtime::mostPixelsOfSide, "the height");
  render.slices =
      readInteger(size.elements[2], 1, runtime::mostPixelsOfSide, "the number of slices");
  const std::uint64_t rows = std::uint64_t(height) * render.slices;
  const auto checkCount = [&](std::uint64_t count, std::uint32_t most, const char *what) {
    if (count > most)
      throw Error(message::launchTooLarge(count, what, most), size.place());
  };
  checkCount(rows, runtime::mostLaunchRows, "rows in all slices");
  checkCount(rows * render.width, runtime::mostLaunchIndices, "launch indices");
  render.height = std::uint32_t(rows);
}

static void readSize(const JsonValue &size, RenderSettings &render, const SceneDescription &scene,
                     const JsonValue *rayGeneration) {
  render.slices = 1;
  render.sizeBuffer.clear();
  render.sizeFile.clear();
  if (size.kind == Kind::String) {
    readBufferSize(size, render, scene, rayGeneration);
  } else if (size.kind == Kind::Array && size.elements.size() == 1) {
    render.width = readInteger(size.elements[0], 1, runtime::mostLaunchWidth, "the size");
    render.height = 1;
  } else if (size.kind == Kind::Array && size.elements.size() == 3) {
    readSlices(size, render);
  } else {
    readNumbers(size, 2, "`size`");
    render.width = readInteger(size.elements[0], 1, runtime::mostPixelsOfSide, "the width");
    render.height = readInteger(size.elements[1], 1, runtime::mostPixelsOfSide, "the height");
  }
}

void readSettings(const JsonValue &value, RenderSettings &render, const SceneDescription &scene,
                  const JsonValue *rayGeneration, ErrorCollector &errors) {
  const auto setting = [&](const char *name, const auto &read) {
    if (const JsonValue *found = value.find(name))
      errors.attempt([&] { read(*found); });
  };
  setting("size", [&](const JsonValue &size) { readSize(size, render, scene, rayGeneration); });
  setting("spp", [&](const JsonValue &spp) {
    render.samplesPerPixel = readInteger(spp, 1, runtime::mostSamplesPerPixel, "`spp`");
    render.hasSamples = true;
  });
  setting("depth", [&](const JsonValue &depth) {
    render.depth = readInteger(depth, 0, runtime::maxRayDepth, "`depth`");
  });
  setting("seed",
          [&](const JsonValue &seed) { render.seed = readInteger(seed, 0, 0xffffffff, "`seed`"); });
}

} // namespace rtsl::scene
