// A checkpoint is read as it was written, or refused: whatever byte of it changes, wherever it
// ends, and for any rendering but its own.
#include "runtime/render/passes/Checkpoint.h"
#include "runtime/render/Crc64.h"
#include "support/AtomicFile.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sys/file.h>
#include <unistd.h>

using namespace rtsl;
using namespace rtsl::runtime;

namespace {

constexpr std::uint64_t pixels = 3;
constexpr std::uint32_t components = 2;

Identity identity() {
  return {"rtslc 1.2.3", {{"the seed", "7", false}, {"`Clay.rtsl`", "00ff", true}}};
}

PartialRendering rendering() {
  PartialRendering made;
  made.state.seconds = 1.5;
  made.state.error = 0.25;
  made.sums = PixelSums::make(pixels, components);
  made.sums.colors = {0.1, 1e-300, -3, 4, 5, 1e300};
  made.sums.squares = {1, 2, 3};
  made.sums.counted = {4, 3, 0};
  made.sums.taken = {4, 5, 0};
  made.met.badRays = 10;
  made.met.raysTooDeep = 11;
  made.met.exceptions[RTSL_EXCEPTION_INDEX] = 12;
  made.met.notFinite = {{1, 0, 2}, {1, 0, 4}};
  return made;
}

/// A file in a folder that goes away.
class Checkpoint : public testing::Test {
protected:
  void SetUp() override {
    char name[] = "/tmp/checkpoint-XXXXXX";
    folder = mkdtemp(name);
    file = folder / "a.ckpt";
    writeCheckpoint(file, identity(), rendering());
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string refusal(const std::string &bytes, const Identity &ours = identity()) {
    try {
      parseCheckpoint(bytes, "a.ckpt", ours, pixels, components);
    } catch (const Error &error) {
      EXPECT_EQ(error.code, ErrorCode::BadCheckpoint);
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder, file;
};

/// Makes the checksum right again.
std::string signedAnew(std::string bytes) {
  std::memset(&bytes[24], 0, 8);
  const std::uint64_t checksum = crc64(bytes);
  std::memcpy(&bytes[24], &checksum, 8);
  return bytes;
}

} // namespace

TEST_F(Checkpoint, IsReadAsItWasWritten) {
  const PartialRendering read =
      parseCheckpoint(readFile(file), file, identity(), pixels, components);
  const PartialRendering written = rendering();
  EXPECT_EQ(read.state.seconds, written.state.seconds);
  EXPECT_EQ(read.state.error, written.state.error);
  EXPECT_EQ(read.sums.colors, written.sums.colors);
  EXPECT_EQ(read.sums.squares, written.sums.squares);
  EXPECT_EQ(read.sums.counted, written.sums.counted);
  EXPECT_EQ(read.sums.taken, written.sums.taken);
  EXPECT_FALSE(read.sums.isAdaptive());
  EXPECT_EQ(read.met.badRays, 10u);
  EXPECT_EQ(read.met.raysTooDeep, 11u);
  EXPECT_EQ(read.met.exceptions[RTSL_EXCEPTION_INDEX], 12u);
  ASSERT_EQ(read.met.notFinite.size(), 2u);
  EXPECT_EQ(read.met.notFinite[1].sample, 4u);
}

TEST_F(Checkpoint, HasAllOfAnAdaptiveRendering) {
  PartialRendering written = rendering();
  written.sums = PixelSums::make(pixels, components, true);
  for (std::size_t i = 0; i < written.sums.colors.size(); ++i)
    written.sums.colors[i] = double(i) / 3;
  written.sums.squares = {1, 2, 3, 4, 5, 6};
  written.sums.values = {7, 8, 9, 10, 11, 12};
  written.sums.counted = {1, 2, 3, 3, 5, 5};
  written.sums.deciding = {2, 2, 3, 3, 4, 5};
  written.sums.taken = {4, 6, 10};
  written.sums.closed = {0, 3, 2};
  writeCheckpoint(file, identity(), written);
  const PartialRendering read =
      parseCheckpoint(readFile(file), file, identity(), pixels, components, true);
  EXPECT_EQ(read.sums.colors, written.sums.colors);
  EXPECT_EQ(read.sums.squares, written.sums.squares);
  EXPECT_EQ(read.sums.values, written.sums.values);
  EXPECT_EQ(read.sums.counted, written.sums.counted);
  EXPECT_EQ(read.sums.deciding, written.sums.deciding);
  EXPECT_EQ(read.sums.taken, written.sums.taken);
  EXPECT_EQ(read.sums.closed, written.sums.closed);
  EXPECT_NE(refusal(readFile(file)), ""); // as one that is not adaptive
}

TEST_F(Checkpoint, IsRefusedWhateverByteChanges) {
  const std::string bytes = readFile(file);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = char(changed[i] ^ 0x10);
    EXPECT_NE(refusal(changed), "") << "byte " << i;
  }
}

TEST_F(Checkpoint, IsRefusedWhereverItEnds) {
  const std::string bytes = readFile(file);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string said = refusal(bytes.substr(0, size));
    EXPECT_NE(said.find(size < 8 ? "it is not a checkpoint" : "it is truncated"), std::string::npos)
        << size << ": " << said;
  }
  EXPECT_NE(refusal(bytes + "x").find("1 bytes follow its end"), std::string::npos);
}

TEST_F(Checkpoint, IsRefusedIfItsNumbersMakeNoSense) {
  const std::string bytes = readFile(file);
  const auto with = [&](std::size_t at, std::uint32_t word) {
    std::string changed = bytes;
    std::memcpy(&changed[at], &word, sizeof word);
    return signedAnew(changed);
  };
  EXPECT_EQ(refusal(signedAnew(bytes)), "");
  const std::string damaged = "cannot resume from `a.ckpt`: it is damaged";
  EXPECT_EQ(refusal(with(12, 0xffffffffu)), damaged); // bytes of facts
  EXPECT_EQ(refusal(with(12, 8)), damaged);
  EXPECT_EQ(refusal(with(68, 0xfffffff0u)), damaged);              // length of a text
  EXPECT_EQ(refusal(with(bytes.size() - 4 * pixels, 3)), damaged); // 3 taken, 4 counted
}

TEST_F(Checkpoint, SaysHowTheRenderingsDiffer) {
  const std::string bytes = readFile(file);
  Identity other = identity();
  other.producer = "rtslc 1.2.4";
  EXPECT_EQ(refusal(bytes, other),
            "cannot resume from `a.ckpt`: it was written by rtslc 1.2.3, and this is rtslc 1.2.4");
  other = identity();
  other.dependences[0].value = "8";
  EXPECT_EQ(refusal(bytes, other), "cannot resume from `a.ckpt`: the seed is 7 there and 8 here");
  other = identity();
  other.dependences[1].value = "00fe";
  EXPECT_EQ(refusal(bytes, other),
            "cannot resume from `a.ckpt`: `Clay.rtsl` has changed since it was written");
  other.dependences.pop_back();
  EXPECT_EQ(refusal(bytes, other), "cannot resume from `a.ckpt`: its picture depends on "
                                   "`Clay.rtsl`, where this one depends on nothing");
  std::string producer = bytes; // whose bytes may be checked in another way
  producer[32 + 10] = '7';
  EXPECT_EQ(refusal(producer),
            "cannot resume from `a.ckpt`: it was written by rtslc 1.2.7, and this is rtslc 1.2.3");
  producer[32 + 10] = 'x';
  EXPECT_EQ(refusal(producer), "cannot resume from `a.ckpt`: it is damaged");
  std::string version = bytes;
  version[8] = 9;
  EXPECT_EQ(refusal(signedAnew(version)), "cannot resume from `a.ckpt`: it is a checkpoint of "
                                          "format 9, and this program has format 2");
}

TEST_F(Checkpoint, LeavesNothingBehindOfThoseThatWereKilled) {
  const auto create = [&](const char *name) {
    std::ofstream(folder / name) << "half";
    return folder / name;
  };
  const auto left = create(".a.ckpt.123-0.tmp"), used = create(".a.ckpt.124-0.tmp"),
             another = create(".b.ckpt.123-0.tmp"), similar = create(".a.ckpt.123-0");
  const int lock = ::open(used.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  removeUnfinishedFiles(file);
  EXPECT_FALSE(std::filesystem::exists(left));
  for (const auto &path : {used, another, similar, file})
    EXPECT_TRUE(std::filesystem::exists(path)) << path;
  ::close(lock);
}
