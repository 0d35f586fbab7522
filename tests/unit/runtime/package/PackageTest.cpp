// A package is read as it was written, or refused: whatever byte of it changes, and wherever it
// ends.
#include "runtime/package/Package.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

using namespace rtsl;
using namespace rtsl::runtime;

namespace {

Package smallPackage() {
  Package package;
  package.compiler = "rtslc 1.2.3";
  package.options.width = 30;
  package.options.height = 20;
  package.options.samplesPerPixel = 4;
  package.hasSamples = true;
  package.options.maxDepth = 5;
  package.options.seed = 6;
  package.stateCount = 7;
  package.frameBytes = 28;
  package.laneBytes[2] = 2800;
  package.wave = {5, 13, true};
  package.ptx = ".version 6.3";
  package.host.bytes = {0xc3, 0x90, 0xc3};
  package.host.laneBytes = 0;
  package.host.runLane = 2;
  package.scene.bytes.assign(sizeof(RtslLaunch) + 16, 0);
  const std::uint64_t target = sizeof(RtslLaunch);
  std::memcpy(package.scene.bytes.data(), &target, sizeof target);
  package.scene.bytes.back() = 99;
  package.scene.pointers = {0};
  return package;
}

/// What is said about the bytes; empty if they are taken.
std::string refusal(const std::string &bytes) {
  try {
    parsePackage(bytes, "x.rtslpkg");
  } catch (const Error &error) {
    EXPECT_EQ(error.code, ErrorCode::BadPackage);
    EXPECT_NE(std::string(error.what()), "");
    return error.what();
  }
  return "";
}

/// CRC-64/XZ bit by bit: the polynomial of ECMA-182, bits reflected, all ones before and inverted
/// after. The format of packages states it, whichever library computes it.
std::uint64_t crc64(std::string_view bytes) {
  std::uint64_t remainder = ~std::uint64_t(0);
  for (char byte : bytes) {
    remainder ^= std::uint8_t(byte);
    for (int bit = 0; bit < 8; ++bit)
      remainder = remainder >> 1 ^ (remainder & 1 ? 0xc96c5795d7870f42u : 0);
  }
  return ~remainder;
}

TEST(Package, HasTheChecksumThatItsFormatStates) {
  ASSERT_EQ(crc64("123456789"), 0x995dc9bbdf1939fau); // the check value of the CRC's catalogue
  std::string bytes = serialize(smallPackage());
  std::uint64_t stored;
  std::memcpy(&stored, &bytes[24], sizeof stored);
  std::memset(&bytes[24], 0, sizeof stored);
  EXPECT_EQ(stored, crc64(bytes));
}

TEST(Package, IsReadAsItWasWritten) {
  const Package written = smallPackage();
  const std::string bytes = serialize(written);
  EXPECT_EQ(bytes, serialize(smallPackage()));
  const Package read = parsePackage(bytes, "x");
  EXPECT_EQ(read.compiler, written.compiler);
  EXPECT_EQ(read.options.width, 30u);
  EXPECT_EQ(read.options.height, 20u);
  EXPECT_EQ(read.options.samplesPerPixel, 4u);
  EXPECT_TRUE(read.hasSamples);
  EXPECT_EQ(read.options.maxDepth, 5u);
  EXPECT_EQ(read.options.seed, 6u);
  EXPECT_EQ(read.stateCount, 7u);
  EXPECT_EQ(read.frameBytes, 28u);
  EXPECT_EQ(read.laneBytes, written.laneBytes);
  EXPECT_EQ(read.wave.states, 5u);
  EXPECT_EQ(read.wave.groups, 13u);
  EXPECT_TRUE(read.wave.hasStacks);
  EXPECT_EQ(read.ptx, written.ptx);
  EXPECT_EQ(read.host.bytes, written.host.bytes);
  EXPECT_EQ(read.host.runLane, 2u);
  EXPECT_EQ(read.scene.bytes, written.scene.bytes);
  EXPECT_EQ(read.scene.pointers, written.scene.pointers);
}

TEST(Package, EveryChangedByteIsFound) {
  const std::string whole = serialize(smallPackage());
  ASSERT_EQ(refusal(whole), "");
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int change : {0x01, 0x10, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[i] = char(damaged[i] ^ change);
      EXPECT_NE(refusal(damaged), "") << "byte " << i << " ^ " << change;
    }
}

TEST(Package, EveryOtherLengthIsFound) {
  const std::string whole = serialize(smallPackage());
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "") << length;
  EXPECT_NE(refusal(whole + '\0'), "");
}

TEST(Package, ContentsThatNoRenderingCanHaveAreFound) {
  const auto refused = [](auto change) {
    Package package = smallPackage();
    PackageBuffer buffer;
    buffer.name = "rays";
    buffer.type.bufferRank = 1;
    buffer.type.elementSize = 4;
    buffer.values = Range{0, 1, true, false};
    buffer.place = sizeof(RtslLaunch) - sizeof(RtslBuffer);
    package.buffers = {buffer};
    change(package);
    return refusal(serialize(package)) == "`x.rtslpkg` is damaged: pack the scene again";
  };
  const auto setElements = [](Package &package, std::uint32_t start, std::uint32_t count) {
    const RtslBuffer header{start, 0, {count, 0, 0}};
    std::memcpy(&package.scene.bytes[package.buffers[0].place], &header, sizeof header);
  };
  EXPECT_FALSE(refused([&](Package &package) { setElements(package, sizeof(RtslLaunch), 4); }));
  EXPECT_TRUE(refused([&](Package &package) { setElements(package, sizeof(RtslLaunch), 5); }));
  EXPECT_TRUE(refused([&](Package &package) { setElements(package, 0xffffffff, 1); }));
  EXPECT_TRUE(refused([](Package &package) { package.buffers[0].type.elementSize = 0; }));
  EXPECT_TRUE(refused([](Package &package) { package.options.maxDepth = maxRayDepth + 1; }));
  EXPECT_TRUE(refused([](Package &package) { package.options.slices = 0; }));
  EXPECT_TRUE(refused([](Package &package) { package.scene.pointers = {8, 0}; }));
}

TEST(Package, RejectionsHaveReasons) {
  const std::string whole = serialize(smallPackage());
  EXPECT_EQ(refusal("an ordinary text that has nothing to do with it"),
            "`x.rtslpkg` is not a package of rtslc");
  EXPECT_EQ(refusal(""), "`x.rtslpkg` is not a package of rtslc");
  std::string newer = whole;
  const int format = newer[8]++;
  EXPECT_EQ(refusal(newer), "`x.rtslpkg` is a package of format " + std::to_string(format + 1) +
                                ", and this program reads format " + std::to_string(format) +
                                ": use a newer rtsl-run");
  EXPECT_NE(refusal(whole.substr(0, 200)).find("is truncated: it has 200 bytes of"),
            std::string::npos);
  std::string damaged = whole;
  damaged[whole.size() - 1] ^= 1;
  EXPECT_EQ(refusal(damaged), "`x.rtslpkg` is damaged: pack the scene again");
}

/// A package whose checksum is right although its contents are not.
std::string forged(std::size_t offset, std::uint32_t word) {
  std::string bytes = serialize(smallPackage());
  std::memcpy(&bytes[offset], &word, sizeof word);
  std::memset(&bytes[24], 0, 8);
  const std::uint64_t checksum = crc64(bytes);
  std::memcpy(&bytes[24], &checksum, sizeof checksum);
  return bytes;
}

TEST(Package, ContentsThatContradictEachOtherAreRefused) {
  constexpr std::size_t sections = 64, sectionBytes = 24, info = 256;
  EXPECT_EQ(refusal(forged(info + 36, 30)), ""); // the width, as it was
  EXPECT_NE(refusal(forged(12, 1000000)), "");   // sections
  for (int i = 0; i < 7; ++i) {
    EXPECT_NE(refusal(forged(sections + i * sectionBytes, 77)), "") << i;              // kind
    EXPECT_NE(refusal(forged(sections + i * sectionBytes + 8, 0x7fffffc0)), "") << i;  // offset
    EXPECT_NE(refusal(forged(sections + i * sectionBytes + 16, 0x7fffffff)), "") << i; // size
  }
  EXPECT_NE(refusal(forged(info, 1)).find("rtslc 1.2.3"), std::string::npos); // layout of a launch
  EXPECT_NE(refusal(forged(info + 96, 3)), ""); // an entry after the code
  std::uint64_t scene;
  const std::string whole = serialize(smallPackage());
  std::memcpy(&scene, &whole[sections + 3 * sectionBytes + 8], sizeof scene);
  EXPECT_NE(refusal(forged(scene, 0x10000)), ""); // a pointer that leads out of the scene
  std::uint64_t buffers;
  std::memcpy(&buffers, &whole[sections + 6 * sectionBytes + 8], sizeof buffers);
  EXPECT_NE(refusal(forged(buffers, 1000)), ""); // more buffers than follow
  std::uint64_t pointers;
  std::memcpy(&pointers, &whole[sections + 4 * sectionBytes + 8], sizeof pointers);
  EXPECT_NE(refusal(forged(pointers, 0x10000)), ""); // a pointer beyond the scene
}

} // namespace
