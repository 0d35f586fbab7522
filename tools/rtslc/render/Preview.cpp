//===- Preview.cpp - a standard scene that shows one class ----------------===//
#include "Preview.h"

#include "codegen/driver/sources/StandardLibrary.h"
#include "support/AtomicFile.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"
#include "tools/rtslc/common/Shaders.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

namespace fs = std::filesystem;

namespace rtsl::tool {

namespace {

using Json = nlohmann::ordered_json;

/// How classes of an rt_ class are shown.
struct Kind {
  const char *root;
  const char *what;                  // for messages
  const char *file;                  // of library/preview
  const char *path;                  // of the object in it, as for --set; SHOWN stands for its name
  std::vector<const char *> methods; // that the class must have; of a material, one of them
};
const Kind kinds[] = {
    {"rt_Material",
     "a material",
     "material",
     "materials.SHOWN",
     {"shade", "sampleBSDF", "BSDF", "emission"}},
    {"rt_Texture", "a texture", "texture", "textures.SHOWN", {"lookup"}},
    {"rt_Primitive",
     "a primitive",
     "primitive",
     "objects.1.primitive",
     {"intersect", "computeBounds"}},
    {"rt_Light", "a light", "light", "lights.0", {"illumination"}},
    {"rt_Camera", "a camera", "camera", "camera", {"generateRay"}},
    {"rt_Miss", "a background", "background", "background", {"miss"}},
    {"rt_RayGeneration", "a ray generation", "rayGeneration", "rayGeneration", {"generate"}},
};
const char *const shown = "SHOWN"; // the name of the object in the files, where it has one

/// Objects of the library for references that must be set, and the classes that these may be to.
struct StandIn {
  const char *className;
  std::vector<const char *> bases;
};
const StandIn standIns[] = {{"Checker", {"rt_Texture", "Pattern", "Checker"}},
                            {"Lambert", {"rt_Material", "Scatterer", "Lambert"}}};

const Kind *kindOf(const typed::Class &one) {
  const auto found = std::find_if(std::begin(kinds), std::end(kinds),
                                  [&](const Kind &kind) { return one.root == kind.root; });
  return found == std::end(kinds) ? nullptr : found;
}

/// Methods for rays with a payload do not count: no class of the scene sends such rays.
bool hasMethod(const typed::Class &one, const char *name) {
  for (const typed::Class *at = &one; at; at = at->base)
    for (const auto &function : at->functions)
      if (function->name == name && function->isStateMethod && function->parameters.empty())
        return true;
  return false;
}

/// Why a class cannot be shown; empty if it can.
std::string whyNot(const typed::Class &one) {
  const Kind *kind = kindOf(one);
  if (!kind)
    return fmt::format("is a{} `{}`, of which there is no picture",
                       one.root == typed::helperRoot ? "" : "n", one.root);
  const bool isMaterial = one.root == "rt_Material";
  std::vector<std::string> missing;
  for (const char *method : kind->methods)
    if (!hasMethod(one, method))
      missing.push_back(fmt::format("`{}`", method));
  if (missing.size() < kind->methods.size() && (isMaterial || missing.empty()))
    return {};
  const bool mayHavePayload = isMaterial || one.root == "rt_Miss";
  return fmt::format("is {} without {}{}", kind->what,
                     fmt::join(missing, isMaterial ? ", " : " and "),
                     mayHavePayload ? ": the standard scene sends no rays with a payload" : "");
}

const typed::Function *constructorOf(const typed::Class &one) {
  for (const typed::Class *at = &one; at; at = at->base)
    for (const auto &function : at->functions)
      if (function->isConstructor)
        return function.get();
  return nullptr;
}

/// A value of a type, to show how it is written. Vectors are the axes in turn: `axis` is the next.
Json exampleOf(const Type *type, std::uint32_t &axis) {
  switch (type->kind) {
  case TypeKind::Bool:
    return true;
  case TypeKind::Int:
  case TypeKind::UInt:
  case TypeKind::Float:
    return 1;
  case TypeKind::Color:
    return {1, 1, 1};
  case TypeKind::Vector: {
    std::vector<int> components(type->count, 0);
    components[axis++ % type->count] = 1;
    return components;
  }
  case TypeKind::Class:
    return {{"class", toString(type)}};
  default:
    return "...";
  }
}

class PreviewMaker {
public:
  PreviewMaker(const PreviewRequest &request, const CommonOptions &options, Messages &messages)
      : request(request), options(options), messages(messages),
        own(messages, options.preprocessor) {}

  std::optional<Preview> make() {
    if (!checkFile())
      return std::nullopt;
    const typed::Class *one = chooseClass();
    if (!one)
      return std::nullopt;
    beingMade.insert(one);
    const Kind &kind = *kindOf(*one);
    path = kind.path;
    if (const std::size_t at = path.find(shown); at != std::string::npos)
      path.replace(at, std::string(shown).size(), one->name);

    Preview preview;
    preview.file = fmt::format("{}/preview/{}.json", libraryFolder(), kind.file);
    Json scene = Json::parse(readFile(preview.file));
    preview.takenNames = takenNames(scene);
    renameLibrary(scene, preview.takenNames);
    scene["import"].push_back(request.file);
    const std::optional<Json> object = objectOf(*one, &scene[pointerTo(kind)]);
    if (!object)
      return std::nullopt;
    place(scene, kind, one->name, *object);
    if (one->root == "rt_Material" && !hasMethod(*one, "shade"))
      scene["render"]["engine"] = "path";

    const std::string name = fmt::format("<scene of {}>", one->name);
    const std::string text = scene.dump(2) + "\n";
    messages.sources.add(name, text); // messages show it
    preview.description = scene::parseScene(text, name, overridesFor(one->name));
    return preview;
  }

private:
  /// Checks shaders without warnings: these are left to the check of the whole scene.
  std::unique_ptr<typed::Module> checkQuietly(Shaders &shaders) {
    const WarningOptions wanted = messages.diagnostics.warnings;
    messages.diagnostics.warnings = {};
    messages.diagnostics.warnings.apply("no-all");
    std::unique_ptr<typed::Module> checked = shaders.check(options.compile);
    messages.diagnostics.warnings = wanted;
    return checked;
  }

  /// Checks the author's files alone.
  bool checkFile() {
    own.add(request.file);
    module = checkQuietly(own);
    return !messages.diagnostics.hasErrors();
  }

  bool isOfLibrary(SourceRange range) const {
    return isLibraryFile(messages.sources.name(range.file));
  }

  /// The class to show. Null, and reported, if there is none.
  const typed::Class *chooseClass() {
    std::vector<const typed::Class *> classes; // of the file itself, in its order
    for (const ast::ClassDecl &declaration : own.units().front()->classes)
      if (!declaration.defaultRange.isValid()) // which has no objects
        classes.push_back(module->findClass(declaration.name.text));
    if (!request.className.empty())
      return chooseNamed(classes);
    const auto last = std::find_if(classes.rbegin(), classes.rend(),
                                   [](const auto *one) { return whyNot(*one).empty(); });
    if (last != classes.rend())
      return *last;
    Diagnostic &diagnostic = messages.diagnostics.report(Code::nothingToShow, {}, request.file);
    for (const typed::Class *one : classes)
      diagnostic.note(fmt::format("`{}` {}", one->name, whyNot(*one)));
    if (classes.empty())
      diagnostic.note("it declares no class");
    diagnostic.note(sceneHint());
    return nullptr;
  }

  const typed::Class *chooseNamed(const std::vector<const typed::Class *> &classes) {
    std::vector<std::string> names;
    for (const typed::Class *one : classes) {
      names.push_back(one->name);
      if (one->name != request.className)
        continue;
      const std::string why = whyNot(*one);
      if (why.empty())
        return one;
      messages.diagnostics.report(Code::cannotShowClass, one->range, one->name, why)
          .note(sceneHint());
      return nullptr;
    }
    Diagnostic &diagnostic =
        messages.diagnostics.report(Code::noSuchClass, {}, request.file, request.className);
    if (const std::string near = closestName(request.className, names); !near.empty())
      diagnostic.note(fmt::format("did you mean `{}`?", near));
    if (!names.empty())
      diagnostic.note(fmt::format("it has `{}`", fmt::join(names, "`, `")));
    return nullptr;
  }

  std::string sceneHint() const {
    return fmt::format("`rtslc new scene NAME` writes a scene file, which can import `{}`",
                       request.file);
  }

  /// What a scene has in place of an object of a class: its class, and objects for references that
  /// must be set. Nothing, and reported, if it needs more. `standIn` is the object that it
  /// replaces; null for objects that others refer to, which overrides do not concern.
  std::optional<Json> objectOf(const typed::Class &one, const Json *standIn) {
    Json object = {{"class", one.name}};
    const typed::Function *constructor = constructorOf(one);
    if (constructor && !constructor->parameters.empty() &&
        !(standIn && isSet(one.name, "constructor"))) {
      if (!standIn || !takesArguments(*constructor, standIn->value("constructor", Json()))) {
        reportConstructor(one, *constructor);
        return std::nullopt;
      }
      object["constructor"] = (*standIn)["constructor"];
    }
    for (const typed::Class *base = &one; base; base = base->base)
      for (const auto &member : base->members) {
        if (member->access != ast::Access::Public || member->isOptional || member->init ||
            (standIn && isSet(one.name, member->name)))
          continue;
        const bool isReference = member->type->is(TypeKind::Class);
        if (member->type->is(TypeKind::Buffer) || (!isReference && constructor))
          continue;
        const std::optional<Json> value = valueOf(member->type, *member, one);
        if (!value)
          return std::nullopt;
        object[member->name] = *value;
        if (!isReference)
          warnOfNumber(one, *member);
      }
    return object;
  }

  void warnOfNumber(const typed::Class &one, const typed::Member &member) {
    messages.diagnostics.reportText(
        Code::sceneWarning, member.range,
        message::previewMemberValue(member.name, one.name, numberText(numberFor(member))));
  }

  /// 0, or another number in the member's range.
  static double numberFor(const typed::Member &member) {
    if (!member.values || member.values->contains(0))
      return 0;
    const Range &range = *member.values;
    const Type *scalar = member.type->scalar();
    const bool isWhole = scalar && !scalar->is(TypeKind::Float);
    return range.includesLow                   ? range.low
           : range.includesHigh                ? range.high
           : std::isinf(range.low)             ? range.high - 1
           : std::isinf(range.high) || isWhole ? range.low + 1
                                               : (range.low + range.high) / 2;
  }

  /// Numbers, and objects for references. Nothing, and reported, if there is none of these.
  std::optional<Json> valueOf(const Type *type, const typed::Member &member,
                              const typed::Class &owner) {
    std::vector<const Type *> parts;
    switch (type->kind) {
    case TypeKind::Class:
      return referenceTo(type, member, owner);
    case TypeKind::Bool:
      return false;
    case TypeKind::Vector:
    case TypeKind::Matrix:
    case TypeKind::Array:
      parts.assign(type->count, type->element);
      break;
    case TypeKind::Struct:
      for (const typed::Field &field : type->structure->fields)
        parts.push_back(field.type);
      break;
    default:
      return numberFor(member);
    }
    Json values = Json::array();
    for (const Type *part : parts) {
      const std::optional<Json> value = valueOf(part, member, owner);
      if (!value)
        return std::nullopt;
      values.push_back(*value);
    }
    return values;
  }

  /// Whether a constructor has the parameters that `arguments` are for, by name: cameras of the
  /// author's may derive from one of the library.
  static bool takesArguments(const typed::Function &constructor, const Json &arguments) {
    return arguments.is_object() && arguments.size() == constructor.parameters.size() &&
           std::all_of(constructor.parameters.begin(), constructor.parameters.end(),
                       [&](const auto &parameter) { return arguments.contains(parameter->name); });
  }

  /// Whether an override sets a member of the object that is shown.
  bool isSet(const std::string &className, const std::string &member) const {
    return std::any_of(
        request.overrides.begin(), request.overrides.end(), [&](const std::string &text) {
          for (const std::string &start : {className, path})
            if (text.rfind(start + "." + member + "=", 0) == 0 || text.rfind(start + "=", 0) == 0)
              return true;
          return false;
        });
  }

  void reportConstructor(const typed::Class &one, const typed::Function &constructor) {
    Json values = Json::object();
    std::uint32_t axis = 0;
    std::vector<std::string> parameters;
    for (const auto &parameter : constructor.parameters) {
      values[parameter->name] = exampleOf(parameter->type, axis);
      parameters.push_back(fmt::format("{} {}", toString(parameter->type), parameter->name));
    }
    messages
        .report(message::previewNeedsArguments(one.name, fmt::join(parameters, ", ")),
                constructor.range)
        .note(fmt::format("`--set {}.constructor='{}'` gives them, with other numbers", one.name,
                          values.dump()))
        .note(sceneHint());
  }

  /// An object for a member: of the library, or of the last class of the author's that fits.
  std::optional<Json> referenceTo(const Type *type, const typed::Member &member,
                                  const typed::Class &owner) {
    const typed::Class *wanted = type->classType;
    const std::string name = wanted ? wanted->name : type->builtinClass;
    if (scene::isImageClass(name)) {
      const char *files = name == "sampler3D" ? R"({"slices": ["front.png", "back.png"]})"
                                              : R"({"file": "picture.png"})";
      messages.report(message::previewNeedsImage(owner.name, member.name), member.range)
          .note(fmt::format("`--set {}.{}='{}'` gives one", owner.name, member.name, files));
      return std::nullopt;
    }
    if (!wanted || isOfLibrary(wanted->range))
      for (const StandIn &standIn : standIns)
        if (std::find(standIn.bases.begin(), standIn.bases.end(), name) != standIn.bases.end())
          return Json{{"class", nameInScene(standIn.className)}};
    const typed::Class *found = nullptr;
    for (const auto &one : module->classes)
      if ((wanted ? one->derivesFrom(wanted) : one->root == name) && !beingMade.count(one.get()) &&
          (!kindOf(*one) || whyNot(*one).empty()))
        found = one.get();
    if (!found) {
      messages.report(message::previewNeedsObject(owner.name, member.name, name), member.range)
          .note(sceneHint());
      return std::nullopt;
    }
    beingMade.insert(found);
    std::optional<Json> object = objectOf(*found, nullptr);
    beingMade.erase(found);
    return object;
  }

  /// The name of a class of the library.
  std::string nameInScene(const std::string &name) const {
    return taken.count(name) ? SourceLoader::renamed(name) : name;
  }

  /// Names at file level in the author's files that the library has, too: those of classes, and
  /// other names in the files that the scene uses.
  std::vector<std::string> takenNames(const Json &scene) {
    std::set<std::string> ours;
    const auto add = [&](const auto &entities, std::set<std::string> &names, bool ofLibrary) {
      for (const auto &entity : entities)
        if (isOfLibrary(entity->range) == ofLibrary)
          names.insert(entity->name);
    };
    add(module->classes, ours, false);
    for (const std::string &part : findModule("std").parts)
      if (ours.count(lastPart(part)))
        taken.insert(lastPart(part));
    add(module->structs, ours, false);
    add(module->functions, ours, false);
    add(module->constants, ours, false);
    Shaders library(messages, {});
    mentionClasses(scene, library);
    for (const StandIn &standIn : standIns)
      library.mention(standIn.className);
    library.addModule("std", {});
    const std::unique_ptr<typed::Module> classes = checkQuietly(library);
    std::set<std::string> theirs;
    add(classes->structs, theirs, true);
    add(classes->functions, theirs, true);
    add(classes->constants, theirs, true);
    std::set<std::string> shared; // with files that the author imports: they are no mistake
    add(module->structs, shared, true);
    add(module->functions, shared, true);
    add(module->constants, shared, true);
    for (const std::string &name : theirs)
      if (ours.count(name) && !shared.count(name))
        taken.insert(name);
    return {taken.begin(), taken.end()};
  }

  static void mentionClasses(const Json &value, Shaders &shaders) {
    if (value.is_object() && value.contains("class"))
      shaders.mention(value["class"].get<std::string>());
    if (value.is_structured())
      for (const Json &part : value)
        mentionClasses(part, shaders);
  }

  static void renameLibrary(Json &value, const std::vector<std::string> &names) {
    if (value.is_object() && value.contains("class"))
      if (const std::string name = value["class"];
          std::find(names.begin(), names.end(), name) != names.end())
        value["class"] = SourceLoader::renamed(name);
    if (value.is_structured())
      for (Json &part : value)
        renameLibrary(part, names);
  }

  static Json::json_pointer pointerTo(const Kind &kind) {
    std::string pointer = std::string("/") + kind.path;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    return Json::json_pointer(pointer);
  }

  /// Puts the object in its place, and its name in that of SHOWN.
  void place(Json &scene, const Kind &kind, const std::string &name, const Json &object) const {
    scene[pointerTo(kind)] = object;
    nameShown(scene, name);
  }

  static void nameShown(Json &value, const std::string &name) {
    if (value.is_string() && value == shown)
      value = name;
    if (value.is_object() && value.contains(shown)) {
      Json renamed = Json::object();
      for (const auto &[key, part] : value.items())
        renamed[key == shown ? name : key] = part;
      value = renamed;
    }
    if (value.is_structured())
      for (Json &part : value)
        nameShown(part, name);
  }

  /// `Clay.tint=...` for the path of the object in the scene.
  std::vector<std::string> overridesFor(const std::string &className) const {
    std::vector<std::string> overrides = request.overrides;
    for (std::string &text : overrides)
      if (const std::size_t length = className.size();
          text.compare(0, length, className) == 0 && (text[length] == '.' || text[length] == '='))
        text.replace(0, length, path);
    return overrides;
  }

  const PreviewRequest &request;
  const CommonOptions &options;
  Messages &messages;
  Shaders own;
  std::unique_ptr<typed::Module> module; // of the author's files alone
  std::string path;                      // of the object that is shown in the scene
  std::set<std::string> taken;
  std::set<const typed::Class *> beingMade;
};

} // namespace

bool holdsShaders(const std::string &file) {
  const std::string ending = ".rtsl";
  return file.size() > ending.size() &&
         file.compare(file.size() - ending.size(), ending.size(), ending) == 0;
}

std::optional<Preview> makePreview(const PreviewRequest &request, const CommonOptions &options,
                                   Messages &messages) {
  return PreviewMaker(request, options, messages).make();
}

} // namespace rtsl::tool
