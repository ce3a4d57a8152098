# SPDX-License-Identifier: GPL-3.0-or-later
"""What `fibres` writes: as many as asked for, apart from each other, the same each time."""
import math
import pathlib
import subprocess
import tomllib
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parent / "fibres"


def written(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=True).stdout


def points(fibre, count=200):
    """A fine sample of a fibre."""
    (ax, ay), (bx, by) = fibre["points"]
    return [(ax + (bx - ax) * k / count, ay + (by - ay) * k / count) for k in range(count + 1)]


class Fibres(unittest.TestCase):
    def test_scattered_ones_keep_the_gap(self):
        geometry = tomllib.loads(written("--random", 60, "--seed", 3, "--gap", 0.3))["geometry"]
        samples = [points(fibre) for fibre in geometry["interface"]]
        length = 0.5 / math.sqrt(60)
        for i, s in enumerate(samples):
            self.assertAlmostEqual(math.dist(s[0], s[-1]), length, delta=1e-8)
            for t in samples[:i]:
                self.assertGreater(min(math.dist(p, q) for p in s[::4] for q in t), 0.29 * length)
            for p in s:
                self.assertTrue(all(0.29 * length < c < 1 - 0.29 * length for c in p))

    def test_each_is_delaminated_on_a_slit_of_its_own(self):
        geometry = tomllib.loads(written("--grid", 3, "--turn", 20))["geometry"]
        self.assertEqual(len(geometry["interface"]), 9)
        for slit, fibre in zip(geometry["interface"], geometry["inclusion"], strict=True):
            self.assertEqual([fibre["from"], fibre["to"]], slit["points"])
            self.assertTrue(fibre["delaminated"])

    def test_cracks_are_cracks(self):
        geometry = tomllib.loads(written("--random", 5, "--cracks"))["geometry"]
        self.assertEqual(len(geometry["crack"]), 5)
        self.assertNotIn("inclusion", geometry)

    def test_the_seed_alone_decides(self):
        self.assertEqual(written("--random", 50, "--seed", 2), written("--random", 50, "--seed", 2))
        self.assertNotEqual(written("--random", 50, "--seed", 2), written("--random", 50, "--seed", 3))

    def test_a_full_square_is_told(self):
        with self.assertRaises(subprocess.CalledProcessError) as caught:
            written("--random", 400, "--length", 0.99, "--gap", 0.9)
        self.assertIn("no room", caught.exception.stderr)


if __name__ == "__main__":
    unittest.main()
