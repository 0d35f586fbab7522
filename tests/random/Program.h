//===- Program.h - a random program ---------------------------------------===//
#pragma once

#include "Tree.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::random {

/// A scene in one text: a camera, primitives, materials, lights, what is behind it all, textures.
/// Every name begins with `prefix`, so that many programs fit into one compilation. Runs end by
/// construction and have one right result.
struct Program {
  std::uint32_t seed = 0;
  std::string prefix; // "p12_"
  NodePtr tree;
  /// No index is ever out of range, so that it may run unchecked.
  bool inRange = true;
  bool traces = false;
  /// Compiled with exceptions (--exceptions), of which the first one ends a sample.
  bool raises = false;
  unsigned colorComponents = 3;
  /// The objects of the scene, by class; what refers to others comes after them.
  std::vector<std::string> helpers, textures, lights, primitives, materials;
  std::string camera;
  // may be empty; of a program with a ray generation the samples are those of its `generate`, or of
  // the engine `path`
  std::string miss, selector, exception, rayGeneration;
  // those that ask nothing of a primitive that meshes have not
  std::vector<std::string> meshMaterials;

  std::string text() const { return toText(*tree); }
};

/// The program of a seed; the same on every machine. One in five is not `inRange`, seven in ten
/// trace; of those with exceptions, fifty of 150 seeds, three in four and four in five.
Program generate(std::uint32_t seed);
bool raises(std::uint32_t seed);
bool isInRange(std::uint32_t seed);
bool hasTraces(std::uint32_t seed);
/// It has a ray generation of its own.
bool generates(std::uint32_t seed);
/// It is for the engine `path`: its ray generation derives from PathTracer.
bool usesPathTracer(std::uint32_t seed);
/// Its materials and textures have images.
bool hasImages(std::uint32_t seed);
/// 3, 1, 4 or 16: the same for fifty seeds, so that they fit into one compilation.
unsigned colorComponents(std::uint32_t seed);

/// The functions that programs share, as far as `text` uses them: they fold values into a hash and
/// make numbers of it. Also the classes of the library for images and for the engine `path`.
std::string prelude(const std::string &text);

} // namespace rtsl::random
