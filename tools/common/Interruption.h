//===- Interruption.h - Ctrl-C while a picture is rendered -----------------===//
#pragma once

#include <atomic>

namespace rtsl::tool {

/// From now on the first SIGINT or SIGTERM sets the returned flag, for renderings to stop
/// at; the second ends the process at once.
const std::atomic<bool> *catchInterruptions();

/// The same for a rendering that finishes its samples first, which the first SIGINT says at once:
/// they may take any time.
const std::atomic<bool> *catchInterruptionsOfSamples();

/// "SIGINT" or "SIGTERM"; null if neither has come.
const char *interruption();

/// The exit status of what was interrupted: 130 or 143. Otherwise `status`.
int statusAfterInterruption(int status);

} // namespace rtsl::tool
