//===- SceneShaders.h - the shaders that a scene file names ---------------===//
#pragma once

#include "Messages.h"
#include "codegen/driver/Compiler.h"
#include "scenefile/SceneFile.h"
#include "sema/typed/TypedAst.h"
#include "support/ErrorCollector.h"

#include <memory>

namespace rtsl::tool {

/// Reads a scene file, or makes a scene of a glTF file; "-" is standard input. Throws with a hint
/// if it is given RTSL; `command` is for that. `kept`: files of scenes before this one. `errors`:
/// as for scene::readSceneFile().
scene::SceneDescription readScene(const std::string &file,
                                  const std::vector<std::string> &overrides, Messages &messages,
                                  const char *command,
                                  const std::shared_ptr<scene::KeptFiles> &kept = nullptr,
                                  ErrorCollector *errors = nullptr);

/// Reads and checks the files that the scene imports; null if there were errors. They find what
/// they include in the scene's folder too. `filesRead`, unless null, gets the scene and all shader
/// files. `takenNames` are renamed in the library (SourceLoader.h). `otherMentions`: classes that
/// the scene does not use as it is described, but that are to be in the module, too. Sizes of
/// launches that depend on their types are set (LaunchSizes.h). `errors` gets the mentions of
/// classes and members that there are not, which are then SceneDescription::refused; null: they are
/// thrown.
std::unique_ptr<typed::Module> loadShaders(
    scene::SceneDescription &description, const CommonOptions &options, Messages &messages,
    std::vector<std::string> *filesRead = nullptr, const std::vector<std::string> &takenNames = {},
    const std::vector<scene::LocatedName> &otherMentions = {}, ErrorCollector *errors = nullptr);

/// All files that the scene is made of, for -MD and so that none is overwritten: `filesRead` and
/// meshes, images and buffers.
std::vector<std::string> withFiles(const scene::SceneDescription &description,
                                   std::vector<std::string> filesRead);

/// The request for the linker: which classes the scene has objects of, and which materials meet
/// which primitives.
LinkRequest linkRequest(const scene::SceneDescription &description);

} // namespace rtsl::tool
