//===- SourceTest.cpp - texts and positions in them -----------------------===//
#include "frontend/source/Source.h"
#include "frontend/source/Utf8.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <unistd.h>

namespace rtsl {
namespace {

TEST(Source, LinesAndColumnsCountFromOneAndInBytes) {
  SourceManager sources;
  const FileId file = sources.add("a.rtsl", "ab\n\xC3\xA9x\n\nlast");
  const auto at = [&](std::uint32_t offset) {
    const LineColumn place = sources.lineColumn(file, offset);
    return std::make_pair(place.line, place.column);
  };
  EXPECT_EQ(at(0), std::make_pair(1u, 1u));
  EXPECT_EQ(at(2), std::make_pair(1u, 3u)); // the line ending belongs to its line
  EXPECT_EQ(at(3), std::make_pair(2u, 1u));
  EXPECT_EQ(at(5), std::make_pair(2u, 3u)); // after the two bytes of e acute
  EXPECT_EQ(at(7), std::make_pair(3u, 1u));
  EXPECT_EQ(at(12), std::make_pair(4u, 5u));    // the end
  EXPECT_EQ(at(10000), std::make_pair(4u, 5u)); // clamped to it
}

TEST(Source, LinesComeWithoutTheirEnding) {
  SourceManager sources;
  const FileId file = sources.add("a.rtsl", "one\r\n\ntwo\nthree");
  EXPECT_EQ(sources.line(file, 1), "one");
  EXPECT_EQ(sources.line(file, 2), "");
  EXPECT_EQ(sources.line(file, 3), "two");
  EXPECT_EQ(sources.line(file, 4), "three");
  EXPECT_EQ(sources.line(file, 5), "");
  EXPECT_EQ(sources.line(file, 0), "");
}

TEST(Source, TextsStayWhereTheyAre) {
  SourceManager sources;
  const FileId first = sources.add("first", "text of the first");
  const std::string_view text = sources.text(first);
  for (int i = 0; i < 1000; ++i)
    sources.add("other", "x");
  EXPECT_EQ(text.data(), sources.text(first).data());
  EXPECT_EQ(text, "text of the first");
  EXPECT_EQ(sources.name(first), "first");
}

TEST(Source, RangesAreClampedToTheText) {
  SourceManager sources;
  const FileId file = sources.add("a", "abc");
  EXPECT_EQ(sources.text({file, 1, 3}), "bc");
  EXPECT_EQ(sources.text({file, 2, 100}), "c");
  EXPECT_EQ(sources.text({file, 50, 60}), "");
}

TEST(Source, AMissingFileHasAReason) {
  SourceManager sources;
  std::string whyNot;
  EXPECT_FALSE(sources.addFile("/nonexistent/a.rtsl", whyNot));
  EXPECT_EQ(whyNot, "No such file or directory");
}

TEST(Source, ADirectoryIsNoFile) {
  SourceManager sources;
  std::string whyNot;
  EXPECT_FALSE(sources.addFile(std::filesystem::temp_directory_path().string(), whyNot));
  EXPECT_EQ(whyNot, "Is a directory");
}

TEST(Source, AFileIsReadAsItIs) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("rtsl-source-test-" + std::to_string(getpid()));
  const std::string text = std::string("a\0b\r\n", 5) + std::string(200000, 'x');
  std::FILE *out = std::fopen(path.c_str(), "wb");
  ASSERT_NE(out, nullptr);
  std::fwrite(text.data(), 1, text.size(), out);
  std::fclose(out);
  SourceManager sources;
  std::string whyNot;
  const std::optional<FileId> file = sources.addFile(path.string(), whyNot);
  std::filesystem::remove(path);
  ASSERT_TRUE(file) << whyNot;
  EXPECT_TRUE(sources.text(*file) == text);
  EXPECT_EQ(sources.name(*file), path.string());
}

TEST(Utf8, DecodesAndRefusesWhatTheStandardRefuses) {
  EXPECT_EQ(decodeUtf8("a").codePoint, U'a');
  EXPECT_EQ(decodeUtf8("\xE2\x82\xAC").codePoint, U'\u20AC');
  EXPECT_EQ(decodeUtf8("\xF0\x9F\x98\x80").size, 4u);
  for (const char *bad : {"\x80", "\xC0\x80", "\xC3", "\xE0\x80\x80", "\xED\xA0\x80",
                          "\xF4\x90\x80\x80", "\xFF", "\xE2\x82"}) {
    EXPECT_FALSE(decodeUtf8(bad).isValid) << static_cast<int>(static_cast<unsigned char>(bad[0]));
    EXPECT_EQ(findInvalidUtf8(std::string("ok") + bad), 2u);
  }
  EXPECT_EQ(findInvalidUtf8("\xE2\x82\xAC fine"), std::string_view::npos);
}

} // namespace
} // namespace rtsl
