#include "runtime/accel/FlatScene.h"

#include <algorithm>
#include <cstddef>

namespace rtsl::runtime {

void FlatScene::removeTrees() {
  RtslLaunch launch = this->launch();
  if (launch.nodeCount == 0)
    return;
  bytes.resize(reinterpret_cast<std::uintptr_t>(launch.nodes));
  const auto isOfTrees = [](std::uint64_t place) {
    return place == offsetof(RtslLaunch, nodes) || place == offsetof(RtslLaunch, treeItems) ||
           place == offsetof(RtslLaunch, meshTrees);
  };
  pointers.erase(std::remove_if(pointers.begin(), pointers.end(), isOfTrees), pointers.end());
  launch.nodes = nullptr;
  launch.treeItems = nullptr;
  launch.meshTrees = nullptr;
  launch.nodeCount = 0;
  setLaunch(launch);
}

} // namespace rtsl::runtime
