//===- CameraAndLights.h - the objects of a scene that are not geometry ---===//
//
// The camera or the ray generation, lights, the background and the exception, and the constant
// colors of the background and the ambient light.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/scene/Objects.h"

#include <vector>

namespace rtsl::runtime {

class CameraAndLights {
public:
  // The functions of Scene with these names.
  void addLight(const Objects &objects, RtslRef light);
  void setCamera(const Objects &objects, RtslRef object);
  void setRayGeneration(const Objects &objects, RtslRef object);
  void setBackground(const Objects &objects, RtslRef miss);
  void setException(const Objects &objects, RtslRef object);
  void setBackgroundColor(const Objects &objects, const std::vector<float> &color);
  void setAmbient(const Objects &objects, const std::vector<float> &color);

  /// All objects that are set.
  std::vector<RtslRef> all() const;
  /// 0: none.
  RtslRef rayGenerationObject() const { return rayGeneration; }
  std::uint32_t lightCount() const { return std::uint32_t(lights.size()); }
  /// RTSL_MAX_COLOR components.
  const float *ambientLight() const { return ambient; }

  /// Throws IncompleteScene if the camera or ray generation is missing that this engine starts
  /// samples with.
  void requireCamera(Engine engine) const;

  /// Sets the launch's fields about them.
  void fill(RtslLaunch &launch) const;

private:
  std::vector<RtslRef> lights;
  RtslRef camera = 0, rayGeneration = 0, background = 0, exception = 0;
  bool isBackgroundSampled = false; // directions of it can be chosen
  float backgroundColor[RTSL_MAX_COLOR] = {}, ambient[RTSL_MAX_COLOR] = {};
};

} // namespace rtsl::runtime
