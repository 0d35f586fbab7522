//===- CompiledShaders.h - RTSL classes, called as a renderer calls them --===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "runtime/Scene.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::numerics {

/// The tree whose shaders are tested; a mutation has its own.
extern std::string sourceRoot;

/// RTSL files, compiled in this process for a scene that is still empty.
class CompiledShaders {
public:
  /// Files are relative to sourceRoot; `surfaces` as in LinkRequest. Throws runtime::Error with the messages if the files have
  /// mistakes.
  CompiledShaders(const std::vector<std::string> &files, std::vector<std::string> classes,
                  std::vector<std::pair<std::string, std::string>> surfaces, FloatingPoint floatingPoint);

  runtime::Scene &scene() { return theScene; }
  const runtime::Program::Slots &slots() const { return theScene.program().slots; }

  /// Call it when the scene has all its objects; states and members are of this launch.
  void finish() { launch = theScene.launch(); }
  /// A ray that has hit nothing, with Epsilon 0 and no limit.
  RtslState ray() const;
  /// A member of an object, private or not, to be changed between calls.
  float *member(RtslRef object, const std::string &name) const;

private:
  runtime::Scene theScene;
  RtslLaunch launch{};
};

} // namespace rtsl::numerics
