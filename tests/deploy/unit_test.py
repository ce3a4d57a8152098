# SPDX-License-Identifier: GPL-3.0-or-later
"""systemd understands the unit, and finds it guarded."""
import re

from places import DEPLOY
from processes import ANTICRACKD, FolderTest, run

UNIT = DEPLOY / "anticrackd.service"


def seconds(text):
    number, unit = re.fullmatch(r"(\d+)(s|m|min)", text).groups()
    return int(number) * (1 if unit == "s" else 60)


class Unit(FolderTest):
    def setUp(self):
        super().setUp()
        self.text = UNIT.read_text(encoding="utf-8")

    def test_is_understood(self):
        installed = self.folder / UNIT.name
        installed.write_text(self.text.replace("/usr/local/bin/anticrackd", ANTICRACKD), encoding="utf-8")
        ended = run("systemd-analyze", "verify", "--man=no", installed)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_is_guarded(self):
        ended = run("systemd-analyze", "security", "--offline=yes", "--threshold=20", UNIT)
        self.assertEqual(ended.returncode, 0, ended.stdout[-400:] + ended.stderr)

    def test_gives_the_drain_its_time(self):
        flags = re.search(r"^ExecStart=\S+ (.*)", self.text, re.M).group(1)
        drain = seconds(re.search(r"--drain-time (\w+)", flags).group(1))
        limit = seconds(re.search(r"^TimeoutStopSec=(\w+)", self.text, re.M).group(1))
        self.assertGreater(limit, drain + 10)

    def test_starts_the_server_with_flags_it_knows(self):
        flags = re.search(r"^ExecStart=\S+ (.*)", self.text, re.M).group(1)
        flags = flags.replace("/etc/anticrack/anticrackd.toml", str(DEPLOY / "anticrackd.toml"))
        flags = flags.replace("${STATE_DIRECTORY}", str(self.folder))
        ended = run(ANTICRACKD, *flags.split(), "--check-config")
        self.assertEqual(ended.returncode, 0, ended.stderr)
