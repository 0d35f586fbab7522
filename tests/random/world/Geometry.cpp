//===- Geometry.cpp - the instances of a world ----------------------------===//
#include "Numbers.h"
#include "World.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rtsl::random {

using runtime::ClassInfo;

/// With these columns.
static RtslTransform transformOf(const float (&linear)[9], const float (&translation)[3]) {
  RtslTransform transform{};
  std::copy_n(linear, 9, transform.linear);
  std::copy_n(translation, 3, transform.translation);
  const auto at = [&](int column, int row) { return double(linear[3 * (column % 3) + row % 3]); };
  const auto cofactor = [&](int column, int row) {
    return at(column + 1, row + 1) * at(column + 2, row + 2) -
           at(column + 1, row + 2) * at(column + 2, row + 1);
  };
  const double determinant =
      at(0, 0) * cofactor(0, 0) + at(0, 1) * cofactor(0, 1) + at(0, 2) * cofactor(0, 2);
  for (int column = 0; column != 3; ++column)
    for (int row = 0; row != 3; ++row)
      transform.inverse[3 * column + row] = cofactor(row, column) / determinant;
  return transform;
}

/// The first is the identity, as in every launch; the others mirror and shear, stretch, and turn.
std::vector<RtslTransform> World::someTransforms() {
  return {transformOf({1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}),
          transformOf({-1, 0.2f, 0, 0.3f, 1, 0.1f, 0, -0.4f, 0.8f}, {0.1f, -0.2f, 0.3f}),
          transformOf({0.5f, 0, 0, 0, 2, 0, 0, 0, 1.5f}, {-0.3f, 0.2f, 0.1f}),
          transformOf({0, 24, 18, 0, -18, 24, 30, 0, 0}, {0, 0, 0})};
}

/// The last transform turns and grows while the shutter is open.
void World::addMotion() {
  RtslMotionKey begins{}, ends{}, turns{};
  turns.numbers[0] = 1; // from the identity
  turns.numbers[5] = 0.6;
  turns.numbers[6] = 0.8;
  turns.numbers[8] = 0.7;
  turns.time = 0.25f;
  const RtslTransform &first = transforms.back();
  for (int i = 0; i != 12; ++i) {
    begins.numbers[i] = i < 9 ? first.linear[i] : first.translation[i - 9];
    ends.numbers[i] = i < 9 ? 1.5 * begins.numbers[i] : begins.numbers[i] + 0.25;
  }
  ends.time = 1;
  RtslMotionKey turned = turns;
  turned.time = 0.75f;
  motionKeys = {turns, turned, begins, ends};
  motionFactors = {{0, 2, 1}, {2, 2, 0}};
  motions = {{}, {0, 2}};
  transforms.back().motion = 1;
  launch.motions = motions.data();
  launch.motionFactors = motionFactors.data();
  launch.motionKeys = motionKeys.data();
  launch.motionCount = static_cast<std::uint32_t>(motions.size());
  launch.motionFactorCount = static_cast<std::uint32_t>(motionFactors.size());
  launch.motionKeyCount = static_cast<std::uint32_t>(motionKeys.size());
  launch.shutterOpen = 0;
  launch.shutterClose = 1;
}

/// Ways through a selector to its children 0 to 3, and on through the same one in another space.
void World::addSelections(RtslRef selector) {
  selections = {RtslSelection{}};
  for (std::uint32_t above = 0; above != 2; ++above)
    for (std::int32_t child = 0; child != 4; ++child)
      selections.push_back({selector, child, 2 * above, above});
}

/// Where the instance is, which rays see it, and whether it is an object of several primitives.
void World::place(RtslInstance &instance, std::uint32_t number, std::uint32_t primitives) {
  const std::uint32_t key = mix(program.seed, 0x706c6163u + number);
  instance.transform = key % 5 < 2 ? 0 : 1 + key / 5 % 3;
  instance.roots = 1 | (key >> 8 & 2);
  instance.id = static_cast<std::int32_t>(key >> 12 & 7) - 3;
  if (selections.size() > 1 && (key >> 16) % 4 == 0)
    instance.selection = 1 + (key >> 20) % 8;
  if (instance.primitive != 0 && primitives > 1) {
    instance.mesh = static_cast<std::uint32_t>(treeItems.size()) - 1; // the first is of the mesh
    instance.firstBox = static_cast<std::uint32_t>(boxes.size());
    instance.boxCount = primitives;
    boxes.insert(boxes.end(), primitives,
                 {{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}}); // nothing is culled
    treeItems.emplace_back();
  }
  const bool hasParts = instance.primitive == 0 || instance.boxCount != 0;
  const bool hasOwnSpace = hasParts && instance.transform != 0;
  const auto add = [&](std::vector<runtime::BvhItem> &items, const RtslLeafItem &item) {
    items.push_back(
        {{{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}}, // nothing is culled
         item,
         instance.primitive == 0 && !(hasOwnSpace && &items == &worldItems) ? &mesh : nullptr});
  };
  for (std::uint32_t primitive = 0; primitive != primitives; ++primitive)
    if (hasOwnSpace)
      add(treeItems[instance.primitive == 0 ? 0 : instance.mesh + 1], {RTSL_NO_HIT, primitive});
    else
      add(worldItems, {number, primitive});
  if (hasOwnSpace)
    add(worldItems, {number, 0});
}

/// One in three is not there for some rays. Its bounds are what the primitive says, and never used
/// to cull it.
void World::addInstance(RtslInstance instance, std::uint32_t primitives) {
  if (instance.primitive != 0 && code.slots.rt_Primitive_computeBounds) {
    RtslState state{};
    state.launch = &launch;
    code.slots.rt_Primitive_computeBounds(&state, instance.primitive);
    std::copy_n(state.BoundMin, 3, instance.boundMin);
    std::copy_n(state.BoundMax, 3, instance.boundMax);
  }
  const auto number = static_cast<std::uint32_t>(instances.size());
  instance.mask = number % 3 == 2 ? 0xaaaaaaaau : ~0u;
  std::fill_n(instance.lower, 3, -1e18f); // primitives are hit where the dice say
  std::fill_n(instance.upper, 3, 1e18f);
  for (const Object &object : objects)
    if (object.reference == instance.material)
      describeMaterial(instance, *code.find(object.info->name));
  place(instance, number, primitives);
  instances.push_back(instance);
}

/// Three triangles round where rays begin.
RtslMesh World::someMesh() {
  static const float positions[] = {-2,   -1, 0.7f, 2,    -1, 0.7f, 0,    2, 0.7f,
                                    0.9f, -3, -3,   0.9f, 3,  -3,   0.9f, 0, 3};
  static const float uvs[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  static const std::uint32_t indices[] = {0, 1, 2, 3, 4, 5, 0, 4, 2};
  RtslMesh mesh{};
  mesh.positions = positions;
  mesh.uvs = uvs;
  mesh.indices = indices;
  mesh.vertexCount = 6;
  mesh.triangleCount = 3;
  return mesh;
}

void World::makeTree() {
  tree = runtime::buildBvh(worldItems, 1);
  for (std::size_t i = 0; i != treeItems.size(); ++i)
    tree.addMeshTree(i, runtime::buildBvh(treeItems[i], 1));
  tree.install(launch);
}

void World::reverseOrder() {
  std::reverse(worldItems.begin(), worldItems.end());
  for (std::vector<runtime::BvhItem> &contents : treeItems)
    std::reverse(contents.begin(), contents.end());
  makeTree();
}

} // namespace rtsl::random
