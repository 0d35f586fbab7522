//===- Main.cpp - examples/glass by hand ----------------------------------===//
//
// The program that rtslc is measured against: the picture of examples/glass/scene.json, with the
// scene and its shaders written in C++ on the same Embree.
//
//===----------------------------------------------------------------------===//
#include "Program.h"
#include "Radiance.h"
#include "Scene.h"

#include "runtime/geometry/Mesh.h"

#include <memory>

using namespace handwritten;
namespace runtime = rtsl::runtime;

int main(int argc, char **argv) {
  const Description description = {"bench-handwritten", "renders examples/glass, written by hand",
                                   "knot.obj of examples/glass", compilerFlags()};
  return runProgram(
      description, argc, argv,
      [](const std::vector<std::string> &files) {
        runtime::Mesh knot = runtime::loadMesh(files[0]);
        knot.apply(runtime::Transform::translate(1.5, 1.15, -0.7));
        return knot;
      },
      [](runtime::Mesh knot) { return std::make_unique<Scene>(std::move(knot)); }, sample);
}
