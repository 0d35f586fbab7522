//===- Objects.h - the records of a scene's objects -----------------------===//
//
// One block of bytes holds the records of all objects, with the layouts of their classes. Code of
// the program, the member defaults and the constructor, initialises a record; then the scene's
// members are written.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/SceneData.h"
#include "runtime/scene/ValueStore.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace rtsl::runtime {

class Objects {
public:
  /// Throws IncompleteScene without a program, and OutOfRange if its number of color components is
  /// invalid.
  explicit Objects(std::shared_ptr<const Program> program);

  const Program &program() const { return *code; }

  /// Scene::useProgram. Throws Internal if the program has other classes.
  void useProgram(std::shared_ptr<const Program> program);

  /// Scene::addObject. `launch` returns the scene's current launch, for the code that runs. If it
  /// throws, nothing is added.
  RtslRef add(const std::string &className, const ObjectValues &values, const std::string &name,
              const std::function<RtslLaunch()> &launch);

  /// Scene::setMember. Returns the record as it was, for setRecord. If it throws, nothing is
  /// changed.
  std::vector<std::uint8_t> setMember(RtslRef reference, const NamedValue &value);
  void setRecord(RtslRef reference, const std::vector<std::uint8_t> &record);

  struct Object {
    RtslRef reference;
    const ClassInfo *classInfo;
    std::string name;
    std::optional<Place> place;
  };
  /// Throws UnknownName.
  const Object &at(RtslRef reference) const;
  /// All objects in the order in which they were added, which is that of their references.
  const std::vector<Object> &all() const { return objects; }

  /// Throws WrongClass if the object's class does not derive from the class `root` of the language,
  /// and MissingMethod if it lacks one of the methods.
  void requireRole(RtslRef reference, const std::string &root,
                   const std::vector<std::string> &methods) const;

  const std::uint8_t *record(RtslRef reference) const;

  /// The given objects and all objects reachable through their references.
  std::vector<RtslRef> reachedFrom(std::vector<RtslRef> references) const;
  /// RTSL_NEEDS_*: the state that methods of this object and of all reachable objects read.
  std::uint32_t needsOf(RtslRef reference) const;
  /// Does no light of the scene's lights pass this material (ClassInfo::opaqueIfZero)?
  bool isOpaque(RtslRef material) const;
  /// May that depend on the value of this member?
  bool isConditionOfOpacity(RtslRef reference, const std::string &member) const;
  /// Which of Program::meshAttributes these methods read, as bits.
  std::uint32_t attributesOf(RtslRef reference) const;
  /// The longest chain of references from object to object.
  std::uint32_t referenceChain() const { return longestChain; }

  std::vector<BufferPlace> buffers() const;
  /// The output buffers of an object.
  std::vector<OutputBuffer> outputs(RtslRef reference) const;

  /// Bytes of all records.
  std::size_t recordBytes() const { return records.size(); }

  /// Sets the launch's fields about objects. Code that uses the launch may write the records.
  void fill(RtslLaunch &launch);

private:
  /// A member that uses a block of memory as its buffer: of which ray generation, 0 if of another
  /// object, and whether it is an output buffer.
  struct BlockUse {
    RtslRef launched;
    bool isOutput;
  };
  using Blocks = std::map<std::shared_ptr<Value::Words>, std::vector<BlockUse>>;

public:
  /// How much there is.
  struct Extent {
    std::size_t recordBytes, objects, bufferMemory;
    Blocks blocks;
    std::uint32_t longestChain;
  };
  Extent extent() const;
  /// Removes what has been added since; nothing else may have changed.
  void cutBack(const Extent &to);

private:
  /// Gives whether it could: arguments may be refused.
  bool runConstructor(const Object &object, const ObjectValues &values,
                      const std::function<RtslLaunch()> &launch);
  void measureChain(const Object &object);
  bool derivesFrom(const ClassInfo *info, const std::string &className) const;
  StoreContext storeContext(const Object &object);
  std::uint8_t *recordOf(const Object &object) { return records.data() + object.reference; }

  std::shared_ptr<const Program> code;
  std::vector<std::uint8_t> records;
  std::vector<Object> objects; // ascending by reference
  std::vector<std::unique_ptr<std::uint32_t[]>> bufferMemory;
  Blocks blocks;
  std::unordered_map<RtslRef, std::uint32_t> chains; // measureChain
  std::uint32_t longestChain = 0;
};

/// Does the class define or inherit a method of this name?
bool hasMethod(const ClassInfo &info, const std::string &method);

/// The method if the program uses the classic engine, which calls it; otherwise nothing.
std::vector<std::string> ifClassic(const Program &program, const char *method);

/// Runs code of the program for an object outside of any ray, with the scene's launch.
void callOutsideOfRays(const RtslLaunch &launch, RtslRef object,
                       const std::function<void(RtslState &)> &call);

} // namespace rtsl::runtime
