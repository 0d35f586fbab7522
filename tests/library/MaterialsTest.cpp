//===- MaterialsTest.cpp - scattering of the library's materials ----------===//
//
// The materials as C++ that rtslc prints, on a floor whose normal is z. `scatter` is compared with
// `density` by a histogram, and with `value` by the energy of a white furnace.
//
//===----------------------------------------------------------------------===//
#include "everything.cpp" // made by rtslc

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace everything {
namespace {

int failures = 0;

float green(const Color &color) {
  return color.components[1];
}

void expect(bool isRight, const std::string &what, double found, double limit) {
  if (isRight)
    return;
  ++failures;
  std::printf("FAILED: %s: %g, limit %g\n", what.c_str(), found, limit);
}

/// What a case allows: the largest albedo, and whether light may be transmitted.
struct Limits {
  double energy = 1.0005;
  double histogram = 0.02; // of the share of directions that a density gets wrong
};

State lookingDown(float cosine, bool isOutside) {
  State rt{};
  const float sine = std::sqrt(1 - cosine * cosine);
  const float side = isOutside ? 1.0f : -1.0f;
  rt.RayDirection = glm::vec3(-sine, 0.0f, -side * cosine);
  rt.GeometricNormal = glm::vec3(0, 0, 1);
  rt.ShadingNormal = glm::vec3(0, 0, 1);
  return rt;
}

/// A point of the unit square: the R2 sequence.
glm::vec2 seedOf(int i) {
  double a = std::fmod(0.5 + 0.7548776662466927 * i, 1.0);
  double b = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
  return glm::vec2(static_cast<float>(a * 0.9999999), static_cast<float>(b * 0.9999999));
}

double largestAlbedo = 0, worstHistogram = 0, worstReciprocity = 0;

template <typename Material>
void testMaterial(const std::string &name, const Material &material, Limits limits = {},
                  bool isOutside = true) {
  constexpr int samples = 20000, heights = 8, turns = 8;
  for (const float cosine : {0.05f, 0.3f, 0.7f, 0.98f}) {
    State rt = lookingDown(cosine, isOutside);
    const glm::vec3 toEye(std::sqrt(1 - cosine * cosine), 0.0f, cosine);
    std::vector<double> drawn(2 * heights * turns), expected(drawn.size());
    double energy = 0, deltas = 0, absorbed = 0;
    for (int i = 0; i < samples; ++i) {
      const Scattering s = material.scatter(rt, toEye, seedOf(i));
      if (!(s.density > 0)) {
        absorbed += 1.0 / samples;
        continue;
      }
      energy += green(material.weight(s)) / double(samples);
      if (s.isDelta) {
        deltas += 1.0 / samples;
        continue;
      }
      // The values that come with a sample are those of the functions.
      const float value = green(material.value(rt, s.toLight, toEye));
      const float density = material.density(rt, s.toLight, toEye);
      if (std::abs(value - green(s.value)) > 1e-3f * value + 1e-6f ||
          std::abs(density - s.density) > 1e-3f * density + 1e-6f)
        expect(false, name + ": value or density of a sample", value, green(s.value));
      const int h = std::min(int(std::abs(s.toLight.z) * heights), heights - 1);
      const double turn = std::atan2(s.toLight.y, s.toLight.x) / (2 * M_PI) + 0.5;
      const int t = std::min(int(turn * turns), turns - 1);
      drawn[((s.toLight.z < 0) * heights + h) * turns + t] += 1.0 / samples;
    }
    double integral = 0;
    constexpr int steps = 96;
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < heights * steps; ++i)
        for (int j = 0; j < turns * steps / 2; ++j) {
          const double z = (i + 0.5) / (heights * steps),
                       turn = 2 * M_PI * (j + 0.5) / (turns * steps / 2) - M_PI;
          const double sine = std::sqrt(1 - z * z);
          const glm::vec3 toLight(float(sine * std::cos(turn)), float(sine * std::sin(turn)),
                                  float(side ? -z : z));
          const double share = material.density(rt, toLight, toEye) * 2 * M_PI /
                               (heights * steps * turns * steps / 2.0);
          expected[(side * heights + i / steps) * turns + j * 2 / steps] += share;
          integral += share;
        }
    double difference = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i)
      difference += 0.5 * std::abs(drawn[i] - expected[i]);
    // In the density but never sampled: directions below the horizon, which are absorbed.
    difference = std::max(0.0, difference - 0.5 * std::abs(integral + deltas + absorbed - 1));
    largestAlbedo = std::max(largestAlbedo, energy);
    worstHistogram = std::max(worstHistogram, difference);
    const std::string where = name + " at cosine " + std::to_string(cosine);
    expect(energy <= limits.energy, where + ": energy", energy, limits.energy);
    expect(difference <= limits.histogram, where + ": histogram", difference, limits.histogram);
    expect(integral + deltas <= 1.01, where + ": integral of the density", integral + deltas, 1.01);
    std::printf("%-44s energy %.4f histogram %.4f absorbed %.3f density %.4f\n", where.c_str(),
                energy, difference, absorbed, integral + deltas);
  }
}

/// Light and eye may be exchanged.
template <typename Material>
void testReciprocity(const std::string &name, const Material &material) {
  for (int i = 0; i < 2000; ++i) {
    const glm::vec2 a = seedOf(2 * i), b = seedOf(2 * i + 1);
    const glm::vec3 toLight = sampleHemisphere(a), toEye = sampleHemisphere(b);
    State rt = lookingDown(toEye.z, true);
    const float there = green(material.value(rt, toLight, toEye));
    const float back = green(material.value(rt, toEye, toLight));
    const double difference = std::abs(there - back) / std::max(1e-6f, std::max(there, back));
    worstReciprocity = std::max(worstReciprocity, difference);
    expect(difference < 1e-4, name + ": reciprocity", difference, 1e-4);
  }
}

/// The methods that engines call agree with the functions, on a surface that is turned.
template <typename Material>
void testMethods(const std::string &name, const Material &material) {
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 normal = sampleSphere(seedOf(3 * i));
    State rt{};
    rt.GeometricNormal = normal;
    rt.ShadingNormal = normal;
    rt.RayDirection = -3.0f * rtsl::mul(frameAround(normal), sampleHemisphere(seedOf(3 * i + 1)));
    rt.BSDFSeed = seedOf(3 * i + 2);
    material.sampleBSDF(rt);
    const float density = rt.PDF, value = green(rt.BSDFValue);
    if (!(density > 0.01f))
      continue;
    material.BSDF(rt);
    material.evaluatePDF(rt);
    const double off = std::max(std::abs(rt.PDF - density) / density,
                                std::abs(green(rt.BSDFValue) - value) / std::max(value, 0.01f));
    expect(off < 0.02, name + ": methods", off, 0.02);
  }
}

template <typename Material>
void testAll(const std::string &name, const Material &material, Limits limits = {}) {
  testMaterial(name, material, limits);
  testReciprocity(name, material);
  testMethods(name, material);
}

int run() {
  const Color white(1.0f);
  Lambert lambert;
  lambert.reflectance = white;
  testAll("Lambert", lambert);
  for (const float sigma : {0.2f, 1.0f}) {
    OrenNayar rough;
    rough.reflectance = white;
    rough.sigma = sigma;
    testAll("OrenNayar", rough, {1.001, 0.02});
  }
  for (const float alpha : {0.0f, 0.1f, 0.4f, 1.0f}) {
    const std::string a = " " + std::to_string(alpha).substr(0, 4);
    Conductor metal;
    metal.eta = Color(0.001f);
    metal.k = Color(1000.0f);
    metal.alpha = alpha;
    testAll("Conductor" + a, metal);
    Plastic plastic;
    plastic.reflectance = white;
    plastic.alpha = alpha;
    testAll("Plastic" + a, plastic, {1.02, 0.02});
    Dielectric glass;
    glass.alpha = alpha;
    testMaterial("Dielectric" + a, glass, {1.0005, 0.03});
    testMaterial("Dielectric from inside" + a, glass, {1.0005, 0.03}, false);
  }
  for (const float alpha : {0.1f, 0.3f}) {
    Ward ward;
    ward.reflectance = Color(0.5f);
    ward.specular = Color(0.5f);
    ward.alphaU = alpha;
    ward.alphaV = 0.5f * alpha + 0.1f;
    testAll("Ward", ward, {1.001, 0.02});
  }
  for (const float spread : {0.2f, 0.5f, 1.0f}) {
    Velvet velvet;
    velvet.reflectance = white;
    velvet.sheen = white;
    velvet.spread = spread;
    testAll("Velvet", velvet, {1.03, 0.02});
  }
  testMaterial("ThinGlass", ThinGlass());
  for (const float metallic : {0.0f, 1.0f})
    for (const float roughness : {0.35f, 0.7f, 1.0f})
      for (const int layers : {0, 1, 2}) {
        Principled all;
        all.baseColor = white;
        all.metallic = metallic;
        all.roughness = roughness;
        all.clearcoat = layers == 1 ? 1.0f : 0.0f;
        all.clearcoatRoughness = 0.4f;
        all.sheenColor = Color(layers == 2 ? 0.8f : 0.0f);
        testAll("Principled", all, {1.04, 0.02});
        all.transmission = 0.7f;
        testMaterial("Principled pane", all, {1.04, 0.02});
      }
  std::printf("largest energy %g, worst histogram %g, worst reciprocity %g\n", largestAlbedo,
              worstHistogram, worstReciprocity);
  return failures != 0;
}

} // namespace
} // namespace everything

int main() {
  return everything::run();
}
