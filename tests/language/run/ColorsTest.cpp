//===- ColorsTest.cpp - the same shaders with 1, 3, 4 and 16 components ---===//
//
// examples/glass as RGB, as luminance alone and as spectra. docs/language.md states the bounds:
// products of spectra are not products of RGB triples, so the pictures agree nearly, and not
// exactly.
//
//===----------------------------------------------------------------------===//
#include "codegen/driver/Compiler.h"
#include "codegen/driver/sources/SourceLoader.h"
#include "language/ColorBasis.h"
#include "runtime/render/Renderer.h"
#include "scenefile/SceneFile.h"
#include "sema/Sema.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rtsl::test {
namespace {

runtime::Image renderGlass(std::uint32_t components) {
  const scene::SceneDescription description =
      scene::readSceneFile(RTSL_ROOT "/examples/glass/scene.json");
  SourceManager sources;
  Diagnostics diagnostics(sources);
  SourceLoader loader(sources, diagnostics);
  std::vector<const ast::TranslationUnit *> units;
  for (const scene::ImportDescription &import : description.imports)
    units.push_back(loader.load(import.path));
  const auto module = check(
      units,
      [&](const ast::ImportDecl &import, FileId importer) {
        return loader.resolve(import, importer);
      },
      diagnostics);
  LinkRequest request;
  request.classes = scene::classesUsed(description);
  for (const scene::GeometryDescription &geometry : description.objects)
    request.surfaces.push_back(
        {geometry.primitive ? geometry.primitive->className.text : std::string(),
         description.materials.at(geometry.material.name.text).className.text});
  CompileOptions compile;
  compile.colorComponents = components;
  const auto program = compileProgram(*module, request, compile, diagnostics);
  EXPECT_FALSE(diagnostics.hasErrors()) << renderText(diagnostics, false);
  const runtime::Scene scene = scene::buildScene(description, program);
  runtime::RenderOptions render;
  render.width = 96;
  render.height = 54;
  render.samplesPerPixel = 16;
  return runtime::render(scene, render);
}

double luminance(const float *rgb) {
  return luminanceWeights[0] * rgb[0] + luminanceWeights[1] * rgb[1] + luminanceWeights[2] * rgb[2];
}

/// How far a picture is from the RGB one, as RGB.
struct Distance {
  double rmse = 0;      // over all pixels and channels
  double luminance = 0; // of the means, relative
};

Distance distance(const runtime::Image &reference, const runtime::Image &image) {
  const runtime::Image rgb = toRgb(image);
  Distance result;
  double referenceSum = 0, sum = 0;
  for (std::size_t i = 0; i < rgb.pixels.size(); i += 3) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double difference = double(rgb.pixels[i + channel]) - reference.pixels[i + channel];
      result.rmse += difference * difference;
    }
    referenceSum += luminance(&reference.pixels[i]);
    sum += luminance(&rgb.pixels[i]);
  }
  result.rmse = std::sqrt(result.rmse / double(rgb.pixels.size()));
  result.luminance = std::abs(sum / referenceSum - 1);
  return result;
}

TEST(Colors, GlassWithOneThreeFourAndSixteenComponents) {
  const runtime::Image rgb = renderGlass(3);
  for (const std::uint32_t components : {1u, 4u, 16u}) {
    const runtime::Image image = renderGlass(components);
    ASSERT_EQ(image.channels, components);
    const Distance far = distance(rgb, image);
    RecordProperty("rmse" + std::to_string(components), std::to_string(far.rmse));
    if (components > 1) {
      EXPECT_LT(far.rmse, 1e-3) << components << " components";
    }
    EXPECT_LT(far.luminance, 5e-3) << components << " components";
    EXPECT_GT(far.rmse, 0) << "it is another computation";
  }
}

} // namespace
} // namespace rtsl::test
