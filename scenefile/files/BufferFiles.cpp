#include "scenefile/files/BufferFiles.h"

#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

namespace rtsl::scene {

using Kind = JsonValue::Kind;

/// A key that only files of some formats have.
static const JsonValue *findFor(bool isTaken, const JsonValue &buffer, const std::string &key,
                                const char *files) {
  for (const auto &[name, value] : buffer.members)
    if (name.text == key && !isTaken)
      throw Error(message::keyOfOtherFiles(key, files), buffer.place(name));
  return buffer.find(key);
}

bool isBuffer(const JsonValue &value) {
  if (value.kind != Kind::Object || value.find("class"))
    return false;
  const JsonValue *file = value.find("buffer"), *size = value.find("size");
  if (file)
    return file->kind == Kind::String;
  return size && size->kind == Kind::Array && value.members.size() == 1;
}

BufferDescription
readBufferDescription(const JsonValue &buffer,
                      const std::function<std::string(const JsonValue &)> &resolve) {
  BufferDescription description;
  if (const JsonValue *size = buffer.find("size"); size && !buffer.find("buffer")) {
    if (size->elements.empty() || size->elements.size() > 3)
      throw Error(message::sizeRank(), size->place());
    for (const JsonValue &one : size->elements)
      description.shape.push_back(readInteger(one, 0, 0xffffffff, "a number of `size`"));
    return description;
  }
  checkKeys(buffer, {"buffer", "element", "columns", "shape"}, "a buffer");
  description.file = resolve(*buffer.find("buffer"));
  const std::string extension = extensionOf(description);
  const bool isPly = extension == ".ply", isTable = isPly || extension == ".csv";
  const bool hasFormat = isTable || extension == ".npy";
  if (const JsonValue *element = findFor(isPly, buffer, "element", ".ply files"))
    description.element = expect(*element, Kind::String, "`element`").string;
  if (const JsonValue *columns = findFor(isTable, buffer, "columns", ".csv and .ply files"))
    for (const JsonValue &column : expect(*columns, Kind::Array, "`columns`").elements)
      description.columns.push_back(expect(column, Kind::String, "a column").string);
  if (const JsonValue *shape = findFor(!hasFormat, buffer, "shape", "files without a format"))
    for (const JsonValue &size : expect(*shape, Kind::Array, "`shape`").elements)
      description.shape.push_back(readInteger(size, 0, 0xffffffff, "a size of `shape`"));
  return description;
}

} // namespace rtsl::scene
