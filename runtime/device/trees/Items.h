//===- Items.h - what a tree is built of ----------------------------------===//
#pragma once

#include "runtime/device/ray/Box.h"
#include "runtime/device/ray/Launch.h"
#include "runtime/device/traverse/Motion.h"
#include "runtime/device/traverse/TestItem.h"

namespace rtsl::device::build {

/// Items of a tree: the triangles of a mesh, the primitives of an object, or an instance as a
/// whole.
struct ItemRange {
  uint32_t first;    // of the tree's items; up to the first of the next range
  uint32_t instance; // whose mesh or object it is
  uint32_t number;   // RtslTreeItem::instance
  uint32_t isWhole;
};

/// All items of a tree.
struct Items {
  const RtslLaunch *launch;
  const ItemRange *ranges; // none of them empty
  uint32_t rangeCount, count;
};

inline const ItemRange &rangeOf(const Items &items, uint32_t item) {
  uint32_t low = 0, high = items.rangeCount; // the range is at `low` or between them
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    (items.ranges[middle].first <= item ? low : high) = middle;
  }
  return items.ranges[low];
}

/// The box of an instance as a whole, or else of one of its triangles or primitives; finite.
inline RtslBox boxOfPart(const RtslLaunch &launch, const RtslInstance &instance, bool isWhole,
                         uint32_t part) {
  if (isWhole) {
    RtslBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = instance.lower[axis];
      box.upper[axis] = instance.upper[axis];
    }
    return box;
  }
  return instance.primitive == 0 ? boxOfTriangle(launch, launch.meshes[instance.mesh], part)
                                 : enlarged(launch.boxes[instance.firstBox + part]);
}

inline RtslBox boxOfItem(const Items &items, uint32_t item) {
  const RtslLaunch &launch = *items.launch;
  const ItemRange &range = rangeOf(items, item);
  return boxOfPart(launch, launch.instances[range.instance], range.isWhole, item - range.first);
}

/// Sets the vertices of an item that has them.
inline void storeVertices(RtslTreeItem &item, const RtslMesh &mesh) {
  const TriangleVertices p = triangleVertices(mesh, item.primitive);
  store(item.vertices, p.v0);
  store(item.vertices + 3, p.v1);
  store(item.vertices + 6, p.v2);
}

inline RtslTreeItem treeItem(const Items &items, uint32_t item) {
  const RtslLaunch &launch = *items.launch;
  const ItemRange &range = rangeOf(items, item);
  const RtslInstance &instance = launch.instances[range.instance];
  RtslTreeItem made;
  __builtin_memset(&made, 0, sizeof made);
  made.instance = range.number;
  made.primitive = range.isWhole ? 0 : item - range.first;
  if (range.isWhole || instance.primitive != 0)
    return made;
  const RtslMesh &mesh = launch.meshes[instance.mesh];
  made.hasVertices = !moves(launch, mesh);
  if (made.hasVertices)
    storeVertices(made, mesh);
  return made;
}

} // namespace rtsl::device::build
