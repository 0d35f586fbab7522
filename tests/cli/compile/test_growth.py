"""Large programs: code grows with the program and not with its square, and what is done about that
shows in no picture. How long it takes is measured by `bench/run scaling`."""

import json
import unittest

from harness import EXAMPLES, Case

SMALL = ["--size", "24x16", "--spp", "1"]
WAYS = (
    ["--trace=recurse", "--traversal=device"],
    ["--trace=split", "--traversal=device"],
    ["--target=host-megakernel"],
)


def traces(count):
    """A material with so many traces, each in an `if`: after each of them all later ones can be
    reached."""
    steps = "".join(
        f"    if (d.x * {i + 1}.5 > w - {i % 3}.0) {{\n      sum += w * trace(rt_HitPoint, d);\n"
        "      w *= 0.75;\n"
        f"      d = normalize(d + vec3(0.1, {i % 5}.0, 0.2));\n    }}\n"
        for i in range(count)
    )
    return (
        "class Many : rt_Material {\n  void shade() {\n    vec3 d = reflect(rt_RayDirection, "
        "rt_ShadingNormal);\n"
        "    float w = 0.5;\n    color sum = color(0.1);\n"
        + steps
        + "    rt_SampleColor = sum;\n  }\n};\n"
    )


def classes(count):
    return "".join(
        f"class M{i} : rt_Material {{\n  public float gloss = {i}.5;\n  void shade() {{\n"
        f"    rt_SampleColor = color(gloss * 0.01);\n    if (rt_HitPoint.x > 0.0{i % 9})\n"
        "      rt_SampleColor += 0.5 * trace(rt_HitPoint, reflect(rt_RayDirection, "
        f"rt_ShadingNormal));\n  }}\n}};\n"
        for i in range(count)
    )


def large_classes(count, line=""):
    """So many that their code is compiled in parts. Each runs `line`, which may change `x`."""
    lines = "".join(
        f"    x = x * 0.{k % 9 + 1}5 + rt_HitPoint.{'xyz'[k % 3]};\n" for k in range(80)
    )
    return "".join(
        f"class M{i} : rt_Material {{\n  public float gloss = {i}.5;\n  void shade() {{\n"
        f"    float x = gloss;\n{lines}{line}"
        f"    rt_SampleColor = color(abs(x) * 0.1);\n    if (rt_HitPoint.x > 0.0{i % 9})\n"
        "      rt_SampleColor += 0.5 * trace(rt_HitPoint, reflect(rt_RayDirection, "
        f"rt_ShadingNormal));\n  }}\n}};\n"
        for i in range(count)
    )


class Growth(Case):
    def write_scene(self, names):
        glass = EXAMPLES / "glass"
        ball = lambda i, name: {
            "primitive": {
                "class": "Sphere",
                "center": [i % 8 - 3.5, i // 8 * 0.8 - 1, 0],
                "radius": 0.6,
            },
            "material": name,
        }
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": [
                        str(glass / "PinholeCamera.rtsl"),
                        str(glass / "Sphere.rtsl"),
                        "large.rtsl",
                    ],
                    "camera": {
                        "class": "PinholeCamera",
                        "constructor": {
                            "eye": [0, 0, 9],
                            "up": [0, 1, 0],
                            "gaze": [0, 0, -1],
                            "uv0": [-1.6, -0.9],
                            "uv1": [1.6, 0.9],
                            "d": 2.2,
                        },
                    },
                    "materials": {name: {"class": name} for name in names},
                    "objects": [ball(i, name) for i, name in enumerate(names)],
                    "background": [0.2, 0.3, 0.4],
                    "render": {"engine": "classic", "depth": 3},
                }
            ),
        )

    def assert_same_pictures(self, ways=WAYS):
        """The bits are those of any level of optimisation."""
        pictures = []
        for number, way in enumerate(ways):
            self.run_rtslc("render", "scene.json", "-o", f"{number}.exr", "-q", *SMALL, *way)
            pictures.append((self.folder / f"{number}.exr").read_bytes())
        self.assertEqual(pictures, len(ways) * pictures[:1])

    def lines_of_states(self, count):
        self.write("large.rtsl", traces(count))
        text, _ = self.run_rtslc("compile", "large.rtsl", "--emit=split", "-o", "-")
        return text.count("\n")

    def test_states_grow_with_the_number_of_traces(self):
        few, many = self.lines_of_states(40), self.lines_of_states(80)
        self.assertLess(many, 2.6 * few)

    def cpp_of(self, count):
        self.write("large.rtsl", traces(count))
        text, _ = self.run_rtslc("compile", "large.rtsl", "--emit=cpp", "-o", "-")
        return text

    def test_cpp_grows_with_the_number_of_traces(self):
        few, many = self.cpp_of(60), self.cpp_of(120)
        self.assertIn("return rtsl::goOn(Step::", many)
        self.assertLess(many.count("\n"), 2.6 * few.count("\n"))

    def test_cpp_of_a_few_traces_has_no_state_that_no_trace_made(self):
        self.assertNotIn("rtsl::goOn", self.cpp_of(12))

    def test_a_few_traces_are_cut_at_no_join(self):
        self.write("large.rtsl", traces(12))
        text, _ = self.run_rtslc("explain", "--states", "large.rtsl")
        self.assertNotIn("join", text)

    def test_joins_are_reported_and_change_no_picture(self):
        self.write("large.rtsl", traces(60))
        text, _ = self.run_rtslc("explain", "--states", "large.rtsl")
        self.assertIn("\n  join at large.rtsl:", text)
        self.write_scene(["Many"])
        self.assert_same_pictures()

    def test_many_classes_change_no_picture(self):
        self.write("large.rtsl", classes(40))
        self.write_scene([f"M{i}" for i in range(40)])
        self.assert_same_pictures()

    def test_parts_and_threads_change_no_picture(self):
        self.write("large.rtsl", large_classes(80))
        self.write_scene([f"M{i}" for i in range(80)])
        self.assert_same_pictures(WAYS[:2])
        for number, options in enumerate(
            (["-O3"], ["--threads", "1"], ["--trace=split", "--threads", "1"])
        ):
            self.run_rtslc(
                "render",
                "scene.json",
                "-o",
                f"again{number}.exr",
                "-q",
                *SMALL,
                "--traversal=device",
                *options,
            )
            self.assertEqual(
                (self.folder / f"again{number}.exr").read_bytes(),
                (self.folder / "0.exr").read_bytes(),
            )

    def test_features_reach_all_parts(self):
        """Random numbers that depend on the sampler, and exceptions."""
        line = (
            "    float two[2];\n    two[1] = rand();\n"
            "    x += two[int(3.0 * abs(rt_HitPoint.x))];\n"
        )
        self.write("large.rtsl", large_classes(80, line))
        self.write_scene([f"M{i}" for i in range(80)])
        pictures, counts = [], []
        for way in WAYS:
            render = ("render", "scene.json", "-o", "a.exr", "-q", *SMALL, *way)
            out, _ = self.run_rtslc(*render, "--sampler=sobol", "--exceptions", "--json")
            counts.append(json.loads(out)["exceptions"]["index"])
            pictures.append((self.folder / "a.exr").read_bytes())
        self.assertGreater(counts[0], 0)
        self.assertEqual(counts, 3 * counts[:1])
        self.assertEqual(pictures, 3 * pictures[:1])


if __name__ == "__main__":
    unittest.main()
