//===- MaterialsTest.cpp - scattering of the library's materials ----------===//
//
// The materials as C++ that rtslc prints. RTSL_DEEP=1 draws fifteen times as many directions, at
// more settings and angles.
//
//===----------------------------------------------------------------------===//
#include "everything.cpp" // made by rtslc

#include "tests/library/SurfaceTest.h"

#include <cstdlib>
#include <new>

namespace everything {
namespace {

float green(const Color &color) {
  return color.components[1];
}

/// Objects that others refer to, as records of a scene.
class Objects {
public:
  template <typename Class>
  RtslRef add(Id id, const Class &object) {
    const RtslRef reference = used;
    constexpr std::size_t offset = rtsl::objectOffset<Class>;
    used += RtslRef((offset + sizeof(Class) + 15) / 16 * 16);
    if (used > sizeof bytes)
      std::abort();
    new (bytes + reference) Id(id);
    new (bytes + reference + offset) Class(object);
    return reference;
  }
  RtslLaunch launch() {
    RtslLaunch result{};
    result.records = bytes;
    result.colorComponents = 3;
    return result;
  }

private:
  alignas(16) unsigned char bytes[4096];
  RtslRef used = 16; // 0 is no object
};

/// Rays that meet a floor.
class Floor {
public:
  Verdict verdict;
  Effort effort;
  std::vector<double> cosines = {0.01, 0.05, 0.3, 0.7, 1};
  Objects objects;

  /// A hit of a ray from `toEye`, on a surface whose normal is z, or -z if the ray comes from
  /// inside. The shading normal leans by `lean` radians towards x.
  State hit(const glm::dvec3 &toEye, bool isOutside = true, double lean = 0) {
    launch = objects.launch();
    State rt{};
    rt.launch = &launch;
    const float side = isOutside ? 1.0f : -1.0f;
    rt.RayDirection = -glm::vec3(toEye);
    rt.GeometricNormal = glm::vec3(0, 0, side);
    rt.ShadingNormal = side * glm::vec3(float(std::sin(lean)), 0.0f, float(std::cos(lean)));
    rt.dPdu = glm::vec3(1, 0, 0);
    rt.dPdv = glm::vec3(0, 1, 0);
    rt.WorldToObject = rt.ObjectToWorld = glm::mat4(1.0f);
    return rt;
  }

  template <typename Material>
  static Scattered evaluate(const Material &material, State &rt, const glm::dvec3 &toLight) {
    rt.LightDirection = glm::vec3(toLight);
    rt.BSDFValue = Color(0.0f);
    rt.PDF = 0;
    material.BSDF(rt);
    material.evaluatePDF(rt);
    return {toLight, green(rt.BSDFValue), rt.PDF};
  }
  template <typename Material>
  static Scattered sample(const Material &material, State &rt, glm::vec2 seed) {
    rt.BSDFSeed = seed;
    rt.BSDFValue = Color(0.0f);
    rt.PDF = 0;
    material.sampleBSDF(rt);
    return {glm::normalize(glm::dvec3(rt.LightDirection)), green(rt.BSDFValue), rt.PDF};
  }

  /// Directions and energy, at several cosines. Where the surface is seen at the most grazing ones,
  /// cells are too coarse for narrow lobes and for refraction.
  template <typename Material>
  void directions(const std::string &name, const Material &material, const Limits &limits = {},
                  bool isOutside = true, double lean = 0) {
    for (const double cosine : cosines) {
      if (cosine < 0.05 && (limits.width < 0.1 || limits.index != 1))
        continue;
      State rt = hit({std::sqrt(1 - cosine * cosine), 0, cosine}, isOutside, lean);
      const Surface surface = {
          [&](glm::vec2 seed) { return sample(material, rt, seed); },
          [&](const glm::dvec3 &toLight) { return evaluate(material, rt, toLight); },
          glm::dvec3(rt.ShadingNormal)};
      SurfaceTest(verdict, effort, name + " at cosine " + std::to_string(cosine).substr(0, 4))
          .run(surface, cosine, limits);
    }
  }

  /// Light and eye may be exchanged. Light that is transmitted has its radiance divided by the
  /// square of the index on its side; `index` is that of the inside, relative to the outside.
  /// `alpha` is the roughness: half vectors are rounded, and their slopes are in units of it.
  template <typename Material>
  void reciprocity(const std::string &name, const Material &material, double alpha,
                   double index = 1) {
    std::mt19937 random(3);
    const auto seed = [&] {
      const float u = float(random() >> 8) * 0x1p-24f;
      return glm::vec2(u, float(random() >> 8) * 0x1p-24f);
    };
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 toEye = glm::normalize(glm::dvec3(sampleHemisphere(seed())));
      glm::dvec3 toLight = glm::normalize(glm::dvec3(sampleSphere(seed())));
      State rt = hit(toEye);
      if (i % 2) { // where the material sends light, which may be far from all directions
        const Scattered drawn = sample(material, rt, seed());
        if (!(drawn.density > 0))
          continue;
        toLight = drawn.toLight;
      }
      const bool isThrough = toLight.z < 0;
      const double there = evaluate(material, rt, toLight).value;
      // From below the surface is seen upside down.
      const glm::dvec3 turned(1, 1, isThrough ? -1 : 1);
      State back = hit(toLight * turned, !isThrough);
      const double again =
          evaluate(material, back, toEye * turned).value * (isThrough ? index * index : 1);
      const double difference = std::abs(there - again) / std::max(1e-6, std::max(there, again));
      const double allowed = 1e-4 + roundingOfMirrors(toEye, toLight, alpha, index);
      verdict.worstReciprocity = std::max(verdict.worstReciprocity, difference);
      verdict.expect(difference < allowed, name + ": reciprocity", difference, allowed);
    }
  }

  template <typename Material>
  void all(const std::string &name, const Material &material, const Limits &limits = {}) {
    directions(name, material, limits);
    reciprocity(name, material, limits.width);
  }

private:
  /// How far values may be off because directions are rounded. The slope of the mirror that leads
  /// one direction into the other is in units of alpha; where a mirror is seen at a grazing angle,
  /// the cosine on one side follows from that on the other by a root, and its digits are lost.
  static double roundingOfMirrors(const glm::dvec3 &toEye, const glm::dvec3 &toLight, double alpha,
                                  double index) {
    const bool isRefracted = toLight.z < 0 && index != 1;
    const glm::dvec3 mirrored(toLight.x, toLight.y, std::abs(toLight.z)),
        half = isRefracted ? toEye + index * toLight : toEye + mirrored;
    const double ofMirror = std::min(std::abs(glm::dot(toEye, half)),
                                     std::abs(glm::dot(isRefracted ? toLight : mirrored, half))) /
                            glm::length(half);
    const double cosine = std::min({ofMirror, toEye.z, mirrored.z});
    return 5e-7 / (alpha * std::abs(half.z)) + 1e-6 * index * index / (cosine * cosine);
  }

  RtslLaunch launch;
};

const Color white(1.0f);
constexpr float alphas[] = {0, 0.001f, 0.003f, 0.01f, 0.03f, 0.1f, 0.3f, 0.6f, 1};

std::string named(const char *name, float number) {
  return std::string(name) + " " + std::to_string(number).substr(0, 5);
}
Limits ofAlpha(float alpha, double energy = 1.002, double index = 1) {
  return {energy, alpha > 0 ? double(alpha) : 1.0, index};
}

/// Settings of a parameter. Many of them take a grid that resolves the narrowest lobes.
struct Settings {
  std::vector<float> few, many;

  const std::vector<float> &of(bool isDeep) const { return isDeep ? many : few; }
};
const Settings sigmas = {{0, 1e-4f, 0.2f, 0.5f, 1},
                         {0, 1e-4f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1}};
const Settings spreads = {{0.2f, 0.25f, 0.5f, 1},
                          {0.2f, 0.22f, 0.25f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1}};
const Settings wardAlphas = {{0.05f, 0.15f, 0.5f}, {0.01f, 0.02f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f}};

void testDiffuse(Floor &floor, bool isDeep) {
  Lambert lambert;
  lambert.reflectance = white;
  floor.all("Lambert", lambert);
  floor.directions("Lambert, other normal", lambert, {}, true, 0.3);
  for (const float sigma : sigmas.of(isDeep)) {
    OrenNayar rough;
    rough.reflectance = white;
    rough.sigma = sigma;
    floor.all(named("OrenNayar", sigma), rough, {1.002});
  }
  for (const float spread : spreads.of(isDeep)) {
    Velvet velvet;
    velvet.reflectance = velvet.sheen = white;
    velvet.spread = spread;
    floor.all(named("Velvet", spread), velvet, {1.03});
  }
}

template <typename Metal>
void testMetal(Floor &floor, const char *name) {
  Metal metal;
  metal.alpha = 0.2f;
  floor.all(name, metal, {0.999, 0.2});
}

void testGlossy(Floor &floor, bool isDeep) {
  for (const float alpha : alphas) {
    Conductor metal;
    metal.eta = Color(0.001f);
    metal.k = Color(1000.0f);
    metal.alpha = alpha;
    floor.all(named("Conductor", alpha), metal, ofAlpha(alpha));
    Plastic plastic;
    plastic.reflectance = white;
    plastic.alpha = alpha;
    floor.all(named("Plastic", alpha), plastic, ofAlpha(alpha, 1.02));
  }
  testMetal<Gold>(floor, "Gold");
  testMetal<Silver>(floor, "Silver");
  testMetal<Copper>(floor, "Copper");
  testMetal<Aluminium>(floor, "Aluminium");
  testMetal<Iron>(floor, "Iron");
  for (const float index : {1.01f, 2.0f}) {
    Plastic plastic;
    plastic.reflectance = white;
    plastic.index = index;
    floor.all(named("Plastic of index", index), plastic, ofAlpha(plastic.alpha, 1.02));
  }
  for (const float alphaU : wardAlphas.of(isDeep))
    for (const float alphaV : wardAlphas.of(isDeep)) {
      Ward ward;
      ward.reflectance = ward.specular = Color(0.5f);
      ward.alphaU = alphaU;
      ward.alphaV = alphaV;
      floor.all(named("Ward", alphaU) + named(" and", alphaV), ward,
                ofAlpha(std::min(alphaU, alphaV), 1.002));
    }
}

void testTransparent(Floor &floor) {
  for (const float index : {1.05f, 1.5f, 4.0f})
    for (const float alpha : alphas) {
      if (index != 1.5f && alpha != 0.0f && alpha != 0.1f)
        continue;
      Dielectric glass;
      glass.index = index;
      glass.alpha = alpha;
      const std::string name = named("Dielectric", alpha) + named(" of index", index);
      const float bent = alpha * std::min(index - 1, 1.0f); // how far refracted rays spread
      floor.directions(name, glass, ofAlpha(bent, 1.002, index));
      floor.directions(name + " from inside", glass, ofAlpha(bent, 1.002, 1 / index), false);
      floor.reciprocity(name, glass, ofAlpha(alpha).width, index);
    }
  for (const float index : {1.0f, 1.5f, 4.0f}) {
    ThinGlass pane;
    pane.index = index;
    floor.directions(named("ThinGlass", index), pane);
  }
  floor.directions("MediumBoundary", MediumBoundary());
}

void testPrincipled(Floor &floor, const std::vector<float> &metallics,
                    const std::vector<float> &roughnesses) {
  for (const float metallic : metallics)
    for (const float roughness : roughnesses)
      for (const int layers : {0, 1, 2}) { // none, a coat, fibres
        Principled surface;
        surface.baseColor = white;
        surface.metallic = metallic;
        surface.roughness = roughness;
        surface.clearcoat = layers == 1 ? 1.0f : 0.0f;
        surface.clearcoatRoughness = roughness == 1 ? 0.03f : 0.4f;
        surface.sheenColor = Color(layers == 2 ? 0.8f : 0.0f);
        const float sharpest =
            layers == 1 ? std::min(surface.clearcoatRoughness, roughness) : roughness;
        const float narrowest = std::max(sharpest * sharpest, 0.001f);
        const std::string name = named("Principled", metallic) + named(" rough", roughness) +
                                 " layers " + std::to_string(layers);
        floor.all(name, surface, ofAlpha(narrowest, 1.04));
        surface.transmission = 0.7f;
        floor.all(name + ", pane", surface, ofAlpha(narrowest, 1.04));
      }
}

/// Materials that are made of others.
void testCompound(Floor &floor) {
  Lambert chalk;
  chalk.reflectance = white;
  Conductor metal;
  metal.alpha = 0.1f;
  Dielectric glass;
  const ScattererRef ofChalk(floor.objects.add(Id::Lambert, chalk)),
      ofMetal(floor.objects.add(Id::Conductor, metal)),
      ofGlass(floor.objects.add(Id::Dielectric, glass));
  const Limits ofMetals = ofAlpha(0.1f);

  MixMaterial mixed;
  mixed.first = ofChalk;
  mixed.second = ofMetal;
  mixed.amount = 0.3f;
  floor.all("MixMaterial", mixed, ofMetals);
  mixed.second = ofGlass;
  floor.directions("MixMaterial with a delta", mixed, {1.002, 1, 1.5});

  TwoSided coin;
  coin.front = ofMetal;
  coin.back = ofChalk;
  floor.all("TwoSided", coin, ofMetals);
  floor.directions("TwoSided from the back", coin, {}, false);

  Cutout gauze;
  gauze.material = ofMetal;
  gauze.opacity = 0.6f;
  floor.all("Cutout", gauze, ofMetals);

  Solid slope;
  slope.value = Color(0.2f);
  NormalMap dented;
  dented.material = ofChalk;
  dented.slopeU = TextureRef(floor.objects.add(Id::Solid, slope));
  floor.directions("NormalMap", dented, {1.2});

  Noise waves;
  BumpMap bumpy;
  bumpy.material = ofChalk;
  bumpy.height = PatternRef(floor.objects.add(Id::Noise, waves));
  floor.directions("BumpMap", bumpy, {1.2});
}

/// The published formula of fibres, in double; both directions are above the surface.
double fibres(const glm::dvec3 &toLight, const glm::dvec3 &toEye, double spread) {
  const double pi = std::acos(-1.0);
  const glm::dvec3 half = glm::normalize(toLight + toEye);
  const double sine = std::sqrt(std::max(0.0, 1 - half.z * half.z));
  const double distribution = (2 + 1 / spread) * std::pow(sine, 1 / spread) / (2 * pi);
  const double visibility = 1 / (4 * (toLight.z + toEye.z - toLight.z * toEye.z));
  return distribution * visibility;
}

/// sheenReflection is that formula, and sheenAlbedo its integral within 0.03.
void testFibres(Floor &floor) {
  constexpr int rings = 256, sectors = 64; // of directions towards light
  const double turn = 2 * std::acos(-1.0);
  for (const double spread : {0.2, 0.35, 0.6, 1.0})
    for (const double cosine : {0.02, 0.1, 0.3, 0.6, 1.0}) {
      const glm::dvec3 toEye(std::sqrt(1 - cosine * cosine), 0, cosine);
      double albedo = 0, worst = 0;
      for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
          const double z = (ring + 0.5) / rings, around = turn * (sector + 0.5) / sectors;
          const double r = std::sqrt(1 - z * z);
          const glm::dvec3 toLight(r * std::cos(around), r * std::sin(around), z);
          const double expected = fibres(toLight, toEye, spread);
          const double found =
              double(sheenReflection(glm::vec3(toLight), glm::vec3(toEye), float(spread)));
          worst = std::max(worst, std::abs(found - expected) / (1e-3 + expected));
          albedo += expected * z * turn / (rings * sectors);
        }
      const std::string name = named("fibres", float(spread)) + named(" cosine", float(cosine));
      floor.verdict.expect(worst < 1e-4, name + ": reflection", worst, 1e-4);
      const double off = std::abs(double(sheenAlbedo(float(cosine), float(spread))) - albedo);
      floor.verdict.expect(off < 0.03, name + ": albedo", off, 0.03);
    }
}

/// A lamp scatters no light.
void testEmitter(Floor &floor) {
  State rt = floor.hit({0, 0, 1});
  Emitter lamp;
  const double density = Floor::sample(lamp, rt, {0.5f, 0.5f}).density,
               value = Floor::evaluate(lamp, rt, {0, 0, 1}).value;
  floor.verdict.expect(density == 0 && value == 0, "Emitter scatters", value, 0);
}

int run() {
  Floor floor;
  const bool isDeep = std::getenv("RTSL_DEEP");
  if (isDeep) {
    floor.effort = {300'000, {24, 96}, 0.002};
    floor.cosines = {0.01, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1};
  }
  testDiffuse(floor, isDeep);
  testGlossy(floor, isDeep);
  testTransparent(floor);
  if (isDeep)
    testPrincipled(floor, {0, 0.5f, 1}, {0, 0.2f, 0.35f, 0.7f, 1});
  else
    testPrincipled(floor, {0, 1}, {0, 0.35f, 1});
  testCompound(floor);
  testFibres(floor);
  testEmitter(floor);
  std::printf("largest albedo %g, worst chi-square %g standard deviations, worst reciprocity %g\n",
              floor.verdict.largestAlbedo, floor.verdict.worstDeviation,
              floor.verdict.worstReciprocity);
  return floor.verdict.hasFailed();
}

} // namespace
} // namespace everything

int main() {
  return everything::run();
}
