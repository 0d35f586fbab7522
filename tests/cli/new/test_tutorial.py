"""docs/tutorial.md: its files, commands, outputs and pictures. `test_tutorial.py --renew` writes
outputs and pictures anew.

A file's text follows its name; a diff changes it. A command is followed by what it prints; it fails
if that has an error. The picture that is shown after commands is the last one that they
rendered."""

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import unittest

from harness import DIAGNOSED, EXAMPLES, FINE, RTSLC, SECONDS, Case

PAGE = EXAMPLES.parent / "docs/tutorial.md"
PART = re.compile(
    r"^`(?P<file>[\w.]+)`\n```(?P<kind>glsl|json|diff)\n(?P<text>.*?)^```$"
    r"|^```console\n(?P<console>.*?)^```$|^!\[[^]]*\]\((?P<picture>[^)]+)\)$",
    re.M | re.S,
)
# Times, and counts of rays, which may differ between processors.
VARIES = re.compile(
    r"compiled in \d+ ms, rendered in [\d.]+ s \([\d.]+ million|\b\d+ rays in \d+ samples"
)


def without_times(text):
    return VARIES.sub(lambda match: re.sub(r"[\d.]+", "N", match.group()), text)


class Tutorial(Case):
    renews = False

    def run_command(self, line):
        """What a command prints, and its exit status."""
        words = shlex.split(line)
        self.assertEqual(words[0], "rtslc")
        if "-o" in words:
            self.last_picture = words[words.index("-o") + 1]
        running = subprocess.Popen(
            [RTSLC, *words[1:]],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
        if "--watch" not in words:
            return running.communicate(timeout=SECONDS)[0], running.returncode
        text = ""
        while "watching" not in text:
            line = running.stdout.readline()
            self.assertTrue(line, text)
            text += line
        running.send_signal(signal.SIGINT)
        self.assertEqual(running.communicate(timeout=SECONDS)[0], "")
        return text, FINE if running.returncode == 128 + signal.SIGINT else running.returncode

    def console(self, block):
        """The block with what its commands print now."""
        lines = []
        for command in re.findall(r"^\$ (.*)$", block, re.M):
            text, status = self.run_command(command)
            is_wrong = "error[" in text and not text.endswith(" fixed\n")
            self.assertEqual(status, DIAGNOSED if is_wrong else FINE, f"{command}\n{text}")
            # An empty line ends each message; those between commands would look like output.
            lines += [f"$ {command}", *re.sub(r"\n+$", "", text).splitlines()]
        return "".join(line + "\n" for line in lines)

    def change(self, name, diff):
        old, new = (
            "".join(line[1:] + "\n" for line in diff.splitlines() if line[0] == sign)
            for sign in "-+"
        )
        path = self.folder / name
        text = path.read_text()
        self.assertEqual(text.count(old), 1, f"{name} has not these lines:\n{old}")
        path.write_text(text.replace(old, new))

    def picture(self, name):
        shown = PAGE.parent / name
        if self.renews:
            shutil.copy(self.folder / self.last_picture, shown)
        self.run_rtslc("compare", shown, self.last_picture, "--threshold", "0.02")

    def test_everything_in_the_page_is_so(self):
        page = PAGE.read_text()
        counts = {"files": 0, "consoles": 0, "pictures": 0}
        renewed, end = "", 0
        for part in PART.finditer(page):
            renewed += page[end : part.start()]
            end = part.end()
            text = part.group()
            if part["console"] is not None:
                counts["consoles"] += 1
                now = self.console(part["console"])
                if self.renews:
                    text = f"```console\n{now}```"
                else:
                    self.assertEqual(without_times(part["console"]), without_times(now))
            elif part["picture"]:
                counts["pictures"] += 1
                self.picture(part["picture"])
            else:
                counts["files"] += 1
                if part["kind"] == "diff":
                    self.change(part["file"], part["text"])
                else:
                    self.write(part["file"], part["text"])
            renewed += text
        if self.renews:
            PAGE.write_text(renewed + page[end:])
        self.assertEqual(
            counts,
            {
                "files": page.count("```glsl") + page.count("```json") + page.count("```diff"),
                "consoles": page.count("```console"),
                "pictures": page.count("!["),
            },
        )
        self.assertGreater(min(counts.values()), 5)


if __name__ == "__main__":
    if "--renew" in sys.argv:
        sys.argv.remove("--renew")
        Tutorial.renews = True
    unittest.main()
