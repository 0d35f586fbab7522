//===- ModelPart.h - models as parts of scenes that programs build --------===//
//
// What `"model"` says in a scene file, for a scene that is not of a file. A part is read as a scene
// file is, and added to a scene by addPart (SceneFile.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/Models.h"
#include "scenefile/SceneFile.h"

#include <memory>
#include <string>

namespace rtsl::scene {

/// What a model shows: as `animation` and `fps` beside a model, `frame` of a scene, and whether it
/// has a `shutter`.
struct ModelPlay {
  std::string animation;      // empty: the first one
  double framesPerSecond = 0; // 0: the default
  double frame = 0;
  bool isDuringFrame = false;
};

/// The nodes, materials and lights of a glTF or OBJ file. `above`: what is above its nodes, of
/// which `inPart` is that of the space in which they may be moved later. Throws the mistakes in the
/// file.
SceneDescription modelPart(const std::string &path, const ModelPlay &play,
                           const InstanceDescription &above, std::shared_ptr<ModelFiles> models);

/// The model's camera of this name (empty: the first), with a transform as beside `"model"`.
SceneDescription modelCameraPart(const std::string &path, const std::string &name,
                                 const ModelPlay &play, const runtime::Transform &transform,
                                 std::shared_ptr<ModelFiles> models);

} // namespace rtsl::scene
