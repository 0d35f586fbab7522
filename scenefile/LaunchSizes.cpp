#include "scenefile/LaunchSizes.h"

#include "scenefile/sections/SettingsReader.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"

#include <filesystem>

namespace rtsl::scene {

using Kind = JsonValue::Kind;

/// The member that takes the buffer; empty: none does.
static std::string memberThatTakes(const std::string &buffer, const ObjectDescription &object) {
  for (const auto &[name, value] : object.members)
    if (name.text == buffer || (value->kind == Kind::String && value->string == buffer))
      return name.text;
  return {};
}

/// Without reading it, unless it has no size.
static std::uint64_t sizeOfFile(const std::string &file) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  return error ? readFile(file).size() : size;
}

static void setLaunchSize(RenderSettings &render, const ObjectDescription *rayGeneration,
                          const FindBuffer &findBuffer) {
  if (render.sizeFile.empty())
    return;
  try {
    BufferMember buffer;
    if (rayGeneration)
      buffer = findBuffer(rayGeneration->className.text,
                          memberThatTakes(render.sizeBuffer, *rayGeneration));
    if (buffer.dimensions != 1 || buffer.elementBytes == 0)
      throw Error(message::shapeMissing(render.sizeFile));
    render.width = launchSize(render.sizeBuffer, sizeOfFile(render.sizeFile) / buffer.elementBytes);
    render.sizeFile.clear();
  } catch (Error &error) {
    error.place = render.sizePlace;
    throw;
  }
}

void setLaunchSizes(SceneDescription &description, const FindBuffer &findBuffer) {
  for (PassDescription &pass : description.passes)
    setLaunchSize(pass.render, &pass.rayGeneration, findBuffer);
  if (description.passes.empty())
    setLaunchSize(description.render,
                  description.rayGeneration ? &*description.rayGeneration : nullptr, findBuffer);
  else
    description.render = description.passes.back().render;
}

} // namespace rtsl::scene
