// Renders a scene of the shaders in examples/glass, which were compiled to C++ ahead: no compiler
// is needed to run this.
#include <rtsl/runtime.h>

#include <cstdio>
#include <cstdlib>

using namespace rtsl::runtime;

RTSL_DECLARE_SHADERS(glass); // glass.cpp: rtslc compile *.rtsl --emit=cpp -o glass.cpp

int main(int argc, char **argv) try {
  if (argc != 3 && argc != 5)
    return std::fprintf(stderr, "usage: %s KNOT.obj PICTURE.png [WIDTH SAMPLES]\n", argv[0]), 2;
  Scene scene(rtsl::program(glass_shaders()));
  auto construct = [&](const char *name, std::vector<Value> arguments) {
    return scene.addObject(name, std::move(arguments));
  };
  auto make = [&](const char *name, std::vector<NamedValue> members) {
    return scene.addObject(name, ObjectValues{{}, std::move(members), {}});
  };
  auto lambert = [&](RtslRef texture) {
    return make("Lambert", {{"albedo", Value::reference(texture)}});
  };

  scene.setCamera(construct(
      "PinholeCamera", {{0, 2.2, 7.5}, {0, 1, 0}, {0, -0.19, -1}, {-1.6, -0.9}, {1.6, 0.9}, 2.7}));
  RtslRef checks =
      make("Checker", {{"scale", 8}, {"even", {0.85, 0.83, 0.78}}, {"odd", {0.12, 0.14, 0.2}}});
  RtslRef floor = construct("Parallelogram", {{-8, 0, 6}, {16, 0, 0}, {0, 0, -16}});
  scene.addPrimitive(floor, lambert(checks));
  scene.addPrimitive(make("Sphere", {{"center", {-1.1, 1, 0.6}}}),
                     construct("Glass", {1.5, 1.0, {0.85, 0.97, 0.9}}));
  scene.addPrimitive(make("Sphere", {{"center", {0.55, 0.45, 2}}, {"radius", 0.45}}),
                     lambert(make("Solid", {{"value", {0.75, 0.75, 0.7}}})));
  Mesh knot = loadMesh(argv[1]);
  knot.apply(Transform::translate(1.5, 1.15, -0.7));
  scene.addMeshInstance(scene.addMesh(std::move(knot)),
                        lambert(make("Solid", {{"value", {0.8, 0.35, 0.2}}})));

  scene.addLight(
      make("BallLight", {{"position", {4, 6, 4}}, {"radius", 0.4}, {"intensity", {38, 36, 33}}}));
  scene.addLight(
      make("BallLight", {{"position", {-5, 4, 2}}, {"radius", 0.4}, {"intensity", {6, 7, 9}}}));
  scene.setAmbient({0.12f, 0.13f, 0.16f});
  scene.setBackground(make("Sky", {}));

  RenderOptions options;
  if (argc == 5) {
    options.width = static_cast<unsigned>(std::atoi(argv[3]));
    options.height = options.width * 9 / 16;
    options.samplesPerPixel = static_cast<unsigned>(std::atoi(argv[4]));
  }
  writeImage(argv[2], render(scene, options));
} catch (const Error &error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
