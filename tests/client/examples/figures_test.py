# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of client/examples/figures: the script makes those that are there, and they are small."""
import os
import pathlib
import struct

from processes import ANTICRACK, FolderTest, run

FIGURES = pathlib.Path(os.environ["EXAMPLES"]) / "figures"


def sizes(folder):
    """Width and height in pixels by name."""
    return {file.name: struct.unpack(">II", file.read_bytes()[16:24]) for file in folder.glob("*.png")}


class Figures(FolderTest):
    def test_are_made_again_by_the_script(self):
        made = run(FIGURES / "remake", ANTICRACK, self.folder)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual(sizes(self.folder), sizes(FIGURES))

    def test_are_small_enough_for_a_page(self):
        self.assertEqual(len(sizes(FIGURES)), 14)
        for file in FIGURES.glob("*.png"):
            self.assertLess(file.stat().st_size, 450_000, file)
            self.assertLessEqual(sizes(FIGURES)[file.name][0], 1400, file)
