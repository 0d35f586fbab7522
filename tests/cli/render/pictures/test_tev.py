"""rtslc render --tev: what it sends to a viewer, here a small server, and what it reports."""

import json
import socket
import struct
import subprocess
import threading
import time
import unittest

from exr_files import channels as exr_channels
from harness import FINE, RTSLC, SECONDS, USAGE, Case

CREATE, UPDATE = 4, 3

CAMERA = """class Camera : rt_Camera;
void generateRay() {
  rt_RayOrigin = vec3(0.0);
  rt_RayDirection = vec3(rt_ScreenCoord.xy, 1.0);
}
"""
# A picture of 8 MB that takes no time.
SKY = {
    "rtsl": 1,
    "import": ["Camera.rtsl"],
    "camera": {"class": "Camera"},
    "background": [0.25, 0.5, 1],
    "render": {"size": [1024, 700]},
}


class Viewer:
    """Takes one connection, and keeps the pictures that its messages make. With `most`, hangs up
    after that many bytes. With `reads`, an event, reads nothing before it is set, and for
    `slow_seconds` after that some bytes at a time."""

    def __init__(self, most=None, reads=None, family=socket.AF_INET, slow_seconds=0):
        self.most, self.reads, self.slow_seconds = most, reads, slow_seconds
        self.pictures, self.updates, self.order = {}, 0, []
        self.server = socket.socket(family)
        if reads:
            self.server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.server.bind(("::1" if family == socket.AF_INET6 else "127.0.0.1", 0))
        self.server.listen()
        self.port = self.server.getsockname()[1]
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        connection, _ = self.server.accept()
        with connection:
            if self.reads:
                self.reads.wait()
            data = b""
            end = time.monotonic() + self.slow_seconds
            while time.monotonic() < end:
                data += connection.recv(1024)
                time.sleep(0.05)
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
            while self.most is None or len(data) < self.most:
                part = connection.recv(1 << 16)
                if not part:
                    break
                data += part
        if self.most is None:
            self.read(data)

    def read(self, data):
        at = 0
        while at < len(data):
            length, kind = struct.unpack_from("<IB", data, at)
            self.message(kind, data[at + 5 : at + length])
            at += length
        assert at == len(data)

    def message(self, kind, data):
        grab, name, rest = data[0], *data[1:].split(b"\0", 1)
        self.order.append(kind)
        if kind == CREATE:
            assert grab == 1
            width, height, count = struct.unpack_from("<III", rest)
            channels = rest[12:].split(b"\0")
            assert channels[-1] == b"" and len(channels) == count + 1
            self.pictures[name.decode()] = (
                width,
                height,
                {c.decode(): [None] * (width * height) for c in channels[:-1]},
            )
        elif kind == UPDATE:
            channel, rest = rest.split(b"\0", 1)
            x, y, width, height = struct.unpack_from("<IIII", rest)
            whole_width, _, channels = self.pictures[name.decode()]
            values = struct.unpack(f"<{width * height}f", rest[16:])
            for row in range(height):
                start = (y + row) * whole_width + x
                channels[channel.decode()][start : start + width] = values[
                    row * width : (row + 1) * width
                ]
            self.updates += 1
        else:
            raise AssertionError(kind)

    def end(self):
        self.thread.join()
        self.server.close()


class Tev(Case):
    level = "-O0"

    def free_port(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            return server.getsockname()[1]

    def test_the_viewer_has_the_picture(self):
        """At the end, that of the file; the file is the one without a viewer."""
        self.glass_scene()
        small = ("scene.json", "--size", "40x20", "--spp", "3", "-q")
        self.run_rtslc("render", *small, "-o", "alone.exr")
        for color in ("rgb", "spectral:4"):
            viewer = Viewer()
            self.run_rtslc(
                "render",
                *small,
                "--color",
                color,
                "-o",
                f"{color[0]}.exr",
                "--tev",
                f"127.0.0.1:{viewer.port}",
            )
            viewer.end()
            self.assertEqual(list(viewer.pictures), [f"{color[0]}.exr"])
            width, height, channels = viewer.pictures[f"{color[0]}.exr"]
            self.assertEqual((width, height, viewer.order[0]), (40, 20, CREATE))
            self.assertEqual(list(channels), ["R", "G", "B"])
            if color == "rgb":
                self.assert_same_bits("alone.exr", "r.exr")
                read = exr_channels((self.folder / "r.exr").read_bytes())
                for name, values in channels.items():
                    self.assertEqual(
                        read[name], list(struct.unpack("<800I", struct.pack("<800f", *values)))
                    )
            else:
                self.assertTrue(all(value >= 0 for value in channels["G"]))

    def test_addresses_of_ipv6(self):
        self.glass_scene()
        small = ("scene.json", "--size", "40x20", "--spp", "1", "-o", "a.exr", "--tev")
        try:
            viewer = Viewer(family=socket.AF_INET6)
        except OSError:
            self.skipTest("this machine has no IPv6")
        self.run_rtslc("render", *small, f"[::1]:{viewer.port}")
        viewer.end()
        self.assertEqual(list(viewer.pictures), ["a.exr"])
        messages = self.diagnose("render", *small, f"[::1]:{viewer.port}")
        self.assert_message(
            messages, "E0908", f"cannot reach a viewer at `[::1]:{viewer.port}`: Connection refused"
        )

    def test_it_is_shown_while_it_is_rendered(self):
        self.glass_scene()
        viewer = Viewer()
        self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "-q",
            "--size",
            "32x18",
            "--time",
            "2500ms",
            "--tev",
            f"127.0.0.1:{viewer.port}",
        )
        viewer.end()
        self.assertGreater(viewer.updates, 3)  # three of a picture
        self.assertEqual(viewer.order.count(CREATE), 1)

    def until_the_file_is_there(self, viewer, *options):
        """Renders a picture larger than what the system keeps for a viewer that does not read, and
        gives the messages. The viewer reads when the file is there, if it waits for that."""
        self.write("Camera.rtsl", CAMERA)
        self.write("scene.json", json.dumps(SKY))
        rendering = subprocess.Popen(
            [RTSLC, "render", "scene.json", "-o", "a.exr", "-O0", *options]
            + ["--tev", f"127.0.0.1:{viewer.port}"],
            cwd=self.folder,
            stderr=subprocess.PIPE,
            text=True,
        )
        while rendering.poll() is None and not (self.folder / "a.exr").exists():
            time.sleep(0.02)
        is_sending = rendering.poll() is None
        viewer.reads.set()
        _, error = rendering.communicate(timeout=SECONDS)
        viewer.end()
        self.assertEqual(rendering.returncode, FINE, error)
        self.assertTrue(is_sending, "the file was written after the viewer had been given up")
        return error

    def test_a_slow_viewer_delays_nothing(self):
        """It reads nothing before the file is there, and shows the last picture in the end, also if
        it accepts little for longer than one that accepts nothing is waited for."""
        for seconds, options in ((7, ("--spp", "1")), (0, ("--time", "1500ms"))):
            viewer = Viewer(reads=threading.Event(), slow_seconds=seconds)
            error = self.until_the_file_is_there(viewer, *options)
            self.assertNotIn("W2869", error)
            _, _, channels = viewer.pictures["a.exr"]
            read = exr_channels((self.folder / "a.exr").read_bytes())
            for name, values in channels.items():
                bits = struct.unpack(f"<{len(values)}I", struct.pack(f"<{len(values)}f", *values))
                self.assertTrue(read[name] == list(bits), name)
            (self.folder / "a.exr").unlink()

    def test_a_viewer_that_accepts_nothing(self):
        self.write("Camera.rtsl", CAMERA)
        self.write("scene.json", json.dumps(SKY))
        viewer = Viewer(reads=threading.Event(), most=0)
        _, error = self.run_rtslc(
            "render", "scene.json", "-o", "a.exr", "--spp", "1", "--tev", f"127.0.0.1:{viewer.port}"
        )
        viewer.reads.set()
        viewer.end()
        self.assertIn("shows an earlier picture: no answer for 5 seconds", error)
        self.assertIn("a.exr", self.files())

    def test_a_viewer_that_is_not_there(self):
        self.glass_scene()
        port = self.free_port()
        messages = self.diagnose(
            "render", "scene.json", "-o", "a.exr", "--tev", f"127.0.0.1:{port}"
        )
        self.assert_message(
            messages, "E0908", f"cannot reach a viewer at `127.0.0.1:{port}`: Connection refused"
        )
        self.assertIn("start tev there first", str(messages))
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "a.exr", "--tev", "no.such.host.invalid"),
            "E0908",
            "cannot reach a viewer at `no.such.host.invalid:14158`",
        )
        self.assertNotIn("a.exr", self.files())

    def test_a_viewer_that_goes_away(self):
        """The picture is written, and a warning says what the viewer shows."""
        self.glass_scene()
        viewer = Viewer(most=1)
        _, error = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "--size",
            "64x36",
            "--time",
            "3s",
            "--tev",
            f"127.0.0.1:{viewer.port}",
        )
        viewer.end()
        self.assertIn("W2869", error)
        self.assertIn(f"the viewer at `127.0.0.1:{viewer.port}` shows an earlier picture", error)
        self.assertIn("a.exr", self.files())

    def test_bad_values(self):
        self.glass_scene()
        for value, message in (
            (":14158", "names no host"),
            ("localhost:0", "1 to 65535"),
            ("localhost:tev", "1 to 65535"),
            ("localhost:70000", "1 to 65535"),
            ("localhost:", "1 to 65535"),
            ("::1", "such as [::1]:14158"),
            ("a:1:2", "an address of IPv6 is written in brackets, such as [::1]:14158"),
            ("[::1", "has no `]`"),
            ("[]:14158", "names no host"),
            ("[::1]14158", "is not `]` or `]:PORT` at its end"),
        ):
            _, error = self.run_rtslc(
                "render", "scene.json", "-o", "a.exr", "--tev", value, status=USAGE
            )
            self.assertIn("--tev", error)
            self.assertIn(message, error)


if __name__ == "__main__":
    unittest.main()
