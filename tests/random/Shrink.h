//===- Shrink.h - the smallest program that still fails -------------------===//
#pragma once

#include "Program.h"

#include <functional>

namespace rtsl::random {

/// Makes `program` smaller as long as `fails` holds for what is left: deletes lines, puts the
/// inside of a statement in its place, replaces expressions by simple values and by parts of
/// themselves. `fails` must refuse programs that are not valid, for many that it is asked about are
/// not. Asks at most `limit` times.
void shrink(Program &program, const std::function<bool(const Program &)> &fails,
            unsigned limit = 4000);

} // namespace rtsl::random
