//===- PlyColumnsTest.cpp - numbers in PLY files --------------------------===//
#include "ErrorText.h"
#include "Folder.h"

#include "runtime/buffers/PlyColumns.h"
#include "scenefile/files/BufferFiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::scene;
using namespace rtsl::scene::test;

namespace {

using Numbers = std::vector<double>;
using Sizes = std::vector<std::size_t>;

/// Every type by one of its two names, lists, and elements before and after them.
constexpr const char *declarations = "comment of no meaning\n"
                                     "element camera 1\n"
                                     "property float focus\n"
                                     "property list uchar short frames\n"
                                     "element vertex 2\n"
                                     "property char a\n"
                                     "property uint8 b\n"
                                     "property int16 c\n"
                                     "property list ushort double weights\n"
                                     "property ushort d\n"
                                     "property int e\n"
                                     "property uint32 f\n"
                                     "property float32 g\n"
                                     "property double h\n"
                                     "element face 1\n"
                                     "property list uchar int vertex_indices\n"
                                     "end_header\n";

std::string header(const std::string &format, const std::string &rest = declarations) {
  return "ply\nformat " + format + " 1.0\n" + rest;
}

std::string text() {
  return header("ascii") + "0.5 3 1 2 3\n"
                           "-128 255 -32768 2 0.5 0.25 65535 -2147483648 4294967295 0.5 1e300\n"
                           "127 0 32767 0 0 2147483647 0 -1.5 -0.1\n"
                           "3 0 1 1\n";
}

/// The same numbers in binary.
class Binary {
public:
  explicit Binary(bool isBig) : isBig(isBig) {}

  template <typename Number>
  Binary &put(Number number) {
    char data[sizeof number];
    std::memcpy(data, &number, sizeof number);
    for (std::size_t i = 0; i < sizeof number; ++i)
      bytes += data[isBig ? sizeof number - 1 - i : i];
    return *this;
  }

  static std::string file(bool isBig) {
    using Byte = std::uint8_t;
    Binary all(isBig);
    all.put(0.5f).put(Byte(3));
    all.put(std::int16_t(1)).put(std::int16_t(2)).put(std::int16_t(3));
    all.put(std::int8_t(-128)).put(Byte(255)).put(std::int16_t(-32768));
    all.put(std::uint16_t(2)).put(0.5).put(0.25);
    all.put(std::uint16_t(65535)).put(std::numeric_limits<std::int32_t>::min());
    all.put(std::numeric_limits<std::uint32_t>::max()).put(0.5f).put(1e300);
    all.put(std::int8_t(127)).put(Byte(0)).put(std::int16_t(32767)).put(std::uint16_t(0));
    all.put(std::uint16_t(0)).put(std::numeric_limits<std::int32_t>::max());
    all.put(std::uint32_t(0)).put(-1.5f).put(-0.1);
    all.put(Byte(3)).put(std::int32_t(0)).put(std::int32_t(1)).put(std::int32_t(1));
    return header(isBig ? "binary_big_endian" : "binary_little_endian") + all.bytes;
  }

  std::string bytes;

private:
  bool isBig;
};

class PlyColumns : public testing::Test {
protected:
  std::string put(const std::string &bytes) const {
    folder.write("p.ply", bytes);
    return folder.path + "/p.ply";
  }

  NumberArray read(const std::string &bytes, const std::vector<std::string> &columns = {},
                   const std::string &element = "vertex") const {
    return readPly(put(bytes), element, columns);
  }

  std::string error(const std::string &bytes, const std::vector<std::string> &columns = {},
                    const std::string &element = "vertex") const {
    return folder.without(errorOf([&] { read(bytes, columns, element); }));
  }

  Folder folder;
};

} // namespace

TEST_F(PlyColumns, AllTypesInTextAndBothByteOrders) {
  const Numbers expected = {-128,       255,   -32768, 65535, -2147483648.0, 4294967295.0,
                            0.5,        1e300, 127,    0,     32767,         0,
                            2147483647, 0,     -1.5,   -0.1};
  for (const std::string &file : {text(), Binary::file(false), Binary::file(true)}) {
    const NumberArray all = read(file);
    EXPECT_EQ(all.shape, (Sizes{2, 8}));
    EXPECT_EQ(all.numbers, expected);
    const NumberArray chosen = read(file, {"h", "a", "e", "a"});
    EXPECT_EQ(chosen.shape, (Sizes{2, 4}));
    EXPECT_EQ(chosen.numbers,
              (Numbers{1e300, -128, -2147483648.0, -128, -0.1, 127, 2147483647, 127}));
    EXPECT_EQ(read(file, {"d"}).shape, Sizes{2});
    EXPECT_EQ(read(file, {}, "camera").numbers, Numbers{0.5});
    EXPECT_EQ(plyCount(put(file), "vertex"), 2u);
    EXPECT_EQ(plyCount(put(file), "face"), 1u);
  }
}

TEST_F(PlyColumns, LinesThatEndAsOnWindows) {
  std::string file;
  for (const char c : text())
    file += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read(file, {"a", "b"}).numbers, (Numbers{-128, 255, 127, 0}));
}

TEST_F(PlyColumns, FloatsMayBeInfiniteOrNaN) {
  const std::string declared = "element vertex 2\nproperty float x\nend_header\n";
  const NumberArray array = read(header("ascii", declared) + "inf nan");
  EXPECT_EQ(array.numbers[0], std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(array.numbers[1]));
}

TEST_F(PlyColumns, NoElements) {
  const std::string file =
      header("ascii", "element vertex 0\nproperty float x\nproperty float y\nend_header\n");
  EXPECT_EQ(read(file).shape, (Sizes{0, 2}));
  EXPECT_EQ(read(file, {"y"}).shape, Sizes{0});
}

TEST_F(PlyColumns, NamesThatAreNotThere) {
  EXPECT_EQ(error(text(), {}, "vertx"), "unknownName: `p.ply` has no element `vertx`; it has "
                                        "`camera`, `vertex`, `face`; did you mean `vertex`?");
  EXPECT_EQ(error(header("ascii", "end_header\n")),
            "unknownName: `p.ply` has no element `vertex`; it has none");
  EXPECT_EQ(error(text(), {"a", "z"}), "unknownName: element `vertex` of `p.ply` has no column "
                                       "`z`; it has `a`, `b`, `c`, `d`, `e`, `f`, `g`, `h`");
  EXPECT_EQ(error(text(), {"focs"}, "camera"),
            "unknownName: element `camera` of `p.ply` has no column `focs`; it has `focus`; did "
            "you mean `focus`?");
  EXPECT_EQ(error(text(), {"weights"}), "notSupported: column `weights` of element `vertex` of "
                                        "`p.ply` is a list; only numbers can be read");
  EXPECT_EQ(error(text(), {}, "face"),
            "badBuffer: cannot read `p.ply`: its element `face` has no numbers that are not in "
            "lists");
}

TEST_F(PlyColumns, FilesThatEndTooEarly) {
  for (const std::string &file : {text(), Binary::file(false), Binary::file(true)}) {
    const std::size_t start = file.find("end_header\n") + 11;
    const bool isText = file == text();
    const auto after = [&](std::size_t length) { return length + (length < start ? 37 : 1); };
    for (std::size_t length = 0; length + isText < file.size(); length = after(length)) {
      const std::string message = error(file.substr(0, length), {"a"});
      ASSERT_EQ(message.substr(0, 32), "badBuffer: cannot read `p.ply`: ") << length;
      if (length >= start && !isText) {
        EXPECT_NE(message.find("it is truncated or damaged in element"), std::string::npos);
      }
    }
  }
  EXPECT_EQ(error(Binary::file(true).substr(0, Binary::file(true).size() - 20)),
            "badBuffer: cannot read `p.ply`: it is truncated or damaged in element 2 of 2 of "
            "`vertex`");
  const std::string many = "element vertex 18446744073709551615\nproperty float x\nend_header\n";
  EXPECT_EQ(error(header("ascii", many) + "1 2"),
            "badBuffer: cannot read `p.ply`: it is truncated or damaged in element 3 of "
            "18446744073709551615 of `vertex`");
}

TEST_F(PlyColumns, DamagedFiles) {
  EXPECT_EQ(error(""), "badBuffer: cannot read `p.ply`: it is not a .ply file");
  EXPECT_EQ(error("plywood\n"), "badBuffer: cannot read `p.ply`: it is not a .ply file");
  const auto inHeader = [&](const std::string &lines) {
    return error("ply\nformat ascii 1.0\n" + lines + "end_header\n1\n");
  };
  const std::string third = "badBuffer: cannot read `p.ply`: its header is damaged or truncated in "
                            "line 3";
  EXPECT_EQ(inHeader("property float x\n"), third); // of no element
  EXPECT_EQ(inHeader("element vertex many\n"), third);
  EXPECT_EQ(inHeader("format middle_endian 1.0\n"), third);
  EXPECT_EQ(inHeader("element vertex 1\nproperty quad x\n"),
            "badBuffer: cannot read `p.ply`: its header is damaged or truncated in line 4");
  const std::string x = "element vertex 1\nproperty float x\n";
  EXPECT_EQ(inHeader(x), "no error");
  EXPECT_EQ(inHeader(x + "property uchar y\n"), "badBuffer: cannot read `p.ply`: it is truncated "
                                                "or damaged in element 1 of 1 of `vertex`");
  const auto inBody = [&](const std::string &body) {
    return error(header("ascii", "element vertex 2\nproperty float x\nproperty uchar y\n"
                                 "element face 1\nproperty list uchar int corners\nend_header\n") +
                 body);
  };
  EXPECT_EQ(inBody("1 2\n3 4\n2 0 0\n"), "no error");
  const std::string cannot = "badBuffer: cannot read `p.ply`: ";
  EXPECT_EQ(inBody("1 2\nfish 4\n2 0 0\n"),
            cannot + "`fish` in line 10 is not a valid value of `x` of `vertex`");
  for (const char *const value : {"256", "-1", "1.5", "nan", "4x"})
    EXPECT_EQ(inBody(std::string("1 2\n3 ") + value + "\n2 0 0\n"),
              cannot + "`" + value + "` in line 10 is not a valid value of `y` of `vertex`");
  EXPECT_EQ(inBody("1 2\n3 4\n-2 0 0\n"),
            cannot + "`-2` in line 11 is not a valid value of `corners` of `face`");
  EXPECT_EQ(inBody("1 2\n3 4\n2 0 0\n5\n"), cannot + "it is longer than its header declares");
  EXPECT_EQ(error(Binary::file(false) + "\n"), "no error");
  EXPECT_EQ(error(Binary::file(false) + "x"), cannot + "it is longer than its header declares");
}

TEST_F(PlyColumns, KeysOfBuffers) {
  const auto description = [&](const std::string &json) {
    const JsonValue value = parseJson(json, "s.json");
    return readBufferDescription(value, [](const JsonValue &path) { return path.string; });
  };
  EXPECT_EQ(description(R"({"buffer": "p.ply"})").element, "vertex");
  const BufferDescription cones =
      description(R"({"buffer": "p.ply", "element": "cone", "columns": ["x", "y"]})");
  EXPECT_EQ(cones.element, "cone");
  EXPECT_EQ(cones.columns, (std::vector<std::string>{"x", "y"}));
  const auto error = [&](const std::string &json) { return errorOf([&] { description(json); }); };
  EXPECT_EQ(error(R"({"buffer": "p.csv", "element": "vertex"})"),
            "s.json:1:22+7: unknownKey: `element` is for .ply files");
  EXPECT_EQ(error(R"({"buffer": "p.npy", "columns": ["x"]})"),
            "s.json:1:22+7: unknownKey: `columns` is for .csv and .ply files");
  for (const char *const file : {"p.npy", "p.csv", "p.ply"})
    EXPECT_EQ(error(std::string(R"({"buffer": ")") + file + R"(", "shape": [2]})"),
              "s.json:1:22+5: unknownKey: `shape` is for files without a format");
  EXPECT_EQ(description(R"({"buffer": "p.raw", "shape": [2]})").shape.size(), 1u);
  EXPECT_EQ(error(R"({"buffer": "p.ply", "element": 3})"),
            "s.json:1:32+1: wrongType: `element` is a string, not a number");
}
