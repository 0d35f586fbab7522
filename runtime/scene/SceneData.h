//===- SceneData.h - plain structs in the interface of scenes -------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/geometry/Motion.h"
#include "runtime/program/Program.h"
#include "runtime/scene/Value.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rtsl::runtime {

/// How an object is described: constructor arguments by position or by name, then public members.
struct ObjectValues {
  std::variant<std::monostate, std::vector<Value>, std::vector<NamedValue>> constructor;
  std::vector<NamedValue> members;
  std::optional<Place> place; // of the object, for messages
  /// Where variables could set members that are not set, as "`car` or the scene"; empty: nowhere.
  std::string variablePlaces = {};
};

/// Where an instance is, and for which rays.
struct Placement {
  MovingTransform transform; // from its object space to world space
  std::uint32_t mask = ~0u;  // rays see it whose mask has a common bit
  std::uint32_t roots = 1;   // bit r: rays that enter at root r can see it
  std::int32_t id = 0;       // rt_InstanceId
  /// A result of Scene::addSelector: rays see the instance if the selector visits that child. 0:
  /// always.
  std::uint32_t selection = 0;
  /// For a mesh: whether rays meet triangles that they reach along rt_GeometricNormal.
  bool hasBackFaces = true;
};

/// How one of the surfaces that shine is chosen to light a point: by their power, by a light tree,
/// or by a tree if there are many.
enum class LampChoice : std::uint8_t { Automatic, ByPower, ByTree };

/// The random numbers of samples: independent of each other, or spread evenly among the samples of
/// a pixel (runtime/device/ray/Sampler.h).
enum class Sampler : std::uint8_t { Independent, R2, Sobol };

/// Their names in scene files and on command lines.
constexpr std::pair<const char *, Sampler> samplerNames[] = {
    {"independent", Sampler::Independent}, {"r2", Sampler::R2}, {"sobol", Sampler::Sobol}};

/// RTSL_FEATURE_SAMPLER_* of programs with this sampler, or 0.
constexpr std::uint32_t featuresOf(Sampler sampler) {
  return sampler == Sampler::R2      ? RTSL_FEATURE_SAMPLER_R2
         : sampler == Sampler::Sobol ? RTSL_FEATURE_SAMPLER_SOBOL
                                     : 0;
}

/// A box. A side may be infinite.
using Bounds = RtslBox;

/// Normals, texture coordinates or a named attribute of a mesh, and whether the program reads them.
struct MeshAttribute {
  std::string mesh; // its name
  std::string name; // "normals", "attribute `wear`"
  std::size_t bytes = 0;
  bool isNeeded = false; // by the material of some instance
  bool isNamed = false;  // a named attribute
};

/// An RtslBuffer in the records of a scene.
struct BufferPlace {
  std::uint32_t offset; // from the start of the records
  std::size_t bytes;    // of its elements
  bool isOutput;        // the program writes it
};

/// A buffer that launches of the scene write. Its elements stay where they are as long as the
/// scene.
struct OutputBuffer {
  std::string member;
  ValueType type;
  std::vector<std::uint32_t> sizes; // of each dimension
  std::uint8_t *elements;
  std::size_t bytes;
};

} // namespace rtsl::runtime
