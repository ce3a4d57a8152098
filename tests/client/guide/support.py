# SPDX-License-Identifier: GPL-3.0-or-later
"""The real command, and the tree of its commands as --help tells it."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

ANTICRACK = os.environ["ANTICRACK"]


def run(*command, **options):
    """The ended process; its output is text."""
    return subprocess.run([str(word) for word in command], text=True, capture_output=True, check=False,
                          timeout=120, **options)


def help_of(*path):
    return run(ANTICRACK, *path, "--help").stdout


def commands_below(*path):
    """Names of the commands that --help lists."""
    _, _, listed = help_of(*path).partition("Subcommands:\n")
    return re.findall(r"^  (\S+)", listed.partition("\n\n")[0], re.M)


def all_commands(path=()):
    """Every command as a tuple of words, the program itself first."""
    yield path
    for name in commands_below(*path):
        yield from all_commands((*path, name))


def options_of(*path):
    """Long options of a command's --help."""
    return set(re.findall(r"--[a-z][a-z-]*(?=[ ,\n]|$)", "\n".join(
        line.strip().split("  ")[0] for line in help_of(*path).splitlines() if line.startswith(("  -", "    -")))))


class FolderTest(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="anticrack-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
