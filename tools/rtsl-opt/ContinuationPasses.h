//===- ContinuationPasses.h - the steps of splitting as passes ------------===//
#pragma once

namespace rtsl {

/// Makes the steps of codegen/passes/continuation known to a command line, each under its own name,
/// and all together as `--rtsl-split`.
void registerContinuationPasses();

} // namespace rtsl
