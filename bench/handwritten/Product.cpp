//===- Product.cpp - a path tracer for a product shot, by hand ------------===//
//
// The estimator of the engine `path` for scenes as examples/product-shot/scene.json: meshes with
// normals of their own of metal and plastic under a clear coat, diffuse parallelograms, several
// lamps chosen by their power, a sky that paths find by chance, and a thin lens.
//
//===----------------------------------------------------------------------===//
#include "Gloss.h"
#include "PathSampling.h"
#include "Program.h"

#include <algorithm>
#include <memory>
#include <utility>

using namespace handwritten;

namespace {

/// The scene, and what the program computes once of it.
struct Product {
  explicit Product(PathWorld world) : scene(std::move(world)) {
    float sum = 0;
    for (const Parallelogram *lamp : scene.lamps)
      sum += power(*lamp);
    for (const Parallelogram *lamp : scene.lamps)
      chances.push_back(power(*lamp) / sum);
    for (const GlossyMesh &one : scene.world.glossy)
      materials.emplace_back(one);
  }

  static float power(const Parallelogram &lamp) {
    return lamp.area * (lamp.radiance.x + lamp.radiance.y + lamp.radiance.z);
  }
  float chanceOf(const Parallelogram &lamp) const {
    return chances[std::find(scene.lamps.begin(), scene.lamps.end(), &lamp) - scene.lamps.begin()];
  }
  /// A lamp by a number in [0, 1), which is uniform again after it.
  const Parallelogram &chooseLamp(float &u) const {
    std::size_t i = 0;
    while (i + 1 < chances.size() && u >= chances[i])
      u -= chances[i++];
    u = std::min(u / chances[i], 1.0f);
    return *scene.lamps[i];
  }

  PathScene scene;
  std::vector<float> chances; // of the lamps
  std::vector<Gloss> materials;
};

vec3 lightOf(const Sky &sky, vec3 direction) {
  const float height = direction.y,
              t = glm::clamp((height + sky.blur) / (2 * sky.blur), 0.0f, 1.0f);
  const vec3 above = glm::mix(sky.horizon, sky.zenith, std::sqrt(std::max(height, 0.0f)));
  return glm::mix(sky.ground, above, t * t * (3 - 2 * t));
}

/// The interpolated normal of a mesh's vertices.
vec3 shadingNormal(const rtsl::runtime::Mesh &mesh, const RTCHit &hit) {
  const unsigned *corners = &mesh.indices[3 * std::size_t(hit.primID)];
  const auto at = [&](int i) {
    const float *n = &mesh.normals[3 * std::size_t(corners[i])];
    return vec3(n[0], n[1], n[2]);
  };
  return glm::normalize((1 - hit.u - hit.v) * at(0) + hit.u * at(1) + hit.v * at(2));
}

/// What a path meets. `Material` has value(), density() and draw(), as Gloss does.
template <typename Material>
struct Surface {
  vec3 point;
  Frame frame;
  vec3 front; // the geometric normal, on the eye's side
  vec3 eye;   // in the frame
  const Material &material;

  /// Does light from there arrive on the side that is seen?
  bool isOnItsSide(vec3 toLight, vec3 direction) const {
    return glm::dot(direction, front) * toLight.z > 0;
  }
};

struct Diffuse {
  vec3 reflectance;

  vec3 value(vec3 light, vec3) const { return light.z > 0 ? reflectance / pi : vec3(0); }
  float density(vec3 light, vec3) const { return std::max(light.z, 0.0f) / pi; }
  vec3 draw(vec3, float u, float v) const { return sampleCosine(u, v); }
};

/// The light of a lamp, by a ray to a point of it.
template <typename Material>
vec3 searched(const Product &product, const Surface<Material> &at, Dice &dice) {
  float u = dice.next();
  const Parallelogram &lamp = product.chooseLamp(u);
  const vec3 path = lamp.anchor + u * lamp.side1 + dice.next() * lamp.side2 - at.point;
  const float squared = glm::dot(path, path), distance = std::sqrt(squared);
  const vec3 direction = path / distance, toLight = at.frame.fromWorld(direction);
  const float ofLamp = std::abs(glm::dot(lamp.normal, direction));
  if (toLight.z <= 0 || ofLamp == 0 || !at.isOnItsSide(toLight, direction))
    return vec3(0);
  const PathScene &scene = product.scene;
  if (isOccluded(scene.embree,
                 embreeRay(at.point, direction, scene.epsilon, distance - scene.epsilon)))
    return vec3(0);
  const float density = product.chanceOf(lamp) * squared / (ofLamp * lamp.area);
  return at.material.value(toLight, at.eye) * lamp.radiance *
         (toLight.z / density * share(density, at.material.density(toLight, at.eye)));
}

struct Path {
  vec3 from, direction;
  vec3 light{0}, weight{1};
  float density = 0; // of the direction; 0: of the camera's ray
};

/// Gathers the light of lamps at a surface and continues the path. False: it ends.
template <typename Material>
bool scatter(const Product &product, Path &path, const Surface<Material> &at, Dice &dice) {
  path.light += path.weight * searched(product, at, dice);
  const float u = dice.next(), v = dice.next();
  const vec3 toLight = at.material.draw(at.eye, u, v);
  if (toLight.z <= 0)
    return false;
  path.from = at.point;
  path.direction = at.frame.toWorld(toLight);
  if (!at.isOnItsSide(toLight, path.direction))
    return false;
  path.density = at.material.density(toLight, at.eye);
  path.weight *= toLight.z / path.density * at.material.value(toLight, at.eye);
  return true;
}

vec3 followPath(const Product &product, Path path, unsigned maxDepth, Dice &dice) {
  const PathScene &scene = product.scene;
  for (unsigned depth = 0;; ++depth) {
    const RTCRayHit found = findHit(scene, path.from, path.direction, depth ? scene.epsilon : 0);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID)
      return path.light + path.weight * lightOf(scene.world.sky, path.direction);
    const float t = found.ray.tfar;
    const vec3 point = path.from + t * path.direction, toEye = -path.direction;
    bool goesOn;
    if (const Parallelogram *flat = scene.parallelogram(found.hit)) {
      const float slant = glm::dot(flat->normal, path.direction);
      if (flat->isLamp()) {
        const float other = product.chanceOf(*flat) * t * t / (std::abs(slant) * flat->area);
        return path.light + path.weight * flat->radiance *
                                (path.density > 0 ? share(path.density, other) : 1.0f);
      }
      if (depth == maxDepth)
        return path.light;
      const vec3 normal = slant < 0 ? flat->normal : -flat->normal;
      const Diffuse diffuse = {flat->reflectance};
      const Frame frame(normal);
      goesOn =
          scatter(product, path,
                  Surface<Diffuse>{point, frame, normal, frame.fromWorld(toEye), diffuse}, dice);
    } else {
      if (depth == maxDepth)
        return path.light;
      const GlossyMesh &mesh = scene.glossy(found.hit);
      vec3 normal = shadingNormal(mesh.mesh, found.hit),
           front = glm::normalize(vec3(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z));
      if (glm::dot(front, normal) < 0)
        front = -front;
      if (glm::dot(front, toEye) < 0)
        front = -front, normal = -normal;
      if (const float cosine = glm::dot(normal, toEye); cosine <= 0) // bent until it is seen
        normal = glm::normalize(normal + (0.001f - cosine) * toEye);
      const Frame frame(normal);
      const Gloss &gloss = product.materials[&mesh - scene.world.glossy.data()];
      goesOn = scatter(product, path,
                       Surface<Gloss>{point, frame, front, frame.fromWorld(toEye), gloss}, dice);
    }
    if (!goesOn || endsAtRandom(path.weight, depth, dice))
      return path.light;
  }
}

/// A point of the lens's polygon, uniform by area.
vec2 lensPoint(const Lens &lens, Dice &dice) {
  const float scaled = dice.next() * float(lens.corners), side = std::floor(scaled),
              step = 2 * pi / float(lens.corners);
  const vec2 from(std::cos(side * step), std::sin(side * step)),
      to(std::cos((side + 1) * step), std::sin((side + 1) * step));
  return lens.radius * std::sqrt(dice.next()) * glm::mix(from, to, scaled - side);
}

vec3 sample(const Product &product, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index) {
  const PathScene &scene = product.scene;
  const View &view = scene.world.view;
  PictureSample drawn = beginSample(picture, x, y, index);
  const float aspect = float(picture.width) / float(picture.height);
  const vec2 lens = lensPoint(scene.world.lens, drawn.dice) / view.slope; // `right` has the slope
  const vec3 offset = lens.x * scene.right + lens.y * scene.upward;
  const vec3 direction =
      scene.world.lens.distance *
          (scene.forward + aspect * drawn.across * scene.right + drawn.upward * scene.upward) -
      offset;
  return followPath(product, {view.eye + offset, glm::normalize(direction)}, picture.maxDepth,
                    drawn.dice);
}

} // namespace

int main(int argc, char **argv) {
  const Description description = {"bench-product", "traces paths in a product shot",
                                   "the scene (PathScene.h)", HANDWRITTEN_FLAGS};
  return runProgram(
      description, argc, argv,
      [](const std::vector<std::string> &files) { return readPathWorld(files[0]); },
      [](PathWorld world) { return std::make_unique<Product>(std::move(world)); }, sample);
}
