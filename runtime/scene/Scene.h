//===- Scene.h - objects, meshes, lights and a camera for a program -------===//
//
// A scene holds the records of the program's objects, in the program's layout, and what there
// is to hit. It checks everything when it is given, so that rendering has nothing left to refuse.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "runtime/program/Program.h"
#include "runtime/scene/SceneData.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rtsl::runtime {

class Scene {
public:
  /// The program must stay as it is; the scene keeps it alive. Throws IncompleteScene for null.
  explicit Scene(std::shared_ptr<const Program> program);
  ~Scene();
  Scene(Scene &&) noexcept;
  Scene &operator=(Scene &&) noexcept;

  const Program &program() const;

  /// Exchanges the program for one that was linked from the same classes, and may be bound to the
  /// objects that the scene has: nothing can be added any more. Data of meshes that no material on
  /// them reads is dropped.
  void useProgram(std::shared_ptr<const Program> program);

  /// Normals and texture coordinates of meshes, as useProgram found them.
  using MeshAttribute = runtime::MeshAttribute;
  const std::vector<MeshAttribute> &meshAttributes() const;

  /// Adds an object of class `className`: defaults, then the constructor, then the public members.
  /// `name` is for messages; empty: the class's name. Throws UnknownClass, UnknownMember,
  /// NotSettable, BadArguments, WrongType, WrongClass, MissingMember.
  RtslRef addObject(const std::string &className, const ObjectValues &values = {},
                    const std::string &name = {});

  /// The same with constructor arguments in order.
  RtslRef addObject(const std::string &className, std::vector<Value> arguments,
                    const std::string &name = {});

  /// The times of samples are drawn between these two, 0 <= open <= close <= 1; rays of other times
  /// see the scene as when it opens or closes. Without it they are drawn from all of [0, 1] if
  /// something moves, and are 0 if nothing does. Throws OutOfRange, and NotSettable if anything
  /// that moves has been added: bounds hold for these times alone.
  void setShutter(float open, float close);

  /// Adds an instance of an RTSL primitive to what rays can hit. Its bounds are computed at once:
  /// if they are inverted or not numbers, DegenerateGeometry is thrown; a box without any extent
  /// gives a warning, because no ray can hit it. A transform that is not finite, or so close to
  /// singular that it cannot be inverted exactly enough, throws DegenerateGeometry. Returns the
  /// instance's index.
  ///
  /// An object may hold several primitives, numbered by rt_PrimitiveIndex: `count` in all of its
  /// instances, which share their tree if they have transforms. Throws OutOfRange for 0.
  std::uint32_t addPrimitive(RtslRef primitive, RtslRef material, const Placement &placement = {},
                             std::uint32_t count = 1);

  /// Adds a selector that lies in the space of `transform`, with as many children. Returns the
  /// Placement::selection of what is below child 0; those of the others follow. `above`: that of
  /// the selector itself.
  std::uint32_t addSelector(RtslRef selector, std::uint32_t children,
                            const MovingTransform &transform = {}, std::uint32_t above = 0);

  /// Adds a mesh; returns its index for addMeshInstance. If its vertices are in world space, to
  /// which `applied` has brought them, rt_ObjectToWorld of instances without a transform is that.
  /// Throws BadMesh, DegenerateGeometry.
  std::uint32_t addMesh(Mesh mesh, const std::string &name = {}, const Transform &applied = {});

  /// Adds an instance of a mesh to what rays can hit. Returns the instance's index. Instances share
  /// the mesh and, if they have transforms, its tree. Throws DegenerateGeometry.
  std::uint32_t addMeshInstance(std::uint32_t mesh, RtslRef material,
                                const Placement &placement = {});

  /// Sets a public member of an object that exists. Bounds of a primitive's instances are computed
  /// anew. Throws what addObject and addPrimitive throw, and changes nothing then.
  void setMember(RtslRef object, const NamedValue &value);

  /// Gives an instance another transform. Bounds are computed anew, and all is checked that is
  /// checked when an instance is added. A program that was linked for the scene (useProgram) knows
  /// where instances were: this is for programs that can render any scene. Throws NotSettable for
  /// keys if nothing in the scene had any, UnknownName, DegenerateGeometry.
  void moveInstance(std::uint32_t instance, const MovingTransform &transform);
  /// Gives a mesh other positions, of as many vertices (at all its keys), and other normals, if it
  /// has any and they are given. Throws BadMesh and leaves the mesh as it was, UnknownName.
  void moveMesh(std::uint32_t mesh, std::vector<float> positions, std::vector<float> normals = {});
  /// The positions of a mesh, at all its keys.
  const std::vector<float> &positions(std::uint32_t mesh) const;
  /// How many times something was moved; and a mesh.
  std::uint64_t moves() const;
  std::uint64_t movesOfMesh(std::uint32_t mesh) const;
  /// Changes whenever trees must be built anew, because instances were added or got transforms.
  std::uint64_t structure() const;

  /// Runs `add`, which adds something to the scene. If it throws, what it has added is removed.
  void addAllOrNothing(const std::function<void()> &add);

  void addLight(RtslRef light);
  void setCamera(RtslRef camera);
  /// Sets the object that generates rays in the programs engine, in place of a camera.
  void setRayGeneration(RtslRef rayGeneration);
  void setBackground(RtslRef miss);
  /// How `illuminate(P)` chooses one of the surfaces that shine.
  void setLampChoice(LampChoice choice);
  /// Changes the sampler of a program that is compiled C++; in others it is a constant of the code.
  void setSampler(Sampler sampler);
  /// Sets the object that determines the color of samples that end with an exception, in programs
  /// with RTSL_FEATURE_EXCEPTIONS.
  void setException(RtslRef exception);
  /// The color is given by as many numbers as the program's color has components, by red, green and
  /// blue, or by one number for all components. Throws WrongType.
  void setBackgroundColor(const std::vector<float> &color);
  void setAmbient(const std::vector<float> &color);

  /// The record of an object.
  const std::uint8_t *record(RtslRef object) const;
  const ClassInfo &classOf(RtslRef object) const;
  /// The facts to which a program can be bound. Records stay where they are until something is
  /// added.
  SceneFacts facts() const;
  const std::string &nameOf(RtslRef object) const;
  /// The first object of this name; 0: there is none.
  RtslRef find(const std::string &name) const;

  const std::vector<Warning> &warnings() const;
  void addWarning(Warning warning);

  /// The launch that describes this scene, with width, height, seed, depth and the traversal left
  /// at 0. It stays valid until the scene changes. Throws IncompleteScene if there is no camera, or
  /// ray generation.
  RtslLaunch launch() const;

  /// Bytes of all records, from RtslLaunch::records.
  std::size_t recordBytes() const;
  /// The RtslBuffers in the records.
  using BufferPlace = runtime::BufferPlace;
  std::vector<BufferPlace> buffers() const;

  /// The output buffers of the ray generation. Backends write their elements; each rendering goes
  /// on from what the one before left there.
  std::vector<OutputBuffer> outputs() const;

  /// World bounds of an instance of an RTSL primitive, or of a mesh with a transform, slightly
  /// enlarged.
  Bounds instanceBounds(std::uint32_t instance) const;
  /// Number of primitives that the instance holds: those of its object, or the triangles of its
  /// mesh.
  std::uint32_t primitiveCount(std::uint32_t instance) const;
  /// The name of an instance for messages: that of its primitive or mesh.
  const std::string &instanceName(std::uint32_t instance) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl::runtime
