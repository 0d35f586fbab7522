//===- Models.cpp - models, their cameras, and lights in nodes, for C -----===//
#include "runtime/c/Handle.h"
#include "runtime/c/SceneFile.h"
#include "scenefile/ModelPart.h"
#include "scenefile/graph/NodeLights.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace runtime = rtsl::runtime;
namespace scene = rtsl::scene;
using rtsl::c::guarded;

namespace {

scene::ModelPlay playOf(const RtslScene &scene, const RtslAnimation *animation) {
  scene::ModelPlay play;
  play.isDuringFrame = scene.hasShutter;
  if (!animation)
    return play;
  play.animation = animation->name ? animation->name : "";
  play.framesPerSecond = animation->framesPerSecond;
  play.frame = animation->frame;
  return play;
}

/// Adds what `read` reads.
template <typename Read>
scene::AddedPart addPart(RtslScene &scene, Read read) {
  try {
    const scene::SceneDescription part = read();
    rtsl::c::requireLibraryClasses(part, scene.scene.program());
    return scene::addPart(part, scene.scene,
                          [&](const std::string &className, runtime::ObjectValues &values) {
                            scene.addVariables(className.c_str(), values);
                          });
  } catch (const rtsl::Error &error) {
    throw rtsl::c::inLines(error);
  }
}

/// The numbers of a member that is a vec3. `what` is for messages.
std::vector<double> vectorOf(const runtime::NamedValue &member) {
  std::vector<double> numbers;
  for (const runtime::Value &one : member.value.list)
    numbers.push_back(one.number);
  if (numbers.size() != 3)
    throw rtsl::Error(
        rtsl::message::numberCount(fmt::format("`{}`", member.name), 3,
                                   member.value.list.empty() ? 1 : member.value.list.size()));
  return numbers;
}

/// Makes the points and directions of a light those in world space.
void moveLight(const char *className, std::vector<runtime::NamedValue> &members,
               const runtime::Transform &toWorld) {
  const auto own = [&](const char *name) {
    return std::find_if(members.begin(), members.end(),
                        [&](const runtime::NamedValue &member) { return member.name == name; });
  };
  const auto valueOf = [&](const scene::SpatialMember &spatial) {
    const auto member = own(spatial.name);
    return member != members.end()
               ? vectorOf(*member)
               : std::vector<double>(spatial.otherwise.begin(), spatial.otherwise.end());
  };
  for (const scene::PlacedMember &placed :
       scene::placedMembers({className, {}}, toWorld, valueOf)) {
    auto member = own(placed.name);
    if (member == members.end())
      member = members.insert(member, {placed.name, 0.0});
    member->value = rtsl::c::valueOf(placed.value.data(), placed.value.size());
  }
}

} // namespace

extern "C" {

int rtslSceneAddModel(RtslScene *scene, const char *path, const RtslAnimation *animation) {
  return guarded(0, {{scene, "scene"}, {path, "path"}}, [&] {
    const runtime::Placement placement = scene->takePlacement();
    scene::InstanceDescription above;
    static_cast<runtime::Placement &>(above) = scene->inNode(placement);
    above.inPart = std::make_shared<const runtime::MovingTransform>(placement.transform);
    const scene::AddedPart added = addPart(*scene, [&] {
      return scene::modelPart(path, playOf(*scene, animation), above, scene->openModels());
    });
    for (const scene::PartInstance &instance : added.instances) {
      runtime::Placement placed;
      placed.transform = instance.inPart;
      scene->noteInstance(instance.number, placed);
    }
    return 1;
  });
}

RtslObject rtslSceneAddModelCamera(RtslScene *scene, const char *path, const char *name,
                                   const RtslAnimation *animation) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {path, "path"}}, [&] {
    const runtime::MovingTransform transform = scene->inNode(scene->takePlacement().transform);
    if (transform.moves())
      throw rtsl::Error(rtsl::message::movingCamera());
    return addPart(*scene,
                   [&] {
                     return scene::modelCameraPart(path, name ? name : "",
                                                   playOf(*scene, animation), transform.still(),
                                                   scene->openModels());
                   })
        .camera;
  });
}

RtslObject rtslSceneAddNodeLight(RtslScene *scene, const char *className) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {className, "className"}}, [&]() -> RtslObject {
    const runtime::MovingTransform toWorld = scene->inNode(scene->takePlacement().transform);
    runtime::ObjectValues values;
    values.members = std::exchange(scene->members, {});
    if (toWorld.moves())
      throw rtsl::Error(rtsl::message::movingLight());
    moveLight(className, values.members, toWorld.still());
    scene->addVariables(className, values);
    const RtslObject light = scene->scene.addObject(className, values);
    scene->scene.addLight(light);
    return light;
  });
}

} // extern "C"
