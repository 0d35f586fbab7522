//===- LinkRequest.h - what a scene requires of a program -----------------===//
#pragma once

#include "codegen/ir/SourcePlace.h"
#include "codegen/link/Items.h"
#include "runtime/program/Program.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rtsl {

/// A part of a scene that may refer to others: a named object, or an item of a list.
struct ScenePart {
  enum class Role : std::uint8_t {
    Root,
    Light,
    Named
  }; // named materials and textures are only used by other parts
  Role role = Role::Root;
  std::string name; // shown to users: "material clay"
  // of the object, and of objects defined inside of it
  std::vector<std::string> classes;
  std::vector<std::size_t> refersTo; // indices of parts
  ir::SourcePlace place;
};

/// The input of the linker about a scene.
struct LinkRequest {
  /// The classes that the scene has objects of; only these are kept. Empty: all classes of the
  /// module.
  std::vector<std::string> classes;
  /// The objects of the scene and their references: code of classes whose objects no ray can reach
  /// is omitted. Empty: all are used.
  std::vector<ScenePart> parts = {};
  /// The pairs of primitives and materials in the scene, as (primitive class, material class); the
  /// primitive class is empty for a triangle mesh. Attributes are matched for these pairs.
  std::vector<std::pair<std::string, std::string>> surfaces = {};
  /// The members that the scene sets in some object of a class, by class. An optional one that is
  /// not listed is empty in all objects; of a class that is not listed nothing is known.
  std::map<std::string, std::set<std::string>> givenMembers = {};
  /// Members whose values must not be constants of the code: "Class.member", or "Class" for all
  /// members of the class and of the classes derived from it.
  std::set<std::string> editable = {};
  /// The classes of the objects that a member refers to in objects of a class, by the names of the
  /// class and the member. Of members that are not listed nothing is known.
  std::map<std::pair<std::string, std::string>, std::set<std::string>> referredClasses = {};
  bool hasCounts = true; // an object of the scene may hold several primitives
  runtime::Engine engine = runtime::Engine::Classic;
  std::uint32_t features = 0; // RTSL_FEATURE_*: exceptions and prints
  bool isSampled =
      false; // the host calls the slots of SamplingSlots.def, which the program then has
  bool isOnlySampled = false; // and nothing else of it: the program cannot render
  /// Items that remain in the program although the scene does not need them.
  ItemSet keep = {};
  /// Items that are omitted although the scene needs them, by Finding::subject: for tests, which
  /// check that the program then changes.
  std::set<std::pair<Item, std::string>> without = {};
  /// The location where the scene first mentions a class.
  std::map<std::string, ir::SourcePlace> places = {};
};

} // namespace rtsl
