"""Lamps behind materials that let light pass."""

import json
import os
import struct
import unittest

from exr_files import channels
from harness import WAYS, Case

SHADERS = """
class Below : rt_Camera { // the middle of the floor, from under the panes
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 0.2, 2.0);
    rt_RayDirection = vec3(0.002 * rt_ScreenCoord.x - 0.001, -0.1, -1.0);
  }
};
class Floor : rt_Material { // an author's own, white
  void shade() {
    rt_SampleColor = color(0.0);
    illuminance (rt_HitPoint)
      rt_SampleColor += rt_LightColor * abs(dot(normalize(rt_LightDirection), rt_ShadingNormal));
  }
};
class Chosen : rt_Material { // the same by `illuminate`
  void shade() {
    rt_SampleColor = illuminate(0, rt_HitPoint)
        ? rt_LightColor * abs(dot(normalize(rt_LightDirection), rt_ShadingNormal)) : color(0.0);
  }
};
class Film : rt_Material { // an author's own, that sends no rays and has a texture
  public rt_Texture tint;
  void shade() { rt_SampleColor = color(0.0); }
  void transmittance() { rt_SampleColor = tint.lookup(); }
};
class Frosted : Film { // part of the light is scattered
  void diffuseTransmittance() { rt_SampleColor = color(0.5, 0.25, 0.0); }
};
class Halves : rt_Texture {
  void lookup() { rt_TextureColor = rt_TextureUV.x < 0.5 ? color(0.25) : color(1.0, 0.5, 0.25); }
};
class Matte : rt_Material { // the same in the engines of paths
  void BSDF() { rt_BSDFValue = color(0.31830989); }
};
"""

FLOOR = {"class": "Parallelogram", "constructor": [[-9, 0, 9], [18, 0, 0], [0, 0, -18]]}
DOWN = {"class": "DistantLight", "irradiance": [1, 1, 1]}
PATHS = ("path", "volume")
STRAIGHT = 0.04  # what a surface of index 1.5 reflects straight on


def pane(height, name, **members):
    shape = [[-1, height, 3], [2.2, 0, 0], [0, 0, -6]]
    return {
        "primitive": {"class": "Parallelogram", "constructor": shape},
        "material": {"class": name, **members},
    }


def ball(material, radius=0.5, height=1):
    return {
        "primitive": {"class": "Sphere", "center": [0, height, 0], "radius": radius},
        "material": material,
    }


class LightThatPasses(Case):
    def setUp(self):
        super().setUp()
        self.write("Below.rtsl", SHADERS)

    def scene(
        self,
        *objects,
        floor="Floor",
        lights=(DOWN,),
        engine="classic",
        size=(1, 1),
        depth=1,
        **more,
    ):
        return {
            "rtsl": 1,
            "import": ["std", "Below.rtsl"],
            "camera": {"class": "Below"},
            "textures": {"halves": {"class": "Halves"}},
            "objects": [{"primitive": FLOOR, "material": {"class": floor}}, *objects],
            "lights": list(lights),
            "render": {"engine": engine, "size": size, "spp": 1, "depth": depth},
            **more,
        }

    def color(self, *objects, spp=1, **more):
        """The mean over all pixels."""
        picture, _ = self.render_scene(self.scene(*objects, **more), "-q", f"--spp={spp}")
        layers = channels(picture.read_bytes())
        values = [
            struct.unpack(f"<{len(layers[c])}f", struct.pack(f"<{len(layers[c])}I", *layers[c]))
            for c in "RGB"
        ]
        return [sum(of_channel) / len(of_channel) for of_channel in values]

    def sun_in_an_image(self):
        """A background that is black but for one texel near the zenith."""
        texels = [0.0] * (4 * 64 * 32)
        texels[4 * (64 * 29 + 32) : 4 * (64 * 29 + 33)] = [1e3] * 4
        self.write("sun.raw", struct.pack(f"<{len(texels)}f", *texels))
        image = {"raw": "sun.raw", "size": [64, 32], "format": "float32", "channels": 4}
        return {"class": "EnvironmentMap", "image": {**image, "filter": "nearest"}}

    def assert_passes(self, expected, *objects, **more):
        for value, share in zip(self.color(*objects, **more), expected):
            self.assertAlmostEqual(value, share, delta=2e-3 * share + 1e-7)

    def assert_passes_everywhere(self, expected, *objects, **more):
        self.assert_passes(expected, *objects, **more)
        for engine in PATHS:
            with self.subTest(engine):
                self.assert_passes(expected, *objects, **{**more, "floor": "Matte"}, engine=engine)

    def assert_passes_in_classic(self, expected, *objects, **more):
        self.assert_passes(expected, *objects, **more)
        for engine in PATHS:
            with self.subTest(engine):
                self.assert_passes([0] * 3, *objects, **more, floor="Matte", engine=engine)

    def test_thin_glass(self):
        tint = [0.5, 0.8, 1.0]
        twice = (1 - STRAIGHT) ** 2
        expected = [twice * t / (1 - (STRAIGHT * t) ** 2) for t in tint]
        self.assert_passes_everywhere(expected, pane(1, "ThinGlass", transmission=tint))

    def test_two_panes_and_a_lamp_between_them(self):
        glass = {"transmission": [0.5, 0.5, 0.5]}
        one = (1 - STRAIGHT) ** 2 * 0.5 / (1 - (STRAIGHT * 0.5) ** 2)
        self.assert_passes_everywhere(
            [one**2] * 3, pane(1, "ThinGlass", **glass), pane(2, "ThinGlass", **glass)
        )
        lamp = {"class": "PointLight", "position": [0, 1.5, 0], "intensity": [2.25] * 3}
        [bare, *_] = self.color(lights=[lamp])
        [lit, *_] = self.color(
            pane(1, "ThinGlass", **glass), pane(2, "ThinGlass", **glass), lights=[lamp]
        )
        self.assertAlmostEqual(lit / bare, one, delta=2e-3)

    def test_solid_glass(self):
        glass = {"class": "Dielectric", "transmission": [0.5, 0.9, 1.0]}
        surfaces = (1 - STRAIGHT) ** 2
        expected = [surfaces * t for t in glass["transmission"]]  # of a ball of diameter 1
        self.assert_passes_in_classic(expected, ball(glass))
        self.assert_passes_in_classic(expected, ball({**glass, "alpha": 0.3}))

    def test_holes(self):
        leaf = {"class": "Lambert"}
        self.assert_passes_everywhere([0.75] * 3, pane(1, "Cutout", material=leaf, opacity=0.25))
        self.assert_passes_everywhere([0] * 3, pane(1, "Cutout", material=leaf))
        behind = pane(2, "Lambert")
        self.assert_passes_everywhere([0] * 3, pane(1, "Cutout", material=leaf, opacity=0), behind)

    def test_principled(self):
        tint = [0.25, 0.5, 1.0]
        members = {"baseColor": tint, "roughness": 0.4}
        half = [0.5 * (1 - STRAIGHT) * t for t in tint]
        self.assert_passes_in_classic(half, pane(1, "Principled", transmission=0.5, **members))
        self.assert_passes_everywhere([0] * 3, pane(1, "Principled", **members))
        clear = {**members, "roughness": 0.02}
        self.assert_passes_everywhere(half, pane(1, "Principled", transmission=0.5, **clear))

    def test_materials_of_other_materials(self):
        glass = {"class": "ThinGlass", "transmission": [0.5] * 3}
        one = (1 - STRAIGHT) ** 2 * 0.5 / (1 - (STRAIGHT * 0.5) ** 2)
        self.assert_passes_everywhere([one] * 3, pane(1, "NormalMap", material=glass))
        mixed = {"first": glass, "second": {"class": "Lambert"}, "amount": 0.25}
        self.assert_passes_everywhere([0.75 * one] * 3, pane(1, "MixMaterial", **mixed))
        self.assert_passes_everywhere([1] * 3, pane(1, "MediumBoundary"))
        sides = {"front": glass, "back": {"class": "Lambert"}}
        above = pane(1, "TwoSided", **sides)  # its normal points up, away from the floor
        self.assert_passes_everywhere([0] * 3, above)
        below = pane(1, "TwoSided", front=sides["back"], back=glass)
        self.assert_passes_everywhere([one] * 3, below)

    def test_an_authors_material(self):
        halves = {"tint": "halves"}
        self.assert_passes_everywhere([0.25] * 3, pane(1, "Film", **halves))
        self.assert_passes_everywhere([0.25] * 3, pane(1, "Film", **halves), floor="Chosen")
        frosted = pane(1, "Frosted", **halves)
        self.assert_passes([0.75, 0.5, 0.25], frosted)
        for engine in PATHS:
            self.assert_passes([0.25] * 3, frosted, floor="Matte", engine=engine)

    def test_others_let_nothing_pass(self):
        for material in ("Lambert", "Emitter", "Floor", "Gold"):
            with self.subTest(material):
                self.assert_passes_everywhere([0] * 3, pane(1, material))

    def test_searches_pass_as_rays_to_lamps_do(self):
        """A far ball and a small sun in an image, which rays of paths rarely find: what passes of
        them is what passes of lamps in their place."""
        far = {"center": [1, 40, -12], "radius": 0.3}
        bright = [3e4] * 3
        shining = {
            "primitive": {"class": "Sphere", **far},
            "material": {"class": "Emitter", "radiance": bright},
        }
        sky = self.sun_in_an_image()
        lamp = {"class": "SphereLight", **far, "radiance": bright}
        glass = {"class": "ThinGlass", "transmission": [0.5, 0.7, 0.9]}
        fog = {"class": "HomogeneousMedium", "scattering": 0, "absorption": [0.5, 1, 2]}
        both = {"class": "MixMaterial", "first": glass, "second": {"class": "MediumBoundary"}}
        leaf = {"class": "Cutout", "material": {"class": "Lambert"}, "opacity": 0.3}
        box = {
            "primitive": {"class": "Box", "low": [-3, 1, -3], "high": [3, 1.5, 3]},
            "material": {"class": "MediumBoundary", "interior": fog},
        }
        clear = pane(2, "Principled", transmission=0.5, roughness=0)
        panes = {
            "path": [
                [pane(1, "", **glass)],
                [pane(1, "NormalMap", material=glass)],
                [pane(1, "", **leaf), clear],
            ],
            "volume": [[pane(1, "", **both), clear], [box]],
        }
        for engine in PATHS:
            more = {"floor": "Matte", "engine": engine, "size": (16, 16), "spp": 128}
            ways = {
                "lamp": ((), {"lights": [lamp]}),
                "ball": ((shining,), {"lights": []}),
                "sun": ((), {"lights": [], "background": sky}),
            }
            bare = {
                way: self.color(*objects, **light, **more) for way, (objects, light) in ways.items()
            }
            for number, above in enumerate(panes[engine]):
                [expected, *others] = [
                    [
                        lit / full
                        for lit, full in zip(
                            self.color(*above, *objects, **light, **more), bare[way]
                        )
                    ]
                    for way, (objects, light) in ways.items()
                ]
                for way, shares in zip(list(ways)[1:], others):
                    with self.subTest(f"{engine} {number} {way}"):
                        for share, of_lamp in zip(shares, expected):
                            self.assertGreater(of_lamp, 0.05)
                            self.assertAlmostEqual(share / of_lamp, 1, delta=0.03)

    def test_a_lamp_lights_as_a_surface_that_shines_does(self):
        """The rays of paths find it, and so does the search: each counts in part."""
        place = {"center": [0.5, 3, 0], "radius": 0.5}
        lamp = {"class": "SphereLight", **place, "radiance": [9, 9, 9]}
        ball = {
            "primitive": {"class": "Sphere", **place},
            "material": {"class": "Emitter", "radiance": [9, 9, 9]},
        }
        glass = {"class": "ThinGlass", "transmission": [0.5, 0.7, 0.9]}
        clear = {"class": "Principled", "transmission": 1, "roughness": 0, "clearcoat": 1}
        leaf = {"class": "Cutout", "material": clear, "opacity": 0.6}
        mixed = {"class": "MixMaterial", "first": glass, "second": leaf}
        turned = {"class": "NormalMap", "material": glass}
        for number, material in enumerate((glass, clear, leaf, mixed, turned)):
            for engine in PATHS[number % 2 :: 2]:
                with self.subTest(f"{material['class']} {engine}"):
                    above = {**pane(1, ""), "material": material}
                    more = {"floor": "Matte", "engine": engine, "size": (16, 16), "spp": 512}
                    listed = self.color(above, lights=[lamp], depth=6, **more)
                    found = self.color(above, ball, lights=[], depth=6, **more)
                    for one, other in zip(listed, found):
                        self.assertAlmostEqual(one / other, 1, delta=0.03)

    def test_rays_end_at_any_hit_where_nothing_passes(self):
        def passing(*objects):
            scene = json.dumps(self.scene(*objects, floor="Lambert", engine="path"))
            said, _ = self.run_rtslc(
                "explain", self.write("scene.json", scene), "--no-savings", "--json", "-O0"
            )
            return {
                entry["subject"].removesuffix(".transmittance")
                for item in json.loads(said)["items"]
                for entry in item["entries"]
                if entry["subject"].endswith(".transmittance")
                and entry["reason"].startswith("for `illuminate`")
            }

        opaque = {"class": "Principled", "roughness": 0}
        pairs = {"first": opaque, "second": {"class": "Lambert"}, "amount": 0.5}
        sides = {"front": opaque, "back": {"class": "NormalMap", "material": opaque}}
        objects = pane(1, "MixMaterial", **pairs), pane(2, "TwoSided", **sides), ball(opaque)
        self.assertEqual(passing(*objects), set())
        clear = {**opaque, "transmission": 0.5}
        self.assertEqual(passing(ball(clear)), {"Principled"})
        wrapped = pane(1, "NormalMap", material={"class": "ThinGlass"})
        self.assertEqual(passing(*objects, wrapped), {"NormalMap", "TwoSided"})

    def test_64_surfaces_and_no_more(self):
        panes = [pane(1 + i / 64, "MediumBoundary") for i in range(65)]
        self.assert_passes_everywhere([1] * 3, *panes[:64])
        self.assert_passes_everywhere([0] * 3, *panes)

    def test_every_way_gives_the_same_bits(self):
        lamp = {"class": "SphereLight", "center": [2, 4, 1], "radius": 0.5, "radiance": [9, 9, 9]}
        objects = [
            ball({"class": "Dielectric", "transmission": [0.5, 0.9, 1.0]}),
            {**ball({"class": "ThinGlass"}, 0.3), "transform": {"translate": [0.3, 0.4, 0.2]}},
            pane(1.6, "Film", tint="halves"),
            pane(1.8, "Cutout", material={"class": "Lambert"}, opacity=0.5),
            {"mesh": "box.obj", "material": {"class": "Principled", "transmission": 1}},
        ]
        corners = [(x, y, z) for x in (-1, -0.3) for y in (0.1, 0.8) for z in (-0.6, 0.3)]
        faces = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
        self.write(
            "box.obj",
            "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
            + "".join(f"f {face}\n" for face in faces),
        )
        scene = self.scene(*objects, lights=[lamp, DOWN], size=(24, 16), depth=4)
        scene["camera"] = {
            "class": "PerspectiveCamera",
            "constructor": {"eye": [0.5, 1.2, 4], "target": [0, 0.4, 0], "up": [0, 1, 0]},
        }
        scene["import"].append("std.cameras")
        searched = json.loads(json.dumps(scene))
        searched["render"]["engine"] = "volume"
        searched["helpers"] = {"fog": {"class": "HomogeneousMedium", "anisotropy": 0.5}}
        searched["background"] = self.sun_in_an_image()
        searched["objects"] += [
            {
                "primitive": {"class": "Box", "low": [-0.2, 0.9, 0.5], "high": [1, 1.5, 1]},
                "material": {"class": "MediumBoundary", "interior": "fog"},
            },
            *(
                {
                    "primitive": {"class": "Sphere", "center": [x, 2.5, 0], "radius": 0.1},
                    "material": {"class": "Emitter", "radiance": [9, 9, 9]},
                }
                for x in (-0.5, 0.5)
            ),
        ]
        # Nothing passes, but that is not known if parameters are kept.
        fog_alone = json.loads(json.dumps(searched))
        fog_alone["objects"] = [
            searched["objects"][0],
            {**scene["objects"][-1], "material": {"class": "Principled"}},
            ball({"class": "Dielectric", "alpha": 0.2, "interior": "fog"}),
            searched["objects"][-1],
        ]
        every = "RTSL_DEEP" in os.environ
        for one, spp, ways in (
            (scene, 1, WAYS if every else WAYS[::2]),
            (searched, 8, WAYS),
            (fog_alone, 1, WAYS if every else WAYS[1::2]),
        ):
            picture, _ = self.render_scene(one, "-q", f"--spp={spp}")
            for way in ways:
                other, _ = self.render_scene(one, "-q", f"--spp={spp}", *way)
                self.assert_same_bits(picture, other, way)


if __name__ == "__main__":
    unittest.main()
