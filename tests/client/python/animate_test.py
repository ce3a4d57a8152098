# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations: a frame for each load, stage, front or size of u, all under the same colours and heights."""
import itertools
import os
import pathlib
import shutil
import unittest
from unittest import mock

import numpy as np
from PIL import Image, ImageSequence

import anticrack
from anticrack import Error
from cases import GROWTH
from processes import ANTICRACKD, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])


class Animations(FolderTest):
    @classmethod
    def setUpClass(cls):
        with anticrack.local(program=ANTICRACKD) as client:
            read = anticrack.Case.read
            cls.opening, cls.several, cls.growing = (client.run(case, progress=False) for case in (
                read(EXAMPLES / "opening.toml"), read(EXAMPLES / "several-inclusions.toml"),
                anticrack.Case.parse(GROWTH)))

    def frames(self, result, what):
        """The images, and for how long each is shown [ms]."""
        anticrack.draw.animate(result, self.folder / f"{what}.gif", what)
        with Image.open(self.folder / f"{what}.gif") as image:
            return zip(*((np.asarray(frame.convert("RGB"), float), frame.info["duration"])
                         for frame in ImageSequence.Iterator(image)))

    def animations(self):
        (growth,), (stages,) = ([getattr(load, what) for load in result.loads.values()] for result, what in (
            (self.growing, "growth"), (self.opening, "stages")))
        leaves = int((np.isfinite(growth["load"]) & (growth["front"] >= 0)).sum())
        self.assertLess(leaves, 60, "more are thinned")
        return ((self.growing, "growth", leaves), (self.several, "loads", len(self.several.loads)),
                (self.opening, "stages", len(stages["triangles"])))

    def test_loads_stages_and_growth_have_a_frame_each(self):
        for result, what, count in self.animations():
            frames, _ = self.frames(result, what)
            self.assertEqual(len(frames), count, what)
            self.assertGreater(count, 1, what)
            for one, other in itertools.combinations(frames, 2):
                self.assertGreater(np.abs(one - other).max(), 100, what)

    @unittest.skipUnless(shutil.which("ffmpeg"), "there is no ffmpeg")
    def test_a_film_shows_the_same_for_as_long(self):
        for result, what in ((self.several, "loads"), (self.opening, "stages")):
            images, times = self.frames(result, what)
            film = self.folder / f"{what}.mp4"
            anticrack.draw.animate(result, film, what)
            told = run("ffprobe", "-v", "error", "-count_frames", "-show_entries",
                       "stream=width,height,nb_read_frames,duration", "-of", "csv=p=0", film).stdout.split(",")
            width, height, seconds, count = int(told[0]), int(told[1]), float(told[2]), int(told[3])
            self.assertEqual((height, width), images[0].shape[:2])
            self.assertAlmostEqual(seconds, sum(times) / 1000, places=3)
            ended = run("ffmpeg", "-v", "error", "-i", film, self.folder / f"{what}-%d.bmp")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            ends = np.cumsum(times)
            for number in range(count):
                with Image.open(self.folder / f"{what}-{number + 1}.bmp") as image:
                    shown = np.asarray(image.convert("RGB"), float)
                far = [np.abs(shown - image).mean() for image in images]
                self.assertEqual(int(np.argmin(far)), int(np.searchsorted(ends, (number + 0.5) / count * ends[-1])))
                self.assertLess(min(far), 4)

    def test_without_ffmpeg_says_how_to_get_it(self):
        with mock.patch.dict(os.environ, PATH=""), self.assertRaisesRegex(Error, "apt install ffmpeg.*gif or webp"):
            anticrack.draw.animate(self.opening, self.folder / "s.mp4", "stages")

    def test_an_amplitude_goes_and_comes_back(self):
        frames, _ = self.frames(self.several, "amplitude")
        far = [np.abs(frame - frames[0]).sum() for frame in frames]
        middle = len(frames) // 2
        self.assertEqual(int(np.argmax(far)), middle)
        self.assertTrue((np.diff(far[:middle + 1]) > 0).all(), "it grows")
        for before, after in zip(frames[1:middle], frames[:middle:-1], strict=True):
            np.testing.assert_array_equal(before, after)
        for path, what, told in (("u.png", "loads", "ends in none of"), ("u.gif", "growth", "no load grows")):
            with self.assertRaisesRegex(Error, told):
                anticrack.draw.animate(self.several, self.folder / path, what)
