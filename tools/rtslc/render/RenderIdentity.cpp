#include "RenderIdentity.h"

#include "runtime/render/Crc64.h"
#include "scenefile/json/JsonText.h"
#include "support/AtomicFile.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>

namespace rtsl::tool {

namespace {

using runtime::Dependence;

Dependence content(std::string what, std::string_view bytes) {
  return {std::move(what), fmt::format("{:016x}", runtime::crc64(bytes)), true};
}

/// The scene without what the render options say, and without the number of samples.
std::string sceneText(const scene::SceneDescription &description) {
  scene::JsonValue root = *description.root;
  const auto remove = [](scene::JsonValue &from, std::initializer_list<std::string_view> keys) {
    auto &members = from.members;
    members.erase(std::remove_if(members.begin(), members.end(),
                                 [&](const auto &member) {
                                   return std::find(keys.begin(), keys.end(), member.first.text) !=
                                          keys.end();
                                 }),
                  members.end());
  };
  remove(root, {"frame", "camera", "cameras"});
  if (scene::JsonValue *render = root.find("render"))
    remove(*render, {"size", "spp", "depth", "seed"});
  return scene::jsonText(root);
}

/// "the scene", and which frame of it.
std::string sceneName(const scene::JsonValue &root) {
  const scene::JsonValue *frame = root.find("frame");
  return frame ? fmt::format("the scene at frame {}", frame->number) : "the scene";
}

/// The camera that was chosen, wherever it is described.
std::string cameraText(const scene::JsonValue &root) {
  const scene::JsonValue *camera = root.find("camera"), *cameras = root.find("cameras");
  const bool isNamed = camera && camera->kind == scene::JsonValue::Kind::String;
  if (cameras && isNamed)
    camera = cameras->find(camera->string);
  else if (!camera && cameras && !cameras->members.empty())
    camera = &cameras->members.front().second;
  return camera ? scene::jsonText(*camera) : "";
}

void addFiles(const RenderInput &input, std::vector<Dependence> &to) {
  const scene::JsonValue &root = *input.description.root;
  to.push_back(content(sceneName(root), sceneText(input.description)));
  to.push_back(content("the camera", cameraText(root)));
  for (std::size_t i = 1; i < input.files.size(); ++i) {
    const std::string &file = input.files[i];
    const std::string name = fmt::format("`{}`", std::filesystem::path(file).filename().string());
    const FileId source = input.sources.find(file);
    to.push_back(source ? content(name, input.sources.text(source))
                        : content(name, readFile(file)));
  }
}

std::string macroText(const PreprocessorOptions &options) {
  std::string text;
  for (const MacroOption &macro : options.macros)
    text += fmt::format("{}{}", text.empty() ? "" : " ",
                        macro.isUndefined ? "no " + macro.name : macro.name + "=" + macro.value);
  return text.empty() ? "nothing" : text;
}

const char *nameOf(FloatingPoint kind) {
  return kind == FloatingPoint::Strict ? "strict" : kind == FloatingPoint::Fast ? "fast" : "double";
}

const char *nameOf(TargetName target) {
  return target == TargetName::Host  ? "host"
         : target == TargetName::Gpu ? "gpu"
                                     : "host-megakernel";
}

std::string yesOrNo(bool is) {
  return is ? "on" : "off";
}

} // namespace

runtime::Identity identityOf(const RenderInput &input) {
  runtime::Identity identity{"rtslc " RTSL_VERSION, {}};
  std::vector<Dependence> &all = identity.dependences;
  const CompileOptions &compile = input.options.compile;
  const runtime::RenderOptions &render = input.render;
  all.push_back({"the size",
                 fmt::format("{}x{}{}", render.width, render.height,
                             render.slices > 1 ? fmt::format(", {} slices", render.slices) : "")});
  const runtime::Window window = windowOf(render);
  all.push_back(
      {"the crop", fmt::format("{},{},{},{}", window.x0, window.y0, window.x1, window.y1)});
  all.push_back({"the seed", fmt::format("{}", render.seed)});
  all.push_back({"the depth", fmt::format("{}", render.maxDepth)});
  all.push_back(
      {"the number of components of a color", fmt::format("{}", compile.colorComponents)});
  all.push_back({"`--fp`", nameOf(compile.floatingPoint)});
  const std::uint32_t sampler = compile.sampler.value_or(
      featuresOf(input.description.sampler.value_or(runtime::Sampler::Independent)));
  for (const auto &[name, choice] : runtime::samplerNames)
    if (featuresOf(choice) == sampler)
      all.push_back({"the sampler", name});
  all.push_back({"`--adaptive`", yesOrNo(render.isAdaptive)});
  if (render.isAdaptive)
    all.push_back({"`--noise`", fmt::format("{}", input.noise)});
  all.push_back({"`--exceptions`", yesOrNo(input.raisesExceptions)});
  all.push_back({"the check of indices", yesOrNo(compile.checkIndices)});
  all.push_back({"what `-D` and `-U` define", macroText(input.options.preprocessor)});
  if (compile.floatingPoint == FloatingPoint::Fast) {
    all.push_back({"`--target`", nameOf(input.target)});
    all.push_back(
        {"`--traversal`", render.traversal == runtime::Traversal::Embree ? "embree" : "device"});
    all.push_back({"`--trace`", compile.trace == TraceMode::Split ? "split" : "recurse"});
    all.push_back({"`-O`", fmt::format("{}", compile.optimization)});
  }
  addFiles(input, all);
  return identity;
}

} // namespace rtsl::tool
