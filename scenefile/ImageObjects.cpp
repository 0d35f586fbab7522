#include "scenefile/ImageObjects.h"

#include "scenefile/SceneFile.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <utility>

namespace rtsl::scene {

using runtime::MemberInfo;
using runtime::Program;

/// Null: the class has no such member, or the program no such class.
static const MemberInfo *memberOf(const Program &program, const std::string &className,
                                  const std::string &name) {
  if (const runtime::ClassInfo *one = program.find(className))
    for (const MemberInfo &member : one->members)
      if (member.name == name)
        return &member;
  return nullptr;
}

/// Whether the program reads a member of images of a class: `levelStarts` if it reads more than
/// level 0.
static bool readsOfImages(const Program &program, const std::string &className,
                          const std::string &name) {
  const MemberInfo *member = memberOf(program, className, name);
  return member && member->isRead;
}

static std::string sliceOf(const runtime::Texels &texels, const runtime::NotFiniteTexels &found) {
  return texels.depth == 1 ? std::string() : fmt::format(" of slice {}", found.slice);
}

ImageObjects::ImageObjects(const SceneDescription &description, runtime::Scene &scene)
    : description(description), scene(scene),
      files(
          description,
          [&](const std::string &className) {
            return readsOfImages(scene.program(), className, "levelStarts");
          },
          [&](const std::string &className, const std::string &name) {
            const MemberInfo *member = memberOf(scene.program(), className, name);
            return member ? member->imageChannels : MemberInfo::allChannels;
          }) {}

RtslRef ImageObjects::of(const JsonValue &image, const std::string &className,
                         const std::string &name) {
  const std::size_t number = files.numberOf(image);
  if (const auto found = made.find(number); found != made.end())
    return found->second;
  try {
    runtime::Texels texels = files.take(number);
    if (const runtime::NotFiniteTexels &found = files.notFinite(number); found.count != 0)
      scene.addWarning({message::imageNotFinite(name, found.count, found.value, found.channel,
                                                found.column, found.row, sliceOf(texels, found)),
                        image.place()});
    return made[number] =
               scene.addObject(className,
                               runtime::samplerValues(
                                   std::move(texels), description.imageValues.at(&image).sampling,
                                   className == "sampler3D",
                                   readsOfImages(scene.program(), className, "directionChances")),
                               name);
  } catch (const Error &caught) {
    Error error = caught;                       // which other mentions of the image catch, too
    if (!error.place || error.place->line == 0) // else it is in the model that has the image
      error.place = image.place();
    throw error;
  }
}

const runtime::NegativeTexels *ImageObjects::negativeOf(RtslRef object) const {
  for (const auto &[number, one] : made)
    if (one == object && files.negative(number).count != 0)
      return &files.negative(number);
  return nullptr;
}

} // namespace rtsl::scene
