//===- Stripes.h - which device keeps which rows of a picture -------------===//
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// Rows y0 to y1 - 1 of what is rendered, from the top.
struct Rows {
  std::uint32_t y0 = 0, y1 = 0;

  std::uint32_t height() const { return y1 - y0; }
};

/// In a rendering in passes each device keeps the sums of its rows. Stripes of the picture are
/// dealt to the devices in turn, so that each gets as much of what is hard to render; those that
/// take longer all the same give stripes to others between passes.
class Stripes {
public:
  Stripes(std::uint32_t rows, std::size_t devices);

  /// Those of a device, each a multiple of rowsOfBand from the top.
  const std::vector<Rows> &of(std::size_t device) const { return kept[device]; }

  struct Move {
    Rows rows;
    std::size_t from, to;
  };
  /// Moves stripes so that the devices end at about the same time, by what each of them took for
  /// its own. Gives the moves that were made, none if that would save less than a fiftieth.
  std::vector<Move> balance(std::vector<double> seconds);

private:
  std::vector<std::vector<Rows>> kept; // by device
};

} // namespace rtsl::runtime
