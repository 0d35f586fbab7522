//===- Buffers.h - the buffers that a package reads and writes ------------===//
//
// The buffers of a packed scene's ray generation, by name: `rtsl-run --in` replaces their elements,
// and `--out` writes them to files after the launch.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/FlatScene.h"
#include "runtime/program/Program.h"
#include "runtime/render/RenderOptions.h"
#include "runtime/scene/SceneData.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::runtime {

/// A buffer member of the ray generation.
struct PackageBuffer {
  std::string name;            // of the member
  std::string sceneName;       // of the buffer in the scene's `buffers`; empty: it has none
  ValueType type;              // not a reference
  std::optional<Range> values; // which the numbers of its elements may have
  std::uint64_t place = 0;     // of its RtslBuffer in the flat scene
  bool hasLaunchSize = false;  // an output buffer with an element for each launch index
  bool setsLaunchSize = false; // the launch has an index for each of its elements

  bool isNamed(const std::string &wanted) const { return name == wanted || sceneName == wanted; }
};

/// Conversion to bytes, and back. Throws std::bad_alloc, and returns false if the bytes are
/// damaged.
std::string serialize(const std::vector<PackageBuffer> &buffers);
bool parse(std::string_view bytes, std::vector<PackageBuffer> &buffers);

/// Whether the scene holds the buffer with all of its elements.
bool isWithin(const FlatScene &scene, const PackageBuffer &buffer);

/// The flat scene of a package with the buffers of one launch.
class LaunchBuffers {
public:
  /// `buffers` must stay as they are.
  LaunchBuffers(FlatScene scene, const std::vector<PackageBuffer> &buffers);

  /// Throws UnknownName, with a suggestion. `option` begins the message.
  const PackageBuffer &find(const std::string &name, const char *option) const;
  /// Replaces the elements by those of a file. Throws the errors of reading it.
  void read(const PackageBuffer &buffer, const std::string &file);
  /// Gives buffers that have the size of the launch this one, and makes memory for the outputs.
  void setSize(const RenderOptions &options);
  /// The size of the first dimension.
  std::uint32_t lengthOf(const PackageBuffer &buffer) const;

  const FlatScene &scene() const { return flat; }
  /// The buffer after the launch. Throws NotSupported if the launch only reads the buffer.
  OutputBuffer output(const PackageBuffer &buffer);

private:
  RtslBuffer header(const PackageBuffer &buffer) const;
  void replace(const PackageBuffer &buffer, const std::vector<std::uint32_t> &sizes,
               const std::uint32_t *words, std::uint64_t bytes);

  FlatScene flat;
  const std::vector<PackageBuffer> &buffers;
  std::vector<std::vector<std::uint8_t>> memory; // of outputs, in the order of `buffers`
};

} // namespace rtsl::runtime
