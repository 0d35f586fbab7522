//===- ValueFiles.h - images and buffers in files, anywhere in a scene ----===//
#pragma once

#include "scenefile/SceneFile.h"
#include "support/ErrorCollector.h"

namespace rtsl::scene {

/// Finds the images and the buffers in files that are values anywhere in the scene, for
/// `scene.imageValues` and `scene.bufferValues`, and imports the classes of these images. Opens the
/// files of models, no others. Adds mistakes to `errors`.
void readValueFiles(const JsonValue &root, SceneDescription &scene, ErrorCollector &errors);

} // namespace rtsl::scene
