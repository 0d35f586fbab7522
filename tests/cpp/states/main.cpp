// Renders a row of spheres, one a material of Shapes.rtsl, without the compiler: states PICTURE.exr
#include <rtsl/runtime.h>

#include <cstdio>

using namespace rtsl::runtime;

RTSL_DECLARE_SHADERS(shapes);

template <typename Make>
static bool isIncomplete(Make make) {
  try {
    make();
    return false;
  } catch (const Error &error) {
    return error.code == ErrorCode::IncompleteScene;
  }
}

int main(int argc, char **argv) try {
  if (argc != 2)
    return std::fprintf(stderr, "usage: %s PICTURE.exr\n", argv[0]), 2;
  if (!isIncomplete([] { Scene none(rtsl::program(nullptr)); }))
    return std::fprintf(stderr, "a scene without a program is not refused\n"), 1;
  Scene scene(rtsl::program(shapes_shaders()));
  auto make = [&](const char *name, std::vector<NamedValue> members) {
    return scene.addObject(name, ObjectValues{{}, std::move(members), {}});
  };
  scene.setCamera(scene.addObject(
      "PinholeCamera", {{0, 2, 9}, {0, 1, 0}, {0, -0.12, -1}, {-1.6, -0.9}, {1.6, 0.9}, 2.7}));
  RtslRef checks =
      make("Checker", {{"scale", 8}, {"even", {0.85, 0.83, 0.78}}, {"odd", {0.12, 0.14, 0.2}}});
  RtslRef floor = scene.addObject("Parallelogram", {{-8, 0, 6}, {16, 0, 0}, {0, 0, -16}});
  scene.addPrimitive(floor, make("Glossy", {{"albedo", Value::reference(checks)}}));
  int i = 0;
  for (const char *name :
       {"Many",      "Nested",    "Middle",   "Choices",   "Endless", "Mirror",
        "Base",      "Derived",   "Table",    "Bundle",    "Turned",  "Outputs",
        "Component", "Lit",       "Tangled",  "Loud",      "Quiet",   "Columns",
        "Flags",     "Scattered", "Replaced", "Arms",      "Late",    "Polished",
        "Matte",     "Lacquered", "Chalk",    "Varnished", "Worn",    "Waxed",
        "Rounded",   "Patterned", "Enamel",   "Glazed",    "Frosted", "Stained"}) {
    const double x = -4.5 + i % 10, y = 0.7 + 1.3 * (i / 10);
    scene.addPrimitive(make("Sphere", {{"center", {x, y, 0}}, {"radius", 0.7}}), make(name, {}));
    ++i;
  }
  scene.addLight(
      make("BallLight", {{"position", {4, 6, 4}}, {"radius", 0.4}, {"intensity", {38, 36, 33}}}));
  scene.addLight(
      make("BallLight", {{"position", {-5, 5, 3}}, {"radius", 0.2}, {"intensity", {18, 20, 25}}}));
  scene.setAmbient({0.12f, 0.13f, 0.16f});
  scene.setBackground(make("Sky", {}));
  RenderOptions options;
  options.width = 96;
  options.height = 54;
  options.samplesPerPixel = 2;
  options.maxDepth = 4;
  writeImage(argv[1], render(scene, options));
} catch (const Error &error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
