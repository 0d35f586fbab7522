//===- ParallelRows.cpp ---------------------------------------------------===//
#include "report/measures/ParallelRows.h"

#include <tbb/parallel_for.h>

namespace rtsl::report {

void parallelRows(std::uint32_t rows, const std::function<void(std::uint32_t)> &work) {
  tbb::parallel_for(std::uint32_t(0), rows, [&](std::uint32_t y) { work(y); });
}

} // namespace rtsl::report
