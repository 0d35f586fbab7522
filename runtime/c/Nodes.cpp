//===- Nodes.cpp - nodes and variables of a scene, for C ------------------===//
#include "runtime/c/Handle.h"
#include "support/ErrorMessages.h"

#include <algorithm>

namespace runtime = rtsl::runtime;
using rtsl::c::guarded;

runtime::MovingTransform RtslScene::toWorld(std::uint32_t node) const {
  runtime::MovingTransform transform;
  for (; node != 0; node = nodes[node - 1].parent)
    transform = transform.then(nodes[node - 1].transform);
  return transform;
}

runtime::MovingTransform RtslScene::inNode(const runtime::MovingTransform &transform) const {
  return entered == 0 ? transform : transform.then(toWorld(entered));
}

runtime::Placement RtslScene::inNode(runtime::Placement placement) const {
  placement.transform = inNode(placement.transform);
  return placement;
}

void RtslScene::noteInstance(std::uint32_t instance, const runtime::Placement &placement) {
  if (entered != 0)
    inNodes[instance] = {entered, placement.transform};
}

void RtslScene::addVariables(const char *className, runtime::ObjectValues &values) const {
  const runtime::ClassInfo *info = scene.program().find(className);
  if (!info || !std::holds_alternative<std::monostate>(values.constructor))
    return; // as in scene files, an object that its constructor makes takes none
  for (const runtime::MemberInfo &member : info->members) {
    const auto isIt = [&](const runtime::NamedValue &one) { return one.name == member.name; };
    if (!member.isPublic || std::any_of(values.members.begin(), values.members.end(), isIt))
      continue;
    for (auto scope = variables.rbegin(); scope != variables.rend(); ++scope) {
      const auto found = std::find_if(scope->rbegin(), scope->rend(), isIt);
      if (found == scope->rend())
        continue;
      values.members.push_back(*found);
      break;
    }
  }
}

extern "C" {

RtslNode rtslEnter(RtslScene *scene) {
  return guarded<RtslNode>(0, {{scene, "scene"}}, [&] {
    scene->nodes.push_back({scene->entered, scene->takePlacement().transform});
    scene->variables.emplace_back();
    return scene->entered = RtslNode(scene->nodes.size());
  });
}

int rtslLeave(RtslScene *scene) {
  return guarded(0, {{scene, "scene"}}, [&] {
    if (scene->entered == 0)
      throw rtsl::Error(rtsl::message::noNodeToLeave());
    scene->entered = scene->nodes[scene->entered - 1].parent;
    scene->variables.pop_back();
    return 1;
  });
}

int rtslVariable(RtslScene *scene, const char *name, const double *numbers, size_t count) {
  return guarded(0, {{scene, "scene"}, {name, "name"}, {numbers, "numbers", count}}, [&] {
    scene->variables.back().push_back({name, rtsl::c::valueOf(numbers, count)});
    return 1;
  });
}

int rtslVariableObject(RtslScene *scene, const char *name, RtslObject object) {
  return guarded(0, {{scene, "scene"}, {name, "name"}}, [&] {
    scene->variables.back().push_back({name, runtime::Value::reference(object)});
    return 1;
  });
}

int rtslMoveNode(RtslScene *scene, RtslNode node) {
  return guarded(0, {{scene, "scene"}}, [&] {
    const runtime::MovingTransform transform = scene->takePlacement().transform;
    if (node == 0 || node > scene->nodes.size())
      throw rtsl::Error(rtsl::message::noNodeOfNumber(node));
    const runtime::MovingTransform before =
        std::exchange(scene->nodes[node - 1].transform, transform);
    const auto isBelow = [&](std::uint32_t inner) {
      while (inner != 0 && inner != node)
        inner = scene->nodes[inner - 1].parent;
      return inner == node;
    };
    const auto move = [&] {
      for (const auto &[instance, place] : scene->inNodes)
        if (isBelow(place.first))
          scene->scene.moveInstance(instance, place.second.then(scene->toWorld(place.first)));
    };
    try {
      move();
    } catch (...) { // all or none
      scene->nodes[node - 1].transform = before;
      move();
      throw;
    }
    return 1;
  });
}

int rtslMoveInstance(RtslScene *scene, uint32_t instance) {
  return guarded(0, {{scene, "scene"}}, [&] {
    const runtime::MovingTransform transform = scene->takePlacement().transform;
    const auto found = scene->inNodes.find(instance);
    if (found == scene->inNodes.end()) {
      scene->scene.moveInstance(instance, transform);
      return 1;
    }
    scene->scene.moveInstance(instance, transform.then(scene->toWorld(found->second.first)));
    found->second.second = transform;
    return 1;
  });
}

} // extern "C"
