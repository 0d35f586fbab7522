//===- ImageClaimTest.cpp -------------------------------------------------===//
#include "tests/unit/support/Files.h"

#include "runtime/image/Image.h"
#include "runtime/image/ImageClaim.h"
#include "support/AtomicFile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

using namespace rtsl;
using namespace rtsl::runtime;
using rtsl::test::errorOf;
using rtsl::test::Files;

namespace {

ImageClaim claimOf(const char *format, const char *compression, std::uint64_t width,
                   std::uint64_t height, std::uint64_t channels, std::uint64_t channelBytes) {
  ImageClaim claim;
  claim.format = format;
  claim.compression = compression;
  claim.width = width;
  claim.height = height;
  claim.channels = channels;
  claim.pixelBytes = channels * channelBytes;
  return claim;
}

} // namespace

// The sizes are those of files that OpenImageIO wrote, of 16384 x 16384 black pixels.
TEST(ImageClaim, BlackImagesAreHeld) {
  constexpr std::uint64_t side = 16384;
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "dwab", side, side, 3, 4), 96641), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "dwab", side, side, 4, 4), 114707), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "dwaa", side, side, 4, 4), 200083), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "pxr24", side, side, 3, 4), 2381151), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "piz", side, side, 3, 4), 7888223), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "zip", side, side, 3, 4), 3161439), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("png", "", side, side, 3, 1), 783966), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("tiff", "zip", side, side, 3, 1), 796374), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("tiff", "lzw", side, side, 3, 1), 1189590), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("jpeg", "", side, side, 3, 1), 4194957), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("hdr", "", side, side, 3, 4), 17104949), "");
  // 4096 x 4096.
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "rle", 4096, 4096, 3, 4), 3219807), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "zips", 4096, 4096, 3, 4), 356703), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "b44", 4096, 4096, 3, 2), 44042591), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "b44a", 4096, 4096, 3, 2), 9439583), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("tiff", "packbits", 4096, 4096, 3, 1), 787658), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("gif", "", 4096, 4096, 4, 1), 14378), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("targa", "rle", 4096, 4096, 3, 1), 524827), "");
}

TEST(ImageClaim, ThinImagesAreHeld) {
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "none", 1, 16384, 3, 4), 16384 * 12 + 400), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "zip", 16384, 1, 3, 4), 600), "");
}

TEST(ImageClaim, MoreThanTheFileCanHold) {
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "none", 1073741826, 1, 3, 4), 393),
            "it claims 1073741826 x 1 pixels of 3 channels, 12.0 GiB, but a file of 393 bytes "
            "(openexr none) has 393 bytes of pixels at most");
  // Channels that are decoded, and not read.
  EXPECT_EQ(whyFileTooSmall(claimOf("openexr", "zip", 1000, 1000, 1000, 4), 3000000),
            "it claims 1000 x 1000 pixels of 1000 channels, 3.7 GiB, but a file of 3000000 bytes "
            "(openexr zip) has 2.9 GiB of pixels at most");
  // Products that overflow integers.
  const std::uint64_t most = 0x7fffffff;
  EXPECT_NE(whyFileTooSmall(claimOf("tiff", "zip", most, most, 65535, 8), 1000), "");
}

TEST(ImageClaim, Tiles) {
  ImageClaim claim = claimOf("openexr", "zip", 10, 10, 4, 4);
  claim.tileWidth = claim.tileHeight = 1024; // a small image has one large tile
  EXPECT_EQ(whyFileTooSmall(claim, 700), "");
  claim.tileHeight = std::uint64_t(1) << 20;
  EXPECT_EQ(whyFileTooSmall(claim, 700),
            "it claims tiles of 1024 x 1048576 x 1 pixels, 16.0 GiB in a row of them, but a file "
            "of 700 bytes (openexr zip) has 705.5 KiB of pixels at most");
}

TEST(ImageClaim, BitsAndIndicesBecomeMoreBytes) {
  ImageClaim bits = claimOf("tiff", "none", 1000, 1000, 1, 1);
  EXPECT_NE(whyFileTooSmall(bits, 125000), "");
  bits.bitsPerSample = 1;
  EXPECT_EQ(whyFileTooSmall(bits, 125000), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("tiff", "ccittfax4", 16384, 16384, 1, 1), 2300), "");
  EXPECT_EQ(whyFileTooSmall(claimOf("jpeg2000", "", 16384, 16384, 3, 1), 400), "");
}

TEST(ImageClaim, MemoryToRead) {
  ImageClaim claim = claimOf("openexr", "zip", 100, 50, 10, 4);
  EXPECT_EQ(memoryToRead(claim, 16), 100.0 * 50 * 16 + 100.0 * 50 * 40);
  claim.tileWidth = claim.tileHeight = 64;
  EXPECT_EQ(memoryToRead(claim, 16), 100.0 * 50 * 16 + 128 * 64 * 40);
  claim = claimOf("tiff", "none", 10000, 10000, 4, 2);
  EXPECT_EQ(memoryToRead(claim, 8), 1e8 * 8 + (1 << 26));
  claim = claimOf("tiff", "none", 1000000, 1000, 4, 2); // very wide
  EXPECT_EQ(memoryToRead(claim, 8), 1e9 * 8 + 1e6 * 256 * 8);
}

TEST(ImageClaim, UserDataOfDpx) {
  std::array<unsigned char, startBytes> start = {'S', 'D', 'P', 'X'};
  start[33] = 1;
  EXPECT_EQ(whyStartWrong(start, 65536), "");
  EXPECT_EQ(whyStartWrong(start, 65535),
            "it claims 64.0 KiB of user data, but the file has 65535 bytes");
  std::copy_n("XPDS", 4, start.begin());
  EXPECT_EQ(whyStartWrong(start, 256), "");
  EXPECT_EQ(whyStartWrong(start, 255),
            "it claims 256 bytes of user data, but the file has 255 bytes");
  start[32] = start[33] = start[34] = start[35] = 0xff; // none
  EXPECT_EQ(whyStartWrong(start, 100), "");
  EXPECT_EQ(whyStartWrong({}, 0), "");
}

using Claims = Files;

TEST_F(Claims, PicturesInExr) {
  writeImage(path("a.exr"), Image(2, 2, 3));
  std::string bytes = readFile(path("a.exr"));
  const std::size_t window = bytes.find("dataWindow") + sizeof "dataWindow" + sizeof "box2i" + 4;
  bytes.replace(window + 8, 4, std::string("\xff\xff\x0f\0", 4)); // 2^20 pixels
  put("b.exr", bytes);
  const std::string error = errorOf([&] { readImage(path("b.exr")); });
  EXPECT_NE(error.find("it claims 1048576 x 2 pixels of 3 channels, 24.0 MiB, but a file of "),
            std::string::npos)
      << error;
}
