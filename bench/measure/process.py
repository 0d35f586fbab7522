"""Runs one program and measures its time and memory."""

import os
import tempfile
import time
from dataclasses import dataclass


class Failed(Exception):
    """A program that is measured did not do its work."""


@dataclass
class Run:
    wall: float  # seconds from before it is spawned until it is reaped
    user: float  # seconds of processor time, over all threads
    system: float
    # The largest resident set, in bytes; at least that of this script, which Linux includes.
    memory: int
    output: str


def run(arguments, keep_output=True):
    """Runs a program (a path and its arguments) to its end. Its messages go where ours go. Raises
    Failed if it cannot be started or ends with anything but 0."""
    with tempfile.TemporaryFile() if keep_output else open(os.devnull, "wb") as sink:
        actions = [
            (os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0),
            (os.POSIX_SPAWN_DUP2, sink.fileno(), 1),
        ]
        start = time.perf_counter_ns()
        try:
            child = os.posix_spawn(arguments[0], arguments, os.environ, file_actions=actions)
        except OSError as error:
            hint = (
                "; `make bench` builds what is needed"
                if isinstance(error, FileNotFoundError)
                else ""
            )
            raise Failed(f"{arguments[0]}: {error.strerror}{hint}") from error
        _, status, usage = os.wait4(child, 0)
        wall = (time.perf_counter_ns() - start) * 1e-9
        code = os.waitstatus_to_exitcode(status)
        if code != 0:
            how = f"exit status {code}" if code > 0 else f"signal {-code}"
            raise Failed(f"{' '.join(arguments)}: {how}")
        output = ""
        if keep_output:
            sink.seek(0)
            output = sink.read().decode()
    return Run(wall, usage.ru_utime, usage.ru_stime, usage.ru_maxrss * 1024, output)
