//===- CompiledShaders.h - RTSL classes, called through camera rays -------===//
#pragma once

#include "Eye.h"

#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::numerics {

/// The tree whose shaders are tested; a mutation has its own. Emitted C++ was compiled with the
/// tests and has none.
extern std::string sourceRoot;

/// RTSL files, compiled for one of the paths, and a scene of them that is still empty.
class CompiledShaders {
public:
  /// Files are relative to sourceRoot; `surfaces` as in LinkRequest. Throws Error with the messages
  /// if the files have mistakes. `isSampled`: the program has SamplingSlots.def, for a host to
  /// call.
  CompiledShaders(const std::vector<std::string> &files, std::vector<std::string> classes,
                  std::vector<std::pair<std::string, std::string>> surfaces, Path path,
                  bool isSampled = false);

  runtime::Scene &scene() { return theScene; }
  const runtime::Scene &scene() const { return theScene; }

  /// Begins another scene.
  void restart() { theScene = runtime::Scene(compiled.program); }
  /// Call it when the scene has all its objects, and before `set` and `look`.
  void finish();
  /// Changes a member of an object, private or not.
  void set(RtslRef object, const std::string &name, std::initializer_list<float> values) const;
  float *member(RtslRef object, const std::string &name) const;
  /// The color of a camera ray. It does not depend on `seed` unless a shader draws random numbers.
  std::array<float, 3> look(std::uint32_t seed = 1) const { return eye->look(seed); }
  /// A picture of the scene. Its depth is eyeDepth, whatever the options say.
  runtime::Image picture(runtime::RenderOptions options) const;

private:
  struct Compiled {
    std::shared_ptr<const runtime::Program> program;
    std::string ptx; // the same for a GPU; Path::Gpu alone has it
  };
  static Compiled compile(const std::vector<std::string> &files, std::vector<std::string> classes,
                          std::vector<std::pair<std::string, std::string>> surfaces, Path path,
                          bool isSampled);
  CompiledShaders(Compiled compiled, Path path);

  Path path;
  Compiled compiled;
  runtime::Scene theScene;
  std::unique_ptr<Eye> eye;
};

} // namespace rtsl::numerics
