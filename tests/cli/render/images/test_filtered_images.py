"""Images that are filtered by the footprints of rays."""

import json
import unittest

from footprint_case import FootprintCase, MeshCase


class FilteredImages(FootprintCase):
    LEVELS = """
class Level : rt_Material {
  public sampler2D image;
  public float scale = 1.0;
  vec2 placed(vec2 uv) { return scale * uv; }
  void shade() {
    vec2 uv = placed(rt_TextureUV);
    float across = length(scale * rt_dUVdx * vec2(image.size()));
    float up = length(scale * rt_dUVdy * vec2(image.size()));
    vec4 a = image.sample(uv);
    vec4 b = image.sample(uv, log2(max(across, up)));
    vec4 c = image.sampleGrad(uv, scale * rt_dUVdx, scale * rt_dUVdy);
    print(a.rgb, b.rgb, c.rgb, log2(max(across, up)));
    rt_SampleColor = color(a.r, a.g, a.b);
  }
};
"""

    def test_levels_of_an_image_follow_the_footprint(self):
        levels = set()
        for distance, scale, filter in (
            (1, 1, "trilinear"),
            (1, 20, "trilinear"),
            (40, 1, "trilinear"),
            (1e6, 1e5, "trilinear"),
            (40, 2, "anisotropic"),
        ):
            plane = {
                "class": "Parallelogram",
                "constructor": [
                    [-3 * distance, -2 * distance, 2 - distance],
                    [6 * distance, 0, 0],
                    [0, 5 * distance, 0],
                ],
            }
            material = {
                "class": "Level",
                "scale": scale,
                "image": self.checkerboard(64, 3, filter=filter),
            }
            self.scene(self.LEVELS, [{"primitive": plane, "material": material}])
            for line in self.printed():
                a, b, c, level = line[:3], line[3:6], line[6:9], line[9]
                self.assert_close(a, c, 1e-5)
                if filter == "trilinear":
                    self.assert_close(a, b, 1e-5)
                levels.add(int(level))
        self.assertGreater(len(levels), 3)

    FAR = """
class Board : rt_Material {
  public sampler2D image;
  public rt_Texture texture;
  public int way = 0;
  void shade() {
    vec2 uv = 8.0 * rt_TextureUV;
    vec4 value = way == 0 ? image.sample(uv, 0.0) : image.sample(uv);
    rt_SampleColor = way == 2 ? texture.lookup() : color(value.r, value.g, value.b);
  }
};
"""

    def far_scene(self, way, spp=1, filter="trilinear", size=(64, 48)):
        image = self.checkerboard(filter=filter)
        floor = {"class": "Parallelogram", "constructor": [[-40, -1, 10], [80, 0, 0], [0, 0, -80]]}
        material = {
            "class": "Board",
            "image": image,
            "way": way,
            "texture": {"class": "ImageTexture", "image": image, "repeats": [8, 8]},
        }
        camera = {"class": "Eye", "forward": [0, -0.5, -1], "right": [0.5, 0, 0], "up": [0, 0.4, 0]}
        self.scene(
            self.FAR,
            [{"primitive": floor, "material": material}],
            size,
            camera,
            render={"engine": "classic", "size": list(size), "spp": spp, "depth": 2},
        )

    def error(self, a, b):
        text, _ = self.run_rtslc("compare", a, b, "--json", status=None)
        return json.loads(text)["rmse"]

    def test_a_far_pattern_comes_nearer_to_its_mean(self):
        self.far_scene(0, spp=256)
        self.run_rtslc("render", "scene.json", "-q", "-o", "reference.exr", "-O2")
        errors = {}
        for way, filter in (
            (0, "trilinear"),
            (1, "trilinear"),
            (1, "anisotropic"),
            (2, "anisotropic"),
        ):
            self.far_scene(way, filter=filter)
            name = f"{way}-{filter}.exr"
            self.run_rtslc("render", "scene.json", "-q", "-o", name)
            errors[way, filter] = self.error(name, "reference.exr")
        self.assertLess(2 * errors[1, "trilinear"], errors[0, "trilinear"])
        self.assertLess(2 * errors[1, "anisotropic"], errors[0, "trilinear"])
        # A texture of the library sees the same.
        self.assert_same_bits("1-anisotropic.exr", "2-anisotropic.exr")

    def test_every_path_gives_the_same_bits(self):
        for way, filter in ((1, "anisotropic"), (2, "trilinear")):
            self.far_scene(way, filter=filter, size=(16, 12))
            self.same_bits()
        self.run_rtslc("pack", "scene.json", "-q", "-o", "x.rtslpkg")
        self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr")
        self.run_package("x.rtslpkg", "--target=host", "-q", "-o", "y.exr")
        self.assert_same_bits("x.exr", "y.exr")

    ELSEWHERE = """
vec4 widened(sampler2D image, vec2 uv) { return image.sample(uv * (1.0 + 0.0 * length(dFdx(uv)))); }
class Sky : rt_Miss {
  public sampler2D image;
  public rt_Texture texture;
  void miss() {
    vec2 uv = 40.0 * normalize(rt_RayDirection).xy;
    rt_TextureUV = uv;
    vec4 a = image.sample(uv);
    vec4 b = image.sample(uv, 0.0);
    vec4 c = widened(image, uv);
    print(a.r - b.r, a.r - c.r, luminance(texture.lookup()) - b.r, dFdxOf(uv));
    rt_SampleColor = color(a.r, a.g, a.b);
  }
  vec2 dFdxOf(vec2 uv) { return zero(uv); }
};
vec2 zero(vec2 uv) { return dFdx(uv); }
"""

    def test_elsewhere_images_have_level_0(self):
        image = self.checkerboard()
        self.scene(
            self.ELSEWHERE,
            [],
            background={
                "class": "Sky",
                "image": image,
                "texture": {"class": "ImageTexture", "image": image},
            },
        )
        for line in self.printed():
            for number in line:
                self.assertAlmostEqual(number, 0, delta=1e-6)

    def test_programs_without_filtered_images_have_no_cones(self):
        def footprints():
            text, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
            return [
                item for item in self.items(json.loads(text)) if item[0] == "footprints of rays"
            ]

        self.far_scene(1, filter="bilinear")
        self.assertEqual(footprints(), [("footprints of rays", False)])
        self.same_bits([[], ["--keep=all"], ["--target=host-megakernel"]])
        self.far_scene(1, filter="trilinear")
        self.assertEqual(footprints(), [("footprints of rays", True)])
        for filter in ("nearest", "trilinear"):  # through calls that are not inlined
            images = [self.checkerboard(filter=filter), self.checkerboard(8, filter=filter)]
            layers = [{"class": "Plain"}, {"class": "Chosen", "images": images}]
            plane = {"class": "Parallelogram", "constructor": [[-9, -9, 0], [18, 0, 0], [0, 18, 0]]}
            objects = [{"primitive": plane, "material": {"class": "Layered", "layers": layers}}]
            self.scene(self.LAYERED, objects)
            self.assertEqual(footprints(), [("footprints of rays", filter == "trilinear")])
        self.same_bits([[], ["--keep=all"], ["--target=host-megakernel"]])

    LAYERED = """
class Layer { vec4 over(vec4 below, vec2 uv) { return below; } };
class Plain : Layer { vec4 over(vec4 below, vec2 uv) { return 0.5 * below + vec4(uv, uv) * 0.1; } };
class Chosen : Layer {
  public sampler2D images[];
  vec4 over(vec4 below, vec2 uv) {
    return below + images[int(floor(9.0 * uv.x)) & 1].sample(7.0 * uv);
  }
};
class Layered : rt_Material {
  public Layer layers[];
  void shade() {
    vec4 value = vec4(1.0);
    for (int i = 0; i < layers.length(); ++i)
      value = layers[i].over(value, rt_TextureUV);
    rt_SampleColor = color(value.r, value.g, value.b);
  }
};
"""


class OtherCoordinates(MeshCase):
    COORDINATES = """
class Disc : rt_Primitive {
  scratch vec2 uv1;
  void computeBounds() { rt_BoundMin = vec3(-9.0, -9.0, -1.5); rt_BoundMax = vec3(9.0, 9.0, -0.5); }
  void intersect() {
    if (hit((-1.0 - rt_RayOrigin.z) / rt_RayDirection.z))
      uv1 = rt_RayOrigin.xy;
  }
  void computeNormal() { rt_GeometricNormal = vec3(0.0, 0.0, 1.0); }
};
class Second : rt_Material {
  public sampler2D image;
  scratch vec2 uv1;
  vec2 scaled(vec2 uv) { return 9.0 * uv; }
  void shade() {
    vec4 a = image.sample(scaled(uv1));
    vec4 b = image.sample(scaled(rt_TextureUV));
    vec4 c = image.sample(scaled(uv1), 0.0);
    vec2 change = dFdx(uv1);
    print(a.rgb, b.rgb, c.rgb, change);
    rt_SampleColor = color(a.r, a.g, a.b);
  }
};
class Plain : Second {
  void shade() {
    vec4 a = image.sample(scaled(uv1));
    rt_SampleColor = color(a.r, a.g, a.b);
  }
};
"""

    def test_images_are_filtered_by_other_coordinates_of_meshes(self):
        mesh = self.bent_mesh(uv1=self.PLACED)
        disc = {"primitive": {"class": "Disc"}}

        def show(material, *objects, filter="trilinear"):
            material = {"class": material, "image": self.checkerboard(64, 3, filter=filter)}
            self.scene(self.COORDINATES, [{**one, "material": material} for one in objects], (4, 4))

        def needed():
            text, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
            found = dict(self.items(json.loads(text)))
            return found["footprints of rays"], found.get("change of uv1 along dPdx")

        show("Second", mesh, disc)
        kinds = {True: 0, False: 0}
        for line in self.printed():
            a, b, c, change = line[:3], line[3:6], line[6:9], line[9:]
            isMesh = change != [0, 0]
            self.assert_close(a, b if isMesh else c, 1e-3)
            kinds[isMesh] += max(abs(x - y) for x, y in zip(a, c)) > 0.05
        self.assertGreater(kinds[True], 2)
        self.assertEqual(kinds[False], 0)
        self.same_bits()
        for objects, filter, expected in (
            ([mesh], "trilinear", (True, True)),
            ([mesh], "bilinear", (False, False)),
            ([disc], "trilinear", (True, True)),
            ([disc], "nearest", (False, False)),
        ):
            show("Plain", *objects, filter=filter)
            self.assertEqual(needed(), expected)


if __name__ == "__main__":
    unittest.main()
