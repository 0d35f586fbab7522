//===- BuildObjects.h - objects of a program from their descriptions ------===//
//
// Named objects are made on first use, after those that they refer to. With variables, what is used
// below a node is another object than what is used elsewhere.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/ImageObjects.h"
#include "scenefile/SceneFile.h"
#include "scenefile/graph/VariablePlaces.h"
#include "scenefile/graph/Variables.h"
#include "support/ErrorCollector.h"

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {

/// Thrown when a reference is to an object that was rejected, which has been reported.
struct Refused {};

class ObjectBuilder {
public:
  ObjectBuilder(const SceneDescription &description, runtime::Scene &scene, Variables &variables,
                ImageObjects &images, NamedBuffers &buffers, ValueCompletion complete);

  /// An error in one part of the scene does not prevent checking the others. Gives whether there
  /// was none.
  template <typename Step>
  bool attempt(Step step) {
    try {
      return errors.attempt(step);
    } catch (const Refused &) {
      return false;
    }
  }
  void throwIfAny() { errors.throwIfAny(); }

  /// `launch`: of a ray generation, whose output buffers that are not set get its size.
  RtslRef add(const ObjectDescription &object, const std::string &name,
              const RenderSettings *launch = nullptr);
  /// An object written in place takes variables as a named one does: it is one object for all
  /// instances for which it takes the same.
  RtslRef addOnce(const ObjectDescription &object, const std::string &name);
  /// How many of these were made.
  std::size_t madeOnce() const { return inPlaces.size(); }
  RtslRef referred(const ReferenceDescription &reference);
  /// All objects with names that nothing has referred to, in the order of their names.
  void addNamed();

  /// Converts JSON to a value. Strings name objects if the type is a reference, and are not allowed
  /// otherwise; null is no object, for references that `mayBeEmpty`.
  runtime::Value convert(const JsonValue &json, const runtime::ValueType *type,
                         const std::string &what, bool mayBeEmpty = false);

private:
  /// The helper, texture or material of this name, created on first use, once for all uses for
  /// which it takes the same variables.
  RtslRef named(const std::string &name, const Place &place);
  /// Is there an object of this name, with whatever variables?
  bool isMade(const std::string &name) const;
  std::vector<std::string> allNames() const;

  runtime::Value bufferOf(const BufferDescription &buffer, const runtime::ValueType &type,
                          const std::string &what, const Place &place) const;
  /// An element for each launch index.
  runtime::Value outputOf(const runtime::MemberInfo &member, const std::string &name,
                          const RenderSettings &launch, const Place &place) const;
  /// A buffer of `buffers`, whose elements all members that use it share.
  runtime::Value makeBuffer(const JsonValue &value, const runtime::ValueType &type,
                            const std::string &name);
  /// The buffer of this name, made on first use.
  runtime::Value namedBuffer(const JsonValue &json, const runtime::ValueType &type,
                             const std::string &what);

  const SceneDescription &description;
  const std::array<const std::map<std::string, ObjectDescription> *, 4> sections = {
      &description.images, &description.helpers, &description.textures,
      &description.materials}; // of named objects
  const runtime::Program &program;
  runtime::Scene &scene;
  Variables &variables;
  VariablePlaces variablePlaces;
  ImageObjects &images;
  NamedBuffers &buffers;
  const ValueCompletion complete;
  std::map<std::pair<std::string, Variables::Taken>, RtslRef> made; // 0: being created
  std::map<std::pair<const ObjectDescription *, Variables::Taken>, RtslRef> inPlaces;
  std::set<std::string> refused = description.refused.names;
  ErrorCollector errors;
};

} // namespace rtsl::scene
