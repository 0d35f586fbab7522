//===- LightTree.h - choosing among many lamps ----------------------------===//
//
// The lamps of a scene, emitters or parts of them, are the leaves of a tree. Its nodes bound their
// positions, the directions into which they emit light, and their power. A lamp is chosen from the
// root down: at each node one of the children, with probabilities in the ratio of the light that
// they may send to the point (Conty Estevez and Kulla, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting", 2018; this bound for cosines without angles: Pharr, Jakob and
// Humphreys, "Physically Based Rendering", 4th edition, 2023, section 12.6.3). From a leaf up, the
// same probabilities give the chance of the lamp.
//
// The chance does not depend on the surface at the point: a ray that meets a lamp by chance must
// find the same one, and carries only the point where it began.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Random.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// An angle from 0 to pi.
struct Angle {
  float cosine, sine;
};

inline Angle angleOfCosine(float cosine) {
  return {cosine, squareRoot(maximum(1 - cosine * cosine, 0))};
}

/// a - b, or 0 if b is larger.
inline Angle difference(Angle a, Angle b) {
  if (a.cosine > b.cosine)
    return {1, 0};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}

/// The largest cosine, at a lamp of the node, of the angle between its normal and the direction to
/// the point; at most 0 if all face away from it. `to` leads from the middle of the node, and
/// `square` is its square.
inline float cosineAtLamps(const RtslLightNode &node, Vec3 to, float square) {
  if (node.cosine == -1 || !(square > node.squareRadius))
    return 1;
  float alongAxis = dot(load(node.axis), to) / squareRoot(square);
  if (node.parent & RTSL_SHINES_ON_BOTH_SIDES)
    alongAxis = absolute(alongAxis);
  const Angle toPoint = angleOfCosine(maximum(minimum(alongAxis, 1), -1));
  const float squareSine = node.squareRadius / square; // of half the angle at which it is seen
  const Angle ofBall = {squareRoot(maximum(1 - squareSine, 0)), squareRoot(squareSine)};
  return difference(difference(toPoint, angleOfCosine(node.cosine)), ofBall).cosine;
}

/// How much light the lamps of the node may send to the point. It is 0 only if they all face away
/// from it, not because the point is extremely far away. The mean of 1 / distance^2 in the middle
/// of lamps that fill a box is about four times that at its corners.
inline float importance(const RtslLightNode &node, Vec3 point) {
  const Vec3 to = point - load(node.middle);
  const float square = dot(to, to);
  const float cosine = cosineAtLamps(node, to, square);
  if (!(cosine > 0))
    return 0;
  return maximum(node.power * cosine / maximum(square, 0.25f * node.squareRadius), 0x1p-126f);
}

/// The least chance of a child whose lamps may send light to the point: a multiple of the steps of
/// random numbers, so that they choose it with the chance that it has.
constexpr float leastChance = 0x1p-16f;

/// The chance of the first of an inner node's children; negative: no light of them reaches the
/// point.
inline float chanceOfFirst(const RtslLightNode &node, const RtslLightNode *nodes, Vec3 point) {
  const RtslLightNode &first = nodes[node.first], &second = nodes[node.first + 1];
  float a = importance(first, point), b = importance(second, point);
  if (a == 0 && b == 0)
    return -1;
  if (a == 0 || b == 0)
    return a == 0 ? 0 : 1;
  if (!(a + b < infinity)) { // the point is in the middle of a lamp
    a = first.power;
    b = second.power;
  }
  return minimum(maximum(a / (a + b), leastChance), 1 - leastChance);
}

/// The chance with which chooseLeaf() chooses a leaf at this point.
inline float chanceOfLeaf(const RtslLightNode *nodes, uint32_t leaf, Vec3 point) {
  float chance = 1;
  for (uint32_t number = leaf; number != 0 && chance > 0;) {
    const uint32_t parent = nodes[number].parent & ~RTSL_SHINES_ON_BOTH_SIDES;
    const float ofFirst = chanceOfFirst(nodes[parent], nodes, point);
    if (ofFirst < 0)
      return 0;
    chance *= number == nodes[parent].first ? ofFirst : 1 - ofFirst;
    number = parent;
  }
  return chance;
}

/// Chooses a leaf by a number in [0, 1); RTSL_NO_LIGHT_LEAF: no light reaches the point. `key`: of
/// the shadow ray, for more digits where those of `choice` are used up.
inline uint32_t chooseLeaf(const RtslLightNode *nodes, Vec3 point, float choice,
                           const uint32_t key[2]) {
  uint32_t number = 0;
  float chance = 1; // since the last draw
  for (uint32_t level = 0; nodes[number].part == RTSL_INNER_LIGHT_NODE; ++level) {
    const float ofFirst = chanceOfFirst(nodes[number], nodes, point);
    if (ofFirst < 0)
      return RTSL_NO_LIGHT_LEAF;
    const bool isFirst = choice < ofFirst;
    number = nodes[number].first + (isFirst ? 0 : 1);
    const float ofChosen = isFirst ? ofFirst : 1 - ofFirst;
    choice = (isFirst ? choice : choice - ofFirst) / ofChosen;
    chance *= ofChosen;
    if (chance < 0x1p-6f) {
      choice = unitFloat(hash4(key[0], key[1], level, 0x6c616d70u).x);
      chance = 1;
    }
    choice = minimum(choice, 1 - roundingUnit);
  }
  return number;
}

} // namespace rtsl::device
