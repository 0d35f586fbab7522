//===- DirectionCells.h - directions sorted into cells around two peaks ---===//
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace everything {

/// The sphere of directions around a surface whose normal is z, cut into cells for a density that
/// may be as narrow as a polished mirror's: on each side of the surface into rings around the
/// direction where the density is expected to be largest, and these into sectors. The radii of the
/// rings grow geometrically.
class DirectionCells {
public:
  static constexpr int rings = 20, sectors = 8, perSide = rings * sectors, count = 2 * perSide;

  /// The peaks above and below have length 1 and lie in the plane of x and z. `innermost` is the
  /// angle of the smallest ring, in radians.
  DirectionCells(glm::dvec3 above, glm::dvec3 below, double innermost) : peaks{above, below} {
    angles[0] = 0;
    const double growth = std::pow(pi / innermost, 1.0 / (rings - 1));
    for (int ring = 1; ring <= rings; ++ring)
      angles[ring] = innermost * std::pow(growth, ring - 1);
    angles[rings] = pi * (1 + 1e-12);
  }

  /// Of a direction of length 1.
  int cellOf(const glm::dvec3 &direction) const {
    const int side = direction.z < 0;
    const glm::dvec3 &peak = peaks[side];
    const double angle =
        2 * std::atan2(glm::length(direction - peak), glm::length(direction + peak));
    const double turn =
        std::atan2(direction.y, glm::dot(direction, acrossOf(side))) / (2 * pi) + 0.5;
    const auto ring = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
    const int sector = std::min(int(turn * sectors), sectors - 1);
    return side * perSide + int(ring - angles.begin() - 1) * sectors + sector;
  }

  /// Into how many parts a cell is cut for integrals. At grazing angles densities are narrower
  /// across the plane of x and z than in it, by the cosine: hence more steps around a peak.
  struct Steps {
    int outward, around;
  };

  /// Calls visit(cell, direction, solid angle) for one point of each part of each cell, without
  /// those that lie on the other side of the surface.
  template <typename Visit>
  void integrate(const Steps &steps, Visit visit) const {
    for (int cell = 0; cell < count; ++cell) {
      const int side = cell / perSide, ring = cell % perSide / sectors, sector = cell % sectors;
      const double width = (angles[ring + 1] - angles[ring]) / steps.outward;
      for (int i = 0; i < steps.outward; ++i) {
        const double from = angles[ring] + width * i;
        // cos(from) - cos(from + width), which would lose its digits.
        const double height = 2 * std::sin(from + width / 2) * std::sin(width / 2);
        for (int j = 0; j < steps.around; ++j) {
          const double turn = 2 * pi * ((sector + (j + 0.5) / steps.around) / sectors - 0.5);
          // Not in rows: the horizon cuts cells along curves.
          const double angle = from + width * std::fmod((j + 0.5) * 0.6180339887498949, 1.0);
          const glm::dvec3 direction = std::sin(angle) * std::cos(turn) * acrossOf(side) +
                                       std::sin(angle) * std::sin(turn) * glm::dvec3(0, 1, 0) +
                                       std::cos(angle) * peaks[side];
          if ((direction.z < 0) == (side == 1))
            visit(cell, direction, height * 2 * pi / (sectors * steps.around));
        }
      }
    }
  }

private:
  static constexpr double pi = 3.14159265358979323846;

  /// Perpendicular to the peak and y.
  glm::dvec3 acrossOf(int side) const { return glm::cross(glm::dvec3(0, 1, 0), peaks[side]); }

  std::array<glm::dvec3, 2> peaks;
  std::array<double, rings + 1> angles; // the borders of the rings
};

} // namespace everything
