//===- ParallelRows.h - processing the rows of a picture, on all cores ----===//
#pragma once

#include <cstdint>
#include <functional>

namespace rtsl::report {

/// Calls `work(y)` once for each y in [0, rows), on several threads, and waits. What a row computes
/// must not depend on another row's result of the same call.
void parallelRows(std::uint32_t rows, const std::function<void(std::uint32_t)> &work);

} // namespace rtsl::report
