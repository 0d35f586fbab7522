//===- GltfErrorTest.cpp - damaged and hostile glTF files -----------------===//
#include "ErrorText.h"
#include "GltfFiles.h"

#include "scenefile/SceneFile.h"
#include "scenefile/gltf/Mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

using namespace rtsl;
using namespace rtsl::scene;
using namespace rtsl::scene::test;

namespace {

class GltfError : public testing::Test {
protected:
  /// What is wrong with a scene that shows the model.
  std::string sceneError(const std::string &model, const std::string &name = "m.gltf") {
    folder.write(name, model);
    return folder.without(errorOf([&] {
      parseScene(R"({"rtsl": 1, "camera": {"class": "C"},
"objects": [{"model": ")" +
                     name + "\"}]}",
                 folder.path + "/s.json");
    }));
  }

  /// The same for the file of the square with a change in its text.
  std::string changed(const std::string &from, const std::string &to) {
    std::string model = squareFile();
    const std::size_t at = model.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return sceneError(model.replace(at, from.size(), to));
  }

  /// What is wrong with the square's mesh.
  std::string meshError(const std::string &model) {
    folder.write("m.gltf", model);
    return folder.without(errorOf(
        [&] { gltf::readMesh(gltf::File(folder.path + "/m.gltf"), "meshes.0.primitives.0"); }));
  }

  Folder folder;
};

} // namespace

TEST_F(GltfError, WhatIsNoModel) {
  EXPECT_EQ(sceneError("{"), "m.gltf:1:2+1: jsonSyntax: this is not JSON: unexpected end of input; "
                             "expected string literal");
  EXPECT_EQ(sceneError("[]"), "m.gltf:1:1+1: wrongType: a glTF file is an object, not a list");
  EXPECT_EQ(sceneError("{}"), "m.gltf:1:1+1: missingKey: a glTF file needs an `asset`");
  EXPECT_EQ(sceneError(R"({"asset": {"version": "1.0"}})"),
            "m.gltf:1:24+3: notSupported: glTF 1.0 is not supported, only 2.0 is");
  EXPECT_EQ(sceneError(R"({"asset": {"version": "2.1", "minVersion": "2.1"}})"),
            "m.gltf:1:45+3: notSupported: glTF 2.1 is not supported, only 2.0 is");
  EXPECT_EQ(sceneError(R"({"asset": {"version": "2.0"}})"),
            "s.json:2:24+6: incompleteScene: the scene of `m.gltf` has no triangles and no lights");
  EXPECT_EQ(sceneError(R"({"asset": {"version": "2.0"}, "nodes": 3, "meshes": [4],
"extensionsRequired": ["KHR_draco_mesh_compression"]})"),
            "m.gltf:1:54+1: wrongType: `meshes.0` is an object, not a number\n"
            "m.gltf:1:40+1: wrongType: `nodes` is a list, not a number");
  EXPECT_EQ(
      sceneError(R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_draco_mesh_compression"],
"extensionsRequired": ["KHR_draco_mesh_compression"]})"),
      "m.gltf:2:25+26: notSupported: the file requires the extension `KHR_draco_mesh_compression`, "
      "which is not supported");
  folder.write("t.json", R"({"rtsl": 1, "camera": {"class": "C"}, "objects": [{"model": "none.glb"},
{"model": 3}, {"model": "none.glb", "material": "m"}], "root": {"model": "none.gltf"}})");
  EXPECT_EQ(folder.without(errorOf([&] { readSceneFile(folder.path + "/t.json"); })),
            "t.json:2:75+9: fileNotFound: cannot read `none.gltf`: No such file or directory\n"
            "t.json:1:62+8: fileNotFound: cannot read `none.glb`: No such file or directory\n"
            "t.json:2:11+1: wrongType: `model` is a string, not a number\n"
            "t.json:2:38+8: unknownKey: a node has no key `material`");
}

TEST_F(GltfError, DamagedContainers) {
  const std::string whole = container(squareFile(), "");
  EXPECT_EQ(sceneError(whole, "m.glb"), "no error");
  EXPECT_EQ(sceneError(whole.substr(0, 15), "m.glb"),
            "s.json:2:24+5: badMesh: `m.glb`: the file is truncated: it has 15 bytes");
  EXPECT_EQ(sceneError(whole.substr(0, 200), "m.glb"),
            "s.json:2:24+5: badMesh: `m.glb`: the file is truncated: its header gives 648 bytes, "
            "and it has 200");
  std::string version = whole;
  version[4] = 1;
  EXPECT_EQ(sceneError(version, "m.glb"), "s.json:2:24+5: notSupported: `m.glb`: version 1 of "
                                          "glTF's container is not supported, only 2 is");
  std::string binary = whole;
  binary.replace(16, 4, "BIN");
  EXPECT_EQ(sceneError(binary, "m.glb"), "s.json:2:24+5: badMesh: `m.glb`: the file is truncated: "
                                         "its header gives 648 bytes, and it has 647");
  std::string chunk = whole;
  chunk[15] = 127;
  EXPECT_EQ(sceneError(chunk, "m.glb"), "s.json:2:24+5: badMesh: `m.glb`: a chunk of 2130707060 "
                                        "bytes begins at byte 20, and the file has 648");
  std::string broken = whole;
  broken[20] = '[';
  EXPECT_EQ(sceneError(broken, "m.glb"),
            "s.json:2:24+5: jsonSyntax: `m.glb`: this is not JSON: unexpected ':'; expected ']'");
  EXPECT_EQ(
      sceneError("glTX" + whole.substr(4), "m.glb"),
      "s.json:2:24+5: badMesh: `m.glb`: this is not a .glb file, which begins with `glTF`: its "
      "first bytes are 67 6c 54 58 (note export or download it again)");
  EXPECT_EQ(
      sceneError("<!DOCTYPE html>", "m.glb"),
      "s.json:2:24+5: badMesh: `m.glb`: this is not a .glb file, which begins with `glTF`: it "
      "begins with `<`, as web pages do (note the address of the page was downloaded, not that "
      "of the file)");
  EXPECT_EQ(
      sceneError("version https://git-lfs.github.com/spec/v1\n", "m.glb"),
      "s.json:2:24+5: badMesh: `m.glb`: this is not a .glb file, which begins with `glTF`: it "
      "is a pointer of Git LFS (note `git lfs pull` fetches the file)");
  EXPECT_EQ(sceneError("", "m.glb"), "s.json:2:24+5: badMesh: `m.glb`: this is not a .glb file, "
                                     "which begins with `glTF`: it is empty");
  EXPECT_EQ(sceneError(squareFile(), "m.glb"), "no error"); // JSON by another name
  // Every shorter file gives a message.
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_NE(sceneError(whole.substr(0, size), "m.glb"), "no error") << size;
}

TEST_F(GltfError, NodesThatAreNoTree) {
  EXPECT_EQ(sceneError(squareFile(
                R"({"children": [1]}, {"children": [2], "mesh": 0}, {"children": [1]})")),
            "m.gltf:2:74+1: referenceCycle: `nodes.1` is below itself");
  EXPECT_EQ(sceneError(squareFile(R"({"children": [0]})")),
            "m.gltf:2:25+1: referenceCycle: `nodes.0` is below itself");
  EXPECT_EQ(sceneError(squareFile(R"({"children": [1, 1]}, {"mesh": 0})")),
            "m.gltf:2:28+1: outOfRange: `nodes.1` is in the scene twice; a node has one parent");
  EXPECT_EQ(
      sceneError(squareFile(
          R"({"children": [7, -1, "a"], "mesh": 1, "rotation": [0, 0, 0, 0]}, {"scale": [1, 2]})")),
      "m.gltf:2:61+1: outOfRange: `rotation` of `nodes.0` is 0\n"
      "m.gltf:2:25+1: outOfRange: a child of `nodes.0` is 7, and `nodes` has 2 elements\n"
      "m.gltf:2:28+2: outOfRange: a child of `nodes.0` must be between 0 and 4294967295, not -1\n"
      "m.gltf:2:33+1: wrongType: a child of `nodes.0` is a number, not a string");
  EXPECT_EQ(
      sceneError(squareFile(R"({"mesh": 1, "extensions": {"KHR_lights_punctual": {"light": 0}}})")),
      "m.gltf:2:71+1: outOfRange: `light` of `nodes.0` is 0, and `lights` has 0 elements");
  EXPECT_EQ(
      sceneError(squareFile(R"({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 2]})")),
      "m.gltf:2:22+1: outOfRange: the last row of `matrix` of `nodes.0` is not 0 0 0 1");
  EXPECT_EQ(sceneError(
                squareFile(R"({"mesh": 0, "translation": [1e308, 0, 0], "scale": [1, 1, 1e-30]})")),
            "m.gltf:2:11+1: degenerateGeometry: this transform flattens its geometry, or nearly "
            "so: the condition number of the path from the root would be more than 1e+08");
  // A very long chain does not exhaust the stack.
  std::string chain = R"({"mesh": 0})";
  for (int i = 1; i < 20000; ++i)
    chain += ",{}";
  std::string nodes;
  for (int i = 0; i < 20000; ++i)
    nodes += "{\"children\": [" + std::to_string(i + 1) + "]},";
  EXPECT_EQ(sceneError(squareFile(nodes + R"({"mesh": 0})")), "no error");
  nodes.replace(nodes.rfind("20000"), 5, "0");
  EXPECT_NE(sceneError(squareFile(nodes + R"({"mesh": 0})")).find("referenceCycle"),
            std::string::npos);
}

TEST_F(GltfError, Accessors) {
  EXPECT_EQ(changed("\"count\": 4", "\"count\": 5"),
            "m.gltf:5:2+1: badBuffer: `POSITION` of `meshes.0.primitives.0` (`accessors.1`) needs "
            "60 bytes of `bufferViews.1`, which has 48");
  EXPECT_EQ(changed("\"count\": 4", "\"count\": 4294967295"),
            "m.gltf:5:2+1: badBuffer: `POSITION` of `meshes.0.primitives.0` (`accessors.1`) needs "
            "51539607540 bytes of `bufferViews.1`, which has 48");
  EXPECT_EQ(changed("\"count\": 4", "\"count\": 0"),
            "m.gltf:5:52+1: outOfRange: `count` of `POSITION` of `meshes.0.primitives.0` "
            "(`accessors.1`) must be between 1 and 4294967295, not 0");
  EXPECT_EQ(changed("\"VEC3\"", "\"VEC2\""),
            "m.gltf:5:2+1: badBuffer: `POSITION` of `meshes.0.primitives.0` (`accessors.1`) has "
            "elements of type VEC2, where VEC3 is needed");
  EXPECT_EQ(changed("\"VEC3\"", "\"VEC5\""),
            "m.gltf:5:64+4: outOfRange: `type` of `POSITION` of `meshes.0.primitives.0` "
            "(`accessors.1`) is `VEC5`, which is not an element type");
  EXPECT_EQ(changed("5126", "5127"),
            "m.gltf:5:37+4: outOfRange: `componentType` of `POSITION` of `meshes.0.primitives.0` "
            "(`accessors.1`) is 5127, which is not a number type");
  EXPECT_EQ(changed("\"bufferView\": 1", "\"bufferView\": 2"),
            "m.gltf:5:17+1: outOfRange: `bufferView` of `POSITION` of `meshes.0.primitives.0` "
            "(`accessors.1`) is 2, and `bufferViews` has 2 elements");
  EXPECT_EQ(changed("{\"bufferView\": 1,", "{"), "no error"); // zeros
  EXPECT_EQ(changed("{\"bufferView\": 1, \"componentType\": 5126, \"count\": 4",
                    "{\"componentType\": 5126, \"count\": 400000000"),
            "m.gltf:5:2+1: badBuffer: `POSITION` of `meshes.0.primitives.0` (`accessors.1`) has "
            "400000000 elements and no `bufferView`");
  EXPECT_EQ(
      changed("\"byteOffset\": 12, \"byteLength\": 48", "\"byteOffset\": 24, \"byteLength\": 48"),
      "m.gltf:6:50+1: badBuffer: `bufferViews.1` ends at byte 72 of `buffers.0`, which has 60");
  EXPECT_EQ(changed("\"byteOffset\": 12", "\"byteStride\": 4, \"byteOffset\": 12"),
            "m.gltf:5:2+1: badBuffer: `POSITION` of `meshes.0.primitives.0` (`accessors.1`) has "
            "elements of 12 bytes, which lie 4 bytes apart in `bufferViews.1`");
  EXPECT_EQ(changed("\"byteLength\": 60, ", ""),
            "m.gltf:7:13+1: missingKey: `buffers.0` needs a `byteLength`");
  EXPECT_EQ(
      changed("\"POSITION\": 1", "\"NORMAL\": 1"),
      "m.gltf:3:43+1: missingKey: `attributes` of `meshes.0.primitives.0` needs a `POSITION`");
  EXPECT_EQ(changed("\"POSITION\": 1", "\"POSITION\": 1, \"NORMAL\": 0"),
            "m.gltf:4:15+1: badBuffer: `NORMAL` of `meshes.0.primitives.0` (`accessors.0`) has "
            "elements of type SCALAR, where VEC3 is needed");
  EXPECT_EQ(changed("\"indices\": 0", "\"indices\": 0, \"mode\": 7"),
            "m.gltf:3:82+1: outOfRange: `mode` of `meshes.0.primitives.0` must be between 0 and 6, "
            "not 7");
  EXPECT_EQ(changed("\"indices\": 0", "\"indices\": 1"),
            "m.gltf:5:2+1: badBuffer: `indices` of `meshes.0.primitives.0` (`accessors.1`) has "
            "elements of type VEC3, where SCALAR is needed");
  EXPECT_EQ(changed("\"indices\": 0", "\"indices\": 0, \"material\": 0"),
            "m.gltf:3:86+1: outOfRange: `material` of `meshes.0.primitives.0` is 0, and "
            "`materials` has 0 elements");
  EXPECT_EQ(changed("\"primitives\"", "\"primitive\""),
            "m.gltf:3:12+1: missingKey: `meshes.0` needs a `primitives`");
}

TEST_F(GltfError, Buffers) {
  EXPECT_EQ(meshError(squareFile()), "no error");
  EXPECT_EQ(meshError(squareFile("{}", "", square().substr(0, 50))),
            "m.gltf:7:28+2: badBuffer: `buffers.0` is truncated: it has 50 bytes of its "
            "`byteLength` 60, and `bufferViews.1` ends at byte 60");
  std::string model = squareFile();
  const std::size_t at = model.find("data:"), end = model.find('"', at);
  const auto withUri = [&](const std::string &uri) {
    return std::string(model).replace(at, end - at, uri);
  };
  EXPECT_EQ(meshError(withUri("none.bin")),
            "m.gltf:7:40+8: fileNotFound: cannot read `none.bin`: No such file or directory");
  EXPECT_EQ(meshError(withUri("https://example.org/square.bin")),
            "m.gltf:7:40+30: notSupported: files are read only from disk, not by `https`");
  EXPECT_EQ(meshError(withUri("data:,abc")),
            "m.gltf:7:40+9: badBuffer: `buffers.0` has a `data:` URI that is not in base64");
  EXPECT_EQ(meshError(withUri("data:;base64,AA!A")),
            "m.gltf:7:40+17: badBuffer: `buffers.0` has a `data:` URI with a byte that is not "
            "base64, at 15");
  EXPECT_EQ(meshError(std::string(model).replace(at - 9, end - at + 10, "")),
            "m.gltf:7:31+1: jsonSyntax: this is not JSON: unexpected '}'; expected string literal "
            "(note JSON allows no comma after the last element)");
  folder.write("a b.bin", square());
  EXPECT_EQ(meshError(withUri("a%20b.bin")), "no error");

  EXPECT_EQ(meshError(squareFile("{}", "",
                                 bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 4}) + square().substr(12))),
            "m.gltf/meshes.0.primitives.0: badMesh: mesh `m.gltf/meshes.0.primitives.0` has an "
            "index out of range: triangle 1 uses vertex 4 of 4");
  std::string bytes = square();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bytes.replace(16, 4, bytesOf<float>({nan}));
  EXPECT_EQ(meshError(squareFile("{}", "", bytes)),
            "m.gltf/meshes.0.primitives.0: badMesh: mesh `m.gltf/meshes.0.primitives.0` has a "
            "vertex that is not finite: y of vertex 0 is nan");
}

/// Nothing that is needed is missing, but the file promises more.
TEST_F(GltfError, BuffersWithFewerBytesThanTheyGive) {
  const auto warningsOf = [&](const gltf::File &file) {
    std::string text;
    for (const Warning &warning : file.warnings())
      text +=
          fmt::format("{}:{}: {}\n", warning.place->line, warning.place->column, warning.message);
    return text;
  };
  const auto longer = [](std::string model) {
    const std::string length = "\"byteLength\": 60";
    return model.replace(model.find(length), length.size(), "\"byteLength\": 99");
  };
  const std::string warning =
      "`buffers.0` has 60 bytes, and its `byteLength` is 99: the file may be truncated, though all "
      "its views are complete\n";
  EXPECT_EQ(warningsOf(gltf::File(squareFile(), folder.path + "/m.gltf")), "");
  EXPECT_EQ(warningsOf(gltf::File(longer(squareFile()), folder.path + "/m.gltf")),
            "7:28: " + warning);
  std::string model = longer(squareFile());
  const std::size_t at = model.find("data:"), end = model.find('"', at);
  folder.write("square.bin", square());
  EXPECT_EQ(warningsOf(gltf::File(std::string(model).replace(at, end - at, "square.bin"),
                                  folder.path + "/m.gltf")),
            "7:28: " + warning);
  model.replace(at - 10, end - at + 11, ""); // no `uri`
  EXPECT_EQ(warningsOf(gltf::File(container(model, square()), folder.path + "/m.glb")),
            "0:0: " + warning);
  EXPECT_EQ(errorOf([&] {
              gltf::File(container(model, square().substr(0, 48)), folder.path + "/m.glb");
            }).substr(folder.path.size() + 1),
            "m.glb: badBuffer: `" + folder.path +
                "/m.glb`: `buffers.0` is truncated: it has 48 bytes of its `byteLength` 99, and "
                "`bufferViews.1` ends at byte 60");
}

TEST_F(GltfError, Materials) {
  const auto material = [&](const std::string &json, const std::string &more = "") {
    std::string file = squareFile(R"({"mesh": 0})", ", \"materials\": [" + json + "]" + more);
    return sceneError(
        file.replace(file.find("\"indices\": 0"), 12, "\"indices\": 0, \"material\": 0"));
  };
  EXPECT_EQ(material(R"({"pbrMetallicRoughness": {"metallicFactor": 2}})"),
            "m.gltf:8:87+1: outOfRange: `metallicFactor` of `materials.0` must be between 0 and 1, "
            "not 2");
  EXPECT_EQ(material(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 2, 1]}})"),
            "m.gltf:8:88+1: outOfRange: the numbers of `baseColorFactor` of `materials.0` must be "
            "from 0 to 1");
  EXPECT_EQ(material(R"({"pbrMetallicRoughness": 1})"),
            "m.gltf:8:68+1: wrongType: `pbrMetallicRoughness` of `materials.0` is an object, not a "
            "number");
  EXPECT_EQ(material(R"({"alphaMode": "CLIP"})"),
            "m.gltf:8:58+4: outOfRange: `alphaMode` of `materials.0` is `OPAQUE`, `MASK` or "
            "`BLEND`, not `CLIP`");
  EXPECT_EQ(
      material(
          R"({"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": -1}}})"),
      "m.gltf:8:144+2: outOfRange: `emissiveStrength` of `materials.0` must not be negative, but "
      "is -1");
  EXPECT_EQ(
      material(
          R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0}}})"),
      "m.gltf:8:186+1: outOfRange: `attenuationDistance` of `materials.0` must be above 0, not 0");
  EXPECT_EQ(material(R"({"normalTexture": {"index": 0}})"),
            "m.gltf:8:71+1: outOfRange: `index` of a texture of `materials.0` is 0, and `textures` "
            "has 0 elements");
  const std::string texture = R"({"normalTexture": {"index": 0}})";
  EXPECT_EQ(
      material(texture, R"(, "textures": [{"source": 1}], "images": [{}])"),
      "m.gltf:8:101+1: outOfRange: `source` of `textures.0` is 1, and `images` has 1 element");
  EXPECT_EQ(material(texture, R"(, "textures": [{"source": 0}], "images": [{}])"),
            "m.gltf:8:117+1: missingKey: `images.0` without a `uri` needs a `bufferView`");
  EXPECT_EQ(
      material(
          texture,
          R"(, "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "http://a.b/c"}])"),
      "m.gltf:8:140+12: notSupported: files are read only from disk, not by `http`");
  EXPECT_EQ(
      material(
          texture,
          R"(, "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "c.png"}], "samplers": [{"wrapS": 1}])"),
      "m.gltf:8:173+1: outOfRange: `wrapS` of `samplers.0` is 1, which is not a wrap mode");
}

TEST_F(GltfError, CamerasAndLights) {
  const std::string light = R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})";
  const auto lights = [&](const std::string &json) {
    return sceneError(squareFile(
        light, ", \"extensions\": {\"KHR_lights_punctual\": {\"lights\": [" + json + "]}}"));
  };
  EXPECT_EQ(lights(R"({"type": "area"})"), "m.gltf:8:89+4: outOfRange: `type` of `lights.0` is "
                                           "`point`, `spot` or `directional`, not `area`");
  EXPECT_EQ(lights(R"({"type": "spot", "spot": {"outerConeAngle": 3}})"),
            "m.gltf:8:123+1: outOfRange: `outerConeAngle` of `lights.0` must be between 0 and "
            "1.5708, not 3");
  EXPECT_EQ(
      lights(R"({"intensity": -1, "type": "point"})"),
      "m.gltf:8:93+2: outOfRange: `intensity` of `lights.0` must be between 0 and 1e+30, not -1");
  EXPECT_EQ(lights("3"), "m.gltf:8:79+1: wrongType: `lights.0` is an object, not a number");
  const auto camera = [&](const std::string &json) {
    folder.write("m.gltf",
                 squareFile(R"({"mesh": 0, "camera": 0})", ", \"cameras\": [" + json + "]"));
    return folder.without(errorOf([&] {
      parseScene(R"({"rtsl": 1, "camera": {"model": "m.gltf"}})", folder.path + "/s.json");
    }));
  };
  EXPECT_EQ(camera("{}"), "m.gltf:8:41+1: missingKey: `cameras.0` needs a `type`");
  EXPECT_EQ(camera(R"({"type": "fisheye"})"), "m.gltf:8:51+7: outOfRange: `type` of `cameras.0` is "
                                              "`perspective` or `orthographic`, not `fisheye`");
  EXPECT_EQ(camera(R"({"type": "perspective", "perspective": {"yfov": 4}})"),
            "m.gltf:8:89+1: outOfRange: `yfov` of `cameras.0` must be below pi, not 4");
  EXPECT_EQ(camera(R"({"type": "orthographic", "orthographic": {"ymag": 0}})"),
            "m.gltf:8:91+1: outOfRange: `ymag` of `cameras.0` must be above 0, not 0");
}

TEST_F(GltfError, PartsOfASceneFile) {
  folder.write("m.gltf", squareFile());
  const auto object = [&](const std::string &json) {
    return folder.without(errorOf([&] {
      parseScene(R"({"rtsl": 1, "camera": {"class": "C"}, "nodes": {"a": )" + json +
                     R"(}, "root": "a"})",
                 folder.path + "/s.json");
    }));
  };
  EXPECT_EQ(object(R"({"mesh": "m.gltf", "part": "meshes.0.primitives.0", "material": "m"})"),
            "no error");
  EXPECT_EQ(object(R"({"mesh": "m.gltf", "part": "meshes.1.primitives.0", "material": "m"})"),
            "s.json:1:82+21: unknownName: `m.gltf` has no `meshes.1.primitives.0`; its meshes are "
            "named like `meshes.0.primitives.0`");
  EXPECT_EQ(object(R"({"mesh": "m.gltf", "part": 1, "material": "m"})"),
            "s.json:1:81+1: wrongType: `part` is a string, not a number");
  EXPECT_EQ(
      object(
          R"({"primitive": {"class": "S", "i": {"file": "a.png", "part": "images.0"}}, "material": "m"})"),
      "s.json:1:115+8: unknownKey: `part` names an image in a glTF file");
  EXPECT_EQ(object(R"({"light": {"class": "SphereLight"}})"),
            "s.json:1:75+11: notSupported: a `SphereLight` cannot be in a node, only in `lights`; "
            "a node may have a `DistantLight`, `PointLight`, `RectangleLight`, `SpotLight`");
  EXPECT_EQ(object(R"({"light": "lamp"})"),
            "s.json:1:65+4: wrongType: `light` is an object, not a string");
  EXPECT_EQ(
      object(
          R"({"light": {"class": "PointLight", "position": [1, 2]}, "transform": {"scale": 2}})"),
      "s.json:1:100+1: wrongType: `position` takes 3 numbers, not 2");
  EXPECT_EQ(
      object(
          R"({"light": {"class": "PointLight"}, "transform": {"keys": [{"scale": 2}, {"scale": 3}]}})"),
      "s.json:1:64+1: notSupported: a light in a node cannot move, but the transform of its "
      "node, or of one above it, has keys");
}
