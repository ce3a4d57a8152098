# SPDX-License-Identifier: GPL-3.0-or-later
"""The package itself: types, style, what an import brings along, and a wheel that is installed and used."""
import os
import pathlib
import shutil
import sys
import unittest

import anticrack
from processes import ANTICRACK, ANTICRACKD, DEBIAN_12, FolderTest, run

PACKAGE = pathlib.Path(os.environ["PACKAGE"])
EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
BUILT = pathlib.Path(anticrack.__file__).parents[1]
USED = """
import anticrack, pathlib
with anticrack.local(program={program!r}) as client:
    print(client.run({case!r}, progress=False)["opening"].status)
anticrack.draw.membrane
print(pathlib.Path(anticrack.__file__).parent)
"""


class Wheel(FolderTest):
    def succeed(self, *command):
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(self.folder), "LC_ALL": "C.UTF-8"}
        ended = run(*command, env=environment, cwd=self.folder)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended.stdout

    def test_is_built_installed_and_used_without_an_index(self):
        shutil.copytree(PACKAGE, self.folder / "client/python")
        shutil.copytree(PACKAGE.parents[1] / "proto", self.folder / "proto")
        self.succeed(sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-index", "--no-deps", "-w",
                     "wheels", "./client/python")
        (wheel,) = (self.folder / "wheels").glob("*.whl")
        self.assertEqual(wheel.name, f"anticrack-{anticrack.__version__}-py3-none-any.whl")
        self.succeed(sys.executable, "-m", "venv", "--system-site-packages", "new")
        self.succeed("new/bin/pip", "install", "--no-index", wheel)
        said = self.succeed("new/bin/python", "-c", USED.format(program=ANTICRACKD, case=str(EXAMPLES / "slit.toml")))
        status, place = said.splitlines()
        self.assertEqual(status, "converged")
        self.assertTrue(place.startswith(str(self.folder / "new")), place)
        self.assertTrue((pathlib.Path(place) / "py.typed").exists())


class Code(FolderTest):
    @unittest.skipUnless(DEBIAN_12, "it is written for the stubs that Debian 12 has of numpy and matplotlib")
    def test_types(self):
        for what in (("-p", "anticrack"), *((str(path),) for path in sorted(EXAMPLES.glob("*.py")))):
            ended = run(sys.executable, "-m", "mypy", "--config-file", PACKAGE / "pyproject.toml", "--cache-dir",
                        self.folder, *what, cwd=BUILT)
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_style(self):
        ended = run(sys.executable, "-m", "flake8", "--config", PACKAGE / ".flake8", PACKAGE,
                    pathlib.Path(__file__).parent, *EXAMPLES.glob("*.py"))
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_import_leaves_out_what_takes_long(self):
        ended = run(sys.executable, "-c", "import sys, anticrack; print(*sys.modules)")
        modules = set(ended.stdout.split())
        self.assertIn("anticrack.client", modules, ended.stderr)
        self.assertFalse(modules & {"matplotlib", "pandas", "h5py", "anticrack.draw", "anticrack.aio"})

    def test_version_is_that_of_the_command(self):
        self.assertIn(anticrack.__version__, run(ANTICRACK, "--version").stdout)


class Names(unittest.TestCase):
    def test_what_is_offered_is_there(self):
        for name in anticrack.__all__:
            self.assertTrue(getattr(anticrack, name).__doc__, name)
        with self.assertRaises(AttributeError):
            anticrack.nothing
