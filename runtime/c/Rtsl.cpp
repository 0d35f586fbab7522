//===- Rtsl.cpp - the runtime for C ---------------------------------------===//
#include "rtsl/rtsl.h"

#include "rtsl/runtime.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <string>
#include <utility>

namespace runtime = rtsl::runtime;

struct RtslScene {
  runtime::Scene scene;
  std::vector<runtime::NamedValue> arguments, members; // of the next object
  runtime::Placement placement;                        // of the next instance
  std::vector<runtime::NamedAttribute> attributes;     // of the next mesh

  /// The placement of the instance that is being added; the one after it has none.
  runtime::Placement takePlacement() { return std::exchange(placement, {}); }

  runtime::Mesh loadMesh(const char *path) const {
    runtime::MeshRequest request = runtime::requestOf(scene.program());
    request.keepsOrder = !attributes.empty();
    return runtime::loadMesh(path, request);
  }

  /// Gives a mesh the attributes that were set for it. `name` is for messages.
  void giveAttributes(runtime::Mesh &mesh, const char *name) {
    for (runtime::NamedAttribute &attribute : std::exchange(attributes, {}))
      runtime::addInFileOrder(mesh, std::move(attribute), name);
  }
};

namespace {

std::string &lastError() {
  static thread_local std::string message;
  return message;
}

/// Runs `work`; what it throws becomes the error, and `failed` the result.
template <typename Result, typename Work>
Result guarded(Result failed, Work work) {
  lastError().clear();
  try {
    return work();
  } catch (const std::exception &error) {
    lastError() = error.what();
  } catch (...) {
    lastError() = "unknown error";
  }
  return failed;
}

/// One number, or a list of them.
runtime::Value valueOf(const double *numbers, std::size_t count) {
  if (count == 1)
    return runtime::Value(numbers[0]);
  return runtime::Value(std::vector<runtime::Value>(numbers, numbers + count));
}

/// Of 12 numbers, four columns of three.
runtime::Transform transformOf(const double *numbers) {
  runtime::Transform transform;
  for (std::size_t column = 0; column < 4; ++column)
    std::copy_n(numbers + 3 * column, 3, transform.columns[column].begin());
  return transform;
}

runtime::RenderOptions optionsOf(const RtslRenderSettings *settings) {
  const RtslRenderSettings requested = settings ? *settings : rtslRenderDefaults();
  runtime::RenderOptions options;
  options.width = requested.width;
  options.height = requested.height;
  options.samplesPerPixel = requested.samplesPerPixel;
  options.maxDepth = requested.maxDepth;
  options.seed = requested.seed;
  options.threads = requested.threads;
  return options;
}

RtslRenderFacts &lastRendering() {
  static thread_local RtslRenderFacts facts{};
  return facts;
}

runtime::Image render(const RtslScene *scene, const RtslRenderSettings *settings) {
  runtime::RenderStatistics statistics;
  lastRendering() = {};
  runtime::Image image = runtime::render(scene->scene, optionsOf(settings), &statistics);
  lastRendering() = {statistics.samples, statistics.samplesNotFinite,
                     statistics.pixelsWithoutSample, statistics.raysTooDeep, statistics.badRays};
  return image;
}

} // namespace

extern "C" {

const char *rtslError(void) {
  return lastError().c_str();
}

RtslScene *rtslSceneCreate(const RtslShaders *shaders) {
  return guarded<RtslScene *>(nullptr, [&] {
    if (!shaders)
      throw rtsl::Error(rtsl::message::noShaders());
    return new RtslScene{runtime::Scene(rtsl::program(shaders)), {}, {}, {}, {}};
  });
}

void rtslSceneDestroy(RtslScene *scene) {
  delete scene;
}

int rtslArgument(RtslScene *scene, const char *parameter, const double *numbers, size_t count) {
  return guarded(0, [&] {
    scene->arguments.push_back({parameter, valueOf(numbers, count)});
    return 1;
  });
}

int rtslArgumentObject(RtslScene *scene, const char *parameter, RtslObject object) {
  return guarded(0, [&] {
    scene->arguments.push_back({parameter, runtime::Value::reference(object)});
    return 1;
  });
}

int rtslMember(RtslScene *scene, const char *member, const double *numbers, size_t count) {
  return guarded(0, [&] {
    scene->members.push_back({member, valueOf(numbers, count)});
    return 1;
  });
}

int rtslMemberObject(RtslScene *scene, const char *member, RtslObject object) {
  return guarded(0, [&] {
    scene->members.push_back({member, runtime::Value::reference(object)});
    return 1;
  });
}

RtslObject rtslSceneAddObject(RtslScene *scene, const char *className) {
  return guarded<RtslObject>(0, [&] {
    runtime::ObjectValues values;
    if (!scene->arguments.empty())
      values.constructor = std::move(scene->arguments);
    values.members = std::move(scene->members);
    scene->arguments.clear();
    scene->members.clear();
    return scene->scene.addObject(className, values);
  });
}

static runtime::Transform finiteTransform(const double *transform) {
  if (!transform)
    return {};
  if (!std::all_of(transform, transform + 12, [](double x) { return std::isfinite(x); }))
    throw rtsl::Error(rtsl::message::transformNotFinite());
  return transformOf(transform);
}

int rtslPlace(RtslScene *scene, const double *transform, uint32_t mask) {
  return guarded(0, [&] {
    scene->placement.transform = finiteTransform(transform);
    scene->placement.mask = mask;
    return 1;
  });
}

/// Throws OutOfRange unless they are the times of keys.
static std::vector<float> keyTimes(const float *first, std::uint32_t count, std::size_t stride) {
  if (count < 2)
    throw rtsl::Error(rtsl::message::transformNeedsKeys());
  std::vector<float> times;
  for (std::uint32_t i = 0; i < count; ++i) {
    float time;
    std::memcpy(&time, reinterpret_cast<const char *>(first) + i * stride, sizeof time);
    if (!(time >= 0 && time <= 1) || (i > 0 && !(time > times.back())))
      throw rtsl::Error(rtsl::message::keyTimesNotAscending());
    times.push_back(time);
  }
  return times;
}

int rtslPlaceMoving(RtslScene *scene, const double *transforms, const float *times, uint32_t count,
                    uint32_t mask) {
  return guarded(0, [&] {
    runtime::MotionFactor factor;
    factor.times = keyTimes(times, count, sizeof *times);
    for (std::uint32_t i = 0; i < count; ++i)
      factor.maps.push_back(finiteTransform(transforms + 12 * std::size_t(i)));
    scene->placement.transform = runtime::MovingTransform(std::move(factor));
    scene->placement.mask = mask;
    return 1;
  });
}

int rtslPlaceTurning(RtslScene *scene, const RtslPlacementKey *keys, uint32_t count,
                     uint32_t mask) {
  return guarded(0, [&] {
    runtime::MotionFactor scale, rotation, translation;
    const std::vector<float> times = keyTimes(&keys->time, count, sizeof *keys);
    scale.times = rotation.times = translation.times = times;
    const auto orientation = [](const RtslPlacementKey &key) {
      const double *q = key.rotation; // x, y, z, w
      if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
        throw rtsl::Error(rtsl::message::zeroQuaternion());
      return runtime::Quaternion{q[3], q[0], q[1], q[2]};
    };
    for (std::uint32_t i = 0; i < count; ++i) {
      const double *s = keys[i].scale, *t = keys[i].translation;
      scale.maps.push_back(runtime::Transform::scale(s[0], s[1], s[2]));
      translation.maps.push_back(runtime::Transform::translate(t[0], t[1], t[2]));
      if (i + 1 < count)
        rotation.turns.push_back(
            runtime::turnBetween(orientation(keys[i]), orientation(keys[i + 1])));
    }
    scene->placement.transform = runtime::MovingTransform(std::move(scale))
                                     .then(runtime::MovingTransform(std::move(rotation)))
                                     .then(runtime::MovingTransform(std::move(translation)));
    scene->placement.mask = mask;
    return 1;
  });
}

int rtslSceneSetShutter(RtslScene *scene, float open, float close) {
  return guarded(0, [&] {
    scene->scene.setShutter(open, close);
    return 1;
  });
}

int rtslMark(RtslScene *scene, int32_t id, uint32_t selection) {
  return guarded(0, [&] {
    scene->placement.id = id;
    scene->placement.selection = selection;
    return 1;
  });
}

int rtslSetBackFaces(RtslScene *scene, int areHit) {
  return guarded(0, [&] {
    scene->placement.hasBackFaces = areHit != 0;
    return 1;
  });
}

uint32_t rtslSceneAddSelector(RtslScene *scene, RtslObject selector, uint32_t children,
                              const double *transform, uint32_t above) {
  return guarded<uint32_t>(0, [&] {
    return scene->scene.addSelector(selector, children, finiteTransform(transform), above);
  });
}

int rtslMeshAttribute(RtslScene *scene, const char *name, uint32_t components, const float *values,
                      size_t count, int ofFaces, RtslAttributeSpace space) {
  return guarded(0, [&] {
    runtime::NamedAttribute attribute =
        runtime::floatAttribute(name, components, {values, values + count * components});
    attribute.ofTriangles = ofFaces != 0;
    attribute.space = static_cast<runtime::NamedAttribute::Space>(space);
    scene->attributes.push_back(std::move(attribute));
    return 1;
  });
}

int rtslMeshAttributeInts(RtslScene *scene, const char *name, const int32_t *values, size_t count) {
  return guarded(0, [&] {
    runtime::NamedAttribute attribute;
    attribute.name = name;
    attribute.kind = runtime::NamedAttribute::Kind::Int;
    attribute.ofTriangles = true;
    attribute.words.assign(values, values + count);
    scene->attributes.push_back(std::move(attribute));
    return 1;
  });
}

int rtslSceneAddPrimitive(RtslScene *scene, RtslObject primitive, RtslObject material) {
  return rtslSceneAddPrimitives(scene, primitive, 1, material);
}

int rtslSceneAddPrimitives(RtslScene *scene, RtslObject primitive, uint32_t count,
                           RtslObject material) {
  return guarded(0, [&] {
    scene->scene.addPrimitive(primitive, material, scene->takePlacement(), count);
    return 1;
  });
}

int rtslSceneAddMeshFile(RtslScene *scene, const char *path, const double *transform,
                         RtslObject material) {
  return guarded(0, [&] {
    runtime::Mesh mesh = scene->loadMesh(path);
    scene->giveAttributes(mesh, path);
    if (transform)
      mesh.apply(transformOf(transform));
    scene->scene.addMeshInstance(scene->scene.addMesh(std::move(mesh), path), material,
                                 scene->takePlacement());
    return 1;
  });
}

int32_t rtslSceneLoadMesh(RtslScene *scene, const char *path) {
  return guarded<int32_t>(-1, [&] {
    runtime::Mesh mesh = scene->loadMesh(path);
    scene->giveAttributes(mesh, path);
    return static_cast<int32_t>(scene->scene.addMesh(std::move(mesh), path));
  });
}

int rtslSceneAddMeshInstance(RtslScene *scene, int32_t mesh, RtslObject material) {
  return guarded(0, [&] {
    scene->scene.addMeshInstance(static_cast<std::uint32_t>(mesh), material,
                                 scene->takePlacement());
    return 1;
  });
}

int rtslSceneAddTriangles(RtslScene *scene, const float *positions, size_t vertexCount,
                          const uint32_t *indices, size_t triangleCount, RtslObject material) {
  return guarded(0, [&] {
    runtime::Mesh mesh;
    mesh.positions.assign(positions, positions + 3 * vertexCount);
    mesh.indices.assign(indices, indices + 3 * triangleCount);
    mesh.order = {true, vertexCount, triangleCount, {}, {}};
    scene->giveAttributes(mesh, "the mesh");
    scene->scene.addMeshInstance(scene->scene.addMesh(std::move(mesh)), material,
                                 scene->takePlacement());
    return 1;
  });
}

int rtslSceneAddLight(RtslScene *scene, RtslObject light) {
  return guarded(0, [&] {
    scene->scene.addLight(light);
    return 1;
  });
}

int rtslSceneSetCamera(RtslScene *scene, RtslObject camera) {
  return guarded(0, [&] {
    scene->scene.setCamera(camera);
    return 1;
  });
}

int rtslSceneSetRayGeneration(RtslScene *scene, RtslObject rayGeneration) {
  return guarded(0, [&] {
    scene->scene.setRayGeneration(rayGeneration);
    return 1;
  });
}

int rtslSceneSetException(RtslScene *scene, RtslObject exception) {
  return guarded(0, [&] {
    scene->scene.setException(exception);
    return 1;
  });
}

int rtslSceneSetBackground(RtslScene *scene, RtslObject miss) {
  return guarded(0, [&] {
    scene->scene.setBackground(miss);
    return 1;
  });
}

int rtslSceneSetBackgroundColor(RtslScene *scene, const float *color, size_t count) {
  return guarded(0, [&] {
    scene->scene.setBackgroundColor({color, color + count});
    return 1;
  });
}

int rtslSceneSetAmbient(RtslScene *scene, const float *color, size_t count) {
  return guarded(0, [&] {
    scene->scene.setAmbient({color, color + count});
    return 1;
  });
}

RtslRenderSettings rtslRenderDefaults(void) {
  const runtime::RenderOptions defaults;
  return {defaults.width,    defaults.height, defaults.samplesPerPixel,
          defaults.maxDepth, defaults.seed,   defaults.threads};
}

uint32_t rtslSceneChannels(const RtslScene *scene) {
  return scene->scene.program().colorComponents;
}

int rtslRender(const RtslScene *scene, const RtslRenderSettings *settings, float *pixels) {
  return guarded(0, [&] {
    const runtime::Image image = render(scene, settings);
    std::copy(image.pixels.begin(), image.pixels.end(), pixels);
    return 1;
  });
}

int rtslRenderToFile(const RtslScene *scene, const RtslRenderSettings *settings, const char *path) {
  return guarded(0, [&] {
    runtime::checkWritable(path);
    runtime::writeImage(path, render(scene, settings));
    return 1;
  });
}

RtslRenderFacts rtslLastRendering(void) {
  return lastRendering();
}

int rtslTakePrinted(const RtslScene *scene, void (*take)(const char *line, void *context),
                    void *context) {
  return guarded(0, [&] {
    for (const std::string &line : runtime::takePrintLog().texts(scene->scene.program().prints))
      take(line.c_str(), context);
    return 1;
  });
}

} // extern "C"
