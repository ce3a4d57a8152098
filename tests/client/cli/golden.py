# SPDX-License-Identifier: GPL-3.0-or-later
"""What the golden tests share: a real server, a case with a bit of everything, and files that hold
what is expected.

To renew the files after a change that is meant, and to read what has changed:
    ANTICRACK_RENEW_GOLDEN=1 ctest --test-dir build/release -R client.cli.*golden
    git diff tests/client/cli/golden
"""
import os
import pathlib
import tempfile
import unittest

from processes import ANTICRACK, Daemon, run

FOLDER = pathlib.Path(__file__).parent / "golden"
RENEW = bool(os.environ.get("ANTICRACK_RENEW_GOLDEN"))

PLATE = """\
title = "A plate with a fibre"

[geometry]
boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
interface = [[-1, 0], [1, 0]]
neumann = [[[1, -1], [1, 1]]]

[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to = [0.5, 0]
delaminated = true

[[geometry.region]]
name = "top"
at = [0, 0.5]
tension = 2

[mesh]
preset = "uniform"
size = 0.5

[solver]
tolerance = 1e-12

[[load]]
name = "opening"
f = "y > 0 ? 1 : -1"

[[load]]
name = "skew"
f = { top = -1 }
boundary_value = "0.1 * x"
traction = 0.2
point_forces = [{ at = [0.2, 0.7], value = 1 }]
inclusion_forces = { fibre = -0.5 }

[job]
queue_timeout = "1h"

[output]
fields = true
"""

# Without the point force, which has no bounds.
ACCURACY = PLATE[:PLATE.index('[[load]]\nname = "skew"')] + """\
[accuracy]
energy = 0.1

[output]
fields = true
"""

# Two triangles and nothing else.
MSH = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
2
1 2 2 1 1 1 2 3
2 2 2 1 1 1 3 4
$EndElements
"""


class GoldenTest(unittest.TestCase):
    """Commands run one after the other in one folder, against one server."""
    maxDiff = None
    _renewed = set()

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(
            cls.enterClassContext(tempfile.TemporaryDirectory(prefix="anticrack-test-")))
        files = {"plate.toml": PLATE, "accuracy.toml": ACCURACY, "plate.msh": MSH, "rows.csv": "opening,skew\n1,0\n0.5,0.5\n0,1\n",
                 # The force is infinite in a node: the job fails.
                 "failing.toml": PLATE.replace("y > 0 ? 1 : -1", "1 / (x - x)")}
        for name, text in files.items():
            (cls.folder / name).write_text(text, encoding="utf-8")
        cls.port = cls.enterClassContext(
            Daemon(cls.folder, "--threads", 1, "--memory-budget", "1GiB", "--mesher-memory", "6GiB")).port

    @classmethod
    def anticrack(cls, *words):
        """The ended process, without a setting of who runs the tests."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("ANTICRACK_")}
        environment["ANTICRACK_SERVER"] = f"127.0.0.1:{cls.port}"
        return run(ANTICRACK, *words, cwd=cls.folder, env=environment)

    def compare(self, name, text):
        """`text` with the file of this name, or makes it the file."""
        path = FOLDER / name
        if RENEW and name not in self._renewed:
            self._renewed.add(name)  # the next one of this name shall be like it
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        self.assertEqual(text, path.read_text(encoding="utf-8"), f"{name}; to renew it see golden.py")
