# SPDX-License-Identifier: GPL-3.0-or-later
"""The real programs as processes. Tests find them through the environment that CMake gives them."""
import os
import pathlib
import platform
import re
import signal
import subprocess
import tempfile
import time
import unittest

ANTICRACKD = os.environ["ANTICRACKD"]
ANTICRACK = os.environ["ANTICRACK"]
# Whose gmsh the figures of documents and the gallery are of.
DEBIAN_12 = platform.freedesktop_os_release().get("VERSION_ID") == "12"


def run(*command, **options):
    """The ended process; its output is text."""
    return subprocess.run([str(word) for word in command], text=True, capture_output=True, check=False, **options)


class FolderTest(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="anticrack-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Daemon:
    """anticrackd on a free port, or the one named, stopped at the end of the scope."""

    def __init__(self, folder, *flags, port=0):
        self._log = open(folder / "daemon.log", "w+", encoding="utf-8")
        command = [ANTICRACKD, "--listen", f"127.0.0.1:{port}", "--data-dir", folder / "data", *flags]
        self._process = subprocess.Popen([str(word) for word in command], text=True,
                                         stdout=subprocess.PIPE, stderr=self._log)
        # One line or, when it does not start, the end of its output.
        line = self._process.stdout.readline()
        if not line:
            self._process.wait()
            raise RuntimeError("anticrackd did not start: " + self.log())
        self.port = int(line.rsplit(":", 1)[1])

    def log(self):
        return pathlib.Path(self._log.name).read_text(encoding="utf-8")

    def metrics_url(self):
        """Of a daemon with --metrics-listen; the log says where once it is started."""
        limit = time.monotonic() + 120
        while not (found := re.search(r"url=(http://\S+)", self.log())):
            if time.monotonic() > limit:
                raise RuntimeError("no metrics: " + self.log())
            time.sleep(0.01)
        return found.group(1)

    def hang_up(self):
        """SIGHUP; returns what the log says of it."""
        said = len(self.log())
        self._process.send_signal(signal.SIGHUP)
        limit = time.monotonic() + 120
        while "read again" not in (more := self.log()[said:]) or not more.endswith("\n"):
            if time.monotonic() > limit or self._process.poll() is not None:
                raise RuntimeError("nothing was read again: " + self.log())
            time.sleep(0.01)
        return more

    def terminate(self):
        self._process.terminate()

    def kill(self):
        """As a crash would."""
        self._process.kill()
        self._process.wait()

    def wait(self):
        return self._process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()
        self._log.close()
