# SPDX-License-Identifier: GPL-3.0-or-later
"""Debian's changelog is made of the one that people read."""
import os
import re

from places import DEPLOY
from processes import FolderTest, run

MAINTAINER = "The maintainers <a@b.example>"
RELEASES = """# Changelog

What users notice.

## [Unreleased]

### Fixed

- A leak
  of memory ([notes](notes.md)).

## [0.2.0] - 2027-02-28

Words.

### Added
- One.
- Two, in {words}.
### Removed
- Three.

## [0.1.0] - 2026-11-26
- First.

[Unreleased]: https://example.org
[0.2.0]: https://example.org
""".format(words=" ".join(["many words"] * 20))


class Changelog(FolderTest):
    def make(self, text):
        return run(DEPLOY / "debian/make-changelog", "0.3.0", MAINTAINER, input=text,
                   env=dict(os.environ, SOURCE_DATE_EPOCH="1800000000"))

    def parse(self, text, *options):
        """Of what is made of the text, by Debian's own reader, which warns of what it cannot read."""
        made = self.make(text)
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        (self.folder / "changelog").write_text(made.stdout, encoding="utf-8")
        parsed = run("dpkg-parsechangelog", "-l", self.folder / "changelog", *options)
        self.assertEqual((parsed.returncode, parsed.stderr), (0, ""))
        return parsed.stdout

    def test_ours_is_read_whole(self):
        ours = (DEPLOY / "CHANGELOG.md").read_text(encoding="utf-8")
        parsed = self.parse(ours, "--all")
        self.assertRegex(parsed, r"(?m)^Source: anticrack\nVersion: 0\.3\.0\n")
        count = len(re.findall(r"^- ", ours, re.M))
        self.assertGreater(count, 5)
        self.assertGreaterEqual(len(re.findall(r"^   \* ", parsed, re.M)), count)
        self.assertNotIn("](", parsed)

    def test_versions_headings_and_days(self):
        made = self.parse(RELEASES, "--all", "--format", "rfc822")
        self.assertEqual(re.findall(r"^Version: (.*)$", made, re.M), ["0.3.0", "0.2.0", "0.1.0"])
        self.assertEqual(re.findall(r"^Distribution: (.*)$", made, re.M), ["UNRELEASED", "unstable", "unstable"])
        self.assertEqual(re.findall(r"^Date: (.*)$", made, re.M),
                         ["Fri, 15 Jan 2027 08:00:00 +0000", "Sun, 28 Feb 2027 00:00:00 +0000",
                          "Thu, 26 Nov 2026 00:00:00 +0000"])
        self.assertEqual(re.findall(r"\[ (\w+) \]", made), ["Fixed", "Added", "Removed"])
        self.assertIn("* A leak of memory (notes).", made)
        self.assertNotIn("example.org", made)
        self.assertLess(max(map(len, self.make(RELEASES).stdout.splitlines())), 81)

    def test_what_is_not_one_is_refused_by_name(self):
        for text, said in (("", "there is no version"), ("# Changelog\n", "there is no version"),
                           ("## Unreleased\n- a\n", "'## Unreleased': write ## [Unreleased]"),
                           ("## [0.1.0] 2026-11-26\n- a\n", "'## [0.1.0] 2026-11-26': write"),
                           ("## [0.1.0]\n- a\n", "[0.1.0] has no date"),
                           ("## [0.1.0] - 2026-13-26\n- a\n", "[0.1.0] has no date"),
                           ("## [Unreleased]\n\n", "[Unreleased] is empty"),
                           ("## [Unreleased]\n\n## [0.1.0] - 2026-11-26\n- a\n", "[Unreleased] is empty")):
            made = self.make(text)
            self.assertEqual((made.returncode, made.stdout), (1, ""), text)
            self.assertIn("make-changelog: " + said, made.stderr)
            self.assertEqual(made.stderr.count("\n"), 1, made.stderr)
