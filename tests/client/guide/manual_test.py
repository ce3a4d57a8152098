# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages that `anticrack manual` writes, as man shows them."""
import os
import pathlib

from command_tree import all_commands, help_of, options_of
from processes import ANTICRACK, FolderTest, run


class Manual(FolderTest):
    def setUp(self):
        super().setUp()
        self.pages = self.folder / "man1"
        written = run(ANTICRACK, "manual", self.pages)
        self.assertEqual((written.returncode, written.stderr), (0, ""))

    def shown(self, *path):
        ended = run("man", "--warnings", "-l", self.pages / ("-".join(["anticrack", *path]) + ".1"),
                    env=dict(os.environ, MANWIDTH="100", LC_ALL="C.UTF-8", MANROFFOPT="-c"))
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return ended.stdout

    def test_has_a_page_for_every_command_that_man_reads_without_a_warning(self):
        commands = list(all_commands())
        self.assertEqual(len(list(self.pages.iterdir())), len(commands))
        for path in commands:
            page = self.shown(*path)
            self.assertIn("-".join(["anticrack", *path]) + " - " + help_of(*path).splitlines()[0].split(".")[0], page)
            for option in options_of(*path):
                self.assertIn(option, page)

    def test_is_found_beside_the_command(self):
        bin = pathlib.Path(ANTICRACK).parent
        found = run("man", "-w", "anticrack-run", env={"PATH": f"{bin}:{os.environ['PATH']}"}).stdout
        self.assertEqual(found.strip(), str(bin.parent / "share/man/man1/anticrack-run.1.gz"))
        self.assertIn("SEE ALSO\n       anticrack(1): options of every command, exit codes\n", self.shown("run"))

    def test_keeps_examples_as_they_are_typed(self):
        for path in all_commands():
            page = self.shown(*path)
            _, found, examples = help_of(*path).partition("\nExample:\n")
            for line in examples.splitlines() if found else []:
                self.assertIn(line.strip(), page)

    def test_says_what_exit_codes_mean(self):
        self.assertIn("EXIT CODES\n", self.shown())
        self.assertIn("some load case did not converge", self.shown())
