//===- PackageReader.cpp - any bytes through the reader of packages -------===//
//
// As a file, and as changes of a small package, which then gets the checksum that it must have:
// otherwise no mutation would reach what follows the header.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "runtime/package/Package.h"
#include "runtime/render/Crc64.h"
#include "support/Error.h"

#include <cstring>
#include <string>
#include <string_view>

using namespace rtsl;
using fuzz::require;

namespace {

runtime::Package smallPackage() {
  runtime::Package package;
  package.compiler = "rtslc 1.2.3";
  package.ptx = ".version 6.3";
  package.host.bytes = {0xc3, 0x90, 0xc3};
  package.host.runLane = 2;

  // A pointer of the launch, and two buffers whose elements follow.
  constexpr std::uint64_t inputs = sizeof(RtslLaunch), outputs = inputs + sizeof(RtslBuffer),
                          elements = outputs + sizeof(RtslBuffer), elementBytes = 24;
  package.scene.bytes.resize(elements + 2 * elementBytes);
  package.scene.pointers = {0, inputs, outputs};
  const auto set = [&package](std::uint64_t place, const auto &value) {
    std::memcpy(&package.scene.bytes[place], &value, sizeof value);
  };
  set(0, elements);
  RtslBuffer buffer{};
  buffer.addressLow = elements;
  buffer.size[0] = 2;
  set(inputs, buffer);
  buffer.addressLow += elementBytes;
  buffer.size[1] = 1;
  set(outputs, buffer);

  runtime::PackageBuffer input;
  input.name = "directions";
  input.sceneName = "rays";
  input.type.rows = 3;
  input.type.bufferRank = 1;
  input.type.name = "vec3[]";
  input.type.elementSize = 12;
  input.values = Range{-1000, 1000, true, false};
  input.place = inputs;
  input.setsLaunchSize = true;
  runtime::PackageBuffer output = input;
  output.name = "hits";
  output.type.bufferRank = 2;
  output.type.isOutput = output.hasLaunchSize = true;
  output.place = outputs;
  package.buffers = {input, output};
  return package;
}

/// The small package with changes, of three bytes each: a place, and the byte there.
std::string changed(std::string_view changes) {
  static const std::string whole = serialize(smallPackage());
  std::string file = whole;
  for (; changes.size() >= 3; changes.remove_prefix(3)) {
    const auto byte = [&](std::size_t i) { return std::size_t(std::uint8_t(changes[i])); };
    file[(byte(0) | byte(1) << 8) % file.size()] = changes[2];
  }
  constexpr std::size_t checksumPlace = 24; // docs/packages.md
  std::uint64_t checksum = 0;
  std::memcpy(&file[checksumPlace], &checksum, sizeof checksum);
  checksum = runtime::crc64(file);
  std::memcpy(&file[checksumPlace], &checksum, sizeof checksum);
  return file;
}

runtime::Package parse(const std::string &bytes) {
  return runtime::parsePackage(bytes, "scene.rtslpkg");
}

/// A launch of some size can have its buffers.
void makeBuffers(const runtime::Package &package) {
  constexpr std::uint32_t largeElement = 1 << 20; // a launch of any size would need much memory
  for (const runtime::PackageBuffer &buffer : package.buffers)
    if (buffer.type.elementSize > largeElement)
      return;
  runtime::LaunchBuffers buffers(package.scene, package.buffers);
  try {
    runtime::RenderOptions options;
    options.width = 3;
    options.height = 2;
    buffers.setSize(options);
  } catch (const Error &error) {
    require(error.code == ErrorCode::OutOfRange, "a launch can have too many dimensions");
    return;
  }
  for (const runtime::PackageBuffer &buffer : package.buffers)
    if (buffer.type.isOutput)
      buffers.output(buffer);
}

void read(const std::string &bytes) {
  try {
    runtime::Package package = parse(bytes);
    const std::string written = serialize(package);
    require(serialize(parse(written)) == written, "a package is read as it was written");
    checkOptions(package.options);
    makeBuffers(package);
    constexpr std::uint64_t someAddress = 1 << 20;
    package.scene.relocate(someAddress);
  } catch (const Error &error) {
    require(error.code == ErrorCode::BadPackage, "an error is the package's");
    require(error.what()[0] != '\0', "an error has a message");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char *>(data), size);
  read(bytes);
  read(changed(bytes));
  return 0;
}
