//===- Handle.h - what a scene of the C interface holds -------------------===//
#pragma once

#include "rtsl/rtsl.h"
#include "rtsl/runtime.h"

#include <cstdint>
#include <exception>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {
class ModelFiles;
}

struct RtslScene {
  explicit RtslScene(std::shared_ptr<const rtsl::runtime::Program> program)
      : scene(std::move(program)) {}
  explicit RtslScene(rtsl::runtime::Scene &&scene) : scene(std::move(scene)) {}

  rtsl::runtime::Scene scene;
  std::vector<rtsl::runtime::NamedValue> arguments, members; // of the next object
  rtsl::runtime::Placement placement;                        // of the next instance
  std::uint32_t roots = 1;                                   // of the next instances
  bool hasShutter = false;                                   // it opens and closes
  bool areBarycentric = false; // the texture coordinates of the next meshes
  std::vector<rtsl::runtime::NamedAttribute> attributes; // of the next mesh

  /// The placement of the instance that is being added; the one after it has none.
  rtsl::runtime::Placement takePlacement();
  /// The glTF and OBJ files that were opened.
  const std::shared_ptr<rtsl::scene::ModelFiles> &openModels();
  /// What the shaders read of the files of meshes.
  rtsl::runtime::MeshRequest meshRequest() const;
  rtsl::runtime::Mesh loadMesh(const char *path) const;
  /// Leaves out those of its file where they are barycentric.
  void setTextureCoordinates(rtsl::runtime::Mesh &mesh) const;
  /// Gives a mesh the attributes that were set for it. `name` is for messages.
  void giveAttributes(rtsl::runtime::Mesh &mesh, const char *name);
  /// Adds an instance below the node that is entered.
  void addMeshInstance(std::uint32_t mesh, RtslObject material);

  //===--------------------------------------------------------------------===//
  // Nodes (Nodes.cpp)
  //===--------------------------------------------------------------------===//

  struct Node {
    std::uint32_t parent; // as RtslNode; 0: the scene
    rtsl::runtime::MovingTransform transform;
  };
  std::vector<Node> nodes;                                           // the first is number 1
  std::uint32_t entered = 0;                                         // the innermost
  std::vector<std::vector<rtsl::runtime::NamedValue>> variables{{}}; // of the scene, and inwards
  /// For instances below nodes: the node, and the transform in it.
  std::map<std::uint32_t, std::pair<std::uint32_t, rtsl::runtime::MovingTransform>> inNodes;

  /// The transform from the space of a node to world space.
  rtsl::runtime::MovingTransform toWorld(std::uint32_t node) const;
  rtsl::runtime::MovingTransform inNode(const rtsl::runtime::MovingTransform &transform) const;
  rtsl::runtime::Placement inNode(rtsl::runtime::Placement placement) const;
  /// An instance that has been added; `placement`: in the node that is entered.
  void noteInstance(std::uint32_t instance, const rtsl::runtime::Placement &placement);
  /// Adds the nearest variables that members of the class take.
  void addVariables(const char *className, rtsl::runtime::ObjectValues &values) const;

  //===--------------------------------------------------------------------===//
  // Rendering (Launch.cpp)
  //===--------------------------------------------------------------------===//

  std::vector<std::shared_ptr<rtsl::runtime::Value::Words>> buffers; // the first is number 1
  std::map<std::uint32_t, std::vector<float>> mappedVertices;        // by mesh
  /// Of the last rendering, whose trees the next one uses.
  mutable std::unique_ptr<rtsl::runtime::Renderer> renderer;
  mutable RtslRenderSettings settings{};
  mutable bool hadPicture = false;
  /// Ends the renderer, before the program or the scene that it runs; its trees are kept.
  void stopRendering();

  //===--------------------------------------------------------------------===//
  // Scene files (SceneFile.cpp)
  //===--------------------------------------------------------------------===//

  std::shared_ptr<rtsl::scene::ModelFiles> models;       // of parts of meshes; null: none yet
  std::string file;                                      // empty: the scene is of none
  std::shared_ptr<const rtsl::runtime::Program> program; // of such a scene
  std::vector<RtslRenderSettings> passes;                // of its launches
  RtslRenderSettings ofFile = rtslRenderDefaults();      // of the pass that is set
  /// Trees of the scene before it was read again, for the next rendering; or null.
  mutable std::shared_ptr<rtsl::runtime::KeptTrees> kept;
};

namespace rtsl::c {

std::string &lastError();

/// A pointer that must not be null, unless it is to 0 elements, and its name for the message.
struct Needed {
  const void *pointer;
  const char *name;
  std::size_t count = 1;
};

/// Throws NotSettable for the first that is null.
void requireAll(std::initializer_list<Needed> needed);

/// Runs `work`; what it throws becomes the error, and `failed` the result.
template <typename Result, typename Work>
Result guarded(Result failed, std::initializer_list<Needed> needed, Work work) {
  lastError().clear();
  try {
    requireAll(needed);
    return work();
  } catch (const std::exception &error) {
    lastError() = error.what();
  } catch (...) {
    lastError() = "unknown error";
  }
  return failed;
}

/// One of `count` enumerators, which are numbered from 0. `what` is for messages. Throws
/// NotSupported.
void requireChoice(unsigned number, unsigned count, const char *what);

/// The value of one number, or of a list of numbers.
runtime::Value valueOf(const double *numbers, std::size_t count);
/// `count` of them, `stride` bytes apart. `what` moves by keys at these times, for messages. Throws
/// OutOfRange.
std::vector<float> keyTimes(const char *what, const float *first, std::uint32_t count,
                            std::size_t stride);
/// The transform of 12 numbers, four columns of three.
runtime::Transform transformOf(const double *numbers);
/// The same; null: none. Throws NotSettable.
runtime::Transform finiteTransform(const double *transform);

} // namespace rtsl::c
