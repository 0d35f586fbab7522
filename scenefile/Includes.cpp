#include "scenefile/Includes.h"

#include "scenefile/gltf/File.h"
#include "scenefile/json/Reader.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;
using Members = std::vector<std::pair<JsonKey, JsonValue>>;

/// How a section of an included file is combined with that of the file that includes it.
enum class Meeting : std::uint8_t {
  Names,  // united; a name in both is an error
  List,   // joined
  Keys,   // united; a key in both has the value of the including file
  Single, // that of the including file
};

Meeting meetingOf(const std::string &section) {
  for (const char *names : {"cameras", "images", "buffers", "helpers", "textures", "materials",
                            "nodes", "variables", "roots"})
    if (section == names)
      return Meeting::Names;
  for (const char *list : {"import", "objects", "lights", "passes"})
    if (section == list)
      return Meeting::List;
  return section == "render" ? Meeting::Keys : Meeting::Single;
}

/// A file under whatever name.
std::string identityOf(const std::string &file) {
  std::error_code unknown;
  return std::filesystem::weakly_canonical(file, unknown).string();
}

/// Paths in a value of an included file are relative to that.
void markIncluded(JsonValue &value) {
  value.isIncluded = true;
  for (JsonValue &element : value.elements)
    markIncluded(element);
  for (auto &[key, member] : value.members) {
    key.file = value.file; // the object may become a part of another file's
    markIncluded(member);
  }
}

class IncludeExpansion {
public:
  explicit IncludeExpansion(ErrorCollector &errors) : errors(errors) {}

  void expand(JsonValue &root, const std::string &file) {
    const auto found = std::find_if(root.members.begin(), root.members.end(),
                                    [](const auto &one) { return one.first.text == "include"; });
    if (found == root.members.end())
      return;
    JsonValue includes = std::move(found->second);
    root.members.erase(found);
    open.push_back(identityOf(file));
    shown.push_back(file);
    Members merged;
    const auto include = [&](const JsonValue &path) {
      errors.attempt([&] {
        if (JsonValue part = read(path, file); part.kind == Kind::Object)
          mergeInto(merged, std::move(part.members));
      });
    };
    if (includes.kind == Kind::Array)
      for (const JsonValue &path : includes.elements)
        include(path);
    else
      include(includes);
    mergeInto(merged, std::move(root.members));
    root.members = std::move(merged);
    open.pop_back();
    shown.pop_back();
  }

  std::vector<std::string> files;

private:
  /// The part of a scene in a file; null if it has been included before.
  JsonValue read(const JsonValue &path, const std::string &from) {
    expect(path, Kind::String, "`include`");
    if (gltf::hasEnding(path.string, ".rtsl"))
      throw Error(message::shadersIncluded(path.string), path.place());
    if (gltf::isModel(path.string))
      throw Error(message::modelIncluded(path.string), path.place());
    const std::string file = resolvePath(path, from);
    const std::string identity = identityOf(file);
    if (const auto above = std::find(open.begin(), open.end(), identity); above != open.end()) {
      std::vector<std::string> cycle(shown.begin() + (above - open.begin()), shown.end());
      throw Error(cycle.size() == 1 ? message::includesItself(cycle.front())
                                    : message::includeCycle(fmt::join(cycle, "`, `")),
                  path.place());
    }
    if (std::find(known.begin(), known.end(), identity) != known.end())
      return {};
    known.push_back(identity);
    std::string text;
    try {
      text = readFile(file);
    } catch (Error &error) {
      error.place = path.place();
      throw;
    }
    files.push_back(file);
    JsonValue part = parseJson(text, file);
    expect(part, Kind::Object, "a scene");
    checkVersion(part);
    markIncluded(part);
    expand(part, file);
    return part;
  }

  /// Adds members to those of files that were included before.
  void mergeInto(Members &merged, Members &&members) {
    for (auto &[key, value] : members) {
      const auto same = std::find_if(merged.begin(), merged.end(), [&key = key](const auto &one) {
        return one.first.text == key.text;
      });
      if (same == merged.end())
        merged.emplace_back(std::move(key), std::move(value));
      else
        errors.attempt([&, &key = key, &value = value] {
          meet(meetingOf(key.text), *same, {std::move(key), std::move(value)});
        });
    }
  }

  void meet(Meeting meeting, Members::value_type &before, Members::value_type &&added) {
    JsonValue &value = before.second, &more = added.second;
    if (meeting == Meeting::Single || value.kind != more.kind || value.find("frames") ||
        (value.kind != Kind::Object && value.kind != Kind::Array)) {
      if (meeting == Meeting::List)
        return joinLists(value, std::move(more));
      before = std::move(added);
      return;
    }
    if (meeting == Meeting::List)
      return joinLists(value, std::move(more));
    for (auto &[key, member] : more.members) {
      const auto same =
          std::find_if(value.members.begin(), value.members.end(),
                       [&key = key](const auto &one) { return one.first.text == key.text; });
      if (same == value.members.end())
        value.members.emplace_back(withFile(key, more), std::move(member));
      else if (meeting == Meeting::Keys)
        *same = {withFile(key, more), std::move(member)};
      else
        throw Error(message::definedTwice(key.text, before.first.text), more.place(key))
            .related(value.place(same->first), "the other one is here");
    }
  }

  /// A key that keeps its position in another file's object.
  static JsonKey withFile(JsonKey key, const JsonValue &object) {
    if (!key.file)
      key.file = object.file;
    return key;
  }

  /// `import` may also be one string.
  static void joinLists(JsonValue &list, JsonValue &&more) {
    const auto asList = [](JsonValue value) {
      if (value.kind == Kind::Array)
        return value;
      JsonValue made = value;
      made.kind = Kind::Array;
      made.elements = {std::move(value)};
      return made;
    };
    JsonValue joined = asList(std::move(list)), added = asList(std::move(more));
    std::move(added.elements.begin(), added.elements.end(), std::back_inserter(joined.elements));
    list = std::move(joined);
  }

  ErrorCollector &errors;
  std::vector<std::string> open, shown; // the files on the way from the scene
  std::vector<std::string> known;       // that have been included
};

} // namespace

void checkVersion(const JsonValue &root) {
  const JsonValue *version = root.find("rtsl");
  if (!version)
    throw Error(message::versionMissing(), root.place());
  expect(*version, Kind::Number, "`rtsl`");
  if (version->number != 1)
    throw Error(message::versionUnsupported(version->number), version->place());
}

std::vector<std::string> expandIncludes(JsonValue &root, const std::string &file,
                                        ErrorCollector &errors) {
  IncludeExpansion expansion(errors);
  expansion.expand(root, file);
  return std::move(expansion.files);
}

} // namespace rtsl::scene
