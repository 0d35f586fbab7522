#include "runtime/scene/lights/CameraAndLights.h"

#include "runtime/scene/ValueStore.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::runtime {

namespace {

void setColor(std::uint32_t colorComponents, const std::vector<float> &color, float *to,
              const char *what) {
  std::vector<float> components = colorFromNumbers(color, colorComponents);
  if (components.empty())
    throw Error(message::colorComponentCount(what, numbersOfColor(colorComponents), color.size()));
  std::copy(components.begin(), components.end(), to);
}

} // namespace

void CameraAndLights::addLight(const Objects &objects, RtslRef light) {
  objects.requireRole(light, "rt_Light", {"illumination"});
  lights.push_back(light);
}

void CameraAndLights::setCamera(const Objects &objects, RtslRef object) {
  objects.requireRole(object, "rt_Camera", {"generateRay"});
  camera = object;
}

void CameraAndLights::setRayGeneration(const Objects &objects, RtslRef object) {
  objects.requireRole(object, "rt_RayGeneration", {"generate"});
  rayGeneration = object;
}

void CameraAndLights::setBackground(const Objects &objects, RtslRef miss) {
  objects.requireRole(miss, "rt_Miss", ifClassic(objects.program(), "miss"));
  background = miss;
  const ClassInfo &info = *objects.at(miss).classInfo;
  isBackgroundSampled = hasMethod(info, "sampleDirection") && hasMethod(info, "directionPDF");
}

void CameraAndLights::setException(const Objects &objects, RtslRef object) {
  objects.requireRole(object, "rt_Exception", {"exception"});
  exception = object;
}

void CameraAndLights::setBackgroundColor(const Objects &objects, const std::vector<float> &color) {
  setColor(objects.program().colorComponents, color, backgroundColor, "the background");
  background = 0;
  isBackgroundSampled = false;
}

void CameraAndLights::setAmbient(const Objects &objects, const std::vector<float> &color) {
  setColor(objects.program().colorComponents, color, ambient, "the ambient light");
}

std::vector<RtslRef> CameraAndLights::all() const {
  std::vector<RtslRef> set = lights;
  for (RtslRef one : {camera, rayGeneration, background, exception})
    if (one != 0)
      set.push_back(one);
  return set;
}

void CameraAndLights::requireCamera(Engine engine) const {
  if (engine == Engine::Classic && camera == 0)
    throw Error(message::noCamera());
  if (engine == Engine::Programs && rayGeneration == 0)
    throw Error(message::noRayGeneration());
  if (engine == Engine::Either && camera == 0 && rayGeneration == 0)
    throw Error(message::nothingToRender());
}

void CameraAndLights::fill(RtslLaunch &launch) const {
  launch.lights = lights.data();
  launch.lightCount = lightCount();
  launch.camera = camera;
  launch.rayGeneration = rayGeneration;
  launch.background = background;
  launch.needs |= isBackgroundSampled ? RTSL_HAS_SAMPLED_BACKGROUND : 0;
  launch.exception = exception;
  std::copy_n(backgroundColor, RTSL_MAX_COLOR, launch.backgroundColor);
  std::copy_n(ambient, RTSL_MAX_COLOR, launch.ambient);
}

} // namespace rtsl::runtime
