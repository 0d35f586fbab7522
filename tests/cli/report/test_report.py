"""`rtslc report`: what it writes, that it resumes after an interruption, and its messages for
unusable references."""

import csv
import json
import re
import signal
import subprocess
import time
import unittest

from harness import RTSLC, USAGE, Case, deep

SMALL = ("--size", "24x16", "--budget", "30ms", "--runs", "3")


class Report(Case):
    def report(self, *arguments, status=0, size=SMALL):
        self.glass_scene()
        return self.run_rtslc(
            "report", "scene.json", "--out", "out", *size, *arguments, status=status
        )

    def measurements(self):
        with open(self.folder / "out" / "measurements.csv", newline="") as table:
            return list(csv.DictReader(table))

    def test_writes_tables_json_and_a_page(self):
        out, error = self.report("--json")
        self.assertEqual(error, "")
        document = json.loads(out)
        self.assertEqual(document, json.loads((self.folder / "out" / "report.json").read_text()))
        names = [configuration["name"] for configuration in document["configurations"]]
        for name in (
            "strict embree recurse",
            "strict device split",
            "fast embree recurse",
            "fast device split",
        ):
            self.assertIn(name, names)
        pictures = {
            c["commonPicture"] for c in document["configurations"] if c["name"].startswith("strict")
        }
        self.assertEqual(len(pictures), 1, "in strict mode all of them make the same picture")
        rows = self.measurements()
        for configuration in document["configurations"]:
            self.assertGreaterEqual(len(configuration["levels"]), 3)
            for level in configuration["levels"]:
                self.assertEqual(level["runs"], 3)
                self.assertEqual(
                    len(
                        [
                            r
                            for r in rows
                            if r["configuration"] == configuration["name"]
                            and int(r["spp"]) == level["spp"]
                        ]
                    ),
                    3,
                )
                self.assertGreater(level["relMse"]["value"], 0)
        self.assertGreater(document["reference"]["ownError"]["rmse"], 0)
        page = (self.folder / "out" / "index.html").read_text()
        self.assertEqual(page.count('<svg class="plot"'), 5)
        self.assertEqual(document["version"], 2)
        self.assertIsNone(document["heavyTails"])
        self.assertNotRegex(page, r"https?://")
        self.assertFalse((self.folder / "out" / "partial").exists())

    # Of 24x16 pixels with some 32 000 samples each in the reference an eighth meets one that is ten
    # thousand times as bright.
    HOT = (
        "class Hot : rt_Miss { void miss() {"
        " rt_SampleColor = color(rand() < 0.00004 ? 1000000.0 : 0.05); } };"
    )

    def test_rare_hot_samples_have_no_interval(self):
        self.glass_scene()
        self.write("hot.rtsl", self.HOT)
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"] = (
            scene["import"] if isinstance(scene["import"], list) else [scene["import"]]
        ) + ["hot.rtsl"]
        scene["background"] = {"class": "Hot"}
        self.write("hot.json", json.dumps(scene))
        out, _ = self.run_rtslc(
            "report",
            "hot.json",
            "--out",
            "hot",
            "--size",
            "24x16",
            "--budget",
            "1s",
            "--runs",
            "4",
            "--only",
            "embree recurse",
        )
        self.assertIn("no interval can be given", out)
        document = json.loads((self.folder / "hot" / "report.json").read_text())
        self.assertTrue(document["reference"]["ownError"]["heavyTails"])
        self.assertIsNone(document["reference"]["ownError"]["relMse"])
        self.assertIsNone(document["configurations"][0]["relMseOverSeconds"])
        self.assertIn("no interval can be given", (self.folder / "hot" / "index.html").read_text())

    def test_a_bright_scene_is_shown_at_another_exposure(self):
        self.glass_scene()
        self.write(
            "bright.rtsl",
            "class Bright : rt_Miss { void miss() { rt_SampleColor = color(300.0 * (0.1 + "
            "rt_RayDirection.y * rt_RayDirection.y)); } };",
        )
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"] = (
            scene["import"] if isinstance(scene["import"], list) else [scene["import"]]
        ) + ["bright.rtsl"]
        scene["background"] = {"class": "Bright"}
        self.write("bright.json", json.dumps(scene))
        self.run_rtslc(
            "report", "bright.json", "--out", "bright", *SMALL, "--only", "strict embree recurse"
        )
        page = (self.folder / "bright" / "index.html").read_text()
        self.assertRegex(page, r"the reference, at an exposure of -\d+(\.5)? stops")
        self.assertIn("brighter than a screen", page)

    @deep
    def test_goes_on_after_an_interruption(self):
        self.glass_scene()
        arguments = [
            RTSLC,
            "report",
            "scene.json",
            "--out",
            "out",
            "--size",
            "48x32",
            "--budget",
            "3s",
            "--runs",
            "3",
            "--only",
            "embree recurse",
        ]
        running = subprocess.Popen(
            arguments, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        table = self.folder / "out" / "measurements.csv"
        for _ in range(6000):
            if table.exists() and table.read_text().count("\n") > 4:
                break
            time.sleep(0.02)
        running.send_signal(signal.SIGINT)
        error = running.communicate(timeout=300)[1].decode()
        self.assertEqual(running.returncode, 130, error)
        self.assertIn("the same command goes on from here", error)
        before = table.read_text()
        # Interrupted while it wrote, too.
        table.write_text(before + "strict embree rec")
        self.run_rtslc(*arguments[1:])
        self.assertTrue(table.read_text().startswith(before))
        finished = table.read_text()
        self.run_rtslc(*arguments[1:])
        self.assertEqual(table.read_text(), finished, "nothing is left to measure")

    def test_refuses_the_folder_of_another_study(self):
        self.report("--only", "embree recurse")
        _, error = self.run_rtslc(
            "report",
            "scene.json",
            "--out",
            "out",
            "--size",
            "25x16",
            "--only",
            "embree recurse",
            status=1,
        )
        self.assertIn("--fresh", error)
        self.run_rtslc(
            "report",
            "scene.json",
            "--out",
            "out",
            "--fresh",
            "--size",
            "25x16",
            "--budget",
            "10ms",
            "--runs",
            "2",
            "--only",
            "embree recurse",
        )

    def test_takes_the_size_of_the_reference(self):
        self.write_exr("grey.exr", 20, 10, 0.5)
        out, _ = self.report(
            "--reference",
            "grey.exr",
            "--json",
            "--only",
            "embree recurse",
            size=("--budget", "10ms", "--runs", "2"),
        )
        self.assertEqual(json.loads(out)["size"], [20, 10])

    def test_says_what_is_wrong_with_a_reference_and_still_reports(self):
        for value, size, words in (
            (float("nan"), (24, 16), "has no finite pixel"),
            (0.0, (24, 16), "the reference is black"),
            (0.5, (30, 10), "has 30x10 pixels"),
        ):
            self.write_exr("reference.exr", *size, value)
            out, _ = self.report(
                "--reference", "reference.exr", "--json", "--fresh", "--only", "embree recurse"
            )
            document = json.loads(out)
            self.assertRegex("\n".join(document["problems"]), re.escape(words))
            self.assertGreater(document["configurations"][0]["levels"][0]["seconds"]["value"], 0)
            self.assertIn(words, (self.folder / "out" / "index.html").read_text())

    def test_bad_arguments(self):
        self.report("--budget", "soon", status=USAGE, size=())
        self.report("--runs", "1", status=USAGE, size=())
        self.report("--only", "fastest", status=1)
        self.report("--reference", "missing.exr", status=1)
        self.write("file", "")
        self.run_rtslc("report", "scene.json", "--out", "file", status=1)


if __name__ == "__main__":
    unittest.main()
