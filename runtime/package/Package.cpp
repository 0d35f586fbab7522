//===- Package.cpp - a scene and its compiled code in one file ------------===//
#include "runtime/package/Package.h"

#include "runtime/package/FileLayout.h"
#include "runtime/render/Crc64.h"
#include "support/AtomicFile.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace rtsl::runtime {

using namespace packageFile;

namespace {

std::string_view bytesOf(const void *data, std::size_t size) {
  return {static_cast<const char *>(data), size};
}

std::uint64_t aligned(std::uint64_t offset) {
  return (offset + alignment - 1) / alignment * alignment;
}

/// The checksum of a file whose header is there.
std::uint64_t checksumOf(std::string_view file) {
  Header header;
  std::memcpy(&header, file.data(), sizeof header);
  header.checksum = 0;
  const std::uint64_t start = crc64(bytesOf(&header, sizeof header));
  return crc64(file.substr(sizeof header), start);
}

Info infoOf(const Package &package) {
  Info info{};
  info.layouts = Layouts();
  info.width = package.options.width;
  info.height = package.options.height;
  info.slices = package.options.slices;
  info.samplesPerPixel = package.options.samplesPerPixel;
  info.hasSamples = package.hasSamples;
  info.maxDepth = package.options.maxDepth;
  info.seed = package.options.seed;
  info.stateCount = package.stateCount;
  info.frameBytes = package.frameBytes;
  info.hostStackBytes = package.host.stackBytes;
  info.registers = package.registers;
  info.waveStates = package.wave.states;
  info.waveGroups = package.wave.groups;
  info.waveHasStacks = package.wave.hasStacks;
  info.waveIsPersistent = package.wave.isPersistent;
  info.hostLaneBytes = package.host.laneBytes;
  info.hostRunLane = package.host.runLane;
  return info;
}

} // namespace

std::string serialize(const Package &package) {
  const Info info = infoOf(package);
  const std::string buffers = serialize(package.buffers);
  const std::string_view contents[] = {
      bytesOf(&info, sizeof info),
      package.ptx,
      bytesOf(package.host.bytes.data(), package.host.bytes.size()),
      bytesOf(package.scene.bytes.data(), package.scene.bytes.size()),
      bytesOf(package.scene.pointers.data(), package.scene.pointers.size() * 8),
      bytesOf(package.laneBytes.data(), sizeof package.laneBytes),
      buffers};
  constexpr std::size_t count = std::size(contents);
  static_assert(count == std::size(allKinds));

  Section sections[count];
  std::uint64_t end = sizeof(Header) + sizeof sections;
  for (std::size_t i = 0; i < count; ++i) {
    sections[i] = {std::uint32_t(allKinds[i]), 0, aligned(end), contents[i].size()};
    end = sections[i].offset + sections[i].bytes;
  }

  std::string file(end, '\0');
  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.version = formatVersion;
  header.sectionCount = count;
  header.fileBytes = end;
  package.compiler.copy(header.compiler, sizeof header.compiler - 1);
  std::memcpy(file.data(), &header, sizeof header);
  std::memcpy(file.data() + sizeof header, sections, sizeof sections);
  for (std::size_t i = 0; i < count; ++i)
    contents[i].copy(file.data() + sections[i].offset, contents[i].size());
  header.checksum = checksumOf(file);
  std::memcpy(file.data(), &header, sizeof header);
  return file;
}

namespace {

class PackageReader {
public:
  PackageReader(std::string_view file, const std::string &name) : file(file), name(name) {}

  Package read() {
    checkFile();
    readSections();
    Package package;
    package.compiler = compiler;
    readInfo(package);
    package.ptx = std::string(content(SectionKind::Ptx));
    const std::string_view code = content(SectionKind::HostCode);
    package.host.bytes.assign(code.begin(), code.end());
    readScene(package.scene);
    readBuffers(package);
    return package;
  }

private:
  [[noreturn]] void refuse(const Message &why) const { throw Error(why, Place{name}); }
  [[noreturn]] void refuseDamaged() const { refuse(message::packageDamaged(name)); }

  /// Throws unless this is a package of this version, complete and undamaged.
  void checkFile() {
    Header header;
    if (file.size() < sizeof magic || std::memcmp(file.data(), magic, sizeof magic) != 0)
      refuse(message::notPackage(name));
    if (file.size() < sizeof header)
      refuse(message::packageHeaderTruncated(name));
    std::memcpy(&header, file.data(), sizeof header);
    if (header.version != formatVersion)
      refuse(message::packageFormat(name, header.version, formatVersion,
                                    header.version > formatVersion ? "use a newer rtsl-run"
                                                                   : "pack the scene again"));
    if (file.size() < header.fileBytes)
      refuse(message::packageTruncated(name, file.size(), header.fileBytes));
    if (file.size() > header.fileBytes)
      refuse(message::packageTooLong(name, file.size() - header.fileBytes));
    if (header.checksum != checksumOf(file))
      refuseDamaged();
    sectionCount = header.sectionCount;
    compiler.assign(header.compiler, strnlen(header.compiler, sizeof header.compiler));
  }

  void readSections() {
    if (sectionCount == 0 || sectionCount > (file.size() - sizeof(Header)) / sizeof(Section))
      refuseDamaged();
    sections.resize(sectionCount);
    std::memcpy(sections.data(), file.data() + sizeof(Header), sectionCount * sizeof(Section));
    for (const Section &section : sections)
      if (section.offset % alignment != 0 || section.offset > file.size() ||
          section.bytes > file.size() - section.offset)
        refuseDamaged();
  }

  std::string_view content(SectionKind kind) const {
    for (const Section &section : sections)
      if (section.kind == std::uint32_t(kind))
        return file.substr(section.offset, section.bytes);
    refuseDamaged();
  }

  void readInfo(Package &package) const {
    const std::string_view bytes = content(SectionKind::Info);
    const Layouts ours;
    if (bytes.size() < sizeof ours)
      refuseDamaged();
    if (std::memcmp(bytes.data(), &ours, sizeof ours) != 0)
      refuse(message::packageOfOtherVersion(name, compiler));
    Info info;
    if (bytes.size() != sizeof info)
      refuseDamaged();
    std::memcpy(&info, bytes.data(), sizeof info);
    package.options.width = info.width;
    package.options.height = info.height;
    package.options.slices = info.slices;
    package.options.samplesPerPixel = info.samplesPerPixel;
    package.hasSamples = info.hasSamples != 0;
    package.options.maxDepth = info.maxDepth;
    package.options.seed = info.seed;
    try {
      checkOptions(package.options);
    } catch (const Error &) {
      refuseDamaged();
    }
    package.stateCount = info.stateCount;
    package.frameBytes = info.frameBytes;
    const std::string_view laneBytes = content(SectionKind::LaneBytes);
    if (laneBytes.size() != sizeof package.laneBytes)
      refuseDamaged();
    std::memcpy(package.laneBytes.data(), laneBytes.data(), sizeof package.laneBytes);
    package.host.stackBytes = info.hostStackBytes;
    package.registers = info.registers;
    package.wave = {info.waveStates, info.waveGroups, info.waveHasStacks != 0,
                    info.waveIsPersistent != 0};
    package.host.laneBytes = info.hostLaneBytes;
    package.host.runLane = info.hostRunLane;
    const std::uint64_t code = content(SectionKind::HostCode).size();
    if (info.hostLaneBytes >= code || info.hostRunLane >= code)
      refuseDamaged();
  }

  /// Every pointer must be within the scene, after the one before it, and point into it.
  void readScene(FlatScene &scene) const {
    const std::string_view bytes = content(SectionKind::Scene);
    const std::string_view pointers = content(SectionKind::Pointers);
    if (bytes.size() < sizeof(RtslLaunch) || pointers.size() % 8 != 0)
      refuseDamaged();
    scene.bytes.assign(bytes.begin(), bytes.end());
    scene.pointers.resize(pointers.size() / 8);
    if (!pointers.empty())
      std::memcpy(scene.pointers.data(), pointers.data(), pointers.size());
    std::uint64_t end = 0; // of the one before it
    for (std::uint64_t place : scene.pointers) {
      std::uint64_t target;
      if (place < end || place > bytes.size() - sizeof target)
        refuseDamaged();
      end = place + sizeof target;
      std::memcpy(&target, bytes.data() + place, sizeof target);
      if (target >= bytes.size())
        refuseDamaged();
    }
  }

  /// Every buffer must be within the scene, with all of its elements.
  void readBuffers(Package &package) const {
    if (!parse(content(SectionKind::Buffers), package.buffers))
      refuseDamaged();
    for (const PackageBuffer &buffer : package.buffers)
      if (!isWithin(package.scene, buffer))
        refuseDamaged();
  }

  std::string_view file;
  const std::string &name;
  std::uint32_t sectionCount = 0;
  std::string compiler;
  std::vector<Section> sections;
};

} // namespace

Package parsePackage(std::string_view bytes, const std::string &name) {
  return PackageReader(bytes, name).read();
}

Package readPackage(const std::string &path) {
  return parsePackage(readFile(path), path);
}

} // namespace rtsl::runtime
