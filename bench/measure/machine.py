"""On what was measured."""

import os
import platform
import sys


def describe():
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as info:
            for line in info:
                if line.startswith("model name"):
                    model = line.split(":", 1)[1].strip()
                    break
    except OSError:
        pass
    return {"processor": model, "cores": len(os.sched_getaffinity(0)), "load": os.getloadavg()[0]}


def announce(machine):
    """Says it to people; a busy machine gets a warning, for its times mean little."""
    print(f"{machine['processor']}, {machine['cores']} cores")
    if machine["load"] > 0.3:
        print(
            f"the machine is busy (load {machine['load']:.2f}): do not trust these times",
            file=sys.stderr,
        )
