#include "runtime/scene/Objects.h"

#include "runtime/device/ray/Random.h"
#include "runtime/scene/ObjectValues.h"
#include "runtime/scene/References.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <unordered_set>

namespace rtsl::runtime {

namespace {

/// Records begin after this: reference 0 is "none", and a class id of 0 there makes every dispatch
/// do nothing.
constexpr std::uint32_t firstRecord = 16;
constexpr std::uint32_t recordAlignment = 16;

/// Throws UnknownClass.
const ClassInfo &findClass(const Program &program, const std::string &className,
                           const std::optional<Place> &place) {
  if (const ClassInfo *classInfo = program.find(className))
    return *classInfo;
  Error error(message::noSuchClass(className), place);
  std::vector<std::string> names;
  for (const ClassInfo &one : program.classes)
    names.push_back(one.name);
  if (const std::string near = closestName(className, names); !near.empty())
    error.fix(near);
  throw error;
}

} // namespace

bool hasMethod(const ClassInfo &info, const std::string &method) {
  return std::find(info.methods.begin(), info.methods.end(), method) != info.methods.end();
}

std::vector<std::string> ifClassic(const Program &program, const char *method) {
  return program.engine == Engine::Classic ? std::vector<std::string>{method}
                                           : std::vector<std::string>{};
}

void callOutsideOfRays(const RtslLaunch &launch, RtslRef object,
                       const std::function<void(RtslState &)> &call) {
  RtslState state{};
  state.launch = &launch;
  state.instance = state.primitive = RTSL_NO_HIT;
  state.HitDistance = std::numeric_limits<float>::infinity();
  device::Words3 key = device::hash3(object, 0, 0);
  state.randomKey[0] = key.x;
  state.randomKey[1] = key.y;
  call(state);
}

Objects::Objects(std::shared_ptr<const Program> program)
    : code(std::move(program)), records(firstRecord, 0) {
  if (!code)
    throw Error(message::noShaders());
  if (code->colorComponents < 1 || code->colorComponents > RTSL_MAX_COLOR)
    throw Error(message::colorComponents(RTSL_MAX_COLOR, code->colorComponents));
}

void Objects::useProgram(std::shared_ptr<const Program> program) {
  const std::vector<ClassInfo> &before = code->classes, &after = program->classes;
  if (program->engine != code->engine || program->colorComponents != code->colorComponents ||
      !std::equal(before.begin(), before.end(), after.begin(), after.end(),
                  [](const ClassInfo &a, const ClassInfo &b) {
                    return a.name == b.name && a.id == b.id && a.recordSize == b.recordSize;
                  }))
    throw Error(message::otherProgram());
  for (Object &object : objects)
    object.classInfo = &after[std::size_t(object.classInfo - before.data())];
  code = std::move(program);
}

RtslRef Objects::add(const std::string &className, const ObjectValues &values,
                     const std::string &name, const std::function<RtslLaunch()> &launch) {
  const ClassInfo &classInfo = findClass(*code, className, values.place);
  std::size_t start = (records.size() + recordAlignment - 1) / recordAlignment * recordAlignment;
  if (start + classInfo.recordSize > std::numeric_limits<std::uint32_t>::max())
    throw Error(message::objectsTooLarge(), values.place);
  std::size_t before = records.size();
  records.resize(start + std::max(classInfo.recordSize, 4u), 0);
  std::memcpy(records.data() + start, &classInfo.id, 4);
  const Object object = {RtslRef(start), &classInfo, name.empty() ? className : name, values.place};
  objects.push_back(object);
  try {
    if (classInfo.initialize)
      callOutsideOfRays(launch(), object.reference,
                        [&](RtslState &state) { classInfo.initialize(&state, object.reference); });
    ErrorCollector errors;
    bool isConstructed = false;
    errors.attempt([&] { isConstructed = runConstructor(object, values, launch); });
    errors.attempt([&] {
      storeMembers(classInfo, object.name, values, recordOf(object), storeContext(object),
                   !isConstructed && std::holds_alternative<std::monostate>(values.constructor));
    });
    errors.throwIfAny();
    if (isConstructed) {
      checkUnset(classInfo, object.name, values, recordOf(object));
      checkOwnValues(classInfo, object.name, values, recordOf(object), code->colorComponents);
    }
    measureChain(object);
  } catch (...) { // an object is added completely or not at all
    objects.pop_back();
    records.resize(before);
    throw;
  }
  return object.reference;
}

std::vector<std::uint8_t> Objects::setMember(RtslRef reference, const NamedValue &value) {
  const Object &object = at(reference);
  ObjectValues values;
  values.members.push_back(value);
  const std::size_t size = std::max(object.classInfo->recordSize, 4u);
  std::vector<std::uint8_t> before(recordOf(object), recordOf(object) + size), changed = before;
  storeMembers(*object.classInfo, object.name, values, changed.data(), storeContext(object));
  setRecord(reference, changed);
  return before;
}

void Objects::setRecord(RtslRef reference, const std::vector<std::uint8_t> &record) {
  const Object &object = at(reference);
  std::copy(record.begin(), record.end(), recordOf(object));
  measureChain(object);
}

bool Objects::runConstructor(const Object &object, const ObjectValues &values,
                             const std::function<RtslLaunch()> &launch) {
  const ClassInfo &classInfo = *object.classInfo;
  if (!classInfo.hasConstructor && std::holds_alternative<std::monostate>(values.constructor))
    return true;
  const std::vector<std::uint32_t> arguments =
      packArguments(classInfo, values, storeContext(object));
  if (arguments.empty())
    return false;
  if (classInfo.construct)
    callOutsideOfRays(launch(), object.reference, [&](RtslState &state) {
      classInfo.construct(&state, object.reference, arguments.data());
    });
  return true;
}

bool Objects::derivesFrom(const ClassInfo *info, const std::string &className) const {
  for (; info; info = code->find(info->base)) {
    const std::vector<std::string> &above = info->ancestors;
    if (info->name == className || info->base == className || info->root == className ||
        std::find(above.begin(), above.end(), className) != above.end())
      return true;
  }
  return false;
}

StoreContext Objects::storeContext(const Object &object) {
  StoreContext context;
  context.colorComponents = code->colorComponents;
  context.allocate = [this](std::size_t bytes) {
    bufferMemory.push_back(std::make_unique<std::uint32_t[]>(bytes / 4 + 1));
    return reinterpret_cast<std::uint8_t *>(bufferMemory.back().get());
  };
  // A launch runs one ray generation: others may read what it writes in other launches.
  const RtslRef launched =
      object.classInfo->root == "rt_RayGeneration" ? object.reference : RtslRef(0);
  context.keep = [this, launched](std::shared_ptr<Value::Words> words, bool isOutput) {
    std::vector<BlockUse> &uses = blocks[std::move(words)];
    const bool clashes = std::any_of(uses.begin(), uses.end(), [&](const BlockUse &use) {
      const bool areApart = launched && use.launched && launched != use.launched;
      return (isOutput || use.isOutput) && !areApart;
    });
    uses.push_back({launched, isOutput});
    return !clashes;
  };
  context.classMismatch = [this](RtslRef object,
                                 const std::string &className) -> const std::string * {
    const ClassInfo *classInfo = at(object).classInfo;
    return derivesFrom(classInfo, className) ? nullptr : &classInfo->name;
  };
  return context;
}

const Objects::Object &Objects::at(RtslRef reference) const {
  auto found =
      std::lower_bound(objects.begin(), objects.end(), reference,
                       [](const Object &object, RtslRef ref) { return object.reference < ref; });
  if (found == objects.end() || found->reference != reference)
    throw Error(message::noSuchReference(reference));
  return *found;
}

const std::uint8_t *Objects::record(RtslRef reference) const {
  return records.data() + at(reference).reference;
}

void Objects::requireRole(RtslRef reference, const std::string &root,
                          const std::vector<std::string> &methods) const {
  const Object &given = at(reference);
  if (given.classInfo->root != root)
    throw Error(message::wrongRootClass(given.name, given.classInfo->name, root), given.place);
  for (const std::string &method : methods)
    if (!hasMethod(*given.classInfo, method))
      throw Error(message::methodMissing(given.classInfo->name, given.name, method), given.place);
}

/// Counts the references that lead on from an object that is complete. Those that it refers to
/// were made before it.
void Objects::measureChain(const Object &object) {
  std::uint32_t chain = 0;
  for (const MemberInfo &member : object.classInfo->members) {
    if (holdsReferences(member.type)) // if only to no object: it is called, and does nothing
      chain = std::max(chain, 1u);
    forEachReference(member.type, recordOf(object) + member.offset, [&](RtslRef reference) {
      if (const auto found = chains.find(reference); found != chains.end())
        chain = std::max(chain, found->second + 1);
    });
  }
  chains[object.reference] = chain;
  longestChain = std::max(longestChain, chain);
}

std::vector<RtslRef> Objects::reachedFrom(std::vector<RtslRef> references) const {
  std::unordered_set<RtslRef> seen(references.begin(), references.end());
  for (std::size_t next = 0; next < references.size(); ++next) {
    const Object &object = at(references[next]);
    for (const MemberInfo &member : object.classInfo->members)
      forEachReference(member.type, records.data() + object.reference + member.offset,
                       [&](RtslRef reference) {
                         if (seen.insert(reference).second)
                           references.push_back(reference);
                       });
  }
  return references;
}

std::uint32_t Objects::needsOf(RtslRef reference) const {
  std::uint32_t needs = 0;
  for (RtslRef one : reachedFrom({reference}))
    needs |= at(one).classInfo->needs;
  return code->needs & needs;
}

bool Objects::isOpaque(RtslRef material) const {
  const auto &conditions = at(material).classInfo->opaqueIfZero;
  const auto isZero = [&](RtslRef reference, const MemberInfo &member) {
    const std::uint8_t *value = records.data() + reference + member.offset;
    return std::all_of(value, value + member.type.size,
                       [](std::uint8_t byte) { return byte == 0; });
  };
  const auto holdsFor = [&](RtslRef reference, const MemberName &condition) {
    const ClassInfo &info = *at(reference).classInfo;
    return info.name != condition.className ||
           std::all_of(info.members.begin(), info.members.end(), [&](const MemberInfo &member) {
             return member.name != condition.member || isZero(reference, member);
           });
  };
  if (!conditions)
    return false;
  const std::vector<RtslRef> reached = reachedFrom({material});
  return std::all_of(conditions->begin(), conditions->end(), [&](const MemberName &condition) {
    return std::all_of(reached.begin(), reached.end(),
                       [&](RtslRef one) { return holdsFor(one, condition); });
  });
}

bool Objects::isConditionOfOpacity(RtslRef reference, const std::string &member) const {
  const std::string &className = at(reference).classInfo->name;
  const auto isIt = [&](const MemberName &condition) {
    return condition.className == className && condition.member == member;
  };
  return std::any_of(code->classes.begin(), code->classes.end(), [&](const ClassInfo &info) {
    return info.opaqueIfZero &&
           std::any_of(info.opaqueIfZero->begin(), info.opaqueIfZero->end(), isIt);
  });
}

std::uint32_t Objects::attributesOf(RtslRef reference) const {
  std::uint32_t attributes = 0;
  for (RtslRef one : reachedFrom({reference}))
    attributes |= at(one).classInfo->attributes;
  return attributes;
}

/// The buffer of a member in the record of an object.
static RtslBuffer bufferAt(const std::uint8_t *record, const MemberInfo &member) {
  RtslBuffer buffer;
  std::memcpy(&buffer, record + member.offset, sizeof buffer);
  return buffer;
}

static std::size_t bytesOf(const RtslBuffer &buffer, const ValueType &type) {
  std::size_t bytes = type.elementSize;
  for (std::uint8_t i = 0; i < type.bufferRank; ++i)
    bytes *= buffer.size[i];
  return bytes;
}

std::vector<BufferPlace> Objects::buffers() const {
  std::vector<BufferPlace> places;
  for (const Object &object : objects)
    for (const MemberInfo &member : object.classInfo->members)
      if (member.type.bufferRank != 0)
        places.push_back({object.reference + member.offset,
                          bytesOf(bufferAt(records.data() + object.reference, member), member.type),
                          member.type.isOutput});
  return places;
}

std::vector<OutputBuffer> Objects::outputs(RtslRef reference) const {
  std::vector<OutputBuffer> outputs;
  for (const MemberInfo &member : at(reference).classInfo->members) {
    if (!member.type.isOutput)
      continue;
    const RtslBuffer buffer = bufferAt(record(reference), member);
    const std::uint64_t address = std::uint64_t(buffer.addressHigh) << 32 | buffer.addressLow;
    outputs.push_back({member.name,
                       member.type,
                       {buffer.size, buffer.size + member.type.bufferRank},
                       reinterpret_cast<std::uint8_t *>(address),
                       bytesOf(buffer, member.type)});
  }
  return outputs;
}

Objects::Extent Objects::extent() const {
  return {records.size(), objects.size(), bufferMemory.size(), blocks, longestChain};
}

void Objects::cutBack(const Extent &to) {
  for (std::size_t i = to.objects; i < objects.size(); ++i)
    chains.erase(objects[i].reference);
  records.resize(to.recordBytes);
  objects.resize(to.objects);
  bufferMemory.resize(to.bufferMemory);
  blocks = to.blocks;
  longestChain = to.longestChain;
}

void Objects::fill(RtslLaunch &launch) {
  launch.records = records.data();
  launch.colorComponents = code->colorComponents;
  launch.needs = code->needs;
  launch.referenceChain = longestChain;
}

} // namespace rtsl::runtime
