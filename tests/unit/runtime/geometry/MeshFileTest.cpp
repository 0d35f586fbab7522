#include "tests/unit/support/Files.h"

#include "runtime/geometry/AssimpFile.h"
#include "runtime/geometry/Mesh.h"
#include "runtime/geometry/ObjFile.h"
#include "runtime/geometry/PlyFile.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

using namespace rtsl;
using namespace rtsl::runtime;
using rtsl::test::errorOf;
using rtsl::test::Files;
namespace fs = std::filesystem;

using Meshes = Files;

namespace {

const char *plyHeader = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                        "y\nproperty float z\n"
                        "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 "
                        "0\n1 0 0\n0 1 0\n1 1 0\n";

} // namespace

TEST_F(Meshes, ReadsObjWithPolygonsNormalsAndUvs) {
  Mesh mesh = loadMesh(
      put("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                   "f 1/1/1 2/2/1 3/3/1 4/4/1\n"));
  EXPECT_EQ(mesh.triangleCount(), 2u);
  ASSERT_EQ(mesh.normals.size(), 3 * mesh.vertexCount());
  ASSERT_EQ(mesh.uvs.size(), 2 * mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    EXPECT_EQ(mesh.normals[3 * i + 2], 1);
    EXPECT_EQ(mesh.uvs[2 * i], mesh.positions[3 * i]);
    EXPECT_EQ(mesh.uvs[2 * i + 1], mesh.positions[3 * i + 1]);
  }
}

TEST_F(Meshes, AnObjFileMayBeginWithAByteOrderMark) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(loadMesh(put("a.obj", "\xEF\xBB\xBF" + text)).positions,
            loadMesh(put("b.obj", text)).positions);
}

TEST_F(Meshes, ReadsPlyAndGltf) {
  EXPECT_EQ(loadMesh(put("a.ply", std::string(plyHeader) + "3 0 1 2\n3 1 2 3\n")).triangleCount(),
            2u);
  // One triangle in a buffer, under a node that moves it.
  Mesh mesh = loadMesh(
      put("a.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "translation": [5, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"));
  ASSERT_EQ(mesh.triangleCount(), 1u);
  EXPECT_EQ(mesh.positions[0], 5);
}

/// The numbers of an attribute; empty if the mesh does not have it.
static std::vector<float> numbersOf(const Mesh &mesh, const std::string &name) {
  for (const NamedAttribute &attribute : mesh.attributes)
    if (attribute.name == name) {
      std::vector<float> numbers(attribute.words.size());
      std::memcpy(numbers.data(), attribute.words.data(), 4 * numbers.size());
      return numbers;
    }
  return {};
}

TEST_F(Meshes, ReadTheAttributesThatAreRequested) {
  const std::string ply =
      put("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                   "property float z\nproperty uchar green\nproperty uchar red\nproperty uchar "
                   "blue\nproperty float uv1_v\nproperty float uv1_u\nproperty int wear\n"
                   "element face 1\nproperty list uchar int vertex_indices\nproperty int part\n"
                   "end_header\n0 0 0 0 255 51 1 2 3\n1 0 0 0 0 0 0 0 0\n1 1 0 0 0 0 0 0 -4\n"
                   "0 1 0 0 0 0 0 0 0\n4 0 1 2 3 7\n");
  const Mesh mesh = loadMesh(ply, {{"color", "uv1", "wear", "part", "none"}, true});
  EXPECT_EQ(numbersOf(mesh, "color")[0], 1.0f);
  EXPECT_EQ(numbersOf(mesh, "color")[2], 0.2f);
  EXPECT_EQ(numbersOf(mesh, "uv1")[0], 2.0f);
  EXPECT_EQ(numbersOf(mesh, "wear")[2], -4.0f);
  EXPECT_TRUE(numbersOf(mesh, "none").empty());
  ASSERT_EQ(mesh.attributes.back().name, "part");
  EXPECT_EQ(mesh.attributes.back().words, (std::vector<std::uint32_t>{7, 7})) << "two triangles";
  EXPECT_EQ(mesh.order.faces, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(loadMesh(ply).attributes.size(), 0u);
  EXPECT_EQ(loadMesh(ply).otherAttributes,
            (std::vector<std::string>{"color", "uv1", "wear", "part"}));

  // The corners of the two faces have texture coordinates of their own.
  const Mesh obj =
      loadMesh(put("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nvt 0 0\nvt 1 1\n"
                            "f 3/1 1/1 2/1\nf 1/2 2/2 3/2\n"),
               {{"color"}, true});
  EXPECT_EQ(obj.order.vertices, (std::vector<std::uint32_t>{2, 0, 1, 0, 1, 2}));
  EXPECT_EQ(numbersOf(obj, "color")[2], 1.0f);
  EXPECT_EQ(numbersOf(obj, "color")[3], 1.0f);
}

TEST_F(Meshes, BadFilesAreRefusedByName) {
  auto error = [&](const std::string &name, const std::string &text) {
    std::string file = put(name, text), message = errorOf([&] { loadMesh(file); });
    std::size_t at = message.find(file);
    return at == std::string::npos ? message : message.replace(at, file.size(), name);
  };
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(error("empty.obj", ""), "badMesh: mesh `empty.obj` is empty");
  EXPECT_EQ(error("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
            "badMesh: mesh `points.obj` has no triangles");
  EXPECT_EQ(error("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
            "badMesh: mesh `nan.obj` has a vertex that is not finite: x of vertex 1 is nan");
  EXPECT_EQ(error("range.obj", triangle + "f 1 2 9\n").substr(0, 8), "badMesh:");
  EXPECT_EQ(error("range.ply", std::string(plyHeader) + "3 0 1 2\n3 0 1 7\n").substr(0, 8),
            "badMesh:");
  EXPECT_EQ(error("short.ply", std::string(plyHeader) + "3 0 1 2\n").substr(0, 8), "badMesh:");
  EXPECT_EQ(error("shorter.ply", std::string(plyHeader).substr(0, 200)).substr(0, 8), "badMesh:");
  EXPECT_EQ(
      error("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n"),
      "badMesh: mesh `far.obj` has a vertex too far out: x of vertex 1 is 1e+30, more than 1e+18");
  EXPECT_EQ(error("junk.gltf", "{\"asset\":").substr(0, 8), "badMesh:");
  EXPECT_EQ(error("a.xyzzy", "x"), "unsupportedFormat: cannot read mesh `a.xyzzy`: no reader for "
                                   "`.xyzzy` files; OBJ, PLY and glTF work");
  EXPECT_EQ(errorOf([&] { loadMesh(path("none.obj")); }),
            "fileNotFound: cannot read mesh `" + path("none.obj") + "`: No such file or directory");
  EXPECT_EQ(errorOf([&] { loadMesh(folder.string()); }),
            "fileUnreadable: cannot read mesh `" + folder.string() + "`: it is a folder");
}

/// assimp crashes, renders another mesh or aborts.
TEST_F(Meshes, DamageOfPlyIsFoundBeforeAssimpReadsIt) {
  auto damage = [](std::string text, const std::string &what = "",
                   const std::string &instead = "") {
    text.replace(text.find(what), what.size(), instead);
    const std::optional<Message> found = findPlyDamage(text, "a.ply");
    return found ? found->text : "";
  };
  const std::string header = plyHeader;
  const std::string good = header + "3 0 1 +2\n5 0 1 2 3 0\n";
  EXPECT_EQ(damage(good), "");
  EXPECT_EQ(damage(header + "3 0 1 2\n5 0 1 2 3 4\n"),
            "mesh `a.ply` is damaged: face 2 of 2 has the corner 4, and there are 4 vertices");
  EXPECT_EQ(damage(header + "3 0 1 2\n5 0 1 2 3 -1\n"),
            "mesh `a.ply` is damaged: face 2 of 2 has the corner -1, and there are 4 vertices");
  EXPECT_EQ(damage(header + "3 0 1 2\n0\n"), "mesh `a.ply` is damaged: face 2 of 2 has no corners");
  EXPECT_EQ(damage(header + "3 0 1 2\n5 0 1 2 3 x\n"),
            "mesh `a.ply` is damaged in element 2 of 2 of `face`: `x` is not a number of its type");
  EXPECT_EQ(damage(good, "1 0 0", "1 0.5x 0"), "mesh `a.ply` is damaged in element 2 of 4 of "
                                               "`vertex`: `0.5x` is not a number of its type");
  EXPECT_EQ(damage(good, "property float z", "propperty float z"),
            "mesh `a.ply` is damaged or truncated in line 6 of its header");
  EXPECT_EQ(damage(good, "element vertex 4", "element vertex -4"),
            "mesh `a.ply` is damaged or truncated in line 3 of its header");
  EXPECT_EQ(damage(good, "element face", "obj_info x\ncomment y\nelement face"), "");
  for (const char *axis : {"x", "y", "z"})
    EXPECT_EQ(damage(good, std::string(" ") + axis + "\n", " a\n"),
              std::string("mesh `a.ply` is damaged: its element `vertex` has no property `") +
                  axis + "`");
  EXPECT_EQ(damage(good, "vertex_indices", "corners"),
            "mesh `a.ply` is damaged: its element `face` has no property `vertex_indices`");

  // As floats, and in the other order
  const std::string binary = damage("ply\nformat binary_big_endian 1.0\nelement face 1\n"
                                    "property list uchar float vertex_index\nelement vertex 1\n"
                                    "property uchar x\nproperty uchar y\nproperty uchar z\n"
                                    "end_header\n\1\x3f\x80" +
                                    std::string(5, '\0'));
  EXPECT_EQ(binary,
            "mesh `a.ply` is damaged: face 1 of 1 has the corner 1, and there are 1 vertices");
}

TEST_F(Meshes, BinaryPlyThatEndsTooEarly) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float "
                       "x\nproperty float y\nproperty float z\n"
                       "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string body(reinterpret_cast<char *>(positions), sizeof positions);
  std::int32_t indices[3] = {0, 1, 2};
  std::string face =
      std::string(1, '\3') + std::string(reinterpret_cast<char *>(indices), sizeof indices);
  EXPECT_EQ(loadMesh(put("good.ply", header + body + face + face)).triangleCount(), 2u);
  for (std::size_t cut : {1u, 12u, 13u, 20u, 30u}) {
    std::string whole = header + body + face + face;
    EXPECT_EQ(errorOf([&] {
                loadMesh(put("cut.ply", whole.substr(0, whole.size() - cut)));
              }).substr(0, 8),
              "badMesh:")
        << cut;
  }
}

namespace {

/// Triangle by triangle, what stands at their corners: coordinates, normals and texture
/// coordinates.
std::vector<float> corners(const Mesh &mesh) {
  std::vector<float> values;
  auto append = [&](const std::vector<float> &from, std::size_t width, std::size_t vertex) {
    for (std::size_t i = 0; i < width && !from.empty(); ++i)
      values.push_back(from[width * vertex + i]);
  };
  for (std::uint32_t vertex : mesh.indices) {
    append(mesh.positions, 3, vertex);
    append(mesh.normals, 3, vertex);
    append(mesh.uvs, 2, vertex);
  }
  return values;
}

/// Numbers agree but for how they are rounded, which assimp does not do correctly.
void expectSame(const Mesh &plain, const Mesh &general) {
  const std::vector<float> a = corners(plain), b = corners(general);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_NEAR(a[i], b[i], 1e-6f * std::max(1.0f, std::fabs(b[i]))) << i;
}

/// A grid of quadrilaterals and triangles, some of them concave, in the notations that OBJ has.
std::string randomObj(std::mt19937 &random) {
  auto below = [&](int n) { return int(random() % unsigned(n)); };
  auto number = [&] { return fmt::format("{:.6g}", std::ldexp(double(random()) - 0x1p31, -28)); };
  const bool uvs = below(2), normals = below(2), relative = below(2);
  const int width = 2 + below(5), count = width * width;
  std::string text = "# a grid\r\nmtllib none.mtl\no grid\ns off\n\n";
  for (int i = 0; i < count; ++i) {
    text +=
        fmt::format("v  {} {}\t{:g}{}\n", i % width + 0.3 * below(3), i / width + 0.3 * below(3),
                    1e-4 * below(100), below(2) ? " 0.5 0.25 1" : "");
    if (uvs)
      text += fmt::format("vt {} {}{}\n", number(), number(), below(2) ? " 0" : "");
    if (normals)
      text += fmt::format("vn {} {} {}  \r\n", number(), number(), number());
  }
  auto corner = [&](int vertex) {
    auto index = [&](int i) { return relative ? i - count : i + 1; };
    std::string written = fmt::format("{}", index(vertex));
    if (uvs)
      written += fmt::format("/{}", index(below(count)));
    if (normals)
      written += fmt::format("{}{}", uvs ? "/" : "//", index(below(count)));
    return " " + written;
  };
  for (int y = 0; y + 1 < width; ++y)
    for (int x = 0; x + 1 < width; ++x) {
      const int first = y * width + x;
      if (below(9) == 0)
        text += "usemtl other\n";
      text += "f" + corner(first) + corner(first + 1) + corner(first + width + 1) +
              (below(2) ? corner(first + width) : "") + "\n";
    }
  return text;
}

} // namespace

TEST_F(Meshes, PlainObjIsWhatAssimpReads) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const std::string text = randomObj(random), file = put("plain.obj", text);
    const std::optional<Mesh> plain = readPlainObj(text);
    ASSERT_TRUE(plain) << text;
    ASSERT_NO_FATAL_FAILURE(expectSame(*plain, readByAssimp(file))) << text;
  }
}

namespace {

void expectEqual(const Mesh &a, const Mesh &b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.otherAttributes, b.otherAttributes);
  ASSERT_EQ(a.attributes.size(), b.attributes.size());
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    EXPECT_EQ(a.attributes[i].name, b.attributes[i].name);
    EXPECT_EQ(a.attributes[i].words, b.attributes[i].words);
  }
  EXPECT_EQ(a.order.vertices, b.order.vertices);
  EXPECT_EQ(a.order.faces, b.order.faces);
}

} // namespace

// Parts know what stands above them, by its number, and their vertices and materials go on.
TEST_F(Meshes, PartsOfAnObjFileAreReadAsAWhole) {
  std::mt19937 random(2);
  for (int i = 0; i < 30; ++i) {
    const std::string text = randomObj(random);
    const MeshRequest request{
        i % 2 == 0 ? std::vector<std::string>{"color"} : std::vector<std::string>{}, true};
    const std::optional<Mesh> whole = readPlainObj(text, request);
    const auto groups = readPlainObjGroups(text);
    ASSERT_TRUE(whole && groups);
    for (const std::size_t bytes : {std::size_t(1), text.size() / 7 + 1, text.size() - 1}) {
      const std::optional<Mesh> inParts = readPlainObj(text, request, bytes);
      ASSERT_TRUE(inParts) << bytes;
      ASSERT_NO_FATAL_FAILURE(expectEqual(*inParts, *whole)) << bytes << text;
      const auto groupsInParts = readPlainObjGroups(text, bytes);
      ASSERT_TRUE(groupsInParts && groupsInParts->size() == groups->size());
      for (std::size_t group = 0; group < groups->size(); ++group) {
        EXPECT_EQ((*groupsInParts)[group].material, (*groups)[group].material);
        expectEqual((*groupsInParts)[group].mesh, (*groups)[group].mesh);
      }
    }
    EXPECT_FALSE(readPlainObj(text + "f 1 2 999999\n", request, 100));
    EXPECT_FALSE(readPlainObj("f 1 2 3\n" + text, request, 100)) << "they stand below";
  }
}

TEST_F(Meshes, CornersThatAreEqualShareAVertex) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\n";
  EXPECT_EQ(readPlainObj(vertices + "f 1 2 3\nf 1 3 4\n")->vertexCount(), 4u);
  EXPECT_EQ(readPlainObj(vertices + "f 1//1 2//1 3//1\nf 1//2 3//1 4//1\n")->vertexCount(), 5u);
}

TEST_F(Meshes, WhatIsNotPlainIsLeftToAssimp) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0\n";
  ASSERT_TRUE(readPlainObj(vertices + "f 1 2 3\n"));
  for (const char *rest :
       {"f 1 2 3 4 5\n", "f 1 2 3 \\\n4\n", "v 1 1 1 2\nf 1 2 6\n", "f 1 2 3\nl 1 2\n"}) {
    EXPECT_FALSE(readPlainObj(vertices + rest)) << rest;
    EXPECT_GE(loadMesh(put("general.obj", vertices + rest)).triangleCount(), 1u) << rest;
  }
  for (const char *rest : {"", "f 1 2\n", "f 1 2 9\n", "f 1 2 0\n", "f 1 2 -9\n", "f 1 2 3/1\n",
                           "f 1 2 3//1\n", "f 1 2 x\n", "f 1 2 3/\n", "v 1 nan 1\nf 1 2 3\n",
                           "v 1 1\nf 1 2 3\n", "v 1 1e99 1\nf 1 2 3\n", "v 1 1 x\nf 1 2 3\n",
                           "vn 0 0\nf 1 2 3\n", "vt 0\nf 1 2 3\n", "nonsense\nf 1 2 3\n"})
    EXPECT_FALSE(readPlainObj(vertices + rest)) << rest;
}

TEST_F(Meshes, APipeIsReadOnce) {
  const std::string pipe = path("pipe.obj"), triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto read = [&](const std::string &text) {
    std::thread writer([&] { std::ofstream(pipe) << text; });
    const std::string message = errorOf([&] { EXPECT_EQ(loadMesh(pipe).triangleCount(), 1u); });
    writer.join();
    return message;
  };
  EXPECT_EQ(read(triangle), "no error");
  EXPECT_NE(read(triangle + "nonsense\n").find("from a pipe"), std::string::npos);
}

namespace {

/// The grid of quadrilaterals again, with properties that no mesh has, in one of PLY's formats.
std::string plyGrid(const char *format, bool normals, bool uvs) {
  const bool isText = std::string(format) == "ascii",
             isBig = std::string(format) == "binary_big_endian";
  std::string body;
  auto put = [&](auto value) {
    if (isText) {
      body += fmt::format("{} ", value);
      return;
    }
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (isBig)
      std::reverse(bytes, bytes + sizeof value);
    body.append(bytes, sizeof value);
  };
  std::string header =
      fmt::format("ply\nformat {} 1.0\ncomment a grid\nelement vertex 9\nproperty float x\n"
                  "property double y\nproperty float z\nproperty uchar red\n",
                  format);
  if (normals)
    header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (uvs)
    header += "property float s\nproperty float t\n";
  for (int i = 0; i < 9; ++i) {
    put(float(i % 3));
    put(double(i / 3));
    put(0.001f * float(i * i % 5));
    put(std::uint8_t(7));
    for (int axis = 0; axis < 3 && normals; ++axis)
      put(0.5f * float(axis + i));
    for (int axis = 0; axis < 2 && uvs; ++axis)
      put(0.125f * float(axis + i));
    if (isText)
      body += "\n";
  }
  header += "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      const int first = 3 * y + x;
      put(std::uint8_t(x ? 3 : 4));
      put(std::int32_t(first));
      put(std::int32_t(first + 1));
      put(std::int32_t(first + 4));
      if (!x)
        put(std::int32_t(first + 3));
      if (isText)
        body += "\n";
    }
  return header + body;
}

} // namespace

TEST_F(Meshes, PlainPlyIsWhatAssimpReads) {
  for (const char *format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (bool normals : {false, true})
      for (bool uvs : {false, true}) {
        const std::string bytes = plyGrid(format, normals, uvs), file = put("plain.ply", bytes);
        const std::optional<Mesh> plain = readPlainPly(bytes);
        ASSERT_TRUE(plain) << format;
        EXPECT_EQ(plain->triangleCount(), 6u);
        EXPECT_EQ(plain->normals.empty(), !normals);
        EXPECT_EQ(plain->uvs.empty(), !uvs);
        ASSERT_NO_FATAL_FAILURE(expectSame(*plain, readByAssimp(file))) << format;
        for (std::size_t length = 1; length < bytes.size(); length += 3) {
          const std::string cut = bytes.substr(0, bytes.size() - length);
          if (std::strcmp(format, "ascii") != 0) {
            ASSERT_FALSE(readPlainPly(cut)) << length;
          }
        }
      }
}

// Rows are read in parts of 32,768: the same grid as an OBJ file, where faces are numbered too.
TEST_F(Meshes, LargePlyIsTheSameMeshAsObj) {
  constexpr unsigned width = 260;
  std::string vertices, faces, obj;
  const auto put = [](std::string &to, auto value) {
    to.append(reinterpret_cast<const char *>(&value), sizeof value);
  };
  for (unsigned i = 0; i < width * width; ++i) {
    const float position[3] = {float(i % width), float(i / width), float(i * 7 % 5)};
    for (const float x : position)
      put(vertices, x);
    obj += fmt::format("v {} {} {}\n", position[0], position[1], position[2]);
  }
  unsigned faceCount = 0;
  for (unsigned i = 0; i + width + 1 < width * width; ++i, ++faceCount) {
    const std::uint32_t corners[4] = {i, i + 1, i + width + 1, i + width};
    const unsigned count = 3 + i * 3 % 7 % 2;
    put(faces, std::uint8_t(count));
    obj += "f";
    for (unsigned corner = 0; corner < count; ++corner) {
      put(faces, corners[corner]);
      obj += fmt::format(" {}", corners[corner] + 1);
    }
    obj += "\n";
    put(faces, std::int32_t(i));
  }
  const std::string header =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
                  "property float y\nproperty float z\nelement face {}\n"
                  "property list uchar int vertex_indices\nproperty int part\nend_header\n",
                  width * width, faceCount);
  const MeshRequest request{{"part"}, true};
  const std::optional<Mesh> ply = readPlainPly(header + vertices + faces, request);
  const std::optional<Mesh> plain = readPlainObj(obj, request);
  ASSERT_TRUE(ply && plain);
  EXPECT_EQ(corners(*ply), corners(*plain));
  ASSERT_EQ(ply->attributes.size(), 1u);
  EXPECT_EQ(ply->attributes[0].words, ply->order.faces) << "the number of each triangle's face";
  EXPECT_EQ(ply->order.faces, plain->order.faces);
  EXPECT_FALSE(readPlainPly(header + vertices + faces.substr(0, faces.size() - 1), request));
}

TEST_F(Meshes, PlyThatIsNotPlainIsLeftToAssimp) {
  const std::string header = plyHeader;
  ASSERT_TRUE(readPlainPly(header + "3 0 1 2\n3 1 2 3\n"));
  for (const char *faces : {"3 0 1 2\n3 1 2 4\n", "3 0 1 2\n3 1 2 -1\n", "3 0 1 2\n2 1 2\n",
                            "3 0 1 2\n3 1 2 x\n", "3 0 1 2\n3 1 2\n", ""})
    EXPECT_FALSE(readPlainPly(header + faces)) << faces;
  auto with = [&](const std::string &what, const std::string &instead) {
    std::string text = header + "3 0 1 2\n3 1 2 3\n";
    return text.replace(text.find(what), what.size(), instead);
  };
  EXPECT_FALSE(readPlainPly(with("float z", "float q")));
  EXPECT_FALSE(readPlainPly(with("float z", "float y")));
  EXPECT_FALSE(readPlainPly(with("float z", "list uchar float z")));
  EXPECT_FALSE(readPlainPly(with("vertex_indices", "strips")));
  EXPECT_FALSE(readPlainPly(with("1 1 0", "1 nan 0")));
}

TEST(MeshTransform, MovesNormalsAndKeepsSides) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.normals = {0, 0, 1, 0, 0, 1, 0, 0.6f, 0.8f};
  mesh.indices = {0, 1, 2};
  mesh.apply(Transform::scale(1, 2, -1));
  EXPECT_EQ(mesh.positions[7], 2);
  EXPECT_EQ(mesh.indices[1],
            2u); // turned round, so that the geometric normal goes with the shading normal
  EXPECT_EQ(mesh.normals[2], -1);
  EXPECT_NEAR(mesh.normals[7], 0.3f / std::hypot(0.3f, 0.8f),
              1e-6); // by the inverse transpose, not by the matrix
  mesh.apply(Transform::rotate({0, 0, 5}, 90).then(Transform::translate(10, 0, 0)));
  EXPECT_EQ(mesh.positions[3], 10);
  EXPECT_EQ(mesh.positions[4], 1);
}
