"""rtslc render --tev: what it sends to a viewer, here a small server, and what it reports."""

import socket
import struct
import threading
import unittest

from exr_files import channels as exr_channels
from harness import USAGE, Case

CREATE, UPDATE = 4, 3


class Viewer:
    """Takes one connection, and keeps the pictures that its messages make. With `most`, hangs up
    after that many bytes."""

    def __init__(self, most=None):
        self.most = most
        self.pictures, self.updates, self.order = {}, 0, []
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        connection, _ = self.server.accept()
        with connection:
            data = b""
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
        ):
            _, error = self.run_rtslc(
                "render", "scene.json", "-o", "a.exr", "--tev", value, status=USAGE
            )
            self.assertIn("--tev", error)
            self.assertIn(message, error)


if __name__ == "__main__":
    unittest.main()
