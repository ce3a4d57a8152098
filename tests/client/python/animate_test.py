# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations: u grows to its size and back, under the same colours and heights."""
import os
import pathlib
import shutil

import numpy as np
from PIL import Image, ImageSequence

import anticrack
from anticrack import Error
from processes import ANTICRACKD, FolderTest

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])


class Animations(FolderTest):
    def test_stages_and_growth_have_a_frame_each(self):
        with anticrack.local(program=ANTICRACKD) as client:
            result = client.run(EXAMPLES / "opening.toml", progress=False)
        anticrack.draw.animate(result, self.folder / "s.gif", "stages")
        with Image.open(self.folder / "s.gif") as image:
            frames = [np.asarray(frame.convert("RGB"), float) for frame in ImageSequence.Iterator(image)]
        (load,) = result.loads.values()
        self.assertEqual(len(frames), len(load.stages["triangles"]))
        for before, after in zip(frames, frames[1:]):
            self.assertGreater(np.abs(after - before).max(), 100, "the dots go on")
        if shutil.which("ffmpeg"):
            anticrack.draw.animate(result, self.folder / "s.mp4", "stages")
            self.assertEqual((self.folder / "s.mp4").read_bytes()[4:8], b"ftyp")

    def test_an_amplitude_goes_and_comes_back(self):
        with anticrack.local(program=ANTICRACKD) as client:
            case = anticrack.Case.read(EXAMPLES / "several-inclusions.toml")
            result = client.run(case, progress=False)
        anticrack.draw.animate(result, self.folder / "u.gif")
        with Image.open(self.folder / "u.gif") as image:
            frames = [np.asarray(frame.convert("RGB"), float) for frame in ImageSequence.Iterator(image)]
        far = [np.abs(frame - frames[0]).sum() for frame in frames]
        middle = len(frames) // 2
        self.assertEqual(int(np.argmax(far)), middle)
        for before, after in zip(frames[1:middle], frames[:middle:-1], strict=True):
            np.testing.assert_array_equal(before, after)
        for path, what, told in (("u.png", "loads", "ends in none of"), ("u.gif", "growth", "no load grows")):
            with self.assertRaisesRegex(Error, told):
                anticrack.draw.animate(result, self.folder / path, what)
