# SPDX-License-Identifier: GPL-3.0-or-later
"""What the checks of this folder share."""
import importlib.machinery
import importlib.util
import json
import pathlib
import shlex
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def tracked(*patterns):
    """Paths of what git has under such names."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", *patterns], text=True, check=True, capture_output=True)
    return [ROOT / path for path in listed.stdout.split()]


def flags(build, part):
    """What the sources of a part are compiled with, as far as clang's reading of them is concerned."""
    own, system = {}, {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        if words[words.index("-o") + 1].startswith(part + "/"):
            own.update((word, None) for word in words if word.startswith(("-I", "-D", "-std")))
            system.update((path, None) for word, path in zip(words, words[1:]) if word == "-isystem")
    return [*own, *(word for path in system for word in ("-isystem", path))]


def load(name):
    """A check as a module, for its tests."""
    loader = importlib.machinery.SourceFileLoader(name, str(HERE / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module
