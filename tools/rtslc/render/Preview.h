//===- Preview.h - a standard scene that shows one class ------------------===//
//
// `rtslc render Clay.rtsl` renders a scene of library/preview with an object of the file's class in
// the place of the one that shows its kind: a ball of the material, a picture by the camera, ...
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "tools/rtslc/common/Messages.h"

#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

/// Whether a file holds shaders, by its name.
bool holdsShaders(const std::string &file);

struct PreviewRequest {
  std::string file;                   // RTSL
  std::string className;              // empty: the last class of the file that can be shown
  std::vector<std::string> overrides; // --set: `Clay.tint=...` means the object shown
};

struct Preview {
  scene::SceneDescription description;
  std::string file; // of library/preview
  /// Names that the author's files give to something of their own: the library's are renamed
  /// (SourceLoader.h).
  std::vector<std::string> takenNames;
};

/// Checks the file and makes the scene. References that a scene must set are to objects of the
/// library. Nothing if there are errors, which are reported. Throws Error for mistakes in
/// overrides.
std::optional<Preview> makePreview(const PreviewRequest &request, const CommonOptions &options,
                                   Messages &messages);

} // namespace rtsl::tool
