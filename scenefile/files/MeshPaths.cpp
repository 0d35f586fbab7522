#include "scenefile/files/MeshPaths.h"

#include "scenefile/graph/KeyTimes.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;

/// The error for a mesh that is written in another way, with what its author may have meant: a list
/// of files, or of objects with a `file` and a `time`.
Error notMesh(const JsonValue &value) {
  std::vector<std::string> files, times;
  const auto add = [&](const JsonValue &key) {
    const JsonValue *file = key.kind == Kind::Object ? key.find("file") : &key;
    if (file && file->kind == Kind::String)
      files.push_back(fmt::format("\"{}\"", file->string));
    if (const JsonValue *time = key.find("time"); time && time->kind == Kind::Number)
      times.push_back(fmt::format("{}", time->number));
  };
  if (value.kind == Kind::Object)
    add(value);
  for (const JsonValue &key : value.elements)
    add(key);
  Error error(message::notMesh(value.kind == Kind::Array ? "a list" : "an object without `keys`"),
              value.place());
  if (files.size() == 1 && value.kind == Kind::Object)
    error.note(fmt::format("write `\"mesh\": {}`", files.front()));
  else if (files.size() > 1 && files.size() == value.elements.size())
    error.note(fmt::format("write `\"mesh\": {{\"keys\": [{}]{}}}`", fmt::join(files, ", "),
                           times.size() == files.size()
                               ? fmt::format(", \"times\": [{}]", fmt::join(times, ", "))
                               : ""));
  return error;
}

} // namespace

std::vector<MeshPath> readMeshPaths(const JsonValue &mesh, const std::string &sceneFile,
                                    std::vector<float> &times) {
  const auto pathOf = [&](const JsonValue &path) {
    return MeshPath{{path.string, path.place()}, resolvePath(path, sceneFile)};
  };
  if (mesh.kind == Kind::Array || (mesh.kind == Kind::Object && !mesh.find("keys")))
    throw notMesh(mesh);
  if (mesh.kind != Kind::Object)
    return {pathOf(expect(mesh, Kind::String, "`mesh`"))};
  checkKeys(mesh, {"keys", "times"}, "`mesh` with keys");
  times = readKeyTimes(mesh, "a mesh");
  std::vector<MeshPath> paths;
  for (const JsonValue &key : mesh.find("keys")->elements)
    paths.push_back(pathOf(expect(key, Kind::String, "a key of a mesh")));
  return paths;
}

} // namespace rtsl::scene
