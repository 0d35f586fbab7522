//===- SurfaceTest.h - what holds for every surface that scatters light ---===//
//
// A surface is what engines see of a material: `sampleBSDF`, `BSDF` and `evaluatePDF`, on a floor
// whose normal is z. Nothing here knows a class of the library.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "tests/library/DirectionCells.h"
#include "tests/numerics/robustness/ChiSquare.h"

#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace everything {

/// What a method of a material wrote.
struct Scattered {
  glm::dvec3 toLight;
  double value = 0, density = 0; // of one color
};

/// A material under one ray, which comes from the side of z > 0. Densities and values are those of
/// the engines' conventions (docs/library.md).
struct Surface {
  std::function<Scattered(glm::vec2 seed)> sample;
  std::function<Scattered(const glm::dvec3 &toLight)> evaluate;
  glm::dvec3 shadingNormal{0, 0, 1}; // of which engines take the cosine
};

/// What a case allows, and where its density is largest.
struct Limits {
  double energy = 1.002; // the largest albedo
  double width = 1;      // the smallest angle that the density has, in radians
  double index = 1;      // of the far side, relative to the eye's: where the refracted ray is
};

/// Counts what fails, and prints it.
class Verdict {
public:
  void expect(bool isRight, const std::string &what, double found, double limit) {
    if (isRight)
      return;
    ++failures;
    std::printf("FAILED: %s: %g, limit %g\n", what.c_str(), found, limit);
  }
  bool hasFailed() const { return failures != 0; }

  double largestAlbedo = 0, worstDeviation = 0, worstReciprocity = 0;

private:
  int failures = 0;
};

/// How many directions are drawn, how finely cells are integrated, and how far integrals may be
/// off.
struct Effort {
  int samples = 20000;
  DirectionCells::Steps steps = {10, 24};
  double inexact = 0.005;
};

/// Draws directions of the surface as it is seen at this cosine, and compares them with its density
/// (chi-square over cells), and their weights with the integral of its values: a white furnace, in
/// two ways.
class SurfaceTest {
public:
  SurfaceTest(Verdict &verdict, const Effort &effort, std::string name)
      : verdict(verdict), effort(effort), name(std::move(name)) {}

  void run(const Surface &surface, double cosine, const Limits &limits) {
    const double sine = std::sqrt(1 - cosine * cosine), refracted = sine / limits.index;
    const glm::dvec3 below(-std::min(refracted, 1.0), 0,
                           -std::sqrt(std::max(1 - refracted * refracted, 0.0)));
    const DirectionCells cells({-sine, 0, cosine}, below, 0.1 * limits.width * cosine);
    draw(surface, cells);
    integrate(surface, cells);

    const double integral = sumOf(expected);
    const double deviation = chiSquareDeviation();
    const double albedo = scattered + deltas.energy,
                 spread = std::sqrt(std::max(squares - energy * energy, 0.0) / effort.samples);
    std::printf("%-44s albedo %.4f, drawn %.4f, chi-square %+.2f, density %.4f, absorbed %.4f\n",
                name.c_str(), albedo, energy, deviation, integral + deltas.probability, absorbed);
    verdict.largestAlbedo = std::max(verdict.largestAlbedo, albedo);
    verdict.worstDeviation = std::max(verdict.worstDeviation, deviation);
    verdict.expect(deviation <= 6, name + ": chi-square", deviation, 6);
    verdict.expect(albedo <= limits.energy, name + ": energy", albedo, limits.energy);
    const double difference = std::abs(albedo - energy), allowed = 5 * spread + effort.inexact;
    verdict.expect(difference <= allowed, name + ": energy in two ways", difference, allowed);
    expectShare("absorbed", absorbed, 1 - integral - deltas.probability);
    expectShare("delta", deltas.drawn, deltas.probability);
  }

private:
  struct Deltas {
    double drawn = 0, probability = 0, energy = 0;
    double sides[2] = {}; // the probability that a sample there stated
  };

  static double sumOf(const std::vector<double> &shares) {
    double sum = 0;
    for (double share : shares)
      sum += share;
    return sum;
  }

  /// In standard deviations; 0 if all directions are those of delta distributions.
  double chiSquareDeviation() const {
    if (sumOf(expected) == 0)
      return 0;
    rtsl::numerics::ChiSquare chiSquare;
    for (std::size_t i = 0; i < counts.size(); ++i)
      chiSquare.add(expected[i] * effort.samples, counts[i]);
    return chiSquare.deviation();
  }

  /// A share of all samples is what its probability says.
  void expectShare(const char *what, double share, double probability) {
    const double spread =
        std::sqrt(std::max(probability * (1 - probability), 0.0) / effort.samples);
    const double allowed = 5 * spread + effort.inexact, difference = std::abs(share - probability);
    verdict.expect(difference <= allowed, name + ": share of " + what, difference, allowed);
  }

  void draw(const Surface &surface, const DirectionCells &cells) {
    std::mt19937 random(7);
    const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
    counts.assign(DirectionCells::count, 0);
    for (int i = 0; i < effort.samples; ++i) {
      const float u = uniform();
      const Scattered drawn = surface.sample({u, uniform()});
      double weight = 0;
      if (drawn.density == 0)
        absorbed += 1.0 / effort.samples;
      else if (drawn.density < 0)
        weight = addDelta(drawn);
      else
        weight = addDirection(surface, cells, drawn);
      energy += weight / effort.samples;
      squares += weight * weight / effort.samples;
    }
  }

  double addDelta(const Scattered &drawn) {
    double &stated = deltas.sides[drawn.toLight.z < 0];
    verdict.expect(stated == 0 || std::abs(stated + drawn.density) < 1e-5,
                   name + ": probability of a delta", -drawn.density, stated);
    if (stated == 0) {
      stated = -drawn.density;
      deltas.probability += stated;
      deltas.energy += drawn.value;
    }
    deltas.drawn += 1.0 / effort.samples;
    return drawn.value / -drawn.density;
  }

  /// The value and the density that come with a direction are those of the other methods.
  double addDirection(const Surface &surface, const DirectionCells &cells, const Scattered &drawn) {
    const Scattered again = surface.evaluate(drawn.toLight);
    const double off =
        std::max(std::abs(again.value - drawn.value) / std::max(drawn.value, 0.01),
                 std::abs(again.density - drawn.density) / std::max(drawn.density, 0.01));
    verdict.expect(off < 0.02, name + ": methods", off, 0.02);
    ++counts[std::size_t(cells.cellOf(drawn.toLight))];
    return drawn.value * std::abs(glm::dot(drawn.toLight, surface.shadingNormal)) / drawn.density;
  }

  void integrate(const Surface &surface, const DirectionCells &cells) {
    expected.assign(DirectionCells::count, 0);
    cells.integrate(effort.steps, [&](int cell, const glm::dvec3 &toLight, double solidAngle) {
      const Scattered here = surface.evaluate(toLight);
      expected[std::size_t(cell)] += here.density * solidAngle;
      scattered += here.value * std::abs(glm::dot(toLight, surface.shadingNormal)) * solidAngle;
    });
  }

  Verdict &verdict;
  const Effort effort;
  const std::string name;
  std::vector<std::uint64_t> counts; // drawn, by cell
  std::vector<double> expected;      // shares, by cell
  double scattered = 0;              // the integral of values, without deltas
  double energy = 0, squares = 0;    // means of the drawn weights and of their squares
  double absorbed = 0;
  Deltas deltas;
};

} // namespace everything
