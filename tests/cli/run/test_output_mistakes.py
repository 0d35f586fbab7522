"""Output buffers: mistakes in scenes and on the command line, and too little memory or disk."""

import os
import subprocess
import unittest

from harness import DIAGNOSED, FINE, RTSLC, USAGE
from output_case import OutputCase


class OutputMistakes(OutputCase):
    def test_what_is_wrong_in_a_scene(self):
        def refused(containing, code, **changes):
            self.scene(**changes)
            self.assert_message(self.diagnose("run", "scene.json"), code, containing)

        start = {"class": "Probe", "histogram": "histogram", "most": "most"}
        refused(
            "no buffer is named `histogrom`", "E0806", start={**start, "histogram": "histogrom"}
        )
        refused(
            "a `uint[]`, and the buffer `most` an `int[]`",
            "E0804",
            start={**start, "histogram": "most"},
            buffers={"most": {"size": [7]}},
        )
        refused(
            "`size` takes 2 numbers, not 1", "E0804", start={**start, "distance": {"size": [4]}}
        )
        refused("`size` takes 1 to 3 numbers", "E0805", start={**start, "distance": {"size": []}})
        refused(
            "is a list, or has a `size`, or a file",
            "E0803",
            buffers={"histogram": {"shape": [6]}, "most": {"buffer": "initial.npy"}},
        )
        refused("`rayGeneration` or `passes`", "E0802", passes=[{"rayGeneration": start}])
        refused(
            "`width`", "E0802", rayGeneration=None, passes=[{"rayGeneration": start, "width": 3}]
        )
        refused("needs a `rayGeneration`", "E0803", rayGeneration=None, passes=[{"size": [3]}])
        self.write(
            "more.rtsl",
            "class Two : Probe { public inout int again[]; };"
            "class Row : rt_RayGeneration { public out float row[]; "
            "void generate() { row[0] = 1.0; } };",
        )
        more = {"import": ["probe.rtsl", "more.rtsl"]}
        refused(
            "one of them is an output buffer",
            "E0804",
            start={**start, "class": "Two", "again": "histogram"},
            **more,
        )
        refused('needs a size: {"size": [...]}', "E0815", start={"class": "Row"}, **more)

    def test_what_is_wrong_on_the_command_line(self):
        self.scene()
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=distanse=d.npy"),
            "E0806",
            "no output buffer of this name",
        )
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=distance=no/d.npy"),
            "E0902",
            "cannot write `no/d.npy`",
        )
        self.assertIn(
            "is an input",
            self.diagnose("run", "scene.json", "--out=distance=initial.npy")[0]["message"],
        )
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=distance=d.npy", "--out=cells=c.csv"),
            "E0808",
            "its elements are structs",
        )
        for arguments in (
            ["--out=distance"],
            ["--out==x"],
            ["--out=distance=x.npy", "--out=normal=x.npy"],
            ["--out=distance=x.npy", "--out=distance=y.npy"],
        ):
            self.run_rtslc("run", "scene.json", *arguments, status=USAGE)
        self.assertFalse((self.folder / "d.npy").exists())

    def test_more_memory_than_there_is(self):
        for size in ([4000000000, 4000000000], [4000000000, 100000]):
            self.scene(
                start={
                    "class": "Probe",
                    "histogram": "histogram",
                    "most": "most",
                    "distance": {"size": size},
                }
            )
            self.assertIn(
                "not enough memory for member `distance`",
                self.diagnose("run", "scene.json")[0]["message"],
            )

    def test_more_memory_than_there_is_together(self):
        """Each of two buffers fits, but not both, which is known before anything runs. Elements
        that nothing writes take no memory."""
        with open("/proc/meminfo") as lines:
            available = next(int(line.split()[1]) for line in lines if "MemAvailable" in line)
        self.write(
            "pair.rtsl",
            "class Pair : rt_RayGeneration { public out float near[][]; "
            "public out float far[][]; void generate() { near[0][0] = far[0][0] = 2.0; } };",
        )
        for share, status in ((0.7, DIAGNOSED), (0.3, FINE)):
            size = {"size": [int(share * available / 1024), 1 << 18]}  # MiB
            self.scene(
                start={"class": "Pair", "near": size, "far": size},
                size=(2, 1),
                **{"import": ["pair.rtsl"], "objects": [], "materials": {}},
            )
            process = subprocess.Popen(
                [RTSLC, "run", "scene.json", "-q"], cwd=self.folder, stderr=subprocess.PIPE
            )
            error = process.stderr.read().decode()
            process.stderr.close()
            _, ended, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(ended)
            self.assertEqual(process.returncode, status, error)
            self.assertLess(usage.ru_maxrss, available // 4)
            if status == DIAGNOSED:
                self.assertRegex(
                    error, "not enough memory for member `far` of .*: .* GiB, beside .* GiB"
                )

    def test_a_full_disk_leaves_nothing(self):
        self.scene()
        _, error = self.run_rtslc("run", "scene.json", "--out=distance=/dev/full", status=DIAGNOSED)
        self.assertIn("/dev/full", error)


if __name__ == "__main__":
    unittest.main()
