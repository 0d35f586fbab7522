//===- LinkRequest.h - what a scene tells the linker ----------------------===//
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

/// A part of a scene that may refer to others: an object that has a name, or a place in a list.
struct ScenePart {
  enum class Role : std::uint8_t {
    Root,
    Light,
    Named
  }; // named materials and textures are there for others alone
  Role role = Role::Root;
  std::string name; // for people: "material clay"
  // of the object, and of those that are written in place inside of it
  std::vector<std::string> classes;
  std::vector<std::size_t> refersTo; // indices of parts
  ir::SourcePlace place;
};

/// What a scene tells the linker.
struct LinkRequest {
  /// The classes that the scene has objects of; only these are kept. Empty: all classes of the
  /// module.
  std::vector<std::string> classes;
  /// The objects of the scene and what they refer to: the code of classes whose objects no ray can
  /// come to is left out. Empty: all are used.
  std::vector<ScenePart> parts = {};
  /// Which material meets which primitive, as (primitive class, material class); the primitive
  /// class is empty for a triangle mesh. Attributes are matched along these.
  std::vector<std::pair<std::string, std::string>> surfaces = {};
  /// The members that the scene sets in some object of a class, by class. An optional one that is
  /// not among them is empty in all objects; a class that is not there is one of which nothing is
  /// known.
  std::map<std::string, std::set<std::string>> givenMembers = {};
  runtime::Engine engine = runtime::Engine::Classic;
  std::uint32_t features = 0; // RTSL_FEATURE_*: exceptions and prints
  bool isSampled = false;     // the host calls SamplingSlots.def; the program has them then
  /// What stays in the program although the scene does not need it.
  ItemSet keep = {};
  /// What is left out although the scene needs it, by Finding::subject: for tests, which require
  /// that the program changes then.
  std::set<std::pair<Item, std::string>> without = {};
  /// Where the scene first mentions a class.
  std::map<std::string, ir::SourcePlace> places = {};
};

} // namespace rtsl
