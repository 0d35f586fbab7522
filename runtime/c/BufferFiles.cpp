//===- BufferFiles.cpp - buffers of files, for C --------------------------===//
#include "scenefile/files/BufferFiles.h"
#include "runtime/c/Handle.h"
#include "scenefile/gltf/Parts.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace runtime = rtsl::runtime;
namespace scene = rtsl::scene;
using rtsl::c::guarded;

namespace {

/// The description as it would be in a scene file, so that the same checks apply.
scene::BufferDescription describe(const char *path, const RtslBufferFile *file) {
  using namespace scene::gltf;
  scene::JsonValue nowhere;
  nowhere.file = std::make_shared<const std::string>();
  scene::JsonValue buffer = object(nowhere, {{"buffer", text(nowhere, path)}});
  if (file && file->element)
    set(buffer, "element", text(nowhere, file->element));
  if (file && file->columnCount != 0) {
    std::vector<scene::JsonValue> columns;
    for (std::uint32_t i = 0; i < file->columnCount; ++i)
      columns.push_back(text(nowhere, file->columns[i]));
    set(buffer, "columns", list(nowhere, std::move(columns)));
  }
  if (file && file->dimensions != 0) {
    std::vector<scene::JsonValue> sizes;
    for (std::uint32_t i = 0; i < file->dimensions; ++i) {
      sizes.push_back(number(nowhere, file->shape[i]));
      sizes.back().isInteger = true;
    }
    set(buffer, "shape", list(nowhere, std::move(sizes)));
  }
  return scene::readBufferDescription(buffer,
                                      [](const scene::JsonValue &value) { return value.string; });
}

const runtime::MemberInfo &memberOf(const runtime::Program &program, const char *className,
                                    const char *member) {
  const runtime::ClassInfo *info = program.find(className);
  if (!info)
    throw rtsl::Error(rtsl::message::noSuchClass(className));
  for (const runtime::MemberInfo &one : info->members)
    if (one.name == member)
      return one;
  throw rtsl::Error(rtsl::message::noSuchMember(className, member));
}

} // namespace

extern "C" {

RtslBufferNumber rtslSceneLoadBuffer(RtslScene *scene, const char *path, const char *className,
                                     const char *member, const RtslBufferFile *file,
                                     uint32_t sizes[3]) {
  return guarded<RtslBufferNumber>(0,
                                   {{scene, "scene"},
                                    {path, "path"},
                                    {className, "className"},
                                    {member, "member"},
                                    {sizes, "sizes"}},
                                   [&] {
                                     const runtime::Program &program = scene->scene.program();
                                     const runtime::ValueType &type =
                                         memberOf(program, className, member).type;
                                     const runtime::Value read = runtime::readBuffer(
                                         describe(path, file), type, program.colorComponents,
                                         fmt::format("member `{}` of `{}`", member, className));
                                     std::fill_n(sizes, 3, 1u);
                                     std::copy(read.sizes.begin(), read.sizes.end(), sizes);
                                     scene->buffers.push_back(read.words);
                                     return RtslBufferNumber(scene->buffers.size());
                                   });
}

} // extern "C"
