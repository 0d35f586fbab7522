//===- BoxRuns.cpp --------------------------------------------------------===//
//
// A tree is built over the runs, so only the lowest levels of this sorting matter. Boxes are first
// sorted into the cells of a grid, along a Morton curve; cells that follow each other are a group
// of some hundred boxes. A group, which fits into a cache, is then split in two again and again by
// the surface area heuristic over bins (Wald, "On fast construction of SAH-based bounding volume
// hierarchies", 2007), with costs that count whole runs.
//
//===----------------------------------------------------------------------===//
#include "runtime/accel/trees/BoxRuns.h"

#include "runtime/accel/trees/Extent.h"
#include "support/Parallel.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <utility>

namespace rtsl::runtime {

namespace {

/// x, y, z, and a number that does not matter.
using Vector = __m128;

Vector lowerOf(const TriangleBox &box) {
  return _mm_blend_ps(_mm_load_ps(box.lower), _mm_setzero_ps(), 8);
}
Vector upperOf(const TriangleBox &box) {
  return _mm_blend_ps(_mm_load_ps(box.upper), _mm_setzero_ps(), 8);
}
/// Twice the middle.
Vector middleOf(const TriangleBox &box) {
  return _mm_add_ps(lowerOf(box), upperOf(box));
}

//===----------------------------------------------------------------------===//
// Groups into runs
//===----------------------------------------------------------------------===//

constexpr unsigned binCount = 16;

/// The number of runs that so many boxes need at least.
std::size_t runsOf(std::size_t boxes) {
  return (boxes + longestRun - 1) / longestRun;
}

/// Where to split: boxes in bins below `bin` go to the left.
struct Split {
  int axis = -1; // there is none
  int bin = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/// The bins of boxes, along all axes.
class Bins {
public:
  Bins(const TriangleBox *first, const TriangleBox *end) {
    Extent middles;
    for (const TriangleBox *box = first; box != end; ++box)
      middles.add(middleOf(*box), middleOf(*box));
    lower = middles.lower;
    scale = middles.scaleTo(float(binCount));
    for (const TriangleBox *box = first; box != end; ++box) {
      const Vector low = lowerOf(*box), high = upperOf(*box);
      const std::array<int, 4> bin = binsOf(*box);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        extents[axis][std::size_t(bin[axis])].add(low, high);
        ++counts[axis][std::size_t(bin[axis])];
      }
    }
  }

  int binOf(const TriangleBox &box, int axis) const { return binsOf(box)[std::size_t(axis)]; }

  /// The cheapest one that leaves boxes on both sides.
  Split best() const {
    Split best;
    for (int axis = 0; axis < 3; ++axis)
      improve(best, axis);
    return best;
  }

private:
  std::array<int, 4> binsOf(const TriangleBox &box) const {
    const Vector place = _mm_mul_ps(_mm_sub_ps(middleOf(box), lower), scale);
    alignas(16) std::array<int, 4> bins;
    _mm_store_si128(reinterpret_cast<__m128i *>(bins.data()),
                    _mm_min_epi32(_mm_cvttps_epi32(place), _mm_set1_epi32(int(binCount) - 1)));
    return bins;
  }

  void improve(Split &best, int axis) const {
    const auto &extent = extents[std::size_t(axis)];
    const auto &count = counts[std::size_t(axis)];
    std::array<double, binCount> right; // costs of the bins from here on
    Extent sum;
    std::size_t boxes = 0;
    for (std::size_t bin = binCount; bin-- > 1;) {
      sum.add(extent[bin]);
      boxes += count[bin];
      right[bin] = boxes == 0 ? -1 : sum.area() * double(runsOf(boxes));
    }
    sum = {};
    boxes = 0;
    for (std::size_t bin = 1; bin < binCount; ++bin) {
      sum.add(extent[bin - 1]);
      boxes += count[bin - 1];
      const double cost = sum.area() * double(runsOf(boxes)) + right[bin];
      if (boxes != 0 && right[bin] >= 0 && cost < best.cost)
        best = {axis, int(bin), cost};
    }
  }

  Vector lower, scale;
  std::array<std::array<Extent, binCount>, 3> extents;
  std::array<std::array<std::uint32_t, binCount>, 3> counts{};
};

/// Partitions boxes into two parts, neither of which is empty. Returns the first of the second.
TriangleBox *splitInTwo(TriangleBox *first, TriangleBox *end) {
  const Bins bins(first, end);
  const Split split = bins.best();
  if (split.axis < 0) // all have the same middle
    return first + longestRun * (runsOf(std::size_t(end - first)) / 2);
  return std::partition(
      first, end, [&](const TriangleBox &box) { return bins.binOf(box, split.axis) < split.bin; });
}

/// Writes the length of each run at the place of its first box.
void splitIntoRuns(TriangleBox *first, TriangleBox *end, std::uint8_t *lengths) {
  while (std::size_t(end - first) > longestRun) {
    TriangleBox *middle = splitInTwo(first, end);
    if (middle - first < end - middle) { // the smaller half: calls nest log2(n) deep at most
      splitIntoRuns(first, middle, lengths);
      lengths += middle - first;
      first = middle;
    } else {
      splitIntoRuns(middle, end, lengths + (middle - first));
      end = middle;
    }
  }
  if (first != end)
    *lengths = std::uint8_t(end - first);
}

//===----------------------------------------------------------------------===//
// Boxes into groups
//===----------------------------------------------------------------------===//

constexpr std::size_t largestGroup = 1024;

/// A grid over the middles of boxes, with cells that are numbered along a Morton curve.
class Grid {
public:
  Grid(const Extent &middles, std::size_t boxes) {
    while (bits < 5 && cellCount() * 8 * 16 <= boxes)
      ++bits;
    lower = middles.lower;
    scale = middles.scaleTo(float(1u << bits));
  }

  std::size_t cellCount() const { return std::size_t(1) << (3 * bits); }

  std::uint32_t cellOf(const TriangleBox &box) const {
    const Vector place = _mm_mul_ps(_mm_sub_ps(middleOf(box), lower), scale);
    alignas(16) std::array<int, 4> cell;
    _mm_store_si128(reinterpret_cast<__m128i *>(cell.data()),
                    _mm_min_epi32(_mm_cvttps_epi32(place), _mm_set1_epi32((1 << bits) - 1)));
    return spread(cell[0]) << 2 | spread(cell[1]) << 1 | spread(cell[2]);
  }

private:
  /// The bits of a number, with two zeros between them.
  static std::uint32_t spread(int number) {
    return std::uint32_t(_pdep_u32(unsigned(number), 0x1249));
  }

  unsigned bits = 2; // of the number of cells along each axis
  Vector lower, scale;
};

/// A range of boxes.
struct Group {
  std::size_t first, end;
};

class Sorter {
public:
  Sorter(LargeArray<TriangleBox> &boxes, unsigned threads)
      : threads(threads), boxes(boxes), lengths(boxes.size()) {
    sort({0, boxes.size()});
  }

  std::vector<BoxRun> runs() const {
    std::vector<BoxRun> runs;
    runs.reserve(lengths.size() / (longestRun - 2));
    for (std::size_t first = 0; first < lengths.size(); first += lengths[first])
      runs.push_back({first, lengths[first]});
    return runs;
  }

private:
  void sort(const Group &all) {
    if (all.end - all.first <= largestGroup)
      return splitIntoRuns(boxes.data() + all.first, boxes.data() + all.end,
                           lengths.data() + all.first);
    const std::vector<Group> groups = sortIntoGroups(all);
    // Where all is in one cell, a few distant boxes may have made the grid too coarse.
    forEachInParallel(threads, groups.size(), [&](std::size_t i) {
      const auto [first, end] = groups[i];
      const std::size_t count = end - first;
      if (count > 16 * largestGroup && count < all.end - all.first)
        sort(groups[i]);
      else
        splitIntoRuns(boxes.data() + first, boxes.data() + end, lengths.data() + first);
    });
  }

  /// Counting sort by cells. Each thread counts, and then moves, parts of the boxes.
  std::vector<Group> sortIntoGroups(const Group &all) {
    const std::size_t count = all.end - all.first;
    TriangleBox *const source = boxes.data() + all.first;
    const Grid grid(middlesOf(source, count), count);
    const std::size_t cellCount = grid.cellCount();
    const std::size_t atOnce = std::max<std::size_t>(count / 16 + 1, 4 * cellCount);
    const std::size_t parts = (count + atOnce - 1) / atOnce;
    std::vector<std::uint32_t> places(parts * cellCount); // by part and cell
    forRangesInParallel(threads, count, atOnce, [&](std::size_t first, std::size_t end) {
      std::uint32_t *of = &places[first / atOnce * cellCount];
      for (std::size_t i = first; i < end; ++i)
        ++of[grid.cellOf(source[i])];
    });
    std::vector<std::uint32_t> starts(cellCount + 1);
    std::uint32_t start = 0;
    for (std::size_t cell = 0; cell < cellCount; ++cell) {
      starts[cell] = start;
      for (std::size_t part = 0; part < parts; ++part)
        start += std::exchange(places[part * cellCount + cell], start);
    }
    starts[cellCount] = start;
    LargeArray<TriangleBox> sorted(count);
    forRangesInParallel(threads, count, atOnce, [&](std::size_t first, std::size_t end) {
      std::uint32_t *of = &places[first / atOnce * cellCount];
      for (std::size_t i = first; i < end; ++i)
        sorted[of[grid.cellOf(source[i])]++] = source[i];
    });
    if (count == boxes.size())
      boxes = std::move(sorted);
    else
      std::copy(sorted.begin(), sorted.end(), source);
    std::vector<Group> groups;
    addGroups(starts, 0, cellCount, all.first, groups);
    return groups;
  }

  Extent middlesOf(const TriangleBox *source, std::size_t count) const {
    Extent middles;
    std::mutex mutex;
    forRangesInParallel(threads, count, 1 << 16, [&](std::size_t first, std::size_t end) {
      Extent some;
      for (std::size_t i = first; i < end; ++i)
        some.add(middleOf(source[i]), middleOf(source[i]));
      const std::lock_guard<std::mutex> lock(mutex);
      middles.add(some);
    });
    return middles;
  }

  /// Adds the groups of `count` cells from this one on; each half of them is a group of its own if
  /// together they are too large.
  static void addGroups(const std::vector<std::uint32_t> &starts, std::size_t cell,
                        std::size_t count, std::size_t offset, std::vector<Group> &groups) {
    const std::size_t first = starts[cell], end = starts[cell + count];
    if (first == end)
      return;
    if (count == 1 || end - first <= largestGroup) {
      groups.push_back({offset + first, offset + end});
      return;
    }
    addGroups(starts, cell, count / 2, offset, groups);
    addGroups(starts, cell + count / 2, count / 2, offset, groups);
  }

  const unsigned threads;
  LargeArray<TriangleBox> &boxes;
  std::vector<std::uint8_t> lengths; // of a run, at its first box
};

} // namespace

std::vector<BoxRun> sortIntoRuns(LargeArray<TriangleBox> &boxes, unsigned threads) {
  return Sorter(boxes, threads).runs();
}

} // namespace rtsl::runtime
