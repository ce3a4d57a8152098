# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the gallery share: the commands that a case opens with are run as typed, in a folder that looks
like the project's root, and what they answer is checked by test_NAME (with "_" for "-")."""
import math
import os
import pathlib
import re
import shutil

from answers import Answers
from opening import Opening
from processes import ANTICRACK, DEBIAN_12, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])

# Where A and the energy of the paper's examples converge to, see tests/accuracy/paper_limits.hpp.
LIMITS = {"example-1": (0.266179, -0.278308), "example-2": (0.0157145, -0.074553),
          "example-3": (0.1038245, -0.170034), "example-4": (0.020658, -0.089007)}


def rectangle(terms=60):
    """The integral of u over (0, 2) x (0, 1), -lap u = 1 inside and u = 0 around it."""
    odd = range(1, 2 * terms, 2)
    return sum(2 * 64 / (math.pi ** 6 * m * m * n * n * (m * m / 4 + n * n)) for m in odd for n in odd)


class GalleryTest(FolderTest):
    def follow(self, name):
        """Runs the commands of a case, in order; the answers in the files they leave, by file."""
        shutil.copytree(EXAMPLES, self.folder / "client/examples")
        opening = Opening(EXAMPLES / f"{name}.toml")
        self.words = opening.words
        self.figures = self.folder / "figures" / name
        environment = dict(os.environ, PATH=f"{pathlib.Path(ANTICRACK).parent}:{os.environ['PATH']}")
        environment.pop("ANTICRACK_SERVER", None)
        for command in opening.commands:
            ended = run("sh", "-c", command.text, cwd=self.folder, env=environment)
            self.assertEqual(ended.returncode, command.exit_code, command.text + "\n" + ended.stdout + ended.stderr)
        answers = {path.name: Answers(path) for path in self.folder.glob("*.h5")}
        for result in answers.values():
            self.addCleanup(result.file.close)
        return answers

    def follow_one(self, name):
        """Of a case that leaves one file, all of whose load cases converge."""
        (answers,) = self.follow(name).values()
        for load in answers.loads.values():
            self.assertEqual((load["status"], load["error"]), ("converged", ""))
        return answers

    def assert_figures(self, *wanted):
        """A .png and a .svg of each name."""
        drawn = {path.name for path in self.figures.iterdir() if path.stat().st_size > 1000}
        for name in wanted:
            self.assertLessEqual({name + ".png", name + ".svg"}, drawn)

    def assert_told(self, *told):
        """What the opening says is what comes out, within one of its last digit: pairs of a number's text and value.
        The figures are of Debian 12: another gmsh makes other meshes."""
        elsewhere = 0 if DEBIAN_12 else 5e-3
        for text, value in told:
            self.assertRegex(self.words, rf"(?<![\d.]){re.escape(text)}(?!\d)")
            digit = 1.001 * 10.0 ** -len(text.partition(".")[2])
            self.assertLessEqual(abs(value - float(text)), max(digit, elsewhere * abs(value)), text)

    def assert_close(self, value, exact, relative):
        self.assertLess(abs(value - exact), relative * abs(exact), f"{value} should be {exact}")

    def assert_balanced(self, answers, load, sign=-1):
        """The energy of the minimum over a cone is minus the strain energy without prescribed displacements, and
        plus the strain energy without forces: the field, the energy and the solver must agree."""
        self.assert_close(answers.loads[load]["energy_mesh"], sign * answers.strain_energy(load), 1e-9)
