//===- Program.cpp - RTSL programs that say what they should compute ------===//
#include "Program.h"

#include "codegen/driver/SceneProgram.h"
#include "frontend/syntax/Parser.h"
#include "runtime/render/HostMegakernel.h"
#include "runtime/scene/Scene.h"
#include "scenefile/SceneFile.h"
#include "sema/Sema.h"
#include "support/Error.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <regex>
#include <sstream>

namespace rtsl::test {

namespace {

/// What the camera sees, and where the functions are called. `#CASES#` are theirs.
const char *const frame = R"(
class RunCamera : rt_Camera {
  public float count;
  void generateRay() {
    rt_RayOrigin = vec3(rt_ScreenCoord.x * count, 0.5, 5.0);
    rt_RayDirection = vec3(0.0, 0.0, -2.0);
    bool begins = rt_Epsilon == 0.0 && isinf(rt_HitDistance) && rt_du == 0.0 && rt_dv == 0.0 && rt_Depth == 0;
    if (!begins) rt_RayDirection.z = -3.0; // which StateRun sees
  }
};
class RunSquare : rt_Primitive {
  public float left;
  public float width;
  void intersect() {
    float t = rt_RayOrigin.z / -rt_RayDirection.z;
    vec2 p = rt_RayOrigin.xy + t * rt_RayDirection.xy;
    if (inside(p, vec2(left, 0.0), vec2(left + width, 1.0))) hit(t);
  }
  void computeBounds() { rt_BoundMin = vec3(left, 0.0, 0.0); rt_BoundMax = vec3(left + width, 1.0, 0.0); }
  void computeNormal() { rt_GeometricNormal = vec3(0.0, 0.0, 1.0); }
};
class RunFunctions : rt_Material {
  void shade() {
    color before = trace(rt_HitPoint, vec3(0.0, 0.0, 1.0));
    int zero = int(rt_HitDistance * 0.0);
    int result = -1;
    switch (int(floor(rt_HitPoint.x))) {
#CASES#
    default: break;
    }
    color after = trace(rt_HitPoint, vec3(0.0, 0.0, 1.0));
    rt_SampleColor = color(float(result)) + before + after;
  }
};
)";

struct Test {
  std::string name; // of the function, or of the material's class
  std::string file;
};

class Builder {
public:
  Builder(const std::vector<ProgramFile> &files, const Configuration &configuration)
      : configuration(configuration) {
    for (const ProgramFile &file : files)
      read(file);
  }

  std::string run();
  std::size_t count() const { return functions.size() + materials.size(); }

private:
  void read(const ProgramFile &file);
  std::string frameText() const;
  std::string sceneText() const;
  std::optional<runtime::Scene> compile(const typed::Module &module,
                                        const scene::SceneDescription &description,
                                        Diagnostics &diagnostics) const;
  std::string judge(const runtime::Image &image) const;

  const Configuration &configuration;
  std::vector<ProgramFile> texts;
  std::vector<Test> functions, materials;
  std::vector<std::string> objects; // of the materials, with $X
  std::string helpers, textures, lights;
};

void Builder::read(const ProgramFile &file) {
  static const std::regex function("int (\\w+)\\(int zero\\) \\{.*");
  static const std::regex directive("//! (\\w+) ?(\\w*): (.*)");
  static const std::regex className("\"material\": \\{\"class\": \"(\\w+)\".*");
  texts.push_back(file);
  std::istringstream stream(file.text);
  std::smatch match;
  bool isLeftOut = false;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_match(line, match, function)) {
      if (!isLeftOut)
        functions.push_back({match[1], file.name});
      isLeftOut = false;
    } else if (line == "// unchecked: no") {
      isLeftOut |= !configuration.compile.checkIndices;
    } else if (line == "// fast: no") {
      isLeftOut |= configuration.compile.floatingPoint != FloatingPoint::Strict;
    } else if (line == "// double: no") {
      isLeftOut |= configuration.compile.floatingPoint == FloatingPoint::Double;
    } else if (std::regex_match(line, match, directive)) {
      const std::string kind = match[1], name = match[2], json = match[3];
      if (kind == "helper")
        helpers += fmt::format("{}\"{}\": {}", helpers.empty() ? "" : ", ", name, json);
      else if (kind == "texture")
        textures += fmt::format("{}\"{}\": {}", textures.empty() ? "" : ", ", name, json);
      else if (kind == "light")
        lights += (lights.empty() ? "" : ", ") + json;
      else if (kind == "material")
        objects.push_back("{\"primitive\": {\"class\": \"RunSquare\", \"left\": $X, \"width\": 1}, "
                          "\"material\": " +
                          json + "}");
      else
        objects.push_back(json);
      if (kind == "material" || kind == "object") {
        std::smatch named;
        std::regex_search(objects.back(), named, className);
        materials.push_back({named[1], file.name});
      }
    }
  }
}

std::string Builder::frameText() const {
  std::string cases;
  for (std::size_t i = 0; i != functions.size(); ++i)
    cases += fmt::format("    case {}: result = {}(zero); break;\n", i, functions[i].name);
  return std::regex_replace(frame, std::regex("#CASES#"), cases);
}

std::string Builder::sceneText() const {
  std::string all;
  if (!functions.empty())
    all = fmt::format("{{\"primitive\": {{\"class\": \"RunSquare\", \"left\": 0, \"width\": {}}}, "
                      "\"material\": {{\"class\": \"RunFunctions\"}}}}",
                      functions.size());
  for (std::size_t i = 0; i != objects.size(); ++i)
    all += (all.empty() ? "" : ",\n") +
           std::regex_replace(objects[i], std::regex("\\$X"), std::to_string(functions.size() + i));
  return fmt::format(
      "{{\"rtsl\": 1, \"import\": [], \"camera\": {{\"class\": \"RunCamera\", \"count\": {}}},\n"
      "\"helpers\": {{{}}}, \"textures\": {{{}}}, \"lights\": [{}], \"ambient\": [0.5, 0.5, 0.5], "
      "\"background\": [0, 0, 0],\n"
      "\"objects\": [{}]}}\n",
      count(), helpers, textures, lights, all);
}

/// Which material meets which primitive.
LinkRequest linkRequest(const scene::SceneDescription &description) {
  LinkRequest request;
  request.classes = scene::classesUsed(description);
  request.givenMembers = scene::givenMembers(description);
  request.referredClasses = scene::referredClasses(description);
  for (const scene::GeometryDescription &geometry : description.objects)
    request.surfaces.push_back(
        {geometry.primitive->className.text, geometry.material.object->className.text});
  return request;
}

std::string Builder::judge(const runtime::Image &image) const {
  std::string wrong;
  for (std::size_t i = 0; i != count(); ++i) {
    const Test &test = i < functions.size() ? functions[i] : materials[i - functions.size()];
    const float *pixel = image.at(static_cast<std::uint32_t>(i), 0);
    for (std::uint32_t channel = 0; channel != image.channels; ++channel)
      if (!(pixel[channel] == 0.0f)) {
        wrong += fmt::format("{}: {} says {}\n", test.file, test.name, pixel[channel]);
        break;
      }
  }
  return wrong;
}

/// Nothing if there were errors.
std::optional<runtime::Scene> Builder::compile(const typed::Module &module,
                                               const scene::SceneDescription &description,
                                               Diagnostics &diagnostics) const {
  const BuildScene build = [&](const auto &program) {
    return scene::buildScene(description, program);
  };
  const LinkRequest request = linkRequest(description);
  if (configuration.bindsScene)
    return compileScene(module, request, configuration.compile, diagnostics, build);
  const auto program = compileProgram(module, request, configuration.compile, diagnostics);
  return program ? std::optional(build(program)) : std::nullopt;
}

std::string Builder::run() {
  SourceManager sources;
  Diagnostics diagnostics(sources);
  diagnostics.warnings.apply("no-all");
  texts.push_back({"the frame", frameText()});
  std::vector<std::unique_ptr<ast::TranslationUnit>> trees;
  std::vector<const ast::TranslationUnit *> units;
  for (const ProgramFile &file : texts) {
    trees.push_back(parse(sources.add(file.name, file.text), diagnostics));
    units.push_back(trees.back().get());
  }
  const auto noImports = [](const ast::ImportDecl &, FileId) -> const ast::TranslationUnit * {
    return nullptr;
  };
  const std::unique_ptr<typed::Module> module = check(units, noImports, diagnostics);
  if (diagnostics.hasErrors())
    return renderText(diagnostics, false);

  try {
    const scene::SceneDescription description = scene::parseScene(sceneText(), "the scene");
    const std::optional<runtime::Scene> compiled = compile(*module, description, diagnostics);
    if (!compiled)
      return renderText(diagnostics, false);
    const runtime::Scene &scene = *compiled;
    runtime::RenderOptions render;
    render.width = static_cast<std::uint32_t>(count());
    render.height = 1;
    render.samplesPerPixel = 1;
    render.maxDepth = 4;
    render.threads = 1;
    render.traversal = configuration.traversal;
    if (configuration.compile.target == Target::HostMegakernel)
      return judge(
          runtime::HostMegakernel(scene.program().megakernel, runtime::flatten(scene), render)
              .render());
    return judge(runtime::render(scene, render));
  } catch (const Error &error) {
    return std::string(error.what()) + "\n";
  }
}

} // namespace

std::string runProgram(const std::vector<ProgramFile> &files, const Configuration &configuration,
                       std::size_t &count) {
  Builder builder(files, configuration);
  count = builder.count();
  return builder.run();
}

} // namespace rtsl::test
