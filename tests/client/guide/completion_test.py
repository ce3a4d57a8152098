# SPDX-License-Identifier: GPL-3.0-or-later
"""What bash, zsh and fish offer after what the scripts of `anticrack completion` told them."""
import contextlib
import os
import pty
import re
import select
import shutil
import subprocess
import time
import unittest.mock

from command_tree import all_commands, commands_below, options_of
from processes import ANTICRACK, Daemon, FolderTest, run

BASH = r"""
source "$1"; shift
compopt() { :; }  # readline is not there
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
_anticrack
printf '%s\n' "${COMPREPLY[@]}"
"""


# The scripts ask the command.
WITH_PATH = dict(os.environ, PATH=f"{os.path.dirname(ANTICRACK)}:{os.environ['PATH']}")


class Shell(FolderTest):
    """The scripts' common expectations; `offers(words)` is what a shell offers for the last word."""

    name = ""

    def setUp(self):
        super().setUp()
        printed = run(ANTICRACK, "completion", self.name)
        self.assertEqual((printed.returncode, printed.stderr), (0, ""))
        self.script = self.folder / "script"
        self.script.write_text(printed.stdout, encoding="utf-8")
        self.work = self.folder / "work"
        (self.work / "plates").mkdir(parents=True)
        (self.work / "plate.toml").touch()


class Bash(Shell):
    name = "bash"

    def offers(self, *words):
        ended = run("bash", "-c", BASH, "bash", self.script, "anticrack", *words, cwd=self.work,
                    env=WITH_PATH)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return set(ended.stdout.split())

    def test_offers_every_command(self):
        for path in all_commands():
            below = set(commands_below(*path))
            if below:
                self.assertEqual(self.offers(*path, ""), below, path)

    def test_offers_every_option_of_every_command_and_those_of_all(self):
        for path in all_commands():
            offered = self.offers(*path, "--")
            self.assertEqual(options_of(*path) | options_of(), offered, path)

    def test_is_not_misled_by_options_before_the_command(self):
        self.assertEqual(self.offers("--server", "mesh", "--json", "job", "wa"), {"watch"})

    def test_offers_what_an_option_takes(self):
        self.assertEqual(self.offers("run", "--priority", "n"), {"normal"})
        self.assertEqual(self.offers("run", "pl"), {"plate.toml", "plates"})
        self.assertEqual(self.offers("plot", "-o", "pl"), {"plates"})
        self.assertEqual(self.offers("job", "watch", ""), set())

    def test_offers_the_keys_that_the_server_knows(self):
        for server, key, assignment in ((None, set(), set()), (Daemon, {"mesh.tip_size"}, {"mesh.tip_size="})):
            with server(self.folder) if server else contextlib.nullcontext() as daemon, \
                    unittest.mock.patch.dict(WITH_PATH, ANTICRACK_SERVER=f"127.0.0.1:{daemon.port if daemon else 9}"):
                self.assertEqual(self.offers("explain", "mesh.ti"), key)
                self.assertEqual(self.offers("run", "--set", "mesh.ti"), assignment)


class Fish(Shell):
    name = "fish"

    def offers(self, line):
        ended = run("fish", "--no-config", "-c", f"source {self.script}; complete -C '{line}'", cwd=self.work,
                    env=dict(WITH_PATH, HOME=str(self.folder)))
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return dict(line.partition("\t")[::2] for line in ended.stdout.splitlines())

    def test_offers_every_command_with_its_description(self):
        for path in all_commands():
            below = commands_below(*path)
            if below:
                offered = self.offers(" ".join(["anticrack", *path, ""]))
                self.assertEqual(set(offered), set(below), path)
                self.assertTrue(all(offered.values()), path)

    def test_offers_every_option_of_every_command_and_those_of_all(self):
        for path in all_commands():
            offered = self.offers(" ".join(["anticrack", *path, "--"]))
            self.assertEqual(options_of(*path) | options_of(), set(offered), path)

    def test_is_not_misled_by_options_before_the_command(self):
        self.assertEqual(set(self.offers("anticrack --server mesh --json job wa")), {"watch"})

    def test_offers_what_an_option_takes(self):
        self.assertEqual(set(self.offers("anticrack run --priority n")), {"normal"})
        self.assertEqual(set(self.offers("anticrack run pl")), {"plate.toml", "plates/"})
        self.assertEqual(set(self.offers("anticrack plot -o pl")), {"plates/"})
        self.assertEqual(set(self.offers("anticrack job watch ")), set())


class Zsh(Shell):
    """zsh completes in a terminal only, so it gets one."""

    name = "zsh"

    def setUp(self):
        super().setUp()
        shutil.copy(self.script, self.folder / "_anticrack")
        self.terminal, inside = pty.openpty()
        self.addCleanup(os.close, self.terminal)
        self.shell = subprocess.Popen(["zsh", "-f", "-i"], stdin=inside, stdout=inside, stderr=inside, cwd=self.work,
                                      env=dict(WITH_PATH, TERM="dumb", HOME=str(self.folder)), start_new_session=True)
        os.close(inside)
        self.addCleanup(self.shell.wait)
        self.addCleanup(self.shell.kill)
        self.type(f"PS1='@@ '; fpath=({self.folder} $fpath); autoload -Uz compinit; compinit -u -D; LISTMAX=1000; "
                  "unsetopt automenu zle_bracketed_paste; bindkey '^T' list-choices; print rea''dy\n")
        self.read_until_prompt("ready")

    def type(self, text):
        os.write(self.terminal, text.encode())

    def read_until_prompt(self, last):
        """All that was written until a line came and the prompt after it: only then keys are read as keys."""
        text, limit = "", time.monotonic() + 60
        wanted = re.compile(last + r"\r\n.*@@ ", re.S)
        while not wanted.search(text):
            ready, _, _ = select.select([self.terminal], [], [], max(0, limit - time.monotonic()))
            self.assertTrue(ready, f"zsh wrote no {last!r}, but {text!r}")
            text += os.read(self.terminal, 65536).decode(errors="replace")
        return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)

    def offers(self, line):
        """The list that appears below the line; Ctrl-U and a command end it."""
        self.type(line + "\x14" + "\x15" + "print do''ne\n")
        listed = self.read_until_prompt("done")
        # Names of one option share a line.
        return {name for names in re.findall(r"^((?:\S+ +)+)-- ", listed, re.M) for name in names.split()}

    def test_offers_every_command(self):
        for path in all_commands():
            below = set(commands_below(*path))
            if below:
                self.assertEqual(self.offers(" ".join(["anticrack", *path, ""])), below, path)

    def test_is_not_misled_by_options_before_the_command(self):
        self.assertEqual(self.offers("anticrack --server mesh --json job "), set(commands_below("job")))

    def test_offers_options_of_a_command_and_those_of_all(self):
        for path in [("run",), ("sweep",), ("mesh", "show")]:
            offered = self.offers(" ".join(["anticrack", *path, "--"]))
            self.assertEqual(options_of(*path) | options_of(), {o for o in offered if o.startswith("--")}, path)


del Shell  # has no tests of its own
