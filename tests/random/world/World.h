//===- World.h - a small scene that a random program runs in --------------===//
#pragma once

#include "tests/random/Program.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/program/ProgramHost.h"
#include "runtime/scene/Words.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <vector>

namespace rtsl::random {

/// The objects of a program with values made from its seed, a few instances, and the launch. What a
/// ray meets is what the program's own primitives say, tested one by one.
class World {
public:
  World(const runtime::Program &code, const Program &program);
  /// The world that `made` is, with a program that is bound to it. `made` stays, for its objects
  /// are used.
  World(const runtime::Program &bound, const World &made);
  World(const World &) = delete;

  /// Rays try the primitives the other way round from now on. That must not show.
  void reverseOrder();

  /// What a program can be bound to.
  runtime::SceneFacts facts() const;

  /// The colors of some pixels, each without and with the rays that shaders send, as bits (all NaNs
  /// are one), and what was printed until then; the exceptions, by their codes. After them what
  /// methods leave that only the host calls, if it may call them, and the elements of output
  /// buffers.
  std::vector<std::uint32_t> run(bool isSampled = true);
  /// The colors of a picture as whoever renders it makes it of one sample a pixel: a color that is
  /// not finite is black. With it, what was printed until its end. The program may be a megakernel.
  std::vector<std::uint32_t> render();
  /// Has some ray met something, so that a material ran?
  bool hitSomething() const;

  /// Which primitive may meet which material.
  static std::vector<std::pair<std::string, std::string>> surfaces(const Program &program);

private:
  void makeTree();
  void addObjects(const std::vector<std::string> &classes, std::vector<RtslRef> *references);
  /// Objects of sampler2D with small images.
  void addImages();
  void addImage(const runtime::ClassInfo &info, std::uint32_t number);
  std::size_t wordsOfImages() const;
  void fill(const runtime::MemberInfo &member, std::uint8_t *to, std::uint32_t key);
  void fillElement(const runtime::ValueType &type, const std::optional<Range> &range,
                   std::uint8_t *to, std::uint32_t key);
  void putBuffer(std::uint8_t *to, const runtime::Words &words);
  std::size_t wordsOfRecords() const;
  void addInstances();
  void addInstance(RtslInstance instance, std::uint32_t primitives);
  void describeLaunch();
  static std::vector<RtslTransform> someTransforms();
  static RtslMesh someMesh();
  void listAttributes();
  void addMotion();
  void addSelections(RtslRef selector);
  void addEmitters();
  void addLightTree();
  bool shines(const RtslInstance &instance) const;
  const runtime::ClassInfo &classOf(RtslRef object) const;
  std::uint32_t partsOf(const RtslInstance &instance) const;
  std::uint32_t featuresOfScene() const;
  void place(RtslInstance &instance, std::uint32_t number, std::uint32_t primitives);
  void describeMaterial(RtslInstance &instance, const runtime::ClassInfo &material) const;
  std::uint32_t needsOf(const runtime::ClassInfo &info,
                        std::set<const runtime::ClassInfo *> &seen) const;
  RtslRef choose(const std::string &className, std::uint32_t key) const;
  bool derivesFrom(const runtime::ClassInfo &info, const std::string &base) const;

  void begin();
  /// What render(words) and the objects give with each limit of the depth.
  template <typename Render>
  std::vector<std::uint32_t> renderAtEachDepth(bool isSampled, Render render);
  void noteExceptions(std::vector<std::uint32_t> &words);
  void sampleObjects(std::vector<std::uint32_t> &words);
  void noteOutputs(std::vector<std::uint32_t> &words) const;
  void noteRanges(std::vector<std::uint32_t> &words) const;
  void notePowers(std::vector<std::uint32_t> &words) const;
  void renderBySample(std::vector<float> &pixels);
  void renderByLane(std::vector<float> &pixels);

  const runtime::Program &code;
  const Program &program;
  runtime::ProgramHost host;
  struct Object {
    RtslRef reference;
    const runtime::ClassInfo *info;
  };
  std::vector<Object> objects;
  std::vector<std::uint32_t> records;
  std::size_t used = 4; // words
  std::deque<std::vector<std::uint32_t>> buffers;
  std::deque<std::vector<std::uint32_t>> filledBuffers;    // as they were before a run
  std::vector<const std::vector<std::uint32_t> *> outputs; // buffers that the program writes
  bool mayBeEmpty = true;                                  // buffers of the object in the making
  RtslStatus status{};
  std::vector<RtslRef> lights, primitives, materials, others;
  std::vector<RtslInstance> instances;
  std::vector<RtslTransform> transforms;
  std::vector<RtslMotion> motions;
  std::vector<RtslMotionFactor> motionFactors;
  std::vector<RtslMotionKey> motionKeys;
  std::vector<RtslSelection> selections;
  std::vector<RtslBox> boxes;
  std::vector<RtslEmitter> emitters;
  std::vector<float> partChances;
  std::vector<RtslLightNode> lightNodes;
  std::vector<std::uint32_t> lightLeaves;
  // of the world, and of the mesh and each object with several primitives, in their own spaces
  std::vector<runtime::BvhItem> worldItems;
  std::vector<std::vector<runtime::BvhItem>> treeItems;
  runtime::Bvh tree; // of all of them
  RtslMesh mesh{};
  std::vector<RtslMeshAttribute> attributes; // where primitives have changes of 0
  RtslLaunch launch{};
};

} // namespace rtsl::random
