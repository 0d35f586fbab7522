#include "runtime/package/Buffers.h"

#include "runtime/buffers/BufferFiles.h"
#include "runtime/scene/MemberRanges.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

namespace rtsl::runtime {

//===----------------------------------------------------------------------===//
// As bytes: numbers of 32 bits, and texts with their lengths before them
//===----------------------------------------------------------------------===//

namespace {

class Writer {
public:
  void number(std::uint64_t value) {
    bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
  }
  void real(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    number(bits);
  }
  void text(const std::string &value) {
    number(value.size());
    bytes += value;
  }
  void type(const ValueType &value) {
    number(std::uint64_t(value.kind));
    for (const std::uint64_t one : {std::uint64_t(value.rows), std::uint64_t(value.columns),
                                    std::uint64_t(value.bufferRank), std::uint64_t(value.isOutput),
                                    std::uint64_t(value.size), std::uint64_t(value.elementSize)})
      number(one);
    text(value.name);
    number(value.arraySizes.size());
    for (const std::uint32_t size : value.arraySizes)
      number(size);
    number(value.fields.size());
    for (const MemberInfo &field : value.fields) {
      text(field.name);
      number(field.offset);
      type(field.type);
    }
  }

  std::string bytes;
};

/// Functions return zero after the end: `isDamaged` then.
class ByteReader {
public:
  explicit ByteReader(std::string_view bytes) : left(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    if (left.size() < sizeof value) {
      isDamaged = true;
      return 0;
    }
    std::memcpy(&value, left.data(), sizeof value);
    left.remove_prefix(sizeof value);
    return value;
  }
  double real() {
    const std::uint64_t bits = number();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  /// How many elements follow, which take 8 bytes at least.
  std::uint64_t count() {
    const std::uint64_t value = number();
    isDamaged |= value > left.size();
    return isDamaged ? 0 : value;
  }
  std::string text() {
    const std::uint64_t length = count();
    std::string value(left.substr(0, length));
    left.remove_prefix(length);
    return value;
  }
  ValueType type(unsigned depth = 0) {
    ValueType value;
    const std::uint64_t kind = number();
    isDamaged |= kind > std::uint64_t(ValueType::Kind::Struct) || depth > 64;
    value.kind = ValueType::Kind(isDamaged ? 0 : kind);
    value.rows = std::uint8_t(number());
    value.columns = std::uint8_t(number());
    value.bufferRank = std::uint8_t(number());
    value.isOutput = number() != 0;
    value.size = std::uint32_t(number());
    value.elementSize = std::uint32_t(number());
    value.name = text();
    for (std::uint64_t i = count(); i > 0 && !isDamaged; --i)
      value.arraySizes.push_back(std::uint32_t(number()));
    for (std::uint64_t i = count(); i > 0 && !isDamaged; --i) {
      MemberInfo field;
      field.name = text();
      field.offset = std::uint32_t(number());
      field.type = type(depth + 1);
      value.fields.push_back(std::move(field));
    }
    return value;
  }

  bool isDamaged = false;
  std::string_view left;
};

/// Of element 0, in a flat scene.
std::uint64_t startOf(const RtslBuffer &buffer) {
  return std::uint64_t(buffer.addressHigh) << 32 | buffer.addressLow;
}

std::uint64_t bytesOf(const RtslBuffer &buffer, const ValueType &type) {
  std::uint64_t bytes = type.elementSize;
  for (std::uint8_t i = 0; i < type.bufferRank; ++i)
    bytes *= buffer.size[i];
  return bytes;
}

} // namespace

std::string serialize(const std::vector<PackageBuffer> &buffers) {
  Writer writer;
  writer.number(buffers.size());
  for (const PackageBuffer &buffer : buffers) {
    writer.text(buffer.name);
    writer.text(buffer.sceneName);
    writer.type(buffer.type);
    writer.number(buffer.place);
    writer.number(buffer.hasLaunchSize);
    writer.number(buffer.setsLaunchSize);
  }
  for (std::size_t i = 0; i < buffers.size(); ++i) // of the few that have one
    if (const std::optional<Range> &values = buffers[i].values) {
      writer.number(i);
      writer.real(values->low);
      writer.real(values->high);
      writer.number(values->includesLow);
      writer.number(values->includesHigh);
    }
  return writer.bytes;
}

bool parse(std::string_view bytes, std::vector<PackageBuffer> &buffers) {
  ByteReader reader(bytes);
  for (std::uint64_t i = reader.count(); i > 0 && !reader.isDamaged; --i) {
    PackageBuffer buffer;
    buffer.name = reader.text();
    buffer.sceneName = reader.text();
    buffer.type = reader.type();
    buffer.place = reader.number();
    buffer.hasLaunchSize = reader.number() != 0;
    buffer.setsLaunchSize = reader.number() != 0;
    reader.isDamaged |=
        buffer.type.bufferRank < 1 || buffer.type.bufferRank > 3 || buffer.type.elementSize == 0;
    buffers.push_back(std::move(buffer));
  }
  while (!reader.isDamaged && !reader.left.empty()) {
    const std::uint64_t number = reader.number();
    Range values;
    values.low = reader.real();
    values.high = reader.real();
    values.includesLow = reader.number() != 0;
    values.includesHigh = reader.number() != 0;
    reader.isDamaged |= number >= buffers.size();
    if (!reader.isDamaged)
      buffers[number].values = values;
  }
  return !reader.isDamaged;
}

bool isWithin(const FlatScene &scene, const PackageBuffer &buffer) {
  const std::uint64_t size = scene.bytes.size();
  RtslBuffer header;
  if (size < sizeof header || buffer.place > size - sizeof header)
    return false;
  std::memcpy(&header, scene.bytes.data() + buffer.place, sizeof header);
  const std::uint32_t *const sizes = header.size, *const end = sizes + buffer.type.bufferRank;
  if (std::find(sizes, end, 0u) != end)
    return true;
  if (startOf(header) > size)
    return false;
  std::uint64_t most = (size - startOf(header)) / buffer.type.elementSize;
  for (const std::uint32_t *one = sizes; one != end; ++one)
    most /= *one; // floor(floor(a / b) / c) = floor(a / (b c))
  return most > 0;
}

//===----------------------------------------------------------------------===//
// A launch
//===----------------------------------------------------------------------===//

LaunchBuffers::LaunchBuffers(FlatScene scene, const std::vector<PackageBuffer> &buffers)
    : flat(std::move(scene)), buffers(buffers), memory(buffers.size()) {}

const PackageBuffer &LaunchBuffers::find(const std::string &name, const char *option) const {
  std::vector<std::string> names;
  for (const PackageBuffer &buffer : buffers) {
    if (buffer.isNamed(name))
      return buffer;
    names.push_back(buffer.name);
  }
  throw Error(message::noPackageBuffer(
      option, name, names.empty() ? "" : fmt::format("; it has `{}`", fmt::join(names, "`, `"))));
}

RtslBuffer LaunchBuffers::header(const PackageBuffer &buffer) const {
  RtslBuffer header;
  std::memcpy(&header, flat.bytes.data() + buffer.place, sizeof header);
  return header;
}

std::uint32_t LaunchBuffers::lengthOf(const PackageBuffer &buffer) const {
  return header(buffer).size[0];
}

/// New elements are appended to the scene; members that share a buffer all get them.
void LaunchBuffers::replace(const PackageBuffer &buffer, const std::vector<std::uint32_t> &sizes,
                            const std::uint32_t *words, std::uint64_t bytes) {
  constexpr std::uint64_t alignment = 64;
  const RtslBuffer before = header(buffer);
  const std::uint64_t start =
      bytes == 0 ? 0 : (flat.bytes.size() + alignment - 1) / alignment * alignment;
  if (bytes != 0) {
    flat.bytes.resize(start + bytes);
    if (words)
      std::memcpy(flat.bytes.data() + start, words, bytes);
  }
  for (const PackageBuffer &other : buffers) {
    RtslBuffer changed = header(other);
    const bool isShared = before.size[0] != 0 && changed.addressLow == before.addressLow &&
                          changed.addressHigh == before.addressHigh;
    if (&other != &buffer && !isShared)
      continue;
    changed.addressLow = std::uint32_t(start);
    changed.addressHigh = std::uint32_t(start >> 32);
    std::copy(sizes.begin(), sizes.end(), changed.size);
    std::memcpy(flat.bytes.data() + other.place, &changed, sizeof changed);
    const auto known = std::lower_bound(flat.pointers.begin(), flat.pointers.end(), other.place);
    const bool isPointer = known != flat.pointers.end() && *known == other.place;
    if (bytes != 0 && !isPointer)
      flat.pointers.insert(known, other.place);
    else if (bytes == 0 && isPointer)
      flat.pointers.erase(known);
  }
}

/// As checkRange(), of elements that were read for `--in`.
static void checkElements(const PackageBuffer &buffer, const Value &value,
                          std::uint32_t colorComponents, const std::string &what,
                          const std::string &file) {
  MemberInfo declared;
  declared.name = buffer.name;
  declared.type = buffer.type;
  declared.values = buffer.values;
  RtslBuffer elements{};
  const auto address = reinterpret_cast<std::uint64_t>(value.words->data());
  elements.addressLow = std::uint32_t(address);
  elements.addressHigh = std::uint32_t(address >> 32);
  std::copy(value.sizes.begin(), value.sizes.end(), elements.size);
  checkRange(declared, reinterpret_cast<const std::uint8_t *>(&elements), colorComponents,
             "the package", what, nullptr, Place{file, 0, 0, 0});
}

void LaunchBuffers::read(const PackageBuffer &buffer, const std::string &file) {
  BufferDescription description;
  description.file = file;
  const std::uint32_t colorComponents = flat.launch().colorComponents;
  const std::string what = fmt::format("`--in {}`", buffer.name);
  const Value value = readBuffer(description, buffer.type, colorComponents, what);
  checkElements(buffer, value, colorComponents, what, file);
  replace(buffer, value.sizes, value.words->data(), 4 * value.words->size());
}

void LaunchBuffers::setSize(const RenderOptions &options) {
  const std::uint32_t rows = options.height / options.slices;
  for (const PackageBuffer &buffer : buffers) {
    if (!buffer.hasLaunchSize)
      continue;
    std::vector<std::uint32_t> sizes;
    if (buffer.type.bufferRank == 3)
      sizes.push_back(options.slices);
    if (buffer.type.bufferRank >= 2)
      sizes.push_back(rows);
    sizes.push_back(options.width);
    if ((buffer.type.bufferRank == 1 && options.height != 1) ||
        (buffer.type.bufferRank == 2 && options.slices != 1))
      throw Error(message::launchRankTooHigh(buffer.name, buffer.type.name));
    const RtslBuffer now = header(buffer);
    if (std::equal(sizes.begin(), sizes.end(), now.size))
      continue;
    std::uint64_t bytes = buffer.type.elementSize;
    for (const std::uint32_t size : sizes)
      bytes *= size;
    replace(buffer, sizes, nullptr, bytes);
  }
  flat.outputs.clear();
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const RtslBuffer now = header(buffers[i]);
    const std::uint64_t bytes = bytesOf(now, buffers[i].type);
    if (!buffers[i].type.isOutput || bytes == 0)
      continue;
    memory[i].resize(bytes);
    flat.outputs.push_back({startOf(now), bytes, memory[i].data()});
  }
}

OutputBuffer LaunchBuffers::output(const PackageBuffer &buffer) {
  if (!buffer.type.isOutput)
    throw Error(message::inputNotWritten(buffer.name));
  const RtslBuffer now = header(buffer);
  std::vector<std::uint8_t> &elements = memory[std::size_t(&buffer - buffers.data())];
  return {buffer.name,
          buffer.type,
          {now.size, now.size + buffer.type.bufferRank},
          elements.data(),
          elements.size()};
}

} // namespace rtsl::runtime
