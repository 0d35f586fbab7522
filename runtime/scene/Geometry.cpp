#include "runtime/scene/Geometry.h"
#include "support/ErrorMessages.h"
#include "support/MachineMemory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace rtsl::runtime {

namespace {

/// The results of the object's `computeBounds` for its first `count` primitives; NaN for sides that
/// it does not set.
std::vector<RtslBox> computeBounds(const Objects &objects, RtslRef primitive, std::uint32_t count,
                                   const RtslLaunch &launch) {
  std::vector<RtslBox> given(count);
  callOutsideOfRays(launch, primitive, [&](RtslState &state) {
    for (std::uint32_t number = 0; number < count; ++number) {
      for (int i = 0; i < 3; ++i) { // remains where computeBounds sets nothing
        state.BoundMin[i] = std::numeric_limits<float>::quiet_NaN();
        state.BoundMax[i] = std::numeric_limits<float>::quiet_NaN();
      }
      state.PrimitiveIndex = std::int32_t(number);
      if (objects.program().slots.rt_Primitive_computeBounds)
        objects.program().slots.rt_Primitive_computeBounds(&state, primitive);
      std::copy_n(state.BoundMin, 3, given[number].lower);
      std::copy_n(state.BoundMax, 3, given[number].upper);
    }
  });
  return given;
}

/// Throws DegenerateGeometry for NaN or inverted bounds; `what` makes the words for them. False if
/// the box has no area: no ray can hit it.
template <typename What>
bool checkBounds(const RtslBox &given, const Objects::Object &info, What what) {
  const char axes[] = "xyz";
  int flatSides = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::isnan(given.lower[i]) || std::isnan(given.upper[i]))
      throw Error(message::boundsNotNumbers(what(), axes[i]), info.place);
    if (given.lower[i] > given.upper[i])
      throw Error(message::boundsInverted(what(), axes[i], given.lower[i], given.upper[i]),
                  info.place);
    flatSides += given.lower[i] == given.upper[i];
  }
  return flatSides < 2;
}

/// The bounds of the only primitive of an object.
Bounds boundsOfOne(const Objects &objects, RtslRef primitive, const RtslLaunch &launch,
                   std::vector<Warning> &warnings) {
  const Objects::Object &info = objects.at(primitive);
  const RtslBox box = computeBounds(objects, primitive, 1, launch).front();
  const std::string what = fmt::format("primitive `{}`", info.name);
  if (!checkBounds(box, info, [&] { return what; })) {
    const bool isPoint = std::equal(box.lower, box.lower + 3, box.upper);
    warnings.push_back(
        {message::invisiblePrimitive(what, isPoint ? "a single point" : "a line without width"),
         info.place});
  }
  return box;
}

Bounds boundsOfAll(const std::vector<RtslBox> &boxes) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Bounds all{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const RtslBox &box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      all.lower[axis] = std::min(all.lower[axis], box.lower[axis]);
      all.upper[axis] = std::max(all.upper[axis], box.upper[axis]);
    }
  return all;
}

} // namespace

void Geometry::setShutter(float open, float close) {
  if (!(0 <= open && open <= close && close <= 1))
    throw Error(message::shutterTimesGiven(open, close));
  if (needs & (RTSL_HAS_MOTION | RTSL_HAS_MESH_KEYS))
    throw Error(message::shutterTooLate());
  needs |= RTSL_HAS_SHUTTER;
  shutterOpen = open;
  shutterClose = close;
}

/// RTSL_HAS_* of the linear part of a transform.
static std::uint32_t linearNeeds(const MovingTransform &transform) {
  if (isTranslation(transform))
    return 0;
  const double square = squaredScale(transform);
  const bool turns = !isScale(transform);
  return (turns ? RTSL_HAS_TURNS : RTSL_HAS_SCALE) | (square == 1 ? 0 : RTSL_HAS_SCALE) |
         (square > 0 ? 0 : RTSL_HAS_STRETCH);
}

/// Adds a transform and returns its index; 0 for the identity.
std::uint32_t Geometry::addTransform(const MovingTransform &transform, const std::string &name,
                                     const std::optional<rtsl::Place> &where) {
  if (!transform.moves() && transform.still().isIdentity())
    return 0;
  transforms.push_back(roundedTransform(transform, name, where));
  needs |= RTSL_HAS_TRANSFORMS | linearNeeds(transform);
  const auto index = std::uint32_t(transforms.size() - 1);
  if (transform.moves()) {
    transforms.back().motion = addMotion(transform);
    moving[index] = transform;
    needs |= RTSL_HAS_MOTION | RTSL_HAS_SHUTTER;
  }
  return index;
}

/// Adds the motion of a transform and returns its index.
std::uint32_t Geometry::addMotion(const MovingTransform &transform) {
  motions.push_back(
      {std::uint32_t(motionFactors.size()), std::uint32_t(transform.factors().size())});
  for (const MotionFactor &factor : transform.factors()) {
    motionFactors.push_back({std::uint32_t(motionKeys.size()), std::uint32_t(factor.times.size()),
                             factor.isRotation()});
    for (std::size_t i = 0; i < factor.times.size(); ++i) {
      RtslMotionKey key{};
      key.time = factor.times[i];
      if (!factor.isRotation()) {
        for (std::size_t column = 0; column < 4; ++column)
          std::copy_n(factor.maps[i].columns[column].begin(), 3, key.numbers + 3 * column);
      } else if (i < factor.turns.size()) {
        const Turn &turn = factor.turns[i];
        std::copy_n(turn.from.begin(), 4, key.numbers);
        std::copy_n(turn.across.begin(), 4, key.numbers + 4);
        key.numbers[8] = turn.angle / (0.5 * 3.14159265358979323846);
      }
      motionKeys.push_back(key);
    }
  }
  return std::uint32_t(motions.size() - 1);
}

RtslInstance Geometry::place(const Placement &placement, const std::string &name,
                             const std::optional<rtsl::Place> &where) {
  if (placement.selection >= selections.size())
    throw Error(message::noSuchSelection(placement.selection), where);
  RtslInstance instance{};
  instance.mask = placement.mask;
  instance.roots = placement.roots;
  instance.id = placement.id;
  instance.selection = placement.selection;
  instance.transform = addTransform(placement.transform, name, where);
  return instance;
}

/// RtslInstance::needs, as far as it depends on the material.
static std::uint32_t needsOfMaterial(const Objects &objects, RtslRef material) {
  return objects.needsOf(material) | (objects.isOpaque(material) ? RTSL_IS_OPAQUE : 0);
}

std::uint32_t Geometry::addInstance(const Objects &objects, const RtslInstance &instance,
                                    std::string name, std::uint32_t items) {
  objects.requireRole(instance.material, "rt_Material", ifClassic(objects.program(), "shade"));
  if (treeItems + items > 0x7fffffffu)
    throw Error(message::tooManyPrimitives());
  instances.push_back(instance);
  RtslInstance &added = instances.back();
  added.needs |= needsOfMaterial(objects, instance.material);
  added.anyHit = objects.at(instance.material).classInfo->anyHit;
  treeItems += items;
  instanceNames.push_back(std::move(name));
  needs |= (instance.roots != 1 ? RTSL_HAS_ROOTS : 0) |
           (instance.boxCount != 0 ? RTSL_HAS_COUNTS : 0) |
           (instance.selection != 0 ? RTSL_HAS_SELECTORS : 0) |
           (instance.mask != ~0u ? RTSL_HAS_MASKS : 0) | (instance.needs & RTSL_HAS_NO_BACKS);
  return std::uint32_t(instances.size() - 1);
}

std::uint32_t Geometry::addPrimitive(const Objects &objects, RtslRef primitive, RtslRef material,
                                     const Placement &placement, std::uint32_t count,
                                     const std::function<RtslLaunch()> &launch,
                                     std::vector<Warning> &warnings) {
  objects.requireRole(primitive, "rt_Primitive", {"intersect", "computeBounds"});
  const Objects::Object &info = objects.at(primitive);
  if (count == 0)
    throw Error(message::noPrimitivesIn(info.name), info.place);
  RtslInstance instance = place(placement, info.name, info.place);
  instance.primitive = primitive;
  instance.material = material;
  Bounds given;
  if (count == 1) {
    given = boundsOfOne(objects, primitive, launch(), warnings);
  } else {
    const PrimitiveSet &set = primitiveSet(objects, primitive, count, launch, warnings);
    instance.firstBox = set.firstBox;
    instance.boxCount = set.count;
    instance.mesh = set.number;
    given = set.bounds;
  }
  setPrimitiveBounds(instance, given, placement.transform);
  return addInstance(objects, instance, info.name, instance.transform != 0 ? 1 : count);
}

void Geometry::setPrimitiveBounds(RtslInstance &instance, const Bounds &given,
                                  const MovingTransform &transform) const {
  std::copy_n(given.lower, 3, instance.boundMin);
  std::copy_n(given.upper, 3, instance.boundMax);
  if (instance.transform != 0)
    setWorldBounds(instance, given, transform, shutterOpen, shutterClose);
  else
    setWorldBounds(instance, given);
}

const Geometry::PrimitiveSet &Geometry::primitiveSet(const Objects &objects, RtslRef primitive,
                                                     std::uint32_t count,
                                                     const std::function<RtslLaunch()> &launch,
                                                     std::vector<Warning> &warnings) {
  const Objects::Object &info = objects.at(primitive);
  if (const auto known = sets.find(primitive); known != sets.end()) {
    if (known->second.count != count)
      throw Error(message::primitiveCountsDiffer(info.name, known->second.count, count),
                  info.place);
    return known->second;
  }
  if (count > 0x7fffffffu - boxes.size())
    throw Error(message::tooManyPrimitives(), info.place);
  // Their boxes, a copy of these while they are checked, and the tree.
  constexpr std::uint64_t bytesOfPrimitive = 200;
  try {
    const MemoryReservation needed(count * bytesOfPrimitive);
  } catch (const std::bad_alloc &) {
    throw Error(
        message::noMemoryForPrimitives(count, info.name, double(count * bytesOfPrimitive) / 0x1p30),
        info.place);
  }
  const std::vector<RtslBox> all = boxesOf(objects, primitive, count, launch, warnings);
  const PrimitiveSet set{std::uint32_t(boxes.size()), count, std::uint32_t(sets.size()),
                         boundsOfAll(all)};
  boxes.insert(boxes.end(), all.begin(), all.end());
  return sets.emplace(primitive, set).first->second;
}

std::vector<RtslBox> Geometry::boxesOf(const Objects &objects, RtslRef primitive,
                                       std::uint32_t count,
                                       const std::function<RtslLaunch()> &launch,
                                       std::vector<Warning> &warnings) {
  const Objects::Object &info = objects.at(primitive);
  std::vector<RtslBox> all = computeBounds(objects, primitive, count, launch());
  std::uint32_t flat = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    flat += !checkBounds(all[i], info,
                         [&] { return fmt::format("primitive {} of `{}`", i, info.name); });
  if (flat != 0)
    warnings.push_back({message::invisiblePrimitives(flat, count, info.name), info.place});
  return all;
}

void Geometry::updatePrimitive(const Objects &objects, RtslRef primitive,
                               const std::function<RtslLaunch()> &launch,
                               std::vector<Warning> &warnings) {
  const auto isOf = [&](const RtslInstance &instance) { return instance.primitive == primitive; };
  const auto first = std::find_if(instances.begin(), instances.end(), isOf);
  if (first == instances.end())
    return;
  Bounds given;
  if (first->boxCount == 0) {
    given = boundsOfOne(objects, primitive, launch(), warnings);
  } else {
    PrimitiveSet &set = sets.at(primitive);
    const std::vector<RtslBox> all = boxesOf(objects, primitive, set.count, launch, warnings);
    std::copy(all.begin(), all.end(), boxes.begin() + set.firstBox);
    given = set.bounds = boundsOfAll(all);
  }
  for (auto instance = first; instance != instances.end(); ++instance)
    if (isOf(*instance))
      setPrimitiveBounds(*instance, given, transformOf(*instance));
  ++primitivesChanged;
}

std::uint32_t Geometry::addSelector(const Objects &objects, RtslRef selector,
                                    std::uint32_t children, const MovingTransform &transform,
                                    std::uint32_t above) {
  objects.requireRole(selector, "rt_Selector", {"visit"});
  const Objects::Object &info = objects.at(selector);
  if (above >= selections.size())
    throw Error(message::noSuchSelection(above), info.place);
  const auto first = std::uint32_t(selections.size());
  const std::uint32_t space = addTransform(transform, info.name, info.place);
  for (std::uint32_t child = 0; child < children; ++child)
    selections.push_back({selector, std::int32_t(child), space, above});
  return first;
}

std::uint32_t Geometry::addMesh(Mesh mesh, const std::string &name, const Transform &applied) {
  std::string shown = name.empty() ? fmt::format("mesh {}", meshes.size()) : name;
  validateMesh(mesh, shown);
  auto storage =
      std::make_unique<NamedMesh>(NamedMesh{std::move(mesh), std::move(shown), {}, {}, 0, 0});
  if (!applied.isIdentity()) {
    transforms.push_back(roundedTransform(applied, storage->name, std::nullopt));
    storage->applied = std::uint32_t(transforms.size() - 1);
  }
  Mesh &kept = storage->mesh;
  RtslMesh table{};
  table.positions = kept.positions.data();
  table.normals = kept.normals.empty() ? nullptr : kept.normals.data();
  table.uvs = kept.uvs.empty() ? nullptr : kept.uvs.data();
  table.indices = kept.indices.data();
  table.keyTimes = kept.keyTimes.empty() ? nullptr : kept.keyTimes.data();
  table.keyCount = std::uint32_t(kept.keyCount());
  table.vertexCount = std::uint32_t(kept.vertexCount());
  table.triangleCount = std::uint32_t(kept.triangleCount());
  meshTable.push_back(table);
  meshes.push_back(std::move(storage));
  return std::uint32_t(meshes.size() - 1);
}

const Bounds &Geometry::meshBounds(std::uint32_t mesh) {
  NamedMesh &named = *meshes[mesh];
  if (!named.bounds)
    named.bounds = boundsOf(named.mesh);
  return *named.bounds;
}

std::uint32_t Geometry::addMeshInstance(const Objects &objects, std::uint32_t mesh,
                                        RtslRef material, const Placement &placement) {
  if (mesh >= meshes.size())
    throw Error(message::noSuchMesh(mesh));
  RtslInstance instance = place(placement, meshes[mesh]->name, std::nullopt);
  instance.material = material;
  instance.mesh = mesh;
  instance.needs = placement.hasBackFaces ? 0 : RTSL_HAS_NO_BACKS;
  if (meshTable[mesh].keyTimes)
    needs |= RTSL_HAS_MESH_KEYS | RTSL_HAS_SHUTTER;
  if (instance.transform != 0)
    setWorldBounds(instance, meshBounds(mesh), placement.transform, shutterOpen, shutterClose);
  else
    instance.firstBox = meshes[mesh]->applied;
  const std::uint32_t wanted = objects.attributesOf(material) & ~meshes[mesh]->values.wanted();
  if (wanted != 0) {
    requireAttributes(meshes[mesh]->mesh, meshes[mesh]->name, objects.program(), wanted,
                      objects.at(material));
    setValues(mesh, objects.program(), wanted | meshes[mesh]->values.wanted());
  }
  return addInstance(objects, instance, meshes[mesh]->name,
                     instance.transform != 0 ? 1 : meshTable[mesh].triangleCount);
}

MovingTransform Geometry::transformOf(const RtslInstance &instance) const {
  if (const auto found = moving.find(instance.transform); found != moving.end())
    return found->second;
  const RtslTransform &stored = transforms[instance.transform];
  Transform transform;
  for (std::size_t column = 0; column < 3; ++column)
    std::copy_n(stored.linear + 3 * column, 3, transform.columns[column].begin());
  std::copy_n(stored.translation, 3, transform.columns[3].begin());
  return transform;
}

void Geometry::setBounds(RtslInstance &instance, const MovingTransform &transform) {
  Bounds given;
  if (instance.primitive == 0) {
    given = meshBounds(instance.mesh);
  } else {
    std::copy_n(instance.boundMin, 3, given.lower);
    std::copy_n(instance.boundMax, 3, given.upper);
  }
  setWorldBounds(instance, given, transform, shutterOpen, shutterClose);
}

void Geometry::moveInstance(std::uint32_t number, const MovingTransform &transform) {
  if (number >= instances.size())
    throw Error(message::noSuchInstance(number));
  RtslInstance &instance = instances[number];
  if (transform.moves() && !(needs & RTSL_HAS_MOTION))
    throw Error(message::motionTooLate(instanceNames[number]));
  if (instance.transform == 0) {
    instance.transform = addTransform(transform, instanceNames[number], std::nullopt);
    if (instance.transform == 0) // it stays where it is
      return;
    ++transformsGained;
  } else {
    RtslTransform moved = roundedTransform(transform, instanceNames[number], std::nullopt);
    if (transform.moves()) {
      moved.motion = addMotion(transform);
      moving[instance.transform] = transform;
    } else {
      moving.erase(instance.transform);
    }
    transforms[instance.transform] = moved;
    needs |= linearNeeds(transform);
  }
  setBounds(instance, transform);
  ++moves;
}

const std::vector<float> &Geometry::positions(std::uint32_t mesh) const {
  if (mesh >= meshes.size())
    throw Error(message::noSuchMesh(mesh));
  return meshes[mesh]->mesh.positions;
}

void Geometry::moveMesh(std::uint32_t number, std::vector<float> positions,
                        std::vector<float> normals) {
  if (number >= meshes.size())
    throw Error(message::noSuchMesh(number));
  NamedMesh &named = *meshes[number];
  Mesh &mesh = named.mesh;
  if (positions.size() != mesh.positions.size())
    throw Error(
        message::movedVertexCount(named.name, positions.size() / 3, mesh.positions.size() / 3));
  Mesh moved; // to be checked
  moved.indices = {0, 0, 0};
  moved.keyTimes = mesh.keyTimes;
  moved.positions = std::move(positions);
  moved.normals = std::move(normals);
  validateMesh(moved, named.name);
  mesh.positions.swap(moved.positions);
  meshTable[number].positions = mesh.positions.data();
  if (!mesh.normals.empty() && !moved.normals.empty()) {
    mesh.normals.swap(moved.normals);
    meshTable[number].normals = mesh.normals.data();
  }
  named.bounds.reset();
  for (RtslInstance &instance : instances)
    if (instance.primitive == 0 && instance.mesh == number && instance.transform != 0)
      setBounds(instance, transformOf(instance));
  ++named.moves;
  ++moves;
}

void Geometry::setValues(std::uint32_t mesh, const Program &program, std::uint32_t wanted) {
  attributeTable = attributesOf(program);
  meshes[mesh]->values = MeshValues(meshes[mesh]->mesh, program, wanted);
  meshTable[mesh].attributes = meshes[mesh]->values.table();
}

void Geometry::updateNeeds(const Objects &objects) {
  std::map<RtslRef, std::uint32_t> known; // by material: a scene may have millions of instances
  for (RtslInstance &instance : instances) {
    const auto [found, isNew] = known.emplace(instance.material, 0);
    if (isNew)
      found->second = needsOfMaterial(objects, instance.material);
    instance.needs = (instance.needs & RTSL_HAS_NO_BACKS) | found->second;
  }
}

void Geometry::useProgram(const Objects &objects) {
  updateNeeds(objects);
  std::vector<std::uint32_t> wanted(meshes.size(), 0);
  std::map<RtslRef, std::uint32_t> known;
  for (const RtslInstance &instance : instances) {
    if (instance.primitive != 0 || objects.program().meshAttributes.empty())
      continue;
    const auto [found, isNew] = known.emplace(instance.material, 0);
    if (isNew)
      found->second = objects.attributesOf(instance.material);
    wanted[instance.mesh] |= found->second;
  }
  for (std::uint32_t i = 0; i < meshes.size(); ++i)
    if (!meshes[i]->mesh.attributes.empty())
      setValues(i, objects.program(), wanted[i]);
  dropUnusedAttributes(objects.program());
}

void Geometry::dropUnusedAttributes(const Program &program) {
  attributes.clear();
  std::vector<std::uint32_t> needs(meshes.size(), 0);
  for (const RtslInstance &instance : instances)
    if (instance.primitive == 0)
      needs[instance.mesh] |= instance.needs;
  const auto look = [&](std::size_t i, const char *name, std::uint32_t need,
                        std::vector<float> &values, const float *&inTable) {
    if (values.empty())
      return;
    bool isNeeded = (needs[i] & need) != 0;
    attributes.push_back({meshes[i]->name, name, values.size() * sizeof(float), isNeeded, false});
    if (isNeeded || program.keepsMeshes)
      return;
    values = {};
    inTable = nullptr;
  };
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    Mesh &mesh = meshes[i]->mesh;
    look(i, "normals", RTSL_NEEDS_NORMALS | RTSL_NEEDS_NORMAL_CHANGES, mesh.normals,
         meshTable[i].normals);
    look(i, "texture coordinates",
         RTSL_NEEDS_TEXTURE_COORDINATES | RTSL_NEEDS_DERIVATIVES | RTSL_NEEDS_FOOTPRINT, mesh.uvs,
         meshTable[i].uvs);
    for (NamedAttribute &attribute : mesh.attributes) {
      const bool isNeeded = meshes[i]->values.isRead(attribute, program);
      attributes.push_back({meshes[i]->name, fmt::format("attribute `{}`", attribute.name),
                            4 * attribute.words.size(), isNeeded, true});
      if (!isNeeded && !program.keepsMeshAttributes)
        attribute.words = {};
    }
  }
}

Bounds Geometry::bounds(std::uint32_t instance) const {
  const RtslInstance &one = instances.at(instance);
  Bounds bounds;
  std::copy_n(one.lower, 3, bounds.lower);
  std::copy_n(one.upper, 3, bounds.upper);
  return bounds;
}

std::uint32_t Geometry::primitiveCount(std::uint32_t instance) const {
  const RtslInstance &one = instances.at(instance);
  return one.primitive == 0 ? meshTable[one.mesh].triangleCount : std::max(one.boxCount, 1u);
}

Geometry::Extent Geometry::extent() const {
  return {meshes.size(), transforms.size(), motions.size(), motionFactors.size(), motionKeys.size(),
          boxes.size(),  selections.size(), sets.size(),    instances.size(),     treeItems,
          needs};
}

void Geometry::cutBack(const Extent &to) {
  meshes.resize(to.meshes);
  meshTable.resize(to.meshes);
  moving.erase(moving.lower_bound(std::uint32_t(to.transforms)), moving.end());
  transforms.resize(to.transforms);
  motions.resize(to.motions);
  motionFactors.resize(to.motionFactors);
  motionKeys.resize(to.motionKeys);
  boxes.resize(to.boxes);
  selections.resize(to.selections);
  for (auto set = sets.begin(); set != sets.end();)
    set = set->second.number < to.sets ? std::next(set) : sets.erase(set);
  instances.resize(to.instances);
  instanceNames.resize(to.instances);
  treeItems = to.treeItems;
  needs = to.needs;
}

void Geometry::fill(RtslLaunch &launch) const {
  launch.instances = instances.data();
  launch.meshes = meshTable.data();
  launch.meshAttributes = attributeTable.data();
  launch.meshAttributeCount = std::uint32_t(attributeTable.size());
  launch.transforms = transforms.data();
  launch.motions = motions.data();
  launch.motionFactors = motionFactors.data();
  launch.motionKeys = motionKeys.data();
  launch.motionCount = std::uint32_t(motions.size());
  launch.motionFactorCount = std::uint32_t(motionFactors.size());
  launch.motionKeyCount = std::uint32_t(motionKeys.size());
  launch.boxes = boxes.data();
  launch.boxCount = std::uint32_t(boxes.size());
  launch.selections = selections.data();
  launch.selectionCount = std::uint32_t(selections.size());
  launch.instanceCount = std::uint32_t(instances.size());
  launch.meshCount = std::uint32_t(meshTable.size());
  launch.transformCount = std::uint32_t(transforms.size());
  launch.needs |= needs;
  if (needs & RTSL_HAS_SHUTTER) {
    launch.shutterOpen = shutterOpen;
    launch.shutterClose = shutterClose;
  }
}

} // namespace rtsl::runtime
