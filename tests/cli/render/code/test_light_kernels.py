"""The states of a wavefront that look for lights in a kernel of their own, before the one that
shades. What they find is taken only as the answer to the same question, so pictures have the same
bits with and without; the CPU runs both."""

import json
import re
import unittest

from harness import EXAMPLES, USAGE, Case

WAVE = ("--target=host-megakernel", "--organisation=wavefront", "-q")
ALWAYS, NEVER = "--light-kernels=always", "--light-kernels=never"

# Asks about lights more often than answers have a place, at points that depend on answers, and then
# until one is seen.
ENGINE = """
import std.sampling;

struct Ray {
  color light;
  color weight;
};

class Engine : rt_RayGeneration {
  void generate() {
    Ray ray;
    ray.light = color(0.0);
    ray.weight = color(1.0);
    trace(rt_RayOrigin, rt_RayDirection, 0.0, 1e30, ray);
    rt_SampleColor = ray.light;
  }
};

class Wall : rt_Material {
  public bool shines = false;
  void emission() { rt_EmissionColor = shines ? color(4.0) : color(0.0); }

  void closestHit(inout Ray ray) {
    if (shines) {
      ray.light += ray.weight;
      return;
    }
    vec3 normal = faceforward(normalize(rt_GeometricNormal), rt_RayDirection, rt_GeometricNormal);
    vec3 point = rt_HitPoint;
    for (int i = 0; i < QUESTIONS; ++i)
      if (illuminate(point, normal)) {
        ray.light += (0.1 * float(i + 1)) * ray.weight * rt_LightColor;
        point = rt_HitPoint + (0.05 * float(i + 1)) * normal;
      }
    int tries = 0;
    while (!illuminate(rt_HitPoint, normal) && tries < TRIES)
      ++tries;
    ray.light += color(0.001 * float(tries));
    ray.weight *= 0.5;
    vec3 direction = frameAround(normal) * sampleHemisphereCosine(vec2(rand(), rand()));
    trace(rt_HitPoint, direction, 0.0, 1e30, ray);
  }
};

class Dark : rt_Miss {
  void miss(inout Ray ray) {}
};
"""


def wall(corner, first, second, material):
    return {
        "primitive": {"class": "Parallelogram", "constructor": [corner, first, second]},
        "material": material,
    }


def room():
    """A box that is open to the camera, with a lamp below its ceiling and a block on its floor."""
    return {
        "rtsl": 1,
        "import": ["std.cameras", "std.primitives", "Engine.rtsl"],
        "camera": {
            "class": "ThinLensCamera",
            "constructor": {"eye": [0, 1, 4], "target": [0, 1, 0], "up": [0, 1, 0]},
            "fieldOfView": 40,
            "focusDistance": 4,
        },
        "rayGeneration": {"class": "Engine"},
        "background": {"class": "Dark"},
        "materials": {"wall": {"class": "Wall"}, "lamp": {"class": "Wall", "shines": True}},
        "objects": [
            wall([-1, 0, 1], [2, 0, 0], [0, 0, -2], "wall"),
            wall([-1, 0, -1], [2, 0, 0], [0, 2, 0], "wall"),
            wall([-1, 0, 1], [0, 0, -2], [0, 2, 0], "wall"),
            wall([-0.4, 1.9, 0.4], [0.8, 0, 0], [0, 0, -0.8], "lamp"),
            wall([-0.5, 0.9, 0.3], [0.7, 0.2, 0.1], [0, 0.1, -0.6], "wall"),
        ],
        "render": {"engine": "programs", "size": [40, 40], "spp": 8, "depth": 4},
    }


def engine(questions, tries=3):
    return ENGINE.replace("QUESTIONS", str(questions)).replace("TRIES", str(tries))


class LightKernels(Case):
    def render_both(self, scene, *options):
        """The two pictures have the same bits. Returns what their summaries say."""
        summaries = []
        for lights, picture in ((NEVER, "never.exr"), (ALWAYS, "always.exr")):
            out, _ = self.run_rtslc(
                *("render", scene, "-o", picture, *WAVE, lights, "--json", *options),
                "-Wno-depth-limit",
            )
            summaries.append(json.loads(out))
        self.assert_same_bits("never.exr", "always.exr")
        return summaries

    def test_pictures_have_the_same_bits(self):
        """A mesh and a lamp; lights, and what is in front of an environment; and a material that
        tests hits at random."""
        for name in ("cornell/room.json", "environment/scene.json", "gltf/scene.json"):
            with self.subTest(scene=name):
                self.render_both(EXAMPLES / name, "--size=24x18", "--spp=3", "-O1")

    def test_questions_that_depend_on_answers(self):
        for questions in (1, 3, 9):
            self.write("Engine.rtsl", engine(questions))
            for level in ("-O0", "-O2"):
                with self.subTest(questions=questions, level=level):
                    self.render_both(self.write("room.json", json.dumps(room())), level)

    def test_a_shader_that_waits_for_a_light_goes_on(self):
        self.write("Engine.rtsl", engine(1, tries=200))
        for level in ("-O0", "-O2"):
            with self.subTest(level=level):
                self.render_both(
                    self.write("room.json", json.dumps(room())), level, "--size=16x16", "--spp=2"
                )

    def test_uninitialised_state_has_no_part_in_it(self):
        self.write("Engine.rtsl", engine(3))
        scene = self.write("room.json", json.dumps(room()))
        self.render_both(scene, "--undefined=bytes")
        (self.folder / "always.exr").rename(self.folder / "bytes.exr")
        self.render_both(scene, "--undefined=nan")
        self.assert_same_bits("always.exr", "bytes.exr")

    def test_nothing_is_counted_twice(self):
        self.write("Engine.rtsl", engine(2))
        never, always = self.render_both(self.write("room.json", json.dumps(room())), "-O1")
        self.assertGreater(never["raysTooDeep"], 0)
        self.assertEqual(never["raysTooDeep"], always["raysTooDeep"])

    def kernels(self, scene, *options):
        """The kernels of a wavefront by their names: how many instructions their PTX has."""
        ptx, _ = self.run_rtslc(
            *("compile", scene, "--emit=ptx", "--organisation=wavefront", "--gpu-arch=sm_80"),
            *("-Wno-depth-limit", *options),
        )
        found = re.findall(r"\.entry (rtsl_wave_\w+)\(.*?^\{(.*?)^\}", ptx, re.S | re.M)
        return {name: body.count(";") for name, body in found}

    def test_a_light_kernel_does_nothing_else(self):
        kernels = self.kernels(EXAMPLES / "gltf" / "scene.json")
        lights = [name for name in kernels if name.startswith("rtsl_wave_light_")]
        self.assertGreater(len(lights), 1)
        for light in lights:
            state = light.replace("light", "state")
            self.assertLess(kernels[light], kernels[state] / 3, light)

    def test_a_light_kernel_has_fewer_registers(self):
        scene = EXAMPLES / "cornell" / "room.json"
        ptx, _ = self.run_rtslc(
            *("compile", scene, "--emit=ptx", "--organisation=wavefront", "-O1", ALWAYS)
        )
        limited = re.findall(r"\.entry (\w+)\([^)]*\)\s*\.maxnreg 64\s", ptx)
        self.assertGreater(len(limited), 3)
        self.assertEqual(limited, re.findall(r"\.entry (rtsl_wave_light_\d+)", ptx))

    def test_small_states_have_none(self):
        scene = EXAMPLES / "cornell" / "room.json"
        self.assertFalse([name for name in self.kernels(scene, "-O1") if "light" in name])
        always = [name for name in self.kernels(scene, "-O1", ALWAYS) if "light" in name]
        self.assertGreater(len(always), 3)

    def test_programs_whose_states_must_run_once_have_none(self):
        scene = EXAMPLES / "cornell" / "room.json"
        kernels = self.kernels(scene, ALWAYS, "--exceptions", "-O1")
        self.assertFalse([name for name in kernels if "light" in name])

    def test_the_value_is_one_of_those_listed(self):
        _, error = self.run_rtslc(
            *("render", EXAMPLES / "metal" / "scene.json", "-o", "a.exr", "--light-kernels=no"),
            status=USAGE,
        )
        self.assertIn("`no` is none of auto, always, never", error)


if __name__ == "__main__":
    unittest.main()
