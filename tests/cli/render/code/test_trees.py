"""--tree: pictures have the same bits whatever built the trees, on every target; and what was built
is said."""

import json
import unittest

from harness import Case, example_scenes

SMALL = ("--size", "32x18", "--spp", "2")


class Trees(Case):
    level = "-O0"

    def render(self, *arguments):
        return self.run_package("x.rtslpkg", "-o", "out.exr", *SMALL, *arguments)

    def tree_of(self, *arguments):
        out = self.render("--json", *arguments)[0]
        return json.loads(out).get("tree")

    def bumpy_scene(self):
        """A surface of 9,800 triangles."""
        side = 71
        lines = [
            f"v {x / 35 - 1} {y / 35 - 1} {(x * 7919 + y * 104729) % 101 / 500}"
            for y in range(side)
            for x in range(side)
        ]
        for y in range(side - 1):
            for x in range(side - 1):
                i = y * side + x + 1
                lines += [f"f {i} {i + 1} {i + side}", f"f {i + 1} {i + side + 1} {i + side}"]
        self.write("bumpy.obj", "\n".join(lines) + "\n")
        self.glass_scene()
        scene = json.loads((self.folder / "scene.json").read_text())
        for one in scene["objects"]:
            if "mesh" in one:
                one["mesh"] = "bumpy.obj"
        self.write("scene.json", json.dumps(scene))

    def test_the_examples_have_the_same_bits(self):
        for scene in example_scenes(part=0):
            with self.subTest(scene=scene):
                self.run_rtslc("pack", str(scene), "-o", "x.rtslpkg", "-q", "-O0")
                self.render("--target=host", "--tree=good")
                (self.folder / "out.exr").rename(self.folder / "good.exr")
                self.render("--target=host", "--tree=fast", "--compare", "good.exr")

    def test_packages_without_trees_get_them(self):
        self.bumpy_scene()
        self.run_rtslc("pack", "scene.json", "-o", "good.rtslpkg", "-q", "-O0")
        _, error = self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "--tree=fast", "-O0")
        self.assertIn("without trees", error)
        sizes = [(self.folder / f"{name}.rtslpkg").stat().st_size for name in ("x", "good")]
        self.assertLess(sizes[0] + 9800 * 48, sizes[1])
        fast, good = self.tree_of("--target=host"), self.tree_of("--target=host", "--tree=good")
        self.assertEqual((fast["kind"], good["kind"]), ("fast", "good"))
        self.assertGreater(fast["cost"], good["cost"] * 0.9)
        self.assertLess(fast["cost"], good["cost"] * 1.3)
        (self.folder / "out.exr").rename(self.folder / "first.exr")
        # The device builds the same tree as the host.
        gpu = self.tree_of("--target=gpu")
        for name in ("kind", "nodes", "items", "cost"):
            self.assertEqual(gpu[name], fast[name])
        (self.folder / "good.rtslpkg").rename(self.folder / "x.rtslpkg")
        self.assertIsNone(self.tree_of("--target=host", "--compare", "first.exr"))
        again = self.tree_of("--target=host", "--tree=fast", "--compare", "first.exr")
        self.assertEqual(again["nodes"], fast["nodes"])

    def test_visits_are_counted_with_the_steps(self):
        self.bumpy_scene()
        counted = ("render", "scene.json", "-o", "a.exr", *SMALL, "--target=host-megakernel")
        out, _ = self.run_rtslc(*counted, "--json", "--lane-use")
        document = json.loads(out)
        tree = document["tree"]
        steps = {one["step"]: one["steps"] for one in document["steps"]}
        self.assertGreaterEqual(tree["rays"], steps["traversal"])  # and the rays towards lights
        for visited in ("nodes", "items"):
            self.assertGreater(tree[visited + "PerRay"], 0.5)
            self.assertLess(tree[visited + "PerRay"], tree[visited] / 2)
        _, error = self.run_rtslc(*counted, "--lane-use")
        self.assertIn(
            f"{tree['rays']} rays in the tree: {tree['nodesPerRay']:.1f} nodes and "
            f"{tree['itemsPerRay']:.1f} items each",
            error,
        )
        out, _ = self.run_rtslc(*counted, "--json")
        self.assertNotIn("rays", json.loads(out)["tree"])

    def test_every_target_says_what_it_built(self):
        self.bumpy_scene()
        for target in ("--target=host-megakernel", "--traversal=device"):
            for kind in ("fast", "good", "auto"):
                out, _ = self.run_rtslc(
                    "render",
                    "scene.json",
                    "-o",
                    f"{kind}.exr",
                    *SMALL,
                    target,
                    f"--tree={kind}",
                    "--json",
                )
                tree = json.loads(out)["tree"]
                self.assertEqual(tree["kind"], "good" if kind == "auto" else kind)
                self.assertGreater(tree["cost"], 1)
                self.assertGreaterEqual(tree["seconds"], 0)
                self.assert_same_bits(f"{kind}.exr", "fast.exr")
        _, error = self.run_rtslc(
            "render", "scene.json", "-o", "a.exr", *SMALL, "--traversal=device", "--tree=fast"
        )
        self.assertRegex(error, r"fast tree: \d+ nodes for \d+ items, cost [\d.]+, built in \d+ ms")


if __name__ == "__main__":
    unittest.main()
