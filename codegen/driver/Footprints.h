//===- Footprints.h - footprints that no code reads any more --------------===//
#pragma once

#include "codegen/driver/Compilation.h"

namespace rtsl::driver {

/// Lookups that need the footprint of a ray may be in code that never runs with the numbers of the
/// scene: with the filter of an image, above all. Changes of scratch members that only such code
/// reads are not computed, and if nothing else reads footprints, rays have no cones. Warns of
/// changes that are read and not known. Runs on level 2, where conditions are known.
void leaveOutFootprints(Compilation &compilation);

} // namespace rtsl::driver
