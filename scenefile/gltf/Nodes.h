//===- Nodes.h - the nodes of a glTF file's scene -------------------------===//
#pragma once

#include "runtime/geometry/Transform.h"
#include "scenefile/gltf/File.h"
#include "scenefile/gltf/Parts.h"

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace rtsl::scene::gltf {

/// A node that the scene leads to.
struct Node {
  std::size_t index = 0;                 // in `nodes`
  std::size_t parent = 0;                // 1 + its index in the list of these; 0: a root
  runtime::Transform transform, toWorld; // at the frame of the scene
  std::optional<JsonValue> moving; // `transform` of a scene file, if it moves during the frame
  const JsonValue *json = nullptr;
  std::string what; // for messages: `nodes.3`
};

class Animation;

/// The nodes of the scene that the file shows, parents before children; without a scene, all.
/// Throws, for all mistakes at once, ReferenceCycle, OutOfRange, WrongType.
std::vector<Node> nodesOf(const File &file, const Animation &animation);

/// Translation, rotation and scale of a node, or of a key frame of it. `rotation` is a quaternion,
/// w last, of any length but 0.
struct Motion {
  std::vector<double> translation{0, 0, 0}, rotation{0, 0, 0, 1}, scale{1, 1, 1};

  runtime::Transform transform() const;
};

/// The motion of a node without a matrix. Throws WrongType, OutOfRange.
Motion motionOf(const JsonValue &node, const std::string &what);

/// The `name` of an element; empty: it has none.
std::string nameOf(const JsonValue &element);

/// What the elements of a list are called: their name if no other has it, and else their place,
/// such as "nodes.3".
class Labels {
public:
  Labels(const File &file, const char *list);
  std::string of(std::size_t index) const;

private:
  const std::vector<JsonValue> &elements;
  const std::string start; // "nodes."
  std::unordered_map<std::string, std::size_t> counts;
};

/// The box around everything that the scene shows; nothing if it shows nothing.
struct Box {
  std::array<double, 3> low, high;
};
std::optional<Box> boxOf(const File &file, const Animation &animation);

/// `camera` of a scene: the camera of this name (empty: the first one that a node has); without a
/// camera and a name one that frames the scene. `transform` moves it. `source` is the mention.
/// Throws UnknownName.
JsonValue cameraOf(const File &file, const Animation &animation, const std::string &name,
                   const runtime::Transform &transform, const JsonValue &source, Modules &modules);

/// `light` of a node: an object of the standard library, in the node's space.
JsonValue lightOf(const File &file, const JsonValue &number, const std::string &what,
                  Modules &modules, std::vector<Warning> &warnings);

} // namespace rtsl::scene::gltf
