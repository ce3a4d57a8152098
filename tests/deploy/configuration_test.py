# SPDX-License-Identifier: GPL-3.0-or-later
"""deploy/anticrackd.toml lists every key at its default."""
import re

from places import DEPLOY
from processes import ANTICRACKD, FolderTest, run

# Found out at the start: other machines, other values.
MACHINE = {"connections", "data-dir", "memory-budget", "threads"}
KEY = re.compile(r"#([a-z-]+) = (.*)")


def check_config(*flags):
    """Key and value of each line --check-config prints."""
    ended = run(ANTICRACKD, *flags, "--check-config")
    assert ended.returncode == 0, ended.stderr
    return dict(line.split(" = ", 1) for line in ended.stdout.splitlines())


class Configuration(FolderTest):
    def setUp(self):
        super().setUp()
        self.text = (DEPLOY / "anticrackd.toml").read_text(encoding="utf-8")
        self.lines = [match for line in self.text.splitlines() if (match := KEY.fullmatch(line))]

    def test_has_every_key_once_and_no_other(self):
        self.assertEqual(sorted(match.group(1) for match in self.lines), sorted(check_config()))

    def test_changes_nothing_as_it_is(self):
        self.assertEqual(check_config("--config", DEPLOY / "anticrackd.toml"), check_config())

    def test_has_the_defaults_when_uncommented(self):
        path = self.folder / "all.toml"
        path.write_text("\n".join(match.group(0)[1:] for match in self.lines), encoding="utf-8")
        given, default = check_config("--config", path), check_config()
        for key in MACHINE:
            self.assertTrue(given.pop(key))
            self.assertTrue(default.pop(key))
        self.assertEqual(given, default)

    def test_says_something_of_every_key(self):
        before = ""
        for line in self.text.splitlines():
            if match := KEY.fullmatch(line):
                self.assertRegex(before, r"^# |^#tls-certificate ", match.group(1))
            before = line
