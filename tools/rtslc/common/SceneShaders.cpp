//===- SceneShaders.cpp - the shaders that a scene file names -------------===//
#include "SceneShaders.h"

#include "Shaders.h"
#include "codegen/driver/sources/StandardLibrary.h"
#include "frontend/preprocessor/FileSearch.h"
#include "runtime/scene/Scene.h"
#include "scenefile/LaunchSizes.h"
#include "scenefile/LibraryNames.h"
#include "scenefile/SceneParts.h"
#include "scenefile/gltf/File.h"
#include "sema/typed/TypeProperties.h"
#include "support/AtomicFile.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

namespace rtsl::tool {

namespace {

[[noreturn]] void refuseShaders(const std::string &file, const char *command) {
  Error error(message::shadersInsteadOfScene(file, command), Place{file});
  error.note(fmt::format("a scene is a file such as {{\"rtsl\": 1, \"import\": [\"{}\"], "
                         "\"camera\": {{\"class\": ...}}, "
                         "\"objects\": [{{\"mesh\": ..., \"material\": {{\"class\": ...}}}}]}}",
                         std::filesystem::path(file).filename().string()));
  error.note(fmt::format("`rtslc check {}` checks the shaders alone", file));
  throw error;
}

} // namespace

/// Rejects passes, unless the command runs or checks them.
static scene::SceneDescription requireOneLaunch(scene::SceneDescription description,
                                                std::string_view command) {
  if (!description.passes.empty() && command != "run" && command != "check")
    throw Error(message::passesNotSupported(command), description.passes.front().place);
  return description;
}

/// The scene of library/models around a glTF file.
static scene::SceneDescription sceneOfModel(const std::string &file,
                                            const std::vector<std::string> &overrides,
                                            const std::shared_ptr<scene::KeptFiles> &kept) {
  const std::string path = '"' + std::regex_replace(file, std::regex(R"(["\\])"), R"(\$&)") + '"';
  std::vector<std::string> all{"camera.model=" + path, "objects.0.model=" + path};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return scene::readSceneFile(libraryFolder() + "/models/scene.json", all, kept);
}

scene::SceneDescription readScene(const std::string &file,
                                  const std::vector<std::string> &overrides, Messages &messages,
                                  const char *command,
                                  const std::shared_ptr<scene::KeptFiles> &kept,
                                  ErrorCollector *errors) {
  if (std::filesystem::path(file).extension() == ".rtsl")
    refuseShaders(file, command);
  if (scene::gltf::isModel(file))
    return requireOneLaunch(sceneOfModel(file, overrides, kept), command);
  if (file == "-") {
    const char *const name = "<stdin>";
    const std::string text = readFile(file);
    messages.sources.add(name, text); // messages show it
    return requireOneLaunch(scene::parseScene(text, name, overrides, kept, errors), command);
  }
  return requireOneLaunch(scene::readSceneFile(file, overrides, kept, errors), command);
}

namespace {

/// The classes of the library that the scene may name. Only the files of those that it uses are
/// read.
std::vector<std::string> classesOf(const std::vector<std::string> &libraryModules) {
  std::vector<std::string> names;
  for (const std::string &name : libraryModules)
    names.push_back(lastPart(name));
  return names;
}

/// Says which classes of the scene no file has, before any code is made.
void refuseUnknownClasses(const std::vector<scene::LocatedName> &mentions,
                          const typed::Module &module,
                          const std::vector<std::string> &libraryModules, ErrorCollector &errors) {
  std::vector<std::string> names = classesOf(libraryModules);
  for (const auto &one : module.classes)
    names.push_back(one->name);
  LibraryNames library;
  for (const scene::LocatedName &mention : mentions) {
    if (module.findClass(mention.text))
      continue;
    Error error(message::noSuchClass(mention.text), mention.place);
    if (const std::string module = library.moduleThatDefines(mention.text); !module.empty())
      error.note(fmt::format("it is in the standard library: add \"{}\" to `import`",
                             module.substr(0, module.rfind('.'))));
    else if (const std::string near = closestName(mention.text, names); !near.empty())
      error.fix(near);
    errors.add(std::move(error));
  }
}

/// The error of a name that does not exist, with the one that is closest to it.
Error unknownName(const Message &message, const scene::LocatedName &mention,
                  const std::string &name, const std::vector<std::string> &known) {
  Error error(message, mention.place);
  if (const std::string near = closestName(name, known); !near.empty())
    error.note(fmt::format("did you mean `{}`?", near));
  return error;
}

/// Says which names of `render.editable` are not classes of the scene, or not their members, which
/// are not known of classes that nothing in the scene uses.
void refuseUnknownEditable(const scene::SceneDescription &description, const typed::Module &module,
                           const std::vector<std::string> &libraryModules, ErrorCollector &errors) {
  const std::vector<std::string> ofLibrary = classesOf(libraryModules);
  for (const scene::LocatedName &name : description.editable) {
    const std::size_t dot = name.text.find('.');
    const std::string className = name.text.substr(0, dot);
    std::vector<std::string> known;
    if (!module.findClass(className)) {
      if (std::find(ofLibrary.begin(), ofLibrary.end(), className) != ofLibrary.end())
        continue;
      for (const auto &one : module.classes)
        known.push_back(one->name);
      errors.add(unknownName(message::noSuchClass(className), name, className, known));
    } else if (dot != std::string::npos) {
      const std::string member = name.text.substr(dot + 1);
      for (const typed::Class *one = module.findClass(className); one; one = one->base)
        for (const auto &own : one->members)
          known.push_back(own->name);
      if (std::find(known.begin(), known.end(), member) == known.end())
        errors.add(unknownName(message::noSuchMember(className, member), name, member, known));
    }
  }
}

scene::BufferMember findBuffer(const typed::Class *one, const std::string &name,
                               std::uint32_t colorComponents) {
  for (; one; one = one->base)
    for (const auto &member : one->members)
      if (member->name == name && member->type->is(TypeKind::Buffer))
        return {member->type->count, sizeInBytes(member->type->element, colorComponents)};
  return {};
}

} // namespace

/// Does an author's class, on its own, scatter or emit light without `shade`? Of its bases, and of
/// classes that are no materials, more would be known than is needed.
static bool mayLackShade(const ast::TranslationUnit &unit) {
  const auto lacksShade = [](const ast::ClassDecl &one) {
    const auto has = [&](const char *name) {
      return std::any_of(one.functions.begin(), one.functions.end(),
                         [&](const auto &function) { return function.name.text == name; });
    };
    return (has("BSDF") || has("emission")) && !has("shade");
  };
  return std::any_of(unit.classes.begin(), unit.classes.end(), lacksShade);
}

/// Says what the classic engine shows of classes that have no `shade` of their own.
static void warnWithoutShade(const std::vector<scene::LocatedName> &mentions,
                             const typed::Module &module, Messages &messages) {
  std::set<std::string> said;
  for (const scene::LocatedName &mention : mentions) {
    const typed::Class *const one = module.findClass(mention.text);
    const typed::Function *const shade = one ? one->findMethod("shade") : nullptr;
    if (!shade || !said.insert(mention.text).second)
      continue;
    const bool scatters = shade->owner->name == "ClassicScatterer";
    if (!scatters && shade->owner->name != "ClassicEmitter")
      continue;
    const std::string what =
        scatters ? fmt::format("what the `BSDF` of `{}` scatters of the lights, and not of the "
                               "light of other surfaces",
                               mention.text)
                 : fmt::format("what `{}` emits", mention.text);
    messages.diagnostics.report(Code::noShade, messages.rangeOf(mention.place), mention.text, what)
        .note("the engine `path` shows all of its light");
  }
}

/// What the engines `path` and `volume` do not know of a class that scatters light.
struct UnknownMethod {
  const typed::Class *engine; // the default class that runs the author's
  const char *method;         // that is missing
  const char *consequence;
  const typed::Function *unused = nullptr; // a method of a derived class, which does not count
  bool isDrawn = false;                    // the engine draws directions itself
};

static std::optional<UnknownMethod> methodUnknown(const typed::Class &one) {
  const auto authors = [&](const char *name) -> const typed::Function * {
    const typed::Function *const method = one.findMethod(name);
    return method && method->owner->name != "PathSurface" ? method : nullptr;
  };
  if (const typed::Function *const sample = one.findMethod("pathSample")) {
    const typed::Class *const engine = sample->owner;
    if (engine->name == "PathUnsampled" || engine->name == "VolumeUnsampled")
      return UnknownMethod{engine, "sampleBSDF", "draws directions without knowledge of its `BSDF`",
                           authors("sampleBSDF"), true};
    if (authors("BSDF") && !authors("evaluatePDF"))
      return UnknownMethod{engine, "evaluatePDF", "finds surfaces that shine by chance alone"};
    return std::nullopt;
  }
  const typed::Function *const before = one.findMethod("pathEndsBefore");
  const typed::Function *const unused = authors("BSDF") ? authors("BSDF") : authors("sampleBSDF");
  if (!before || !unused)
    return std::nullopt;
  const typed::Class *const engine = before->owner;
  const bool isShaded = engine->name == "PathShaded" || engine->name == "VolumeShaded";
  return UnknownMethod{
      engine, unused->name == "BSDF" ? "BSDF" : "sampleBSDF",
      isShaded ? "shows only the color that `shade` gives it" : "shows only what it emits", unused};
}

/// Names the classes that scatter light, of which the engines `path` and `volume` know less than
/// they could use.
static void warnWithoutSampling(const std::vector<scene::LocatedName> &mentions,
                                const typed::Module &module, Messages &messages) {
  std::set<std::string> said;
  for (const scene::LocatedName &mention : mentions) {
    const typed::Class *const one = module.findClass(mention.text);
    const std::optional<UnknownMethod> unknown = one ? methodUnknown(*one) : std::nullopt;
    if (!unknown || !said.insert(mention.text).second)
      continue;
    const auto &[engine, method, consequence, unused, isDrawn] = *unknown;
    const typed::Class *deciding = one; // which methods the engine runs
    while (unused && deciding->base != engine)
      deciding = deciding->base;
    Diagnostic &warning = messages.diagnostics.report(
        Code::noSampling, messages.rangeOf(mention.place), deciding->name, method,
        engine->name.rfind("Path", 0) == 0 ? "path" : "volume", consequence);
    if (unused)
      warning.note(fmt::format("that of `{}` does not count: which methods the engine uses is "
                               "decided by the class that derives from rt_Material itself",
                               unused->owner->name));
    else
      warning.note(isDrawn ? "with it and `evaluatePDF` the picture has less noise"
                           : "with it the picture has less noise");
    if (isDrawn && one->findMethod("isTransmissive")->owner->name == "PathSurface")
      warning.note("half of the directions are behind the surface; with `bool isTransmissive() { "
                   "return false; }` none is");
  }
}

/// Does an import make a class of the library available, such as `std.backgrounds.UniformSky`?
static bool offers(const std::string &module, const std::string &part) {
  return part == module || part.rfind(module + ".", 0) == 0;
}

/// Classes of the author's that have names of the library, whose modules neither the author's files
/// nor the scene imports.
static std::vector<std::string> namesTaken(Shaders &shaders,
                                           const scene::SceneDescription &description) {
  std::set<std::string> ours, imported;
  for (const scene::ImportDescription &import : description.imports)
    if (import.isOfScene && import.path.empty())
      imported.insert(import.name.text);
  for (const ast::TranslationUnit *unit : shaders.authorsUnits()) {
    for (const ast::ClassDecl &one : unit->classes)
      ours.insert(one.name.text);
    for (const ast::ImportDecl &import : unit->imports)
      if (!import.isFile)
        imported.insert(import.path);
  }
  std::vector<std::string> taken;
  for (const std::string &part : findModule("std").parts)
    if (ours.count(lastPart(part)) &&
        std::none_of(imported.begin(), imported.end(),
                     [&](const std::string &module) { return offers(module, part); }))
      taken.push_back(lastPart(part));
  return taken;
}

/// Gives classes of the library that stand for parts of the scene other names where the author's
/// have theirs.
static void renameLibraryClasses(scene::SceneDescription &description, Shaders &shaders,
                                 std::vector<std::string> alreadyTaken) {
  if (std::all_of(description.imports.begin(), description.imports.end(),
                  [](const scene::ImportDescription &import) { return import.isOfScene; }))
    return;
  std::vector<std::string> taken = namesTaken(shaders, description);
  shaders.renameInLibrary(taken);
  taken.insert(taken.end(), alreadyTaken.begin(), alreadyTaken.end());
  std::map<std::string, std::string> names;
  for (const std::string &name : taken)
    names[name] = SourceLoader::renamed(name);
  scene::renameLibraryClasses(description, names);
}

std::unique_ptr<typed::Module>
loadShaders(scene::SceneDescription &description, const CommonOptions &options, Messages &messages,
            std::vector<std::string> *filesRead, const std::vector<std::string> &takenNames,
            const std::vector<scene::LocatedName> &otherMentions, ErrorCollector *errors) {
  PreprocessorOptions preprocessor = options.preprocessor;
  preprocessor.includeFolders.push_back(folderOf(description.file));
  Shaders shaders(messages, preprocessor);
  shaders.renameInLibrary(takenNames);
  for (const scene::ImportDescription &import : description.imports)
    if (!import.path.empty())
      shaders.add(import.path, messages.rangeOf(import.name.place));
  renameLibraryClasses(description, shaders, takenNames);
  std::vector<scene::LocatedName> mentions = scene::classMentions(description);
  mentions.insert(mentions.end(), otherMentions.begin(), otherMentions.end());
  for (const scene::LocatedName &mention : mentions)
    shaders.mention(mention.text);
  // What is used of a module is known when all files have been read.
  for (const scene::ImportDescription &import : description.imports)
    if (import.path.empty())
      shaders.addModule(import.name.text, messages.rangeOf(import.name.place));
  if (description.render.engine == runtime::Engine::Classic) {
    const std::vector<const ast::TranslationUnit *> units = shaders.authorsUnits();
    if (std::any_of(units.begin(), units.end(),
                    [](const auto *unit) { return mayLackShade(*unit); }))
      shaders.addModule("std.engines.ClassicScatterer", {});
  }
  std::unique_ptr<typed::Module> module = shaders.check(options.compile);
  if (messages.diagnostics.hasErrors())
    return nullptr;
  ErrorCollector unknown;
  if (!description.refused.isAny) { // its imports may be missing
    refuseUnknownClasses(mentions, *module, shaders.modules(), unknown);
    refuseUnknownEditable(description, *module, shaders.modules(), unknown);
  }
  for (const scene::LocatedName &mention : mentions)
    if (!module->findClass(mention.text))
      description.refused.classes.insert(mention.text);
  if (errors)
    errors->attempt([&] { unknown.throwIfAny(); });
  else
    unknown.throwIfAny();
  warnWithoutShade(mentions, *module, messages);
  warnWithoutSampling(mentions, *module, messages);
  scene::setLaunchSizes(description, [&](const std::string &className, const std::string &member) {
    return findBuffer(module->findClass(className), member, options.compile.colorComponents);
  });
  if (filesRead) {
    *filesRead = {description.file};
    const std::vector<std::string> &files = shaders.filesRead();
    filesRead->insert(filesRead->end(), files.begin(), files.end());
  }
  return module;
}

std::vector<std::string> withFiles(const scene::SceneDescription &description,
                                   std::vector<std::string> filesRead) {
  for (const std::string &file : scene::filesOf(description))
    if (std::find(filesRead.begin(), filesRead.end(), file) == filesRead.end())
      filesRead.push_back(file);
  return filesRead;
}

LinkRequest linkRequest(const scene::SceneDescription &description) {
  LinkRequest request;
  request.classes = scene::classesUsed(description);
  for (const scene::LocatedName &mention : scene::classMentions(description))
    request.places.try_emplace(mention.text, ir::SourcePlace{mention.place.file, mention.place.line,
                                                             mention.place.column});
  for (scene::Part &part : scene::partsOf(description))
    request.parts.push_back({static_cast<ScenePart::Role>(part.role),
                             std::move(part.name),
                             std::move(part.classes),
                             std::move(part.refersTo),
                             {part.place.file, part.place.line, part.place.column}});
  request.givenMembers = scene::givenMembers(description);
  request.referredClasses = scene::referredClasses(description);
  for (const scene::LocatedName &name : description.editable)
    request.editable.insert(name.text);
  request.engine = description.render.engine;
  if (description.sampler)
    request.features |= featuresOf(*description.sampler);
  if (description.exception)
    request.features |= RTSL_FEATURE_EXCEPTIONS;
  request.hasCounts = false;
  for (const scene::GeometryDescription &geometry : description.objects) {
    request.hasCounts |= geometry.count != nullptr;
    const scene::ObjectDescription *material = geometry.material.object.get();
    if (!material)
      if (auto named = description.materials.find(geometry.material.name.text);
          named != description.materials.end())
        material = &named->second;
    if (material && geometry.hasShape)
      request.surfaces.push_back(
          {geometry.primitive ? geometry.primitive->className.text : std::string(),
           material->className.text});
  }
  return request;
}

} // namespace rtsl::tool
