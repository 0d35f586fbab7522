#include "runtime/render/passes/Checkpoint.h"

#include "runtime/render/Crc64.h"
#include "support/AtomicFile.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace rtsl::runtime {

namespace {

constexpr char magic[8] = {'R', 'T', 'S', 'L', 'C', 'K', 'P', '\n'};
/// Counts up with every change that older programs would misread.
constexpr std::uint32_t formatVersion = 2;

/// Numbers are little-endian. The facts follow, and then the sums of all pixels (forEachList).
struct Header {
  char magic[8];
  std::uint32_t version;
  std::uint32_t factBytes;
  std::uint64_t fileBytes;
  std::uint64_t checksum; // CRC-64 of the whole file, with 0 here
  char producer[32];      // ends in zeros
};
static_assert(sizeof(Header) == 64);

template <typename Value>
std::string_view bytesOf(const std::vector<Value> &values) {
  return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(Value)};
}

std::string_view bytesOf(const Header &header) {
  return {reinterpret_cast<const char *>(&header), sizeof header};
}

/// Calls visit(number) for what a rendering has met and how far it is, in the order of the file.
template <typename Rendering, typename Visit>
void forEachNumber(Rendering &rendering, Visit visit) {
  visit(rendering.state.seconds);
  visit(rendering.state.error);
  visit(rendering.met.badRays);
  visit(rendering.met.retracedRays);
  visit(rendering.met.rescaledRays);
  visit(rendering.met.raysTooDeep);
  for (auto &count : rendering.met.exceptions)
    visit(count);
}

class FactWriter {
public:
  void add(const Identity &identity) {
    number(std::uint32_t(identity.dependences.size()));
    for (const Dependence &one : identity.dependences) {
      text(one.what);
      text(one.value);
      number(std::uint32_t(one.isContent));
    }
  }

  void add(const PartialRendering &rendering) {
    forEachNumber(rendering, [&](const auto &value) { number(value); });
    number(std::uint32_t(rendering.met.notFinite.size()));
    for (const SampleId &sample : rendering.met.notFinite) {
      number(sample.x);
      number(sample.y);
      number(sample.sample);
    }
  }

  std::string bytes;

private:
  template <typename Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
  }

  void text(const std::string &value) {
    number(std::uint32_t(value.size()));
    bytes += value;
  }
};

/// Thrown for facts that end too early, which no program has written.
struct Malformed {};

class FactReader {
public:
  explicit FactReader(std::string_view bytes) : bytes(bytes) {}

  Identity readIdentity() {
    Identity identity;
    const auto count = number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      Dependence one;
      one.what = text();
      one.value = text();
      one.isContent = number<std::uint32_t>() != 0;
      identity.dependences.push_back(std::move(one));
    }
    return identity;
  }

  void read(PartialRendering &rendering) {
    forEachNumber(rendering, [&](auto &value) { value = number<std::decay_t<decltype(value)>>(); });
    const auto count = number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      SampleId sample;
      sample.x = number<std::uint32_t>();
      sample.y = number<std::uint32_t>();
      sample.sample = number<std::uint32_t>();
      rendering.met.notFinite.push_back(sample);
    }
    if (!bytes.empty())
      throw Malformed();
  }

private:
  std::string_view take(std::size_t count) {
    if (count > bytes.size())
      throw Malformed();
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(count);
    return taken;
  }

  template <typename Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  std::string text() { return std::string(take(number<std::uint32_t>())); }

  std::string_view bytes;
};

[[noreturn]] void refuse(const std::string &path, const Message &why) {
  throw Error(why, Place{path})
      .note("it is left as it was; to begin anew, delete it or name another file");
}

[[noreturn]] void refuseDamaged(const std::string &path) {
  refuse(path, message::checkpointDamaged(path));
}

/// Is it this program, in this or another version? Other bytes are damage.
bool isVersionOf(std::string_view producer, std::string_view ours) {
  const std::size_t name = ours.rfind(' ') + 1;
  return producer.size() > name && producer.substr(0, name) == ours.substr(0, name) &&
         producer.find_first_not_of("0123456789.", name) == std::string_view::npos;
}

/// The header. Throws unless this is a checkpoint of this version, complete and undamaged. The
/// version is compared first, because another one may store and check a rendering in another way.
Header checkFile(std::string_view file, const std::string &path, const std::string &producer) {
  Header header;
  if (file.size() < sizeof magic || std::memcmp(file.data(), magic, sizeof magic) != 0)
    refuse(path, message::notCheckpoint(path));
  if (file.size() < sizeof header)
    refuse(path, message::checkpointHeaderTruncated(path));
  std::memcpy(&header, file.data(), sizeof header);
  if (header.version != formatVersion)
    refuse(path, message::checkpointFormat(path, header.version, formatVersion));
  const std::string theirs(header.producer, strnlen(header.producer, sizeof header.producer));
  if (theirs != producer && isVersionOf(theirs, producer))
    refuse(path, message::checkpointOfOtherVersion(path, theirs, producer));
  if (file.size() < header.fileBytes)
    refuse(path, message::checkpointTruncated(path, file.size(), header.fileBytes));
  if (file.size() > header.fileBytes)
    refuse(path, message::checkpointTooLong(path, file.size() - header.fileBytes));
  Header withoutChecksum = header;
  withoutChecksum.checksum = 0;
  if (header.checksum != crc64(file.substr(sizeof header), crc64(bytesOf(withoutChecksum))) ||
      header.factBytes > file.size() - sizeof header)
    refuseDamaged(path);
  if (theirs != producer) // of another program
    refuse(path, message::checkpointOfOtherVersion(path, theirs, producer));
  return header;
}

void compare(const Identity &theirs, const Identity &ours, const std::string &path) {
  const std::size_t count = std::max(theirs.dependences.size(), ours.dependences.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Dependence nothing{"nothing", "", false};
    const Dependence &there = i < theirs.dependences.size() ? theirs.dependences[i] : nothing,
                     &here = i < ours.dependences.size() ? ours.dependences[i] : nothing;
    if (there.what != here.what)
      refuse(path, message::checkpointOfOtherParts(path, there.what, here.what));
    if (there.value == here.value)
      continue;
    if (there.isContent)
      refuse(path, message::checkpointInputChanged(path, here.what));
    refuse(path, message::checkpointOfOtherValue(path, here.what, there.value, here.value));
  }
}

template <typename Value>
std::string_view readValues(std::string_view from, std::vector<Value> &values) {
  const std::size_t bytes = values.size() * sizeof(Value);
  if (bytes != 0) // else there is no data(), and memcpy needs one
    std::memcpy(values.data(), from.data(), bytes);
  return from.substr(bytes);
}

PixelSums readSums(std::string_view bytes, const std::string &path, std::uint64_t pixels,
                   std::uint32_t components, bool isAdaptive) {
  PixelSums sums = PixelSums::make(pixels, components, isAdaptive);
  std::size_t expected = 0;
  forEachList([&](const auto &values) { expected += bytesOf(values).size(); }, sums);
  if (bytes.size() != expected)
    refuseDamaged(path);
  forEachList([&](auto &values) { bytes = readValues(bytes, values); }, sums);
  for (std::size_t half = 0; half < sums.counted.size(); ++half)
    if (sums.counted[half] > sums.taken[half / sums.halves()] ||
        (isAdaptive && sums.deciding[half] > sums.taken[half / 2]))
      refuseDamaged(path);
  for (const std::uint32_t closed : sums.closed)
    if (closed > PixelSums::allClosed)
      refuseDamaged(path);
  return sums;
}

} // namespace

void writeCheckpoint(const std::string &path, const Identity &identity,
                     const PartialRendering &rendering) {
  FactWriter facts;
  facts.add(identity);
  facts.add(rendering);
  const PixelSums &sums = rendering.sums;
  Header header{};
  std::vector<std::string_view> parts = {bytesOf(header), facts.bytes};
  forEachList([&](const auto &values) { parts.push_back(bytesOf(values)); }, sums);
  std::memcpy(header.magic, magic, sizeof magic);
  header.version = formatVersion;
  header.factBytes = std::uint32_t(facts.bytes.size());
  for (const std::string_view part : parts)
    header.fileBytes += part.size();
  identity.producer.copy(header.producer, sizeof header.producer - 1);
  std::uint64_t checksum = 0;
  for (const std::string_view part : parts)
    checksum = crc64(part, checksum);
  header.checksum = checksum;
  writeFileAtomically(path, parts);
}

PartialRendering parseCheckpoint(std::string_view bytes, const std::string &path,
                                 const Identity &identity, std::uint64_t pixels,
                                 std::uint32_t components, bool isAdaptive) {
  const Header header = checkFile(bytes, path, identity.producer);
  PartialRendering rendering;
  try {
    FactReader facts(bytes.substr(sizeof header, header.factBytes));
    compare(facts.readIdentity(), identity, path);
    facts.read(rendering);
  } catch (const Malformed &) {
    refuseDamaged(path);
  }
  rendering.sums = readSums(bytes.substr(sizeof header + header.factBytes), path, pixels,
                            components, isAdaptive);
  return rendering;
}

} // namespace rtsl::runtime
