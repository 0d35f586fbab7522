"""Runs rtslc as a user would, in a folder that goes away."""

import ctypes
import json
import os
import pathlib
import re
import resource
import shutil
import struct
import subprocess
import tempfile
import unittest

RTSLC = os.environ["RTSLC"]
RTSL_RUN = os.environ["RTSL_RUN"]
EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])

FINE, DIAGNOSED, USAGE, INTERNAL = 0, 1, 2, 3
SECONDS = 300  # far beyond what any of these takes: only a hang ends there

# How the stand-in of the CUDA driver (FakeCuda.cpp) can fail, and the messages: of devices that
# cannot be used, and of faults while a program runs.
UNUSABLE_DEVICES = {
    "no-device": "there is a CUDA driver, but no device",
    "old-driver": "the CUDA driver is too old: it has version 9.2; install 10.0 or newer",
    "old-ptx": "the CUDA driver is too old for the program's PTX",
    "other-gpu": "Fake 1000 (sm_75) rejects the program's code: SM version 120 is needed",
}
LITTLE_MEMORY = ("little-memory", "not enough GPU memory for")
FAULTS_OF_DEVICES = {
    "fault": "the GPU failed in cuCtxSynchronize: an illegal memory access was encountered",
    "overflow": "rays of depth 8 overflow the stack that was made for them",
}


# What a program that is only wrong may take, however large or deep it is; of processor time, for
# machines may be busy.
BOUNDED_SECONDS = 30
BOUNDED_BYTES = 2 << 30


GRAPH_ITEMS = (
    "transforms",
    "roots",
    "counts",
    "selectors",
    "motion",
    "masks",
    "back-faces",
)


def example_scenes(part=None, parts=4):
    """The scenes of the examples that `rtslc render` takes, which have no passes; with a part, 0 to
    parts - 1, that share of them, but for `make deep`, which sets RTSL_DEEP. A scene takes seconds,
    and tests of the same code take different ones."""
    scenes = [
        file for file in sorted(EXAMPLES.glob("*/*.json")) if '"passes"' not in file.read_text()
    ]
    return scenes if part is None or "RTSL_DEEP" in os.environ else scenes[part::parts]


def has_gpu():
    try:
        driver = ctypes.CDLL("libcuda.so.1")
    except OSError:
        return False
    count = ctypes.c_int(0)
    return (
        driver.cuInit(0) == 0
        and driver.cuDeviceGetCount(ctypes.byref(count)) == 0
        and count.value > 0
    )


def bounded():
    resource.setrlimit(resource.RLIMIT_CPU, (BOUNDED_SECONDS, BOUNDED_SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (BOUNDED_BYTES, BOUNDED_BYTES))


def obey_permissions():
    """For files that a test makes unreadable: root reads everything, unless the program that it
    starts may not override permissions. (Another user would not do: the build may lie where only
    root can go.)"""
    if os.getuid() == 0:
        drop_from_bounding_set = 24  # PR_CAPBSET_DROP
        for capability in (1, 2):  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH
            ctypes.CDLL(None).prctl(drop_from_bounding_set, capability, 0, 0, 0)


# For tests that take long, and whose code others test too.
deep = unittest.skipUnless("RTSL_DEEP" in os.environ, "`make deep` runs it")


def numbers_of(line):
    """The numbers of a line that a shader printed, of vectors, too."""
    values = re.sub(r"vec\d", "", line.split(": ", 1)[1])
    return [float(n) for n in re.findall(r"[-+]?(?:\d[\d.e+-]*|inf|nan)", values)]


# Ways to render a scene on the CPU: the pictures have the same bits.
WAYS = (
    ["--trace=recurse"],
    ["--trace=split"],
    ["--traversal=device"],
    ["--target=host-megakernel"],
    ["--keep=all"],
    ["--threads", "1"],
)


class Case(unittest.TestCase):
    # The level of optimisation of these commands where a test gives none; None: that of users, as
    # in `make deep`. No picture depends on it, which tests/render and the conformance suite check,
    # nor does what a program needs, and a rendering takes a half to a quarter of the time.
    level = None if "RTSL_DEEP" in os.environ else "-O0"
    OPTIMISING = ("render", "run", "explain", "pack")

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="rtslc-"))
        os.chmod(self.folder, 0o755)
        self.addCleanup(shutil.rmtree, self.folder)
        self.pictures = 0

    def write(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content)
        return path

    def with_level(self, arguments):
        """The arguments of rtslc, with the level of optimisation."""
        optimises = arguments[:1] and arguments[0] in self.OPTIMISING
        if not self.level or not optimises or any(str(a).startswith("-O") for a in arguments):
            return arguments
        return (*arguments, self.level)

    def run_rtslc(
        self,
        *arguments,
        status=FINE,
        stdin=None,
        stdout=subprocess.PIPE,
        unprivileged=False,
        prepare=None,
    ):
        """Gives (standard output, standard error); fails unless the exit status is the expected one
        (None: any)."""
        arguments = self.with_level(arguments)
        done = subprocess.run(
            [RTSLC, *map(str, arguments)],
            cwd=self.folder,
            input=stdin,
            stdout=stdout,
            stderr=subprocess.PIPE,
            timeout=SECONDS,
            preexec_fn=obey_permissions if unprivileged else prepare,
        )
        error = done.stderr.decode("utf-8", "replace")
        if status is not None:
            self.assertEqual(
                done.returncode, status, f"exit status of {arguments}:\n{error[:4000]}"
            )
        return (done.stdout or b"").decode("utf-8", "replace"), error

    def run_with_fake_driver(self, command, status=FINE, fake="", folder=None, devices=1):
        """Gives (standard output, standard error) of a command that finds the stand-in of the CUDA
        driver, with so many devices, or what is in `folder`; `fake` names a way in which the
        stand-in fails."""
        folder = folder or os.environ["FAKE_CUDA_FOLDER"]
        done = subprocess.run(
            command,
            cwd=self.folder,
            timeout=SECONDS,
            env={
                **os.environ,
                "LD_LIBRARY_PATH": str(folder),
                "FAKE_CUDA": fake,
                "FAKE_CUDA_DEVICES": str(devices),
            },
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.assertEqual(done.returncode, status, done.stderr[:4000])
        return done.stdout, done.stderr

    def run_package(self, *arguments, status=FINE, fake=""):
        """The same of rtsl-run."""
        return self.run_with_fake_driver([RTSL_RUN, *arguments], status, fake)

    def render_scene(self, scene, *options):
        """Renders a scene that is given as a document. Returns the file of the picture, a new one
        each time, and the messages."""
        self.pictures += 1
        path = self.write(f"scene{self.pictures}.json", json.dumps(scene, indent=1))
        picture = self.folder / f"{self.pictures}.exr"
        _, error = self.run_rtslc("render", path, "-o", picture, *options)
        return picture, error

    def graph_parts(self, path):
        """What `rtslc explain` calls needed of the things that a scene may have in its graph."""
        said, _ = self.run_rtslc("explain", path, "--no-savings", "--json", "-O0")
        return {
            entry["subject"]
            for item in json.loads(said)["items"]
            if item["item"] in GRAPH_ITEMS
            for entry in item["entries"]
            if entry["needed"]
        }

    def stages(self):
        """What `rtslc compile --emit` takes, in order."""
        text, _ = self.run_rtslc("compile", "--help")
        return re.search(r"--emit ([\w|-]+)", text).group(1).split("|")

    def diagnose(self, *arguments, stdin=None, unprivileged=False, prepare=None):
        """The messages of a run that ends with errors, as data."""
        _, error = self.run_rtslc(
            *arguments,
            "--diagnostics=json",
            status=DIAGNOSED,
            stdin=stdin,
            unprivileged=unprivileged,
            prepare=prepare,
        )
        return json.loads(error)["diagnostics"]

    def assert_message(self, diagnostics, code, containing="", line=None, column=None, file=None):
        """Exactly one message, of this code, at this place."""
        self.assertEqual([d["code"] for d in diagnostics], [code], diagnostics)
        message = diagnostics[0]
        self.assertIn(containing, message["message"])
        if line is not None:
            self.assertEqual(message["range"]["begin"]["line"], line, message)
        if column is not None:
            self.assertEqual(message["range"]["begin"]["column"], column, message)
        if file is not None:
            self.assertTrue(message["range"]["file"].endswith(file), message)

    def assert_same_bits(self, first, second, message=None):
        """Two files that rtslc wrote: a picture of the same bits is the same file."""
        self.assertEqual(
            (self.folder / first).read_bytes(), (self.folder / second).read_bytes(), message
        )

    def write_exr(self, name, width, height, value):
        """A picture of one value everywhere: R, G and B of 32 bits, not compressed."""

        def attribute(name, kind, data):
            return (
                name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data
            )

        channels = (
            b"".join(c + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for c in (b"B", b"G", b"R"))
            + b"\0"
        )
        window = struct.pack("<4i", 0, 0, width - 1, height - 1)
        header = struct.pack("<ii", 20000630, 2)
        header += attribute("channels", "chlist", channels) + attribute(
            "compression", "compression", b"\0"
        )
        header += attribute("dataWindow", "box2i", window) + attribute(
            "displayWindow", "box2i", window
        )
        header += attribute("lineOrder", "lineOrder", b"\0") + attribute(
            "pixelAspectRatio", "float", struct.pack("<f", 1)
        )
        header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
        header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
        line = struct.pack("<f", value) * (3 * width)
        first = len(header) + 8 * height
        offsets = b"".join(struct.pack("<q", first + y * (8 + len(line))) for y in range(height))
        lines = b"".join(struct.pack("<ii", y, len(line)) + line for y in range(height))
        return self.write(name, header + offsets + lines)

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())

    def glass_scene(self, **changes):
        """The scene of the first example with some of its keys replaced, beside its shaders."""
        for source in (EXAMPLES / "glass").iterdir():
            if source.suffix in (".rtsl", ".obj"):
                shutil.copy(source, self.folder)
        scene = json.loads((EXAMPLES / "glass" / "scene.json").read_text())
        scene.update(changes)
        return self.write("scene.json", json.dumps(scene, indent=1))
