//===- GltfTest.cpp - what a glTF file becomes in a scene -----------------===//
#include "ErrorText.h"
#include "GltfFiles.h"

#include "scenefile/SceneFile.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/gltf/Textures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::scene;
using namespace rtsl::scene::test;

namespace {

/// A value as JSON on one line.
std::string textOf(const JsonValue &value) {
  std::vector<std::string> parts;
  switch (value.kind) {
  case JsonValue::Kind::String:
    return value.string;
  case JsonValue::Kind::Number:
    return fmt::format("{:.4g}", value.number);
  case JsonValue::Kind::Boolean:
    return value.boolean ? "true" : "false";
  case JsonValue::Kind::Array:
    for (const JsonValue &element : value.elements)
      parts.push_back(textOf(element));
    return fmt::format("[{}]", fmt::join(parts, " "));
  default:
    for (const auto &[key, member] : value.members)
      parts.push_back(key.text == "class" ? textOf(member) : key.text + "=" + textOf(member));
    return fmt::format("({})", fmt::join(parts, " "));
  }
}

std::string textOf(const ObjectDescription &object) {
  std::string text = object.className.text;
  if (object.constructor)
    text += " " + textOf(*object.constructor);
  for (const auto &[name, value] : object.members)
    text += " " + name.text + "=" + textOf(*value);
  return text;
}

class Gltf : public testing::Test {
protected:
  SceneDescription scene(const std::string &model,
                         const std::string &more = R"("objects": [{"model": "m.gltf"}])",
                         const std::string &camera = R"({"class": "C"})") {
    folder.write("m.gltf", model);
    return parseScene("{\"rtsl\": 1, \"camera\": " + camera + ", " + more + "}",
                      folder.path + "/s.json");
  }

  std::string sceneError(const std::string &model) {
    return folder.without(errorOf([&] { scene(model); }));
  }

  /// The material of the square.
  std::string material(const std::string &json, const std::string &more = "") {
    std::string file = squareFile(R"({"mesh": 0})", ", \"materials\": [" + json + "]" + more);
    file.replace(file.find("\"indices\": 0"), 12, "\"indices\": 0, \"material\": 0");
    const SceneDescription described = scene(file);
    warnings.clear();
    for (const Warning &warning : described.warnings)
      warnings += folder.without(warning.message) + "\n";
    return textOf(described.materials.begin()->second);
  }

  std::string camera(const std::string &model, const std::string &mention = "") {
    return textOf(
        *scene(model, R"("objects": [])", R"({"model": "m.gltf")" + mention + "}").camera);
  }

  Folder folder;
  std::string warnings;
};

const std::string images = R"(, "textures": [{"source": 0, "sampler": 0}],
"samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}], "images": [{"uri": "a%20b.png"}])";

} // namespace

TEST_F(Gltf, NodesBecomeInstancesOfOneMesh) {
  const SceneDescription described = scene(squareFile(
      R"({"children": [1, 2], "translation": [0, 0, 5]},
{"mesh": 0, "scale": [2, 3, 4], "rotation": [0, 0, 1, 1], "translation": [1, 0, 0]},
{"name": "plate", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]})"));
  ASSERT_EQ(described.objects.size(), 1u);
  EXPECT_EQ(described.objects[0].name.text, "m.gltf/meshes.0");
  EXPECT_EQ(described.objects[0].part, "meshes.0.primitives.0");
  const auto &placements = described.objects[0].placements;
  ASSERT_EQ(placements.size(), 2u);
  // Scaled, turned by a quarter about z, moved.
  const runtime::Transform &first = placements[0].transform.still();
  for (const auto &[column, x, y, z] :
       {std::tuple(0, 0, 2, 0), {1, -3, 0, 0}, {2, 0, 0, 4}, {3, 1, 0, 5}}) {
    EXPECT_NEAR(first.columns[std::size_t(column)][0], x, 1e-12);
    EXPECT_NEAR(first.columns[std::size_t(column)][1], y, 1e-12);
    EXPECT_NEAR(first.columns[std::size_t(column)][2], z, 1e-12);
  }
  EXPECT_EQ(placements[1].transform.still().columns[3], (std::array<double, 3>{7, 8, 14}));
  EXPECT_EQ(described.warnings.size(), 0u);
}

TEST_F(Gltf, ModelsAreNodes) {
  const SceneDescription described = scene(squareFile(), R"("nodes": {
"two": {"children": [{"model": "m.gltf"}, {"model": "m.gltf", "id": 4, "transform": {"translate": [1, 2, 3]}}]}},
"roots": {"all": {"child": "two", "transform": {"scale": 2}}, "none": {"primitive": {"class": "S"}, "material": "m.gltf/default material"}},
"objects": [{"model": "m.gltf", "transform": {"translate": [9, 9, 9]}}, {"mesh": "o.obj", "material": {"class": "M"}}])");
  ASSERT_EQ(described.objects.size(), 3u);
  EXPECT_EQ(described.objects[0].mesh[0].path, folder.path + "/o.obj");
  std::vector<std::string> found;
  for (const auto &placement : described.objects[1].placements)
    found.push_back(fmt::format("{} {} {}", placement.transform.still().columns[3][0], placement.id,
                                placement.roots));
  EXPECT_EQ(found, (std::vector<std::string>{"0 0 1", "2 4 1", "9 0 1"}));
  EXPECT_EQ(textOf(described.materials.at("m.gltf/default material")),
            "Principled baseColor=[1 1 1] metallic=1 roughness=1");
}

TEST_F(Gltf, MaterialsArePrincipled) {
  EXPECT_EQ(material(R"({"name": "paint", "pbrMetallicRoughness":
{"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
 "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
"emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0}, "doubleSided": true,
"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10}, "KHR_materials_ior": {"ior": 1.4},
"KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 0]},
"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.2, "clearcoatRoughnessTexture": {"index": 0}}}})",
                     images),
            "Principled baseColor=[0.1 0.2 0.3] "
            "baseColorMap=(ImageTexture image=(file=a b.png colorSpace=srgb wrap=[clamp mirror] "
            "filter=nearest)) metallic=0.5 roughness=0.6 "
            "metallicMap=(ImageChannel channel=2 image=(file=a b.png colorSpace=linear "
            "wrap=[clamp mirror] filter=nearest)) "
            "roughnessMap=(ImageChannel channel=1 image=(file=a b.png colorSpace=linear "
            "wrap=[clamp mirror] filter=nearest)) index=1.4 transmission=0.9 clearcoat=0.8 "
            "clearcoatRoughness=0.2 clearcoatRoughnessMap=(ImageChannel channel=1 "
            "image=(file=a b.png colorSpace=linear wrap=[clamp mirror] filter=nearest)) "
            "sheenColor=[1 1 0] sheenRoughness=0 emissive=[10 5 0] "
            "emissiveMap=(ImageTexture image=(file=a b.png colorSpace=srgb wrap=[clamp mirror] "
            "filter=nearest))");
  EXPECT_EQ(warnings, "");
  EXPECT_EQ(material("{}"), "Principled baseColor=[1 1 1] metallic=1 roughness=1");
  EXPECT_EQ(material(R"({"extensions": {"KHR_materials_specular": {"specularFactor": 0.3,
"specularTexture": {"index": 0}, "specularColorFactor": [1, 0.5, 4], "specularColorTexture": {"index": 0}}}})",
                     images),
            "Principled baseColor=[1 1 1] metallic=1 roughness=1 specular=0.3 "
            "specularMap=(ImageChannel channel=3 image=(file=a b.png colorSpace=srgb "
            "wrap=[clamp mirror] filter=nearest)) specularColor=[1 0.5 4] "
            "specularColorMap=(ImageTexture image=(file=a b.png colorSpace=srgb "
            "wrap=[clamp mirror] filter=nearest))");
  EXPECT_EQ(material(R"({"extensions": {"KHR_materials_specular": {}}})"),
            "Principled baseColor=[1 1 1] metallic=1 roughness=1 specular=1");
  EXPECT_EQ(warnings, "");
  EXPECT_EQ(material(R"({"extensions": {"KHR_materials_unlit": {}}})"),
            "Emitter radiance=[1 1 1] isTwoSided=true");
  EXPECT_EQ(material(R"({"extensions": {"KHR_materials_ior": {"ior": 3}}})"),
            "Principled baseColor=[1 1 1] metallic=1 roughness=1 index=2");
  EXPECT_EQ(warnings, "`ior` of `materials.0` is 3; 2 is used\n");
}

TEST_F(Gltf, VolumesAreGlass) {
  const auto glass = [&](const std::string &volume, const std::string &more = "") {
    return material(
        R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0, "roughnessFactor": 0.2},
"extensions": {"KHR_materials_ior": {"ior": 1.4}, "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": )" +
        volume + "}" + more + "}");
  };
  const std::string solid = "Dielectric index=1.4 transmission=[{}] tint=[1 0.5 0.25] alpha=0.04";
  EXPECT_EQ(glass(R"({"thicknessFactor": 1})"), fmt::format(fmt::runtime(solid), "1 1 1"));
  EXPECT_EQ(
      glass(
          R"({"thicknessFactor": 1, "attenuationColor": [0.25, 1, 0], "attenuationDistance": 0.5})"),
      fmt::format(fmt::runtime(solid), "0.0625 1 1e-30"));
  EXPECT_EQ(warnings, "");
  EXPECT_EQ(glass(R"({"thicknessFactor": 1})", R"(, "emissiveFactor": [1, 1, 1])"),
            fmt::format(fmt::runtime(solid), "1 1 1"));
  EXPECT_EQ(warnings, "`emissiveFactor` of `materials.0` is not supported, and ignored\n");
  warnings.clear();
  // A thin pane.
  EXPECT_EQ(glass(R"({"attenuationDistance": 0.5})"),
            "Principled baseColor=[1 0.5 0.25] metallic=0 roughness=0.2 index=1.4 transmission=1");
  const std::string partly =
      R"(, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_volume": {"thicknessFactor": 1}}})";
  EXPECT_EQ(material(R"({"pbrMetallicRoughness": {"metallicFactor": 0.5})" + partly),
            "MixMaterial first=(Principled baseColor=[1 1 1] metallic=0.5 roughness=1) "
            "second=(Dielectric transmission=[1 1 1] tint=[1 1 1] alpha=1) amount=0.25");
  const auto channel = [](int number) {
    return fmt::format("(ImageChannel channel={} image=(file=a b.png colorSpace=linear wrap=[clamp "
                       "mirror] filter=nearest))",
                       number);
  };
  const std::string metal =
      R"({"pbrMetallicRoughness": {"metallicFactor": 0.5, "metallicRoughnessTexture": {"index": 0}})";
  const std::string textured =
      "MixMaterial first=(Principled baseColor=[1 1 1] metallic=0.5 roughness=1 metallicMap=" +
      channel(2) + " roughnessMap=" + channel(1) +
      ") second=(Dielectric transmission=[1 1 1] tint=[1 1 1] alpha=1 alphaMap=(Product first=" +
      channel(1) + " second=" + channel(1) + ")) amount=0.5 amountMap=";
  const std::string noMetal = "(Scaled pattern=" + channel(2) + " scale=-0.5 offset=1)";
  EXPECT_EQ(material(metal + partly, images), textured + noMetal);
  std::string withMap = metal + partly;
  withMap.replace(withMap.find("0.5}"), 3, R"(0.5, "transmissionTexture": {"index": 0})");
  EXPECT_EQ(material(withMap, images),
            textured + "(Product first=" + channel(0) + " second=" + noMetal + ")");
  EXPECT_EQ(warnings, "");
}

TEST_F(Gltf, MaterialsMayHaveNormalsAndHoles) {
  const std::string plain = "(Principled baseColor=[1 1 1] metallic=1 roughness=1";
  const std::string image = "(file=a b.png colorSpace={} wrap=[clamp mirror] filter=nearest)";
  const std::string linear = fmt::format(fmt::runtime(image), "linear"),
                    srgb = fmt::format(fmt::runtime(image), "srgb");
  EXPECT_EQ(material(R"({"normalTexture": {"index": 0, "scale": 0.5}})", images),
            "NormalMap slopeU=(ImageSlope axis=0 image=" + linear +
                ") slopeV=(ImageSlope axis=1 image=" + linear + ") strength=0.5 material=" + plain +
                ")");
  EXPECT_EQ(
      material(R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.3],
"baseColorTexture": {"index": 0}}})",
               images),
      "Cutout opacity=0.3 opacityMap=(ImageChannel channel=3 image=" + srgb +
          ") material=" + "(Principled baseColor=[1 1 1] baseColorMap=(ImageTexture image=" + srgb +
          ") metallic=1 roughness=1)");
  EXPECT_EQ(material(R"({"alphaMode": "MASK", "alphaCutoff": 0.2, "pbrMetallicRoughness":
{"baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": {"index": 0}}})",
                     images)
                .substr(0, 62),
            "Cutout opacityMap=(Threshold edge=0.4 pattern=(ImageChannel ch");
  EXPECT_EQ(
      material(
          R"({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.4]}})"),
      "Cutout opacity=0 material=" + plain + ")");
}

TEST_F(Gltf, TexturesAreTransformed) {
  const auto map = [&](const std::string &transform) {
    const std::string text =
        material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
{"KHR_texture_transform": )" +
                     transform + "}}}}",
                 images);
    const std::size_t begin = text.find("(Transformed"), end = text.find("(ImageTexture");
    return text.substr(begin, end - begin);
  };
  EXPECT_EQ(map(R"({"offset": [0.25, 0.5], "scale": [2, 4]})"),
            "(TransformedPattern scale=[2 4] offset=[0.25 -3.5] pattern=");
  EXPECT_EQ(map(R"({"offset": [0.25, 0.5], "scale": [2, 4], "rotation": 3.14159265358979})"),
            "(TransformedPattern scale=[2 -4] offset=[0 4] pattern=(TransformedPattern "
            "rotation=180 scale=[1 -1] offset=[0.25 0.5] pattern=");
}

TEST_F(Gltf, TexturesMayBeWebP) {
  const auto hasFile = [&](const std::string &texture, const std::string &file) {
    const std::string text =
        material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})",
                 ", \"textures\": [" + texture +
                     R"(], "images": [{"uri": "a.png"}, {"uri": "b.webp"}],
"extensionsRequired": ["EXT_texture_webp"])");
    return text.find("image=(file=" + file) != std::string::npos && warnings.empty();
  };
  EXPECT_TRUE(hasFile(R"({"extensions": {"EXT_texture_webp": {"source": 1}}})", "b.webp"));
  EXPECT_TRUE(
      hasFile(R"({"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}})", "a.png"));
}

TEST_F(Gltf, TexturesHaveTheFirstCoordinates) {
  const auto warningOf = [&](const std::string &info) {
    material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0)" + info + "}}}", images);
    return warnings;
  };
  const std::string first = R"(, "extensions": {"KHR_texture_transform": {"texCoord": 0}})",
                    third = R"(, "extensions": {"KHR_texture_transform": {"texCoord": 2}})";
  EXPECT_EQ(warningOf(R"(, "texCoord": 1)"),
            "a texture of `materials.0` uses the texture coordinates `TEXCOORD_1`; all textures "
            "are placed by `TEXCOORD_0`\n");
  EXPECT_EQ(warningOf(R"(, "texCoord": 1)" + first), ""); // for programs without the extension
  EXPECT_NE(warningOf(third).find("`TEXCOORD_2`"), std::string::npos);
}

TEST_F(Gltf, CamerasAreTheFilesOrFrameIt) {
  const std::string cameras =
      R"(, "cameras": [{"name": "wide", "type": "perspective", "perspective": {"yfov": 1.5707963267948966, "znear": 1}},
{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1.5, "znear": 0, "zfar": 9}}], "scenes": [{"nodes": [0, 1]}])";
  const std::string file = squareFile(R"({"camera": 0, "translation": [0, 1, 2]},
{"name": "flat", "camera": 1, "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476]}, {"mesh": 0})",
                                      cameras);
  EXPECT_EQ(camera(file),
            "PerspectiveCamera (eye=[0 1 2] target=[0 1 1] up=[0 1 0]) fieldOfView=90");
  EXPECT_EQ(camera(file, R"(, "name": "wide", "transform": {"translate": [3, 0, 0]})"),
            "PerspectiveCamera (eye=[3 1 2] target=[3 1 1] up=[0 1 0]) fieldOfView=90");
  EXPECT_NE(camera(file, R"(, "name": "flat")").find("height=3"), std::string::npos);
  EXPECT_EQ(folder.without(errorOf([&] { camera(file, R"(, "name": "front")"); })),
            "s.json:1:34+6: unknownName: the scene of `m.gltf` has no camera `front` "
            "(note it has `wide`, `flat`)");
  EXPECT_EQ(folder.without(errorOf(
                [&] { camera(file, R"(, "transform": {"keys": [{"scale": 1}, {"scale": 2}]})"); })),
            "s.json:1:56+1: notSupported: a camera cannot move, but its transform has keys");
  // The square has the radius sqrt(2) and is seen from the distance sqrt(2) / sin(20 degrees).
  EXPECT_EQ(camera(squareFile()), "PerspectiveCamera (eye=[1.861 1.447 3.391] "
                                  "target=[0 0 0] up=[0 1 0]) fieldOfView=40");
}

TEST_F(Gltf, LightsAreInTheWorld) {
  const std::string lights =
      R"(, "extensions": {"KHR_lights_punctual": {"lights": [
{"type": "point", "intensity": 3.14159265358979, "color": [1, 0.5, 0]}, {"type": "directional", "intensity": 6.28318530717959},
{"type": "spot", "range": 10, "spot": {"innerConeAngle": 0.39269908169872414, "outerConeAngle": 0.7853981633974483}}]}})";
  const auto at = [](int light) {
    return fmt::format("\"extensions\": {{\"KHR_lights_punctual\": {{\"light\": {}}}}}", light);
  };
  const SceneDescription described = scene(
      squareFile(
          "{\"children\": [1, 2, 3], \"translation\": [1, 2, 3]}, {\"translation\": [4, 0, 0], " +
              at(0) + "}, {" + at(1) + "}, {\"rotation\": [1, 0, 0, 1], " + at(2) + "}",
          lights),
      R"("root": {"children": [{"model": "m.gltf"}, {"model": "m.gltf", "transform": {"translate": [0, 0, 100]}}]})");
  ASSERT_EQ(described.lights.size(), 6u);
  EXPECT_EQ(textOf(described.lights[0]), "PointLight intensity=[1 0.5 0] position=[5 2 3]");
  EXPECT_EQ(textOf(described.lights[1]), "DistantLight direction=[0 0 1] irradiance=[2 2 2]");
  EXPECT_NE(textOf(described.lights[2]).find("angle=45 softness=0.5"), std::string::npos);
  EXPECT_EQ(textOf(described.lights[3]), "PointLight intensity=[1 0.5 0] position=[5 2 103]");
  ASSERT_EQ(described.warnings.size(), 1u);
  EXPECT_EQ(described.warnings[0].message,
            "`range` of `lights.2` is ignored: light reaches any distance");
}

TEST_F(Gltf, SaysWhatIsLeftOut) {
  std::string file =
      squareFile(R"({"mesh": 0, "skin": 0, "children": [1]}, {"mesh": 0, "scale": [0, 1, 1]})",
                 R"(, "extensionsUsed": ["KHR_materials_iridescence", "KHR_texture_transform"])");
  file.replace(
      file.find("\"indices\": 0"), 12,
      R"("indices": 0, "targets": [{"TANGENT": 1}]}, {"mode": 1, "attributes": {"POSITION": 1, "COLOR_0": 1})");
  std::vector<std::string> found;
  for (const Warning &warning : scene(file).warnings)
    found.push_back(folder.without(warning.message));
  EXPECT_EQ(found,
            (std::vector<std::string>{
                "`nodes.1` is flattened by its transform, and ignored",
                "the skin of `nodes.0` is ignored: the mesh is not deformed",
                "`meshes.0.primitives.1` has points or lines, which are ignored",
                "`TANGENT` of the morph targets of `meshes.0.primitives.0` is ignored: they change "
                "positions and normals",
                "the extension `KHR_materials_iridescence` of `m.gltf` is not supported; what it "
                "adds is ignored"}));
  // A container has no lines, so the text names the file.
  const SceneDescription packed = scene(container(file, ""));
  ASSERT_EQ(packed.warnings.size(), found.size());
  EXPECT_EQ(folder.without(packed.warnings[0].message), "`m.gltf`: " + found[0]);
  EXPECT_EQ(folder.without(packed.warnings.back().message), found.back());
}

TEST_F(Gltf, AMatrixIsInPlaceOfTheOtherTransforms) {
  const SceneDescription described = scene(squareFile(
      R"({"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1], "translation": [0, 9, 0],
"scale": [2, 2, 2]})"));
  std::vector<std::string> found;
  for (const Warning &warning : described.warnings) {
    found.push_back(warning.message);
    EXPECT_TRUE(warning.place && warning.place->line != 0);
  }
  const std::string rest = " of `nodes.0` is ignored: the node has a `matrix`, and glTF allows one "
                           "or the other";
  EXPECT_EQ(found, (std::vector<std::string>{"`translation`" + rest, "`scale`" + rest}));
}

TEST_F(Gltf, MorphTargetsAreAddedByTheirWeights) {
  // The square as a target of itself: with a weight w it is larger by w.
  std::string model = squareFile(R"({"children": [1, 2, 3]}, {"mesh": 0},
{"mesh": 0, "weights": [3, 0]}, {"mesh": 0, "weights": [0, 0]})");
  const std::string indices = "\"indices\": 0";
  model.replace(model.find(indices), indices.size(),
                indices + R"(, "targets": [{"POSITION": 1}, {"POSITION": 1}])");
  const SceneDescription described = scene(model);
  ASSERT_EQ(described.objects.size(), 2u); // the last node's mesh is the first one's
  EXPECT_TRUE(described.objects[0].weights.empty() != described.objects[1].weights.empty());
  EXPECT_TRUE(described.warnings.empty());

  const gltf::File file(folder.path + "/m.gltf");
  const std::string part = "meshes.0.primitives.0";
  const std::vector<float> plain = gltf::readMesh(file, part).positions;
  const std::vector<float> larger = gltf::readMesh(file, part, {}, {0.5, 1}).positions;
  ASSERT_EQ(plain.size(), larger.size());
  for (std::size_t i = 0; i < plain.size(); ++i)
    EXPECT_FLOAT_EQ(larger[i], 2.5f * plain[i]);

  model.replace(model.find("[3, 0]"), 6, "[3]");
  EXPECT_NE(sceneError(model).find("`weights`"), std::string::npos);
  const std::string more = R"("objects": [{"mesh": "m.gltf", "weights": [1], "material": "m"}])";
  EXPECT_NE(errorOf([&] { scene(model, more); }).find("`weights` are for a `part`"),
            std::string::npos);
}

TEST_F(Gltf, ReadsMeshes) {
  // Positions in 16 bits, normalised, 8 bytes apart; texture coordinates; a sparse normal; a strip.
  const std::string bytes = bytesOf<std::int16_t>({-32767, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0,
                                                   0, -32767, 32767, 0}) +
                            bytesOf<std::uint8_t>({0, 255, 51, 0, 0, 0, 0, 0, 3, 0, 0, 0}) +
                            bytesOf<float>({0, 0, 1});
  const std::string text = R"({"asset": {"version": "2.0"},
"meshes": [{"primitives": [{"mode": 5, "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}},
 {"mode": 6, "attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5122, "normalized": true, "count": 4, "type": "VEC3"},
 {"bufferView": 1, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2"},
 {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 1,
  "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 3}}}],
"bufferViews": [{"buffer": 0, "byteLength": 32, "byteStride": 8}, {"buffer": 0, "byteOffset": 32, "byteLength": 8},
 {"buffer": 0, "byteOffset": 40, "byteLength": 1}, {"buffer": 0, "byteOffset": 44, "byteLength": 12}],
"buffers": [{"byteLength": 56}]})";
  const gltf::File file(container(text, bytes), "m.glb");
  const runtime::Mesh strip = gltf::readMesh(file, "meshes.0.primitives.0");
  EXPECT_EQ(strip.positions, (std::vector<float>{-1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 1}));
  EXPECT_EQ(strip.uvs, (std::vector<float>{0, 0, 0.2f, 1, 0, 1, 0, 1}));
  EXPECT_EQ(strip.normals, (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(strip.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
  EXPECT_EQ(gltf::readMesh(file, "meshes.0.primitives.1").indices,
            (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0}));
  EXPECT_EQ(errorOf([&] { gltf::readMesh(file, "meshes.0.primitives.2"); }),
            "m.glb: unknownName: `m.glb` has no `meshes.0.primitives.2`; its meshes are "
            "named like `meshes.0.primitives.0`");
}

TEST_F(Gltf, ReadsImagesFromBuffers) {
  // A pixel in red, as a PNG file.
  const auto png = bytesOf<std::uint8_t>(
      {0x89, 'P', 'N', 'G', 13,  10,  26,  10,  0,   0,   0,   13,  'I', 'H', 'D', 'R', 0, 0,
       0,    1,   0,   0,   0,   1,   8,   2,   0,   0,   0,   144, 119, 83,  222, 0,   0, 0,
       12,   'I', 'D', 'A', 'T', 120, 218, 99,  248, 207, 192, 0,   0,   3,   1,   1,   0, 247,
       3,    65,  67,  0,   0,   0,   0,   'I', 'E', 'N', 'D', 174, 'B', 96,  130});
  const auto model = [&](const std::string &views) {
    return container(R"({"asset": {"version": "2.0"}, "bufferViews": [)" + views +
                         R"(], "buffers": [{"byteLength": 70}],
"images": [{"bufferView": 0, "mimeType": "image/png"}, {"uri": "data:image/png;base64,)" +
                         base64(png) + R"("}, {"uri": "data:image/png,abc"}]})",
                     "." + png);
  };
  const gltf::File file(model(R"({"buffer": 0, "byteOffset": 1, "byteLength": 69})"), "m.glb");
  for (const char *part : {"images.0", "images.1"}) {
    const runtime::Pixels pixels = gltf::readImage(file, part, runtime::ColorSpace::Linear);
    EXPECT_EQ(pixels.bytes, (std::vector<std::uint8_t>{255, 0, 0}));
  }
  const auto imageError = [&](const gltf::File &from, const char *part) {
    return errorOf([&] { gltf::readImage(from, part, runtime::ColorSpace::Srgb); });
  };
  EXPECT_EQ(imageError(file, "images.2"),
            "m.glb: badBuffer: `m.glb`: `images.2` has a `data:` URI that is not in base64");
  EXPECT_EQ(imageError(file, "images.3"),
            "unknownName: `m.glb` has no `images.3`; its images are named like `images.0`");
  const gltf::File other(model(R"({"buffer": 0, "byteOffset": 20, "byteLength": 50})"), "m.glb");
  EXPECT_EQ(imageError(other, "images.0"),
            "badImage: cannot read `m.glb/images.0`: it is damaged, or in no format that "
            "OpenImageIO reads");
  const gltf::File late(model(R"({"buffer": 0, "byteOffset": 30, "byteLength": 69})"), "m.glb");
  EXPECT_EQ(imageError(late, "images.0"), "m.glb: badBuffer: `m.glb`: `bufferViews.0` ends at byte "
                                          "99 of `buffers.0`, which has 70");
}
