//===- Emitters.h - the instances of a scene that shine -------------------===//
//
// A program that lights points by surfaces chooses among these by the power that they send out, or
// by a light tree where there are many (runtime/device/engines/Emitters.h). The power is estimated,
// and so is on which sides they shine: what an estimate misses is found later, or not, by the rays
// of the picture, whose mean does not depend on the choice.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/scene/Objects.h"
#include "runtime/scene/SceneData.h"
#include "runtime/scene/lights/LightTree.h"

#include <vector>

namespace rtsl::runtime {

class Emitters {
public:
  /// Finds the emitters of a launch that is complete but for them. The objects' program has
  /// `emittedPower`.
  Emitters(const Objects &objects, const RtslLaunch &complete, LampChoice choice);

  /// Sets the launch's fields about emitters.
  void fill(RtslLaunch &launch) const;

private:
  void addTree(std::vector<Lamp> lamps);

  std::vector<RtslEmitter> emitters;
  std::vector<float> partChances;
  std::vector<RtslLightNode> nodes; // none: there is no tree
  std::vector<std::uint32_t> leaves;
};

} // namespace rtsl::runtime
