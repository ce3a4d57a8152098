# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands of other programs: anticrack-NAME on PATH, and the Python package."""
import json
import os
import unittest

from processes import ANTICRACK, FolderTest, run


class External(FolderTest):
    def anticrack(self, *words, **variables):
        return run(ANTICRACK, *words, cwd=self.folder,
                   env={**os.environ, "PATH": f"{os.environ['PATH']}:{self.folder}", **variables})

    def program(self, name, text):
        (self.folder / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (self.folder / name).chmod(0o755)

    def test_are_found_on_path_and_given_all_words(self):
        for name in ("hello", "plot", "show"):
            self.program(f"anticrack-{name}", f'printf "%s|" {name} "$@"; exit 7')
        for name in ("hello", "plot"):
            ended = self.anticrack(name, "a b", "--json", "-x")
            self.assertEqual((ended.returncode, ended.stdout), (7, f"{name}|a b|--json|-x|"))
        self.assertEqual(self.anticrack("show", "no.h5").returncode, 2, "a command of its own is not replaced")

    def test_what_is_nowhere_is_unknown(self):
        self.program("anticrack-sub", "exit 0")
        for name in ("subb", "../anticrack-sub", "sub/", ""):
            ended = self.anticrack(name)
            self.assertEqual(ended.returncode, 2, name)
            self.assertIn("known are", ended.stderr)

    def test_a_python_without_the_package_is_told_what_to_install(self):
        # With the words -P -c CODE FOLDER ..., and no package anywhere.
        self.program("bare", 'code=$3; shift 4; exec /usr/bin/python3 -I -S -c "$code" "" "$@"')
        for python, said in ((self.folder / "bare", "install python3-anticrack and python3-matplotlib"),
                             ("/nowhere/python3", "cannot start /nowhere/python3")):
            ended = self.anticrack("--json", "plot", "r.h5", ANTICRACK_PYTHON=str(python))
            self.assertEqual(ended.returncode, 2)
            self.assertRegex(ended.stderr, f"^anticrack: .*{said}.*\n$")
            self.assertEqual(json.loads(ended.stdout)["error"]["code"], "FIGURES")

    def test_python_imports_nothing_from_the_folder(self):
        for name in ("anticrack", "numpy", "json"):
            (self.folder / f"{name}.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
        self.assertRegex(self.anticrack("plot", "r.h5").stderr, "^anticrack: there is no file r.h5; ")


if __name__ == "__main__":
    unittest.main()
