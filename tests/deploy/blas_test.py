# SPDX-License-Identifier: GPL-3.0-or-later
"""The serial build of OpenBLAS, wrong under threads, is found out by configuring and by the server."""
import os

from places import SERVER
from processes import ANTICRACKD, FolderTest, run

SERIAL = {**os.environ, "LD_LIBRARY_PATH": os.path.dirname(os.environ["SERIAL_OPENBLAS"])}
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(blas CXX)
list(APPEND CMAKE_MODULE_PATH "{}")
find_package(OpenBLAS REQUIRED)
"""


class SerialOpenBlas(FolderTest):
    def test_is_refused_by_the_server(self):
        ended = run(ANTICRACKD, "--data-dir", self.folder / "data", "--listen", "127.0.0.1:0", env=SERIAL, timeout=120)
        self.assertNotEqual(ended.returncode, 0)
        self.assertIn("install libopenblas0-pthread and select it with update-alternatives", ended.stderr)

    def test_is_refused_when_configuring_until_another_is_selected(self):
        (self.folder / "CMakeLists.txt").write_text(PROJECT.format(SERVER / "cmake"), encoding="utf-8")

        def configure(environment):
            return run(os.environ["CMAKE"], "-S", self.folder, "-B", self.folder / "build", env=environment)
        refused = configure(SERIAL)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("update-alternatives --config libopenblas.so.0-", refused.stderr)
        selected = configure(os.environ)
        self.assertEqual(selected.returncode, 0, selected.stderr)
