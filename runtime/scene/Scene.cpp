#include "runtime/scene/Scene.h"

#include "runtime/device/ray/Random.h"
#include "runtime/scene/ValueStore.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace rtsl::runtime {

namespace {

/// Records begin behind this: reference 0 is "none", and a class id of 0 there makes every dispatch
/// do nothing.
constexpr std::uint32_t firstRecord = 16;
constexpr std::uint32_t recordAlignment = 16;

struct ObjectInfo {
  RtslRef object;
  const ClassInfo *classInfo;
  std::string name;
  std::optional<Place> place;
};

struct MeshStorage {
  Mesh mesh;
  std::string name;
};

std::string listParameters(const ClassInfo &info) {
  std::string text = info.name + "(";
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    text += fmt::format("{}{} {}", i ? ", " : "", info.parameters[i].type.name,
                        info.parameters[i].name);
  return text + ")";
}

bool hasMethod(const ClassInfo &info, const std::string &method) {
  return std::find(info.methods.begin(), info.methods.end(), method) != info.methods.end();
}

/// A few units in the last place outwards, for the author's sums are rounded; and into the range in
/// which boxes can be multiplied with each other. An infinite primitive stays in the largest box
/// there is.
float outwards(float side, float direction) {
  constexpr float largest = 1e18f;
  float moved = side + direction * (std::fabs(side) * 0x1p-21f + std::numeric_limits<float>::min());
  return std::clamp(moved, -largest, largest);
}

} // namespace

struct Scene::Implementation {
  std::shared_ptr<const Program> program;
  std::vector<std::uint8_t> records;
  std::vector<ObjectInfo> objects; // ascending by reference
  std::vector<std::unique_ptr<std::uint32_t[]>> buffers;
  std::vector<std::unique_ptr<MeshStorage>> meshes;
  std::vector<RtslMesh> meshTable;
  std::vector<RtslInstance> instances;
  std::vector<std::string> instanceNames;
  std::uint64_t primitiveTotal = 0;
  std::unordered_map<RtslRef, std::uint32_t> chains; // measureChain
  std::uint32_t referenceChain = 0;                  // the longest
  std::vector<RtslRef> lights;
  RtslRef camera = 0, rayGeneration = 0, background = 0, exception = 0;
  float backgroundColor[RTSL_MAX_COLOR] = {}, ambient[RTSL_MAX_COLOR] = {};
  std::vector<Warning> warnings;
  std::vector<MeshAttribute> meshAttributes;

  const ObjectInfo &info(RtslRef object) const {
    auto found =
        std::lower_bound(objects.begin(), objects.end(), object,
                         [](const ObjectInfo &info, RtslRef ref) { return info.object < ref; });
    if (found == objects.end() || found->object != object)
      throw Error(ErrorCode::UnknownName,
                  fmt::format("no object of the scene has the reference {}", object));
    return *found;
  }

  bool derivesFrom(const ClassInfo *info, const std::string &className) const {
    for (; info; info = program->find(info->base))
      if (info->name == className || info->base == className || info->root == className)
        return true;
    return false;
  }

  RtslLaunch tables() {
    RtslLaunch launch{};
    launch.records = records.data();
    launch.instances = instances.data();
    launch.meshes = meshTable.data();
    launch.lights = lights.data();
    launch.camera = camera;
    launch.rayGeneration = rayGeneration;
    launch.background = background;
    launch.exception = exception;
    std::memcpy(launch.backgroundColor, backgroundColor, sizeof backgroundColor);
    std::memcpy(launch.ambient, ambient, sizeof ambient);
    launch.instanceCount = std::uint32_t(instances.size());
    launch.meshCount = std::uint32_t(meshTable.size());
    launch.lightCount = std::uint32_t(lights.size());
    launch.colorComponents = program->colorComponents;
    launch.needs = program->needs;
    launch.referenceChain = referenceChain;
    return launch;
  }

  /// Calls code of the program outside of any ray.
  template <typename Call>
  void withState(RtslRef object, Call call) {
    RtslLaunch launch = tables();
    RtslState state{};
    state.launch = &launch;
    state.instance = state.primitive = RTSL_NO_HIT;
    state.HitDistance = std::numeric_limits<float>::infinity();
    device::Words3 key = device::hash3(object, 0, 0);
    state.randomKey[0] = key.x;
    state.randomKey[1] = key.y;
    call(state);
  }

  StoreContext storeContext() {
    StoreContext context;
    context.colorComponents = program->colorComponents;
    context.allocate = [this](std::size_t bytes) {
      buffers.push_back(std::make_unique<std::uint32_t[]>(bytes / 4 + 1));
      return reinterpret_cast<std::uint8_t *>(buffers.back().get());
    };
    context.classMismatch = [this](RtslRef object,
                                   const std::string &className) -> const std::string * {
      const ClassInfo *classInfo = info(object).classInfo;
      return derivesFrom(classInfo, className) ? nullptr : &classInfo->name;
    };
    return context;
  }

  void requireRole(RtslRef object, const std::string &root,
                   const std::vector<std::string> &methods) const {
    const ObjectInfo &given = info(object);
    if (given.classInfo->root != root)
      throw Error(ErrorCode::WrongClass,
                  fmt::format("`{}` is a `{}`, where a `{}` is needed", given.name,
                              given.classInfo->name, root),
                  given.place);
    for (const std::string &method : methods)
      if (!hasMethod(*given.classInfo, method))
        throw Error(ErrorCode::MissingMethod,
                    fmt::format("class `{}` of `{}` does not define `{}`", given.classInfo->name,
                                given.name, method),
                    given.place);
  }

  void runConstructor(const ClassInfo &classInfo, const ObjectInfo &object,
                      const ObjectValues &values);
  void setMembers(const ClassInfo &classInfo, const ObjectInfo &object, const ObjectValues &values);
  void setMember(const ClassInfo &classInfo, const ObjectInfo &object, const NamedValue &one,
                 const std::optional<Place> &place);
  void checkUnset(const ClassInfo &classInfo, const ObjectInfo &object, const ObjectValues &values);
  void setColor(const std::vector<float> &color, float *to, const char *what) const;
  std::uint32_t addInstance(RtslRef primitive, std::uint32_t mesh, RtslRef material,
                            std::string name, std::uint32_t primitives, std::uint32_t mask);
  /// The objects, and those behind their references.
  std::vector<RtslRef> reachedFrom(std::vector<RtslRef> objects) const;
  /// RtslInstance::needs of whatever has this material: what it reads, and the objects behind it.
  std::uint32_t needsAt(RtslRef material) const;
  /// Counts the references that lead on from an object that is complete. Those that it refers to
  /// were made before it.
  void measureChain(const ObjectInfo &object);
  bool isClassic() const { return program->engine == Engine::Classic; }
  void dropMeshAttributes();
  /// What an object needs that only the classic engine counts on.
  std::vector<std::string> ifClassic(const char *method) const {
    return isClassic() ? std::vector<std::string>{method} : std::vector<std::string>{};
  }
};

namespace {

/// Calls `visit` with each reference in a value of this type that lies at `bytes`.
template <typename Visit>
void forEachReference(const ValueType &type, const std::uint8_t *bytes, const Visit &visit) {
  if (type.kind != ValueType::Kind::Reference && type.kind != ValueType::Kind::Struct)
    return;
  std::size_t count = 1, size = type.size;
  if (type.bufferRank != 0) {
    RtslBuffer buffer;
    std::memcpy(&buffer, bytes, sizeof buffer);
    for (std::uint8_t i = 0; i < type.bufferRank; ++i)
      count *= buffer.size[i];
    const std::uint64_t address = std::uint64_t(buffer.addressHigh) << 32 | buffer.addressLow;
    bytes = reinterpret_cast<const std::uint8_t *>(address);
    size = count * type.elementSize;
  }
  for (std::uint32_t length : type.arraySizes)
    count *= length;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t *element = bytes + i * (size / count);
    if (type.kind == ValueType::Kind::Reference) {
      RtslRef reference;
      std::memcpy(&reference, element, sizeof reference);
      if (reference != 0)
        visit(reference);
      continue;
    }
    for (const MemberInfo &field : type.fields)
      forEachReference(field.type, element + field.offset, visit);
  }
}

bool holdsReferences(const ValueType &type) {
  return type.kind == ValueType::Kind::Reference ||
         std::any_of(type.fields.begin(), type.fields.end(),
                     [](const MemberInfo &field) { return holdsReferences(field.type); });
}

} // namespace

void Scene::Implementation::measureChain(const ObjectInfo &object) {
  std::uint32_t chain = 0;
  for (const MemberInfo &member : object.classInfo->members) {
    if (holdsReferences(member.type)) // if only to no object: it is called, and does nothing
      chain = std::max(chain, 1u);
    forEachReference(member.type, records.data() + object.object + member.offset,
                     [&](RtslRef reference) {
                       if (const auto found = chains.find(reference); found != chains.end())
                         chain = std::max(chain, found->second + 1);
                     });
  }
  chains[object.object] = chain;
  referenceChain = std::max(referenceChain, chain);
}

std::vector<RtslRef> Scene::Implementation::reachedFrom(std::vector<RtslRef> objects) const {
  std::unordered_set<RtslRef> seen(objects.begin(), objects.end());
  for (std::size_t next = 0; next < objects.size(); ++next) {
    const ObjectInfo object = info(objects[next]);
    for (const MemberInfo &member : object.classInfo->members)
      forEachReference(member.type, records.data() + object.object + member.offset,
                       [&](RtslRef reference) {
                         if (seen.insert(reference).second)
                           objects.push_back(reference);
                       });
  }
  return objects;
}

std::uint32_t Scene::Implementation::needsAt(RtslRef material) const {
  std::uint32_t needs = 0;
  for (RtslRef object : reachedFrom({material}))
    needs |= info(object).classInfo->needs;
  return program->needs & needs;
}

Scene::Scene(std::shared_ptr<const Program> program) : self(std::make_unique<Implementation>()) {
  self->program = std::move(program);
  self->records.assign(firstRecord, 0);
  if (self->program->colorComponents < 1 || self->program->colorComponents > RTSL_MAX_COLOR)
    throw Error(ErrorCode::OutOfRange, fmt::format("a color has 1 to {} components, not {}",
                                                   RTSL_MAX_COLOR, self->program->colorComponents));
}
Scene::~Scene() = default;
Scene::Scene(Scene &&) noexcept = default;
Scene &Scene::operator=(Scene &&) noexcept = default;

const Program &Scene::program() const {
  return *self->program;
}

void Scene::useProgram(std::shared_ptr<const Program> program) {
  const std::vector<ClassInfo> &before = self->program->classes, &after = program->classes;
  if (program->engine != self->program->engine ||
      program->colorComponents != self->program->colorComponents ||
      !std::equal(before.begin(), before.end(), after.begin(), after.end(),
                  [](const ClassInfo &a, const ClassInfo &b) {
                    return a.name == b.name && a.id == b.id && a.recordSize == b.recordSize;
                  }))
    throw Error(ErrorCode::Internal, "the scene was made for another program");
  for (ObjectInfo &object : self->objects)
    object.classInfo = &after[std::size_t(object.classInfo - before.data())];
  self->program = std::move(program);
  for (RtslInstance &instance : self->instances)
    instance.needs = self->needsAt(instance.material);
  self->dropMeshAttributes();
}

void Scene::Implementation::dropMeshAttributes() {
  meshAttributes.clear();
  std::vector<std::uint32_t> needs(meshes.size(), 0);
  for (const RtslInstance &instance : instances)
    if (instance.primitive == 0)
      needs[instance.mesh] |= instance.needs;
  const auto look = [&](std::size_t i, const char *name, std::uint32_t need,
                        std::vector<float> &values, const float *&inTable) {
    if (values.empty())
      return;
    bool isNeeded = (needs[i] & need) != 0;
    meshAttributes.push_back({meshes[i]->name, name, values.size() * sizeof(float), isNeeded});
    if (isNeeded || program->keepsMeshes)
      return;
    values = {};
    inTable = nullptr;
  };
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    Mesh &mesh = meshes[i]->mesh;
    look(i, "normals", RTSL_NEEDS_NORMALS, mesh.normals, meshTable[i].normals);
    look(i, "texture coordinates", RTSL_NEEDS_TEXTURE_COORDINATES | RTSL_NEEDS_DERIVATIVES,
         mesh.uvs, meshTable[i].uvs);
  }
}

const std::vector<Scene::MeshAttribute> &Scene::meshAttributes() const {
  return self->meshAttributes;
}

//===----------------------------------------------------------------------===//
// Objects
//===----------------------------------------------------------------------===//

void Scene::Implementation::runConstructor(const ClassInfo &classInfo, const ObjectInfo &object,
                                           const ObjectValues &values) {
  bool given = !std::holds_alternative<std::monostate>(values.constructor);
  if (!classInfo.hasConstructor) {
    if (given)
      throw Error(ErrorCode::BadArguments,
                  fmt::format("class `{}` has no constructor; set its public members by name",
                              classInfo.name),
                  values.place);
    return;
  }

  const std::vector<MemberInfo> &parameters = classInfo.parameters;
  std::vector<const Value *> arguments(parameters.size(), nullptr);
  if (auto *list = std::get_if<std::vector<Value>>(&values.constructor)) {
    if (list->size() != parameters.size())
      throw Error(ErrorCode::BadArguments,
                  fmt::format("the constructor of `{}` takes {} argument{}, not {}", classInfo.name,
                              parameters.size(), parameters.size() == 1 ? "" : "s", list->size()),
                  values.place)
          .note(fmt::format("it is declared as `{}`", listParameters(classInfo)));
    for (std::size_t i = 0; i < parameters.size(); ++i)
      arguments[i] = &(*list)[i];
  } else if (auto *named = std::get_if<std::vector<NamedValue>>(&values.constructor)) {
    for (const NamedValue &one : *named) {
      auto found =
          std::find_if(parameters.begin(), parameters.end(),
                       [&](const MemberInfo &parameter) { return parameter.name == one.name; });
      if (found == parameters.end()) {
        Error error(
            ErrorCode::BadArguments,
            fmt::format("the constructor of `{}` has no parameter `{}`", classInfo.name, one.name),
            one.place ? one.place : values.place);
        std::vector<std::string> names;
        for (const MemberInfo &parameter : parameters)
          names.push_back(parameter.name);
        if (const std::string near = closestName(one.name, names); !near.empty())
          error.fix(near);
        throw error.note(fmt::format("it is declared as `{}`", listParameters(classInfo)));
      }
      const Value *&argument = arguments[std::size_t(found - parameters.begin())];
      if (argument)
        throw Error(ErrorCode::BadArguments, fmt::format("parameter `{}` is given twice", one.name),
                    one.place ? one.place : values.place);
      argument = &one.value;
    }
  }
  std::string missing;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (!arguments[i])
      missing += fmt::format("{}`{}`", missing.empty() ? "" : ", ", parameters[i].name);
  if (!missing.empty())
    throw Error(
        ErrorCode::BadArguments,
        fmt::format("the constructor of `{}` misses an argument for {}", classInfo.name, missing),
        values.place)
        .note(fmt::format("it is declared as `{}`", listParameters(classInfo)));

  // Words, for the packed arguments are read as such.
  std::vector<std::uint32_t> packed(classInfo.parameterSize / 4 + 1, 0);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    storeValue(
        parameters[i].type, *arguments[i],
        reinterpret_cast<std::uint8_t *>(packed.data()) + parameters[i].offset, storeContext(),
        fmt::format("parameter `{}` of `{}`", parameters[i].name, classInfo.name), values.place);
  if (classInfo.construct)
    withState(object.object,
              [&](RtslState &state) { classInfo.construct(&state, object.object, packed.data()); });
}

void Scene::Implementation::setMembers(const ClassInfo &classInfo, const ObjectInfo &object,
                                       const ObjectValues &values) {
  ErrorCollector errors;
  for (const NamedValue &one : values.members)
    errors.attempt([&] { setMember(classInfo, object, one, values.place); });
  errors.throwIfAny();
}

void Scene::Implementation::setMember(const ClassInfo &classInfo, const ObjectInfo &object,
                                      const NamedValue &one, const std::optional<Place> &place) {
  auto found = std::find_if(classInfo.members.begin(), classInfo.members.end(),
                            [&](const MemberInfo &member) { return member.name == one.name; });
  if (found == classInfo.members.end()) {
    Error error(ErrorCode::UnknownMember,
                fmt::format("class `{}` has no member `{}`", classInfo.name, one.name),
                one.place ? one.place : place);
    std::vector<std::string> names;
    for (const MemberInfo &member : classInfo.members)
      if (member.isPublic)
        names.push_back(member.name);
    if (const std::string near = closestName(one.name, names); !near.empty())
      error.fix(near);
    throw error;
  }
  if (!found->isPublic)
    throw Error(ErrorCode::NotSettable,
                fmt::format("member `{}` of `{}` is not public", one.name, classInfo.name),
                one.place ? one.place : place);
  storeValue(found->type, one.value, records.data() + object.object + found->offset, storeContext(),
             fmt::format("member `{}` of `{}`", one.name, object.name), place);
}

void Scene::Implementation::checkUnset(const ClassInfo &classInfo, const ObjectInfo &object,
                                       const ObjectValues &values) {
  for (const MemberInfo &member : classInfo.members) {
    if (!member.isPublic || member.hasDefault)
      continue;
    bool given = std::any_of(values.members.begin(), values.members.end(),
                             [&](const NamedValue &one) { return one.name == member.name; });
    if (given)
      continue;
    if (member.type.kind == ValueType::Kind::Reference && member.type.bufferRank == 0 &&
        member.type.arraySizes.empty()) {
      RtslRef reference;
      std::memcpy(&reference, records.data() + object.object + member.offset, 4);
      if (reference == 0)
        throw Error(ErrorCode::MissingMember,
                    fmt::format("`{}` refers to nothing: set member `{}` of class `{}`, a `{}`",
                                object.name, member.name, classInfo.name, member.type.className),
                    object.place);
    } else if (!classInfo.hasConstructor && member.type.bufferRank == 0) {
      warnings.push_back({fmt::format("member `{}` of `{}` is not set and has no default: it is 0",
                                      member.name, object.name),
                          object.place});
    }
  }
}

RtslRef Scene::addObject(const std::string &className, const ObjectValues &values,
                         const std::string &name) {
  const ClassInfo *classInfo = self->program->find(className);
  if (!classInfo) {
    Error error(ErrorCode::UnknownClass, fmt::format("no class is named `{}`", className),
                values.place);
    std::vector<std::string> names;
    for (const ClassInfo &one : self->program->classes)
      names.push_back(one.name);
    if (const std::string near = closestName(className, names); !near.empty())
      error.fix(near);
    throw error;
  }
  std::vector<std::uint8_t> &records = self->records;
  std::size_t start = (records.size() + recordAlignment - 1) / recordAlignment * recordAlignment;
  if (start + classInfo->recordSize > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::OutOfMemory, "the objects of the scene take more than 4 GiB",
                values.place);
  std::size_t before = records.size();
  records.resize(start + std::max(classInfo->recordSize, 4u), 0);
  std::memcpy(records.data() + start, &classInfo->id, 4);
  RtslRef object = RtslRef(start);
  self->objects.push_back({object, classInfo, name.empty() ? className : name, values.place});
  try {
    const ObjectInfo info = self->objects.back();
    if (classInfo->initialize)
      self->withState(object, [&](RtslState &state) { classInfo->initialize(&state, object); });
    self->runConstructor(*classInfo, info, values);
    self->setMembers(*classInfo, info, values);
    self->checkUnset(*classInfo, info, values);
    self->measureChain(info);
  } catch (...) { // half an object is none
    self->objects.pop_back();
    records.resize(before);
    throw;
  }
  return object;
}

RtslRef Scene::addObject(const std::string &className, std::vector<Value> arguments,
                         const std::string &name) {
  ObjectValues values;
  values.constructor = std::move(arguments);
  return addObject(className, values, name);
}

const std::uint8_t *Scene::record(RtslRef object) const {
  return self->records.data() + self->info(object).object;
}
const ClassInfo &Scene::classOf(RtslRef object) const {
  return *self->info(object).classInfo;
}
SceneFacts Scene::facts() const {
  SceneFacts facts;
  std::vector<RtslRef> roots = self->lights;
  for (RtslRef root : {self->camera, self->rayGeneration, self->background, self->exception})
    if (root != 0)
      roots.push_back(root);
  for (const RtslInstance &instance : self->instances)
    for (RtslRef root : {instance.primitive, instance.material})
      if (root != 0)
        roots.push_back(root);
  const std::vector<RtslRef> list = self->reachedFrom(std::move(roots));
  const std::unordered_set<RtslRef> reached(list.begin(), list.end());
  for (const ObjectInfo &object : self->objects)
    if (reached.count(object.object))
      facts.objects.push_back({object.classInfo->name, self->records.data() + object.object});
  facts.lightCount = std::uint32_t(self->lights.size());
  facts.ambient.assign(self->ambient, self->ambient + self->program->colorComponents);
  facts.referenceChain = self->referenceChain;
  return facts;
}
const std::string &Scene::nameOf(RtslRef object) const {
  return self->info(object).name;
}

//===----------------------------------------------------------------------===//
// What there is to hit
//===----------------------------------------------------------------------===//

std::uint32_t Scene::Implementation::addInstance(RtslRef primitive, std::uint32_t mesh,
                                                 RtslRef material, std::string name,
                                                 std::uint32_t primitives, std::uint32_t mask) {
  requireRole(material, "rt_Material", ifClassic("shade"));
  if (primitiveTotal + primitives > 0x7fffffffu)
    throw Error(ErrorCode::OutOfMemory, "the scene has more than 2^31 primitives");
  instances.push_back({primitive,
                       material,
                       mesh,
                       std::uint32_t(primitiveTotal),
                       needsAt(material),
                       mask,
                       info(material).classInfo->anyHit,
                       {},
                       {},
                       {},
                       {}});
  primitiveTotal += primitives;
  instanceNames.push_back(std::move(name));
  return std::uint32_t(instances.size() - 1);
}

std::uint32_t Scene::addPrimitive(RtslRef primitive, RtslRef material, std::uint32_t mask) {
  self->requireRole(primitive, "rt_Primitive", {"intersect", "computeBounds"});
  const ObjectInfo &info = self->info(primitive);
  Bounds given;
  self->withState(primitive, [&](RtslState &state) {
    for (int i = 0; i < 3; ++i) { // what computeBounds leaves out shows
      state.BoundMin[i] = std::numeric_limits<float>::quiet_NaN();
      state.BoundMax[i] = std::numeric_limits<float>::quiet_NaN();
    }
    if (self->program->slots.rt_Primitive_computeBounds)
      self->program->slots.rt_Primitive_computeBounds(&state, primitive);
    std::copy_n(state.BoundMin, 3, given.lower);
    std::copy_n(state.BoundMax, 3, given.upper);
  });
  const char axes[] = "xyz";
  int flatSides = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::isnan(given.lower[i]) || std::isnan(given.upper[i]))
      throw Error(
          ErrorCode::DegenerateGeometry,
          fmt::format("the bounds of primitive `{}` are not numbers (in {})", info.name, axes[i]),
          info.place);
    if (given.lower[i] > given.upper[i])
      throw Error(ErrorCode::DegenerateGeometry,
                  fmt::format("the bounds of primitive `{}` are inverted: {} runs from {} to {}",
                              info.name, axes[i], given.lower[i], given.upper[i]),
                  info.place);
    flatSides += given.lower[i] == given.upper[i];
  }
  if (flatSides >= 2)
    self->warnings.push_back(
        {fmt::format("primitive `{}` is {}: no ray can hit it", info.name,
                     flatSides == 3 ? "a single point" : "a line without width"),
         info.place});
  std::uint32_t instance = self->addInstance(primitive, 0, material, info.name, 1, mask);
  RtslInstance &added = self->instances.back();
  std::copy_n(given.lower, 3, added.boundMin);
  std::copy_n(given.upper, 3, added.boundMax);
  for (int i = 0; i < 3; ++i) {
    added.lower[i] = outwards(given.lower[i], -1);
    added.upper[i] = outwards(given.upper[i], 1);
  }
  return instance;
}

std::uint32_t Scene::addMesh(Mesh mesh, const std::string &name) {
  std::string shown = name.empty() ? fmt::format("mesh {}", self->meshes.size()) : name;
  validateMesh(mesh, shown);
  auto storage = std::make_unique<MeshStorage>(MeshStorage{std::move(mesh), std::move(shown)});
  Mesh &kept = storage->mesh;
  RtslMesh table{};
  table.positions = kept.positions.data();
  table.normals = kept.normals.empty() ? nullptr : kept.normals.data();
  table.uvs = kept.uvs.empty() ? nullptr : kept.uvs.data();
  table.indices = kept.indices.data();
  table.vertexCount = std::uint32_t(kept.vertexCount());
  table.triangleCount = std::uint32_t(kept.triangleCount());
  self->meshTable.push_back(table);
  self->meshes.push_back(std::move(storage));
  return std::uint32_t(self->meshes.size() - 1);
}

std::uint32_t Scene::addMeshInstance(std::uint32_t mesh, RtslRef material, std::uint32_t mask) {
  if (mesh >= self->meshes.size())
    throw Error(ErrorCode::UnknownName, fmt::format("the scene has no mesh number {}", mesh));
  return self->addInstance(0, mesh, material, self->meshes[mesh]->name,
                           self->meshTable[mesh].triangleCount, mask);
}

std::size_t Scene::recordBytes() const {
  return self->records.size();
}

std::vector<Scene::BufferPlace> Scene::buffers() const {
  std::vector<BufferPlace> places;
  for (const ObjectInfo &object : self->objects)
    for (const MemberInfo &member : object.classInfo->members) {
      if (member.type.bufferRank == 0)
        continue;
      const std::uint32_t offset = object.object + member.offset;
      RtslBuffer buffer;
      std::memcpy(&buffer, self->records.data() + offset, sizeof buffer);
      std::size_t bytes = member.type.elementSize;
      for (std::uint8_t i = 0; i < member.type.bufferRank; ++i)
        bytes *= buffer.size[i];
      places.push_back({offset, bytes});
    }
  return places;
}

Bounds Scene::primitiveBounds(std::uint32_t instance) const {
  const RtslInstance &one = self->instances.at(instance);
  Bounds bounds;
  std::copy_n(one.lower, 3, bounds.lower);
  std::copy_n(one.upper, 3, bounds.upper);
  return bounds;
}

std::uint32_t Scene::primitiveCount(std::uint32_t instance) const {
  const RtslInstance &one = self->instances.at(instance);
  return one.primitive ? 1 : self->meshTable[one.mesh].triangleCount;
}

const std::string &Scene::instanceName(std::uint32_t instance) const {
  return self->instanceNames.at(instance);
}

//===----------------------------------------------------------------------===//
// Lights, camera, background
//===----------------------------------------------------------------------===//

void Scene::addLight(RtslRef light) {
  self->requireRole(light, "rt_Light", {"illumination"});
  self->lights.push_back(light);
}

void Scene::setCamera(RtslRef camera) {
  self->requireRole(camera, "rt_Camera", {"generateRay"});
  self->camera = camera;
}

void Scene::setRayGeneration(RtslRef rayGeneration) {
  self->requireRole(rayGeneration, "rt_RayGeneration", {"generate"});
  self->rayGeneration = rayGeneration;
}

void Scene::setBackground(RtslRef miss) {
  self->requireRole(miss, "rt_Miss", self->ifClassic("miss"));
  self->background = miss;
}

void Scene::setException(RtslRef exception) {
  self->requireRole(exception, "rt_Exception", {"exception"});
  self->exception = exception;
}

void Scene::Implementation::setColor(const std::vector<float> &color, float *to,
                                     const char *what) const {
  std::vector<float> components = colorFromNumbers(color, program->colorComponents);
  if (components.empty())
    throw Error(ErrorCode::WrongType,
                fmt::format("the {} is a color: it takes 1, 3 or {} numbers, not {}", what,
                            program->colorComponents, color.size()));
  std::copy(components.begin(), components.end(), to);
}

void Scene::setBackgroundColor(const std::vector<float> &color) {
  self->setColor(color, self->backgroundColor, "background");
  self->background = 0;
}

void Scene::setAmbient(const std::vector<float> &color) {
  self->setColor(color, self->ambient, "ambient light");
}

const std::vector<Warning> &Scene::warnings() const {
  return self->warnings;
}

RtslLaunch Scene::launch() const {
  if (self->isClassic() && self->camera == 0)
    throw Error(ErrorCode::IncompleteScene, "the scene has no camera");
  if (self->program->engine == Engine::Programs && self->rayGeneration == 0)
    throw Error(ErrorCode::IncompleteScene, "the scene has no ray generation");
  if (self->program->engine == Engine::Either && self->camera == 0 && self->rayGeneration == 0)
    throw Error(ErrorCode::IncompleteScene, "the scene has neither a ray generation nor a camera");
  return self->tables();
}

} // namespace rtsl::runtime
