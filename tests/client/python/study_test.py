# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: rows are the cases that they say, and an interrupted one ends as if nothing had happened."""
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

import anticrack
from anticrack import Accuracy, Case, CaseError, Geometry, Inclusion, Load, Mesh, Study, aio
from anticrack.study.rows import csv_rows, grid, overrides_of, varied
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

ANGLE, FORCE = "geometry.inclusion.fibre.angle", "load.up.f"
GEOMETRY = Geometry([(-1, -1), (1, -1), (1, 1), (-1, 1)],
                    inclusions=[Inclusion("fibre", center=(0, 0), angle=0, length=1)])
TEXT = """
[geometry]
boundary = [[-1,-1], [1,-1], [1,1], [-1,1]]
[[geometry.inclusion]]
name = "fibre"
center = [0, 0]
length = 1
[accuracy]
A = 0.05
[[load]]
name = "up"
f = "y > 0 ? 1 : 0"
"""


def contents(path):
    """All that a study's file says, but the names of jobs, which each server chooses."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()].tolist()}) if hasattr(item, "shape") else None)
        found.update({f"@{name}": str(value) for name, value in file.attrs.items()})
    del found["job"]
    return repr(found)  # NaN equals NaN


def solved(path):
    try:
        with h5py.File(path) as file:
            return int(file.attrs["solved"])
    except OSError:
        return 0


class Rows(FolderTest):
    def test_grids_and_lists(self):
        self.assertEqual(varied("a.b=0:1:5"), ("a.b", np.linspace(0, 1, 5).tolist()))
        self.assertEqual(varied('p=[0, 1], [2, 3]'), ("p", [[0, 1], [2, 3]]))
        self.assertEqual(varied("mesh.preset=graded,uniform"), ("mesh.preset", ["graded", "uniform"]))
        self.assertEqual(varied('f="x:y:2", 3'), ("f", ["x:y:2", 3]))
        rows = grid({"a": np.arange(2), "b": ("x", "y")})
        self.assertEqual([tuple(row.values()) for row in rows], [(0, "x"), (0, "y"), (1, "x"), (1, "y")])
        self.assertEqual(varied("f=y > 0 ? 1 : 2"), ("f", ["y > 0 ? 1 : 2"]))
        for wrong, told in (("a", "varies nothing"), ("a=", "varies nothing"), ("=1", "varies nothing"),
                            ("a=1:2", "FIRST:LAST:COUNT"), ("a=1:2:3:4", "FIRST:LAST:COUNT"), ("a=:1:2", "FIRST is ''"),
                            ("a=nan:1:3", "FIRST is 'nan'"), ("a=0,5:1:3", "FIRST is '0,5'; .* with a point"),
                            ("a=0:x:3", "LAST is 'x'"), ("a=0:1e999:3", "LAST is '1e999'"),
                            *((f"a=0:1:{count}", f"COUNT is '{count}'; write a whole number from 2") for count in (
                                "", "-3", "0", "1", "2.5", "1e3", "x", "9999999", "1000000000000")),
                            ("a=1,,2", "missing beside a comma"), ("a=1;2", "parted by commas"),
                            ("a=nan,1", "nan is not a finite number"),
                            ("a=[1", "close its quotes and brackets"), ("a='x", "close its quotes and brackets")):
            with self.assertRaisesRegex(CaseError, told, msg=wrong) as raised:
                varied(wrong)
            self.assertIn(f"'{wrong}'", str(raised.exception))
        with self.assertRaises(CaseError):
            grid({"a": range(1000), "b": range(1000)})

    def test_csv_of_either_kind(self):
        file = self.folder / "rows.csv"
        for text in ('a,p,t\n0.5,"[0, 1]",y > 0 ? 1 : 2\n', 'a;p;t\n0,5;[0, 1];y > 0 ? 1 : 2\n'):
            file.write_text(text, encoding="utf-8")
            self.assertEqual(csv_rows(str(file)), [{"a": 0.5, "p": [0, 1], "t": "y > 0 ? 1 : 2"}])
        for text, told in (("a,a\n1,2\n", "'a' stands twice"), ("a,b\n\n1\n", "line 3 has 1 value for 2 keys"),
                           ("a\n", "no row follows"), ("", "is empty"), ("a,\n1,2\n", "a key has no name"),
                           ("a,b\n0,5,1\n", "3 values for 2 keys.* semicolons"), ("a\nnan\n", "line 2: nan is not"),
                           ('a\n"x\n', "line 2: .* quotes"), ('a\n"[1"\n', "line 2: .* brackets"),
                           ("\ud800", "is no text in UTF-8; save it")):
            file.write_text(text, "utf-8", "surrogatepass")
            with self.assertRaisesRegex(CaseError, told):
                csv_rows(str(file))

    def test_values_are_read_back_by_toml(self):
        import tomllib
        values = {"a": 1e-300, "b": 3.0, "c": 'a "b" \\ é\n', "d": [[0.1, 2], []], "e": {"x y": True}}
        self.assertEqual(tomllib.loads("\n".join(overrides_of(values))), values)
        with self.assertRaisesRegex(CaseError, "not a finite number"):
            overrides_of({"a": float("inf")})


class Solved(FolderTest):
    @classmethod
    def setUpClass(cls):
        cls.client = anticrack.local(program=ANTICRACKD)
        cls.addClassCleanup(cls.client.close)

    def study(self, vary, path=None, **options):
        case = Case(GEOMETRY, [Load("up", "y > 0 ? 1 : 0")], Mesh(size=0.2), title="rows")
        return self.client.study(case, vary, path, progress=False, **options)

    def jobs(self):
        return {job.name for job in self.client.jobs(1000)}

    def test_rows_are_the_cases_that_they_say(self):
        study = self.study({ANGLE: [0, 30], FORCE: [-1, 2, "x"]}, self.folder / "s.h5")
        meshes = set()
        for row in study.rows:
            geometry = Geometry(GEOMETRY.boundary, inclusions=[
                Inclusion("fibre", center=(0, 0), angle=row.values[ANGLE], length=1)])
            case = Case(geometry, [Load("up", row.values[FORCE])], Mesh(size=0.2))
            alone = self.client.run(case, progress=False)["up"]
            fibre, of = alone.inclusions["fibre"], row.answers["up"]
            self.assertEqual([of[name] for name in ("energy", "energy_lower", "contact_length", "A of fibre",
                                                    "A_upper of fibre")],
                             [alone.energy, alone.energy_lower, alone.contact_length, fibre.A, fibre.A_upper])
            meshes.add(self.client.job(row.job).message.spec.mesh)
        self.assertEqual(len(meshes), 2, "rows that differ in loads share their mesh")
        read = Study.read(self.folder / "s.h5")
        self.assertEqual(repr(read.rows), repr(study.rows))
        np.testing.assert_array_equal(read[ANGLE], [0, 0, 0, 30, 30, 30])
        self.assertEqual(len(read.frame()), 6)
        self.assertIn("row", study._repr_html_())

    def test_the_largest_g_is_that_of_a_tip(self):
        crack = Geometry(GEOMETRY.boundary, cracks=[anticrack.Crack("slit", center=(0.2, 0), length=1)])
        case = Case(crack, [Load("up", boundary_value="y")], Mesh(size=0.2))
        study = self.client.study(case, {"load.up.boundary_value": ["y", "2*y"]}, progress=False)
        tips = self.client.job(study.rows[0].job).result()["up"].tips
        worst = max(tips, key=lambda tip: tip.G)
        self.assertEqual([study.column(name)[0] for name in ("G", "G_x", "G_y")], [worst.G, worst.x, worst.y])
        np.testing.assert_allclose(study["G"][1] / study["G"][0], 4, rtol=1e-9)

    def test_a_row_keeps_its_error_and_a_study_needs_one_that_is_possible(self):
        study = self.study({"geometry.inclusion.fibre.length": [1, -1, 5]})
        self.assertEqual([row.status for row in study.rows], ["succeeded", "refused", "refused"])
        self.assertIn("length=-1", study.rows[1].error)
        self.assertFalse(study.rows[1].answers)
        with self.assertRaisesRegex(CaseError, "did you mean angle"):
            self.study({"geometry.inclusion.fibre.angl": [1, 2]})
        with self.assertRaisesRegex(CaseError, "3 meshes would be made, more than 2"):
            self.study({ANGLE: [1, 2, 3]}, most_meshes=2)

    def test_a_larger_study_solves_only_what_is_new(self):
        path = self.folder / "s.h5"
        first = self.study({ANGLE: [11, 22]}, path)
        before = self.jobs()
        study = self.study({ANGLE: [11, 22, 33]}, path)
        self.assertEqual(len(self.jobs() - before), 1)
        self.assertEqual([row.job for row in study.rows[:2]], [row.job for row in first.rows])
        self.assertFalse((self.folder / "s.h5~").exists())
        self.study({ANGLE: [44]}, path)
        self.assertEqual(len(Study.read(self.folder / "s.h5~").rows), 3)
        without = self.jobs()
        self.study({ANGLE: [11, 22]})
        self.assertEqual(self.jobs(), without, "without a file the server knows the jobs")

    def test_a_cancelled_row_is_solved_again(self):
        endless = {"solver.method": ["uzawa"], "solver.theta": [1e-9], "solver.epsilon": [1e-30],
                   "solver.max_iterations": [1_000_000], "output.bounds": [False]}
        case = Case(GEOMETRY, [Load("up", 1)], Mesh(size=0.2))
        running = subprocess.Popen([sys.executable, "-c", (
            "import anticrack, sys\n"
            f"with anticrack.connect({self.client._session.address!r}) as client:\n"
            f"    client.study(anticrack.Case.parse({case_text(self.client, case)!r}), {endless!r}, 's.h5')\n")],
            cwd=self.folder, stderr=subprocess.DEVNULL)
        before = self.jobs()
        while not (new := self.jobs() - before):
            time.sleep(0.02)
        self.client.job(new.pop()).cancel()
        self.assertEqual(running.wait(), 0)
        (row,) = Study.read(self.folder / "s.h5").rows
        self.assertEqual(row.status, "cancelled")
        before = self.jobs()
        running = subprocess.Popen(running.args, cwd=self.folder, stderr=subprocess.DEVNULL)
        while not (new := self.jobs() - before):
            time.sleep(0.02)
        self.client.job(new.pop()).cancel()
        self.assertEqual(running.wait(), 0)


def case_text(client, case):
    return client.run(case, progress=False).case


class Async(unittest.IsolatedAsyncioTestCase):
    async def test_is_the_same(self):
        async with aio.local(program=ANTICRACKD) as client:
            study = await client.study(Case(GEOMETRY, [Load("up", 1)], Mesh(size=0.2), accuracy=Accuracy(A=0.2)),
                                       {FORCE: [1, 2]})
        np.testing.assert_allclose(study["energy"][1] / study["energy"][0], 4, rtol=1e-9)


class Command(FolderTest):
    def study(self, *words, **options):
        return run(ANTICRACK, "study", *words, cwd=self.folder, **options)

    def setUp(self):
        super().setUp()
        (self.folder / "case.toml").write_text(TEXT, encoding="utf-8")

    def test_interrupted_ten_times_ends_with_the_same_file(self):
        moments, count = random.Random(1), 22
        with Daemon(self.folder) as daemon, anticrack.connect(f"127.0.0.1:{daemon.port}") as client:
            words = [ANTICRACK, "study", "case.toml", "--vary", f"{ANGLE}=0:90:{count}", "--jobs", "3",
                     "--server", f"127.0.0.1:{daemon.port}", "-o", "broken.h5"]
            broken = 0
            for which in range(10):
                running = subprocess.Popen(list(map(str, words)), cwd=self.folder, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.DEVNULL)
                while running.poll() is None and solved(self.folder / "broken.h5") < 2 * (which + 1):
                    time.sleep(0.005)
                time.sleep(moments.uniform(0, 0.1))
                running.send_signal(signal.SIGKILL if which % 2 else signal.SIGINT)
                broken += running.wait() in (-signal.SIGKILL, 130)
                for row in Study.read(self.folder / "broken.h5").rows:
                    self.assertEqual(row.status == "", not row.answers, "a row is there as a whole or not at all")
            self.assertGreater(broken, 5)
            ended = run(*words, cwd=self.folder)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertEqual(len(client.jobs(1000)), count, "nothing is solved twice")
        whole = self.study("case.toml", "--vary", f"{ANGLE}=0:90:{count}", "--local", "-o", "whole.h5",
                           env=with_server())
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertEqual(contents(self.folder / "broken.h5"), contents(self.folder / "whole.h5"))
        self.assertEqual([path.name for path in self.folder.glob("*partial*")], [])

    def test_says_what_it_would_do_and_what_came_of_it(self):
        def local(*words):
            return self.study(*words, "--local", env=with_server())
        vary = ("case.toml", "--vary", f"{ANGLE}=0,45", "--vary", f"{FORCE}=1,2", "--set",
                "geometry.inclusion.0.length=0.8")
        dry = local(*vary, "--dry-run")
        self.assertEqual(dry.returncode, 0, dry.stderr)
        self.assertRegex(dry.stdout, "^4 rows, 0 of them in the file or refused; 2 meshes for the rest\n")
        self.assertEqual(dry.stdout.count("length = 0.8"), 2)
        self.assertEqual(list(self.folder.glob("*.h5")), [])
        ended = local(*vary, "-o", "s.h5", "--json")
        self.assertEqual((ended.returncode, ended.stderr), (0, "row 4/4\n"))
        rows = json.loads(ended.stdout)["rows"]
        self.assertEqual([row["values"][FORCE] for row in rows], [1, 2, 1, 2])
        self.assertEqual(json.loads(self.study("--show", "s.h5", "--json").stdout)["rows"], rows)
        shown = self.study("--show", "s.h5").stdout.splitlines()
        self.assertEqual(len(shown), 2 + len(rows))
        self.assertEqual(run(ANTICRACK, "show", "s.h5", cwd=self.folder).stdout.splitlines(), shown)
        refused = local("case.toml", "--vary", "geometry.inclusion.0.length=1,-1", "-o", "t.h5")
        self.assertEqual(refused.returncode, 1, refused.stderr)
        for words, code, told in ((("case.toml", "-o", "x.h5", "--vary", "mesh.siz=1,2"), 2, "did you mean size"),
                                  (("case.toml", "--vary", "a=1"), 2, "there is no -o FILE"),
                                  (("none.toml", "--vary", "a=1", "-o", "x.h5"), 2, "none.toml: cannot be read"),
                                  (("--show", "case.toml"), 2, "cannot be read as a study")):
            wrong = local(*words)
            self.assertEqual(wrong.returncode, code, wrong.stderr)
            self.assertRegex(wrong.stderr, told)

    def test_is_drawn(self):
        for name, vary in (("one", [f"{ANGLE}=0:90:3"]), ("two", [f"{ANGLE}=0:90:3", f"{FORCE}=1,2"])):
            words = [word for text in vary for word in ("--vary", text)]
            ended = self.study("case.toml", *words, "--local", "-o", f"{name}.h5", env=with_server())
            self.assertEqual(ended.returncode, 0, ended.stderr)
            drawn = run(sys.executable, "-m", "anticrack", "plot", f"{name}.h5", "-o", name, "--format", "png",
                        cwd=self.folder)
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertEqual({path.name for path in self.folder.glob("*/*.png")}, {
            "up-study.png", "up-A-fibre.png", "up-energy.png", "up-contact_length.png"})
        import matplotlib
        matplotlib.use("Agg")
        study = Study.read(self.folder / "one.h5")
        ax = anticrack.draw.curves(study)
        np.testing.assert_array_equal(ax.lines[0].get_xydata(), np.column_stack((study[ANGLE], study["A of fibre"])))
        (band,) = ax.collections
        band = band.get_paths()[0].vertices
        for end in ("lower", "upper"):
            for point in zip(study[ANGLE], study[f"A_{end} of fibre"]):
                self.assertIn(point, [tuple(vertex) for vertex in band])


def with_server():
    return dict(os.environ, PATH=f"{pathlib.Path(ANTICRACKD).parent}:{os.environ['PATH']}")
