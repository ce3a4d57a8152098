# SPDX-License-Identifier: GPL-3.0-or-later
"""The tree of commands as --help tells it."""
import re

from processes import ANTICRACK, run


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
