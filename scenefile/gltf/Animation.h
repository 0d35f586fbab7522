//===- Animation.h - key frames of a glTF file ----------------------------===//
//
// The nodes of a file as they are at a frame of the scene, and how they move during that frame.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/gltf/File.h"
#include "scenefile/gltf/Nodes.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::scene::gltf {

/// What of a file's animations a scene shows.
struct Play {
  std::string animation; // its name; empty: the first one
  double framesPerSecond = 24;
  double frame = 0;           // of the scene
  bool isDuringFrame = false; // the shutter is open: nodes move from this frame to the next
  std::optional<Place> place; // of the name
};

class Animation {
public:
  /// Warns of what is left out: other animations, and channels with no meaning here. Throws
  /// UnknownName (the animation), and for mistakes in it MissingKey, WrongType, OutOfRange,
  /// BadBuffer.
  Animation(const File &file, const Play &play, std::vector<Warning> &warnings);
  ~Animation();

  /// Whether anything changes from frame to frame.
  bool moves() const { return !nodes.empty(); }

  /// The motion of a node at the frame; `rest` is what it is without an animation.
  Motion at(std::size_t node, const Motion &rest) const;

  /// `transform` of the node in a scene file, if it moves during the frame.
  std::optional<JsonValue> transformOf(const JsonValue &node, std::size_t index,
                                       const Motion &rest) const;

  /// The weights of a node's morph targets at the frame; `rest` is what they are without an
  /// animation.
  std::vector<double> weightsAt(std::size_t node, const std::vector<double> &rest) const;

  /// `weights` of a mesh in a scene file, if they change during the frame.
  std::optional<JsonValue> weightsOf(const JsonValue &node, std::size_t index) const;

private:
  struct Channel;
  struct NodeChannels;

  void addChannel(const JsonValue &channel, const JsonValue &samplers, const std::string &what,
                  std::vector<Warning> &warnings);
  Motion at(std::size_t node, const Motion &rest, double frames) const;
  std::vector<float> timesOf(const std::vector<const Channel *> &channels) const;

  const File &file;
  const Play play;
  std::map<std::size_t, std::unique_ptr<NodeChannels>> nodes; // by index
};

} // namespace rtsl::scene::gltf
