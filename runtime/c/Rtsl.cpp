//===- Rtsl.cpp - the runtime for C ---------------------------------------===//
#include "rtsl/rtsl.h"

#include "runtime/c/Handle.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <string>
#include <utility>

namespace runtime = rtsl::runtime;

using rtsl::c::guarded;
using rtsl::c::keyTimes;
using rtsl::c::lastError;

extern "C" {

const char *rtslError(void) {
  return lastError().c_str();
}

RtslScene *rtslSceneCreate(const RtslShaders *shaders) {
  return guarded<RtslScene *>(nullptr, {}, [&] { return new RtslScene(rtsl::program(shaders)); });
}

void rtslSceneDestroy(RtslScene *scene) {
  delete scene;
}

int rtslArgument(RtslScene *scene, const char *parameter, const double *numbers, size_t count) {
  return guarded(0, {{scene, "scene"}, {parameter, "parameter"}, {numbers, "numbers", count}}, [&] {
    scene->arguments.push_back({parameter, rtsl::c::valueOf(numbers, count)});
    return 1;
  });
}

int rtslArgumentObject(RtslScene *scene, const char *parameter, RtslObject object) {
  return guarded(0, {{scene, "scene"}, {parameter, "parameter"}}, [&] {
    scene->arguments.push_back({parameter, runtime::Value::reference(object)});
    return 1;
  });
}

int rtslMember(RtslScene *scene, const char *member, const double *numbers, size_t count) {
  return guarded(0, {{scene, "scene"}, {member, "member"}, {numbers, "numbers", count}}, [&] {
    scene->members.push_back({member, rtsl::c::valueOf(numbers, count)});
    return 1;
  });
}

int rtslMemberObject(RtslScene *scene, const char *member, RtslObject object) {
  return guarded(0, {{scene, "scene"}, {member, "member"}}, [&] {
    scene->members.push_back({member, runtime::Value::reference(object)});
    return 1;
  });
}

RtslObject rtslSceneAddObject(RtslScene *scene, const char *className) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {className, "className"}}, [&] {
    runtime::ObjectValues values;
    if (!scene->arguments.empty())
      values.constructor = std::move(scene->arguments);
    values.members = std::move(scene->members);
    scene->arguments.clear();
    scene->members.clear();
    scene->addVariables(className, values);
    return scene->scene.addObject(className, values);
  });
}

int rtslPlace(RtslScene *scene, const double *transform, uint32_t mask) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->placement.transform = rtsl::c::finiteTransform(transform);
    scene->placement.mask = mask;
    return 1;
  });
}

int rtslPlaceMoving(RtslScene *scene, const double *transforms, const float *times, uint32_t count,
                    uint32_t mask) {
  return guarded(0, {{scene, "scene"}, {transforms, "transforms"}, {times, "times"}}, [&] {
    runtime::MotionFactor factor;
    factor.times = keyTimes("a transform", times, count, sizeof *times);
    for (std::uint32_t i = 0; i < count; ++i)
      factor.maps.push_back(rtsl::c::finiteTransform(transforms + 12 * std::size_t(i)));
    scene->placement.transform = runtime::MovingTransform(std::move(factor));
    scene->placement.mask = mask;
    return 1;
  });
}

int rtslPlaceTurning(RtslScene *scene, const RtslPlacementKey *keys, uint32_t count,
                     uint32_t mask) {
  return guarded(0, {{scene, "scene"}, {keys, "keys"}}, [&] {
    runtime::MotionFactor scale, rotation, translation;
    const std::vector<float> times = keyTimes("a transform", &keys->time, count, sizeof *keys);
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
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->scene.setShutter(open, close);
    scene->hasShutter = true;
    return 1;
  });
}

int rtslMark(RtslScene *scene, int32_t id, uint32_t selection) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->placement.id = id;
    scene->placement.selection = selection;
    return 1;
  });
}

int rtslSetRoots(RtslScene *scene, uint32_t roots) {
  return guarded(0, {{scene, "scene"}}, [&] {
    if (roots == 0)
      throw rtsl::Error(rtsl::message::noRoots());
    scene->roots = roots;
    return 1;
  });
}

int rtslSetBarycentric(RtslScene *scene, int areBarycentric) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->areBarycentric = areBarycentric != 0;
    return 1;
  });
}

int rtslSetBackFaces(RtslScene *scene, int areHit) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->placement.hasBackFaces = areHit != 0;
    return 1;
  });
}

uint32_t rtslSceneAddSelector(RtslScene *scene, RtslObject selector, uint32_t children,
                              const double *transform, uint32_t above) {
  return guarded<uint32_t>(0, {{scene, "scene"}}, [&] {
    return scene->scene.addSelector(selector, children,
                                    scene->inNode(rtsl::c::finiteTransform(transform)), above);
  });
}

int rtslMeshAttribute(RtslScene *scene, const char *name, uint32_t components, const float *values,
                      size_t count, int ofFaces, RtslAttributeSpace space) {
  return guarded(0, {{scene, "scene"}, {name, "name"}, {values, "values", count}}, [&] {
    rtsl::c::requireChoice(space, RTSL_TANGENT + 1, "space of attributes");
    runtime::NamedAttribute attribute =
        runtime::floatAttribute(name, components, {values, values + count * components});
    attribute.ofTriangles = ofFaces != 0;
    attribute.space = static_cast<runtime::NamedAttribute::Space>(space);
    scene->attributes.push_back(std::move(attribute));
    return 1;
  });
}

int rtslMeshAttributeInts(RtslScene *scene, const char *name, const int32_t *values, size_t count) {
  return guarded(0, {{scene, "scene"}, {name, "name"}, {values, "values", count}}, [&] {
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
  return guarded(0, {{scene, "scene"}}, [&] {
    const runtime::Placement placement = scene->takePlacement();
    scene->noteInstance(
        scene->scene.addPrimitive(primitive, material, scene->inNode(placement), count), placement);
    return 1;
  });
}

int rtslSceneAddMeshFile(RtslScene *scene, const char *path, const double *transform,
                         RtslObject material) {
  return guarded(0, {{scene, "scene"}, {path, "path"}}, [&] {
    runtime::Mesh mesh = scene->loadMesh(path);
    scene->giveAttributes(mesh, path);
    if (transform)
      mesh.apply(rtsl::c::transformOf(transform));
    scene->addMeshInstance(scene->scene.addMesh(std::move(mesh), path), material);
    return 1;
  });
}

int32_t rtslSceneLoadMesh(RtslScene *scene, const char *path) {
  return guarded<int32_t>(-1, {{scene, "scene"}, {path, "path"}}, [&] {
    runtime::Mesh mesh = scene->loadMesh(path);
    scene->giveAttributes(mesh, path);
    return static_cast<int32_t>(scene->scene.addMesh(std::move(mesh), path));
  });
}

int32_t rtslSceneLoadMovingMesh(RtslScene *scene, const char *const *paths, const float *times,
                                uint32_t count) {
  return guarded<int32_t>(-1, {{scene, "scene"}, {paths, "paths"}, {times, "times"}}, [&] {
    std::vector<float> ofKeys = keyTimes("a mesh", times, count, sizeof *times);
    std::vector<runtime::Mesh> keys;
    for (std::uint32_t i = 0; i < count; ++i)
      keys.push_back(scene->loadMesh(paths[i]));
    scene->giveAttributes(keys.front(), paths[0]);
    return static_cast<int32_t>(scene->scene.addMesh(
        runtime::movingMesh(std::move(keys), std::move(ofKeys), {paths, paths + count}), paths[0]));
  });
}

int rtslSceneAddMeshInstance(RtslScene *scene, int32_t mesh, RtslObject material) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->addMeshInstance(static_cast<std::uint32_t>(mesh), material);
    return 1;
  });
}

int rtslSceneAddTriangles(RtslScene *scene, const float *positions, size_t vertexCount,
                          const uint32_t *indices, size_t triangleCount, RtslObject material) {
  return guarded(0,
                 {{scene, "scene"},
                  {positions, "positions", vertexCount},
                  {indices, "indices", triangleCount}},
                 [&] {
                   runtime::Mesh mesh;
                   mesh.positions.assign(positions, positions + 3 * vertexCount);
                   mesh.indices.assign(indices, indices + 3 * triangleCount);
                   mesh.order = {true, vertexCount, triangleCount, {}, {}};
                   scene->giveAttributes(mesh, "the mesh");
                   scene->addMeshInstance(scene->scene.addMesh(std::move(mesh)), material);
                   return 1;
                 });
}

int rtslSceneAddLight(RtslScene *scene, RtslObject light) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->scene.addLight(light);
    return 1;
  });
}

int rtslSceneSetCamera(RtslScene *scene, RtslObject camera) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->scene.setCamera(camera);
    return 1;
  });
}

int rtslSceneSetRayGeneration(RtslScene *scene, RtslObject rayGeneration) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->scene.setRayGeneration(rayGeneration);
    return 1;
  });
}

int rtslSceneSetLightSampler(RtslScene *scene, RtslLightSampler sampler) {
  return guarded(0, {{scene, "scene"}}, [&] {
    constexpr runtime::LampChoice choices[] = {
        runtime::LampChoice::Automatic, runtime::LampChoice::ByPower, runtime::LampChoice::ByTree};
    rtsl::c::requireChoice(sampler, unsigned(std::size(choices)), "light sampler");
    scene->scene.setLampChoice(choices[sampler]);
    return 1;
  });
}

int rtslSceneSetSampler(RtslScene *scene, RtslSampler sampler) {
  return guarded(0, {{scene, "scene"}}, [&] {
    constexpr runtime::Sampler samplers[] = {runtime::Sampler::Independent, runtime::Sampler::R2,
                                             runtime::Sampler::Sobol};
    rtsl::c::requireChoice(sampler, unsigned(std::size(samplers)), "sampler");
    scene->stopRendering();
    scene->scene.setSampler(samplers[sampler]);
    return 1;
  });
}

int rtslSceneSetException(RtslScene *scene, RtslObject exception) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->scene.setException(exception);
    return 1;
  });
}

int rtslSceneSetBackground(RtslScene *scene, RtslObject miss) {
  return guarded(0, {{scene, "scene"}}, [&] {
    scene->scene.setBackground(miss);
    return 1;
  });
}

int rtslSceneSetBackgroundColor(RtslScene *scene, const float *color, size_t count) {
  return guarded(0, {{scene, "scene"}, {color, "color", count}}, [&] {
    scene->scene.setBackgroundColor({color, color + count});
    return 1;
  });
}

int rtslSceneSetAmbient(RtslScene *scene, const float *color, size_t count) {
  return guarded(0, {{scene, "scene"}, {color, "color", count}}, [&] {
    scene->scene.setAmbient({color, color + count});
    return 1;
  });
}

} // extern "C"
