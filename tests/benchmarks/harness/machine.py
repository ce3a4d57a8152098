# SPDX-License-Identifier: GPL-3.0-or-later
"""What the numbers were measured on."""
import os
import platform
import re
import subprocess


def _first_match(path, pattern):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            found = re.search(pattern, file.read(), re.MULTILINE)
    except OSError:
        return ""
    return found.group(1).strip() if found else ""


def _compiler(cache):
    path = _first_match(cache, r"^CMAKE_CXX_COMPILER:\w+=(.*)$")
    try:
        said = subprocess.run([path, "--version"], capture_output=True, text=True, check=False)
        return said.stdout.splitlines()[0]
    except (OSError, IndexError):
        return path


def describe(build):
    cache = os.path.join(build, "CMakeCache.txt")
    memory = _first_match("/proc/meminfo", r"^MemTotal:\s*(\d+) kB")
    return {
        "processor": _first_match("/proc/cpuinfo", r"^model name\s*:\s*(.*)$"),
        "cores": len(os.sched_getaffinity(0)),
        "memory_bytes": 1024 * int(memory) if memory else 0,
        "load_before": os.getloadavg()[0],
        "system": platform.platform(),
        "compiler": _compiler(cache),
        "build_type": _first_match(cache, r"^CMAKE_BUILD_TYPE:\w+=(.*)$"),
    }
