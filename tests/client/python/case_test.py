# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases from TOML and from objects: the same as the command's, and refused by name where they are wrong."""
import os
import pathlib

import numpy

import anticrack
from anticrack import Case, Crack, Geometry, Hole, Inclusion, Interface, Load, Mesh, Region, Side
from processes import ANTICRACK, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
SQUARE = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
FIBRE = """
[geometry]
boundary = [[-1,-1], [1,-1], [1,1], [-1,1]]
interface = [[-1,0], [1,0]]
[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to = [0.5, 0]
delaminated = true
"""
# What is added to it, and what the error says.
WRONG = [
    ("[solver]\ntheat = 1", "case: solver.theat: unknown key; did you mean theta?"),
    ("[solver]\ntheta = 1", "case: solver.theta: belongs to method \"uzawa\""),
    ("[mesh]\npreset = 'fine'", "case: mesh.preset: 'fine' is not possible; known are paper, uniform, graded, coarse"),
    ("[mesh]\npreset = 'paper'\nsize = 1", "case: mesh.size: means nothing with preset \"paper\""),
    ("[mesh]\nsize = 0", "case: mesh.size: 0.0 is not above 0"),
    ("[mesh]\nfile = 'x.msh'", "case: geometry: there is a mesh.file too"),
    ("[mesh]\ntension = {a = 1}", "case: mesh.tension: belongs to mesh.file"),
    ("[[geometry.crack]]\nname = 'c'", "case: geometry.crack.c.from: missing; write [x, y]"),
    ("[[geometry.region]]\nname = 'r'\nat = [0]", "case: geometry.region.r.at: [0] is not a point"),
    ("[[geometry.region]]\nname = 'r'\nat = [0, 0]\ncircle = 1", "case: geometry.region.r.circle: the region has at"),
    ("[[geometry.hole]]", "case: geometry.hole.0: the hole without a shape; write circle"),
    ("[[geometry.hole]]\ncircle = {center = [0, 0]}", "case: geometry.hole.0.circle.radius: missing"),
    ("[[geometry.inclusion]]\nname = 'b'\nside = 'up'\nfrom = [0, 0]\nto = [1, 0]",
     "case: geometry.inclusion.b.side: 'up' is not possible; known are left, right"),
    ("[[geometry.inclusion]]\nname = 'b'\ncenter = [0, 0]", "case: geometry.inclusion.b.length: missing; write its"),
    ("[[geometry.inclusion]]\nname = 'b'\ncenter = [0, 0]\nlength = 0",
     "case: geometry.inclusion.b.length: 0.0 is not above 0; write a number above 0"),
    ("[[geometry.inclusion]]\nname = 'b'\ncenter = [0, 0]\nlength = '100 mm'",
     "case: geometry.inclusion.b.length: '100 mm' is a number with a unit; write 100: the units of "),
    ("[[geometry.inclusion]]\nname = 'b'\npoints = []\ndelaminated = false\nside = 'left'",
     "case: geometry.inclusion.b.side: nothing comes off on it"),
    ("[[geometry.inclusion]]\nname = 'b'\narc = [[0, 0]]", "case: geometry.inclusion.b.arc: "),
    ("[[geometry.inclusion]]\nname = 'b'\npoints = []\nto = [0, 0]",
     "case: geometry.inclusion.b.to: belongs to a part"),
    ("[[geometry.inclusion]]\nname = 'b'\npoints = []\nangle = 2",
     "case: geometry.inclusion.b.angle: belongs to center"),
    ("[[geometry.inclusion]]\nname = 'b'\npoints = []\ndelaminated = [[0, 'a']]",
     "case: geometry.inclusion.b.delaminated.0: 'a' is not a finite number"),
    ("[[geometry.inclusion]]\nname = 'b'\npoints = []\ndelaminated = 'left'\nside = 'left'",
     "case: geometry.inclusion.b.side: delaminated names a side too"),
    ("[[geometry.crack]]\nname = 'c'\nside = 'left'", "case: geometry.crack.c.side: belongs to [[geometry.inclusion]]"),
    ("[[load]]\nname = 'a'", "case: load.a.f: missing; write a number"),
    ("[[load]]\nname = 'a'\nf = [1]", "case: load.a.f: [1] is not a finite number"),
    ("[[load]]\nname = 'a'\nf = {values = [1]}", "case: load.a.f.per: missing"),
    ("[[load]]\nname = 'a'\nf = {file = 'none.h5', dataset = '/f', per = 'node'}", "case: load.a.f.file: none.h5: "),
    ("[[geometry.inclusion]]\nname = 'rod'\npoints = []\nfixed = 1\n[[load]]\nname = 'a'\ninclusion_forces = {rod = 1}",
     "case: load.a.inclusion_forces.rod: the inclusion is held by its key fixed"),
    ("[[load]]\nname = 'a'\nf = inf", "case: load.a.f: inf is not a finite number"),
    ("[accuracy]\nenergy = 2", "case: accuracy.energy: 2 is out of range"),
    ("[accuracy]\ntime = 1", "case: accuracy: no accuracy"),
    ("[job]\nrun_timeout = '3 weeks'", "case: job.run_timeout: '3 weeks' is not a time"),
    ("[output]\nfields = 1", "case: output.fields: 1 is neither true nor false"),
    ("", "case: load: missing"),
]


class FromToml(FolderTest):
    def test_every_example_is_what_the_command_makes_of_it(self):
        with Daemon(self.folder) as daemon, anticrack.connect(f"127.0.0.1:{daemon.port}") as client:
            cases = sorted(EXAMPLES.glob("*.toml"))
            self.assertGreater(len(cases), 10)
            for case in cases:
                ours = client.submit(case)
                submitted = run(ANTICRACK, "--server", f"127.0.0.1:{daemon.port}", "job", "submit", case)
                self.assertEqual(submitted.returncode, 0, submitted.stderr)
                theirs = client.job(submitted.stdout.strip())
                ours.refresh()
                for job in (ours, theirs):
                    job.cancel()
                for name in ("title", "mesh", "load_cases", "solver", "outputs", "priority", "accuracy", "units"):
                    self.assertEqual(getattr(ours.message, name), getattr(theirs.message, name), f"{case}: {name}")

    def test_keys_that_no_example_has(self):
        text = FIBRE + """
[mesh]
preset = "uniform"
size = 0.1
align = [[[-0.5, 0.5], [0.5, 0.5]]]
[solver]
method = "uzawa"
theta = "auto"
mass = "consistent"
kkt_tolerance = 1e-6
max_iterations = 3
[job]
priority = "bulk"
queue_timeout = "10min"
run_timeout = 1.5
[[load]]
name = "a"
inclusion_forces = { fibre = 1 }
"""
        text = text.replace("delaminated = true", "delaminated = true\n[[geometry.inclusion]]\nname = 'rod'\n"
                                                  "center = [0, 0.75]\nlength = 0.25\nfixed = 0.1")
        (self.folder / "case.toml").write_text(text, encoding="utf-8")
        with Daemon(self.folder) as daemon, anticrack.connect(f"127.0.0.1:{daemon.port}") as client:
            ours = client.submit(self.folder / "case.toml").refresh().message
            submitted = run(ANTICRACK, "--server", f"127.0.0.1:{daemon.port}", "job", "submit",
                            self.folder / "case.toml")
            theirs = client.job(submitted.stdout.strip()).message
        for name in ("mesh", "load_cases", "solver", "priority", "queue_timeout", "run_timeout"):
            self.assertEqual(getattr(ours, name), getattr(theirs, name), name)

    def test_wrong_ones_name_the_key_and_the_cure(self):
        for text, said in WRONG:
            with self.assertRaises(anticrack.CaseError, msg=text) as caught:
                Case.parse(FIBRE + text).requests(loads_needed="load" in said)
            self.assertTrue(str(caught.exception).startswith(said), f"{caught.exception} / {said}")

    def test_values_that_are_none_of_toml(self):
        for value in ("100 mm", "3,5", "True", "right"):
            with self.assertRaisesRegex(anticrack.CaseError, "not TOML: .*; a value is a number as 3.5, true, false, "):
                Case.parse("[mesh]\nsize = " + value)
        with self.assertRaises(anticrack.CaseError) as caught:
            Case.parse("[mesh")
        self.assertNotIn("a value is", str(caught.exception))

    def test_files_that_are_none(self):
        (self.folder / "broken.toml").write_text("[geometry", encoding="utf-8")
        (self.folder / "binary.toml").write_bytes(b"\xff\xfe")
        for name, said in (("none", "cannot be read"), ("broken", "this is not TOML"), ("binary", "this is not text")):
            with self.assertRaisesRegex(anticrack.CaseError, f"{name}.toml: {said}"):
                Case.read(self.folder / f"{name}.toml")


class FromObjects(FolderTest):
    def test_shapes_of_their_own_are_the_same_as_from_toml(self):
        self.maxDiff = None
        case = Case(Geometry(
            [Side("base", points=[(-1, 0), (1, 0)]), Side(arc=[(1, 0), (0, 1), (-1, 0)])],
            inclusions=[Inclusion("bar", center=(0, 0.5), angle=20, length=0.5, delaminated=[(0, 0.5)], side="left"),
                        Inclusion("bow", arc=[(0, 0.1), (0.1, 0.2), (0.2, 0.1)], delaminated="right")],
            cracks=[Crack("slit", spline=[(-0.5, 0.1), (-0.4, 0.2), (-0.3, 0.1)])],
            regions=[Region("patch", circle={"center": (0, 0.5), "radius": 0.1}, tension=2)],
            holes=[Hole("window", points=[(0.5, 0.1), (0.6, 0.1), (0.6, 0.2)]), Hole(spline=numpy.eye(3, 2))],
            neumann=["base", ((1, 0), (0, 1)), "window"]), [Load("one", {"patch": 1})])
        text = """
[geometry]
neumann = ["base", [[1, 0], [0, 1]], "window"]
boundary = [{ name = "base", points = [[-1, 0], [1, 0]] }, { arc = [[1, 0], [0, 1], [-1, 0]] }]
inclusion = [
    { name = "bar", center = [0, 0.5], angle = 20, length = 0.5, delaminated = [[0, 0.5]], side = "left" },
    { name = "bow", arc = [[0, 0.1], [0.1, 0.2], [0.2, 0.1]], delaminated = "right" }]
crack = [{ name = "slit", spline = [[-0.5, 0.1], [-0.4, 0.2], [-0.3, 0.1]] }]
region = [{ name = "patch", circle = { center = [0, 0.5], radius = 0.1 }, tension = 2 }]
hole = [{ name = "window", points = [[0.5, 0.1], [0.6, 0.1], [0.6, 0.2]] }, { spline = [[1, 0], [0, 1], [0, 0]] }]
[[load]]
name = "one"
f = { patch = 1 }
"""
        ours, theirs = case.requests().mesh, Case.parse(text).requests().mesh
        self.assertEqual(ours, theirs)
        self.assertEqual(list(ours.geometry.neumann_sides), ["base", "window"])
        self.assertEqual(ours.geometry.inclusions[0].delaminated_parts.stretches[0].to, 0.5)
        everywhere = Case.parse(text.replace('["base", [[1, 0], [0, 1]], "window"]', '"all"')).requests().mesh.geometry
        self.assertEqual(list(everywhere.neumann_sides), ["base", "side-2", "window", "hole-2"])

    def test_are_the_same_as_from_toml(self):
        self.maxDiff = None
        case = Case(
            Geometry(numpy.array(SQUARE), [Interface([[-1, 0], [1, 0]], name="middle"),
                                           Interface(arc=[(0, 0), (0.3, 0.6), (0.4, 1)], name="arc")],
                     [Inclusion("fibre", (-0.5, 0), (numpy.float64(-0.2), 0), delaminated=[((-0.5, 0), (-0.4, 0))],
                                tilt=True)],
                     [Crack("crack", (0.3, 0), (0.6, 0), contact=False)],
                     [Region("top", (-0.5, 0.5), tension={"along": 2, "across": "1 + x", "angle": 30})],
                     neumann=[((1, -1), (1, 1))]),
            [Load("pulled", point_forces=[((0.2, 0.3), 1)], inclusion_moments={"fibre": (1, 2)}, traction=0.2),
             Load("pressed", {"top": 1}, boundary_value="x")],
            Mesh("uniform", size=0.1), anticrack.Uzawa(theta="auto"), title="both", fields=True, priority="bulk")
        text = """
title = "both"
[geometry]
boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
neumann = [[[1, -1], [1, 1]]]
interface = [{ name = "middle", points = [[-1, 0], [1, 0]] },
             { name = "arc", arc = [[0, 0], [0.3, 0.6], [0.4, 1]] }]
inclusion = [{ name = "fibre", from = [-0.5, 0], to = [-0.2, 0], delaminated = [[[-0.5, 0], [-0.4, 0]]], tilt = true }]
crack = [{ name = "crack", from = [0.3, 0], to = [0.6, 0], contact = false }]
region = [{ name = "top", at = [-0.5, 0.5], tension = { along = 2, across = "1 + x", angle = 30 } }]
[mesh]
preset = "uniform"
size = 0.1
[solver]
method = "uzawa"
theta = "auto"
[output]
fields = true
[job]
priority = "bulk"
[[load]]
name = "pulled"
traction = 0.2
point_forces = [{ at = [0.2, 0.3], value = 1 }]
inclusion_moments = { fibre = [1, 2] }
[[load]]
name = "pressed"
f = { top = 1 }
boundary_value = "x"
"""
        ours, theirs = case.requests(), Case.parse(text).requests()
        self.assertEqual(ours.mesh, theirs.mesh)
        self.assertEqual(ours.job, theirs.job)

    def test_what_is_wrong_is_named(self):
        def bump(x, y):
            return x * y
        square = Geometry(SQUARE)
        for case, said in (
                (lambda: Case(square, [Load("a", numpy.ones(3))]), "load.a.f.per: missing"),
                (lambda: Case(square, [Load("a", numpy.ones((3, 2)), per="node")]), r"load.a.f.values: .*\(3, 2\)"),
                (lambda: Case(square, [Load("a", numpy.array([numpy.nan]), per="node")]), "load.a.f.values: "),
                (lambda: Case(square, [Load("a", 1, per="node")]), "load a: per goes with an array"),
                (lambda: Case(square, [Load("a", True)]), "load.a.f: true is not a finite number"),
                (lambda: Case(square, title=1), "title: 1 is not text; give a str"),
                (lambda: Case(square, mesh=Mesh(size=True)), "mesh.size: true is not a finite number; write one, "),
                (lambda: Case(square, [Load("a", [1, 2])]), "load.a.f.per: missing"),
                (lambda: Case(square, [Load("a", [[1], [1, 2]], per="node")]), "load.a.f.values: "),
                (lambda: Case(square, [Load("a", bump)]), "f: the Python function bump .*expression .*per=.node"),
                (lambda: Case(square, [Load("a", 1, boundary_value=bump)]), "load.a.boundary_value: .*bump .*express"),
                (lambda: Case(Geometry(SQUARE, regions=[Region("r", (0, 0), tension=bump)]), [Load("a", 1)]),
                 "geometry.region.r.tension: the Python function bump .*along = T1"),
                (lambda: Case(square, [Load("a", point_forces=[(0, 0, 1)])]), r"point_forces: .*\[\(\(x, y\), force\)"),
                (lambda: Case(square, Load("a", 1)), r"load: Load\(name='a', f=1\) is not a list; write \[Load"),
                (lambda: Case(square, ["a"]), "load.0: 'a' is not of the class Load; write Load"),
                (lambda: Case("case.toml"), "geometry: 'case.toml' is not possible; write .*Case.read"),
                (lambda: Case(square, accuracy=0.01), r"accuracy: 0.01 is not possible; write Accuracy\(energy=1e-3\)"),
                (lambda: Case(Geometry(SQUARE, inclusions=Inclusion("b", (0, 0), (1, 0)))), "geometry.inclusion: Inc"),
                (lambda: Case(Geometry(SQUARE, cracks=["c"])), "geometry.crack.0: 'c' is not of the class Crack"),
                (lambda: Case(mesh=Mesh(file="x.msh", curves=["crack"])), "mesh.groups.curve: .* is not a table"),
                (lambda: anticrack.case.as_case(3), "case: 3 is no case; give a Case"),
                (lambda: Case(square, [Load("a", 1)], Mesh(curves={0: "crack"})), "mesh.groups: belongs to mesh.file")):
            with self.assertRaisesRegex(anticrack.CaseError, said):
                case().requests()
        with self.assertRaises(TypeError):
            anticrack.Accuracy(0.01)  # of what?

    def test_only_its_tables_can_be_changed(self):
        case = Case(Geometry(SQUARE), [Load("a", 1)], accuracy=anticrack.Accuracy(A=0.1))
        for name in ("accuracy", "acuracy"):
            with self.assertRaisesRegex(AttributeError, f"case.{name} .* case.tables, which has geometry, acc"):
                setattr(case, name, None)
        copied = case.copy()
        copied.tables = {**case.tables, "title": "other"}
        self.assertEqual(copied.requests().job.title, "other")

    def test_are_told_by_what_is_given(self):
        self.assertEqual(repr(Inclusion("fibre", (0, 0), (1, 0), fixed=0.5)),
                         "Inclusion(name='fibre', start=(0, 0), end=(1, 0), fixed=0.5)")
        half = numpy.float64(0.5)
        self.assertEqual(repr(Inclusion("fibre", (half, 0), [half, half], fixed=half)),
                         "Inclusion(name='fibre', start=(0.5, 0), end=[0.5, 0.5], fixed=0.5)")
        case = Case(Geometry(SQUARE, inclusions=[Inclusion("b", points=numpy.zeros((1000, 2)))] * 9), [Load("a", 1)])
        self.assertEqual(repr(case), "<Case '' with geometry, load>")
        self.assertLess(len(repr(Inclusion("b", points=numpy.zeros((1000, 2))))), 120)


class Msh(FolderTest):
    def test_wrong_arrays_are_named(self):
        points = [[0, 0], [1, 0], [0, 1]]
        for cells, groups, said in (
                ({"triangle": [[0, 1, 3]]}, {}, "points that are not there"),
                ({"triangle": [[0, 1]]}, {}, r"shape \(1, 2\) is not \(n, 3\)"),
                ({"quad": [[0, 1, 2, 0]]}, {}, "no part of a membrane"),
                ({"triangle": [[0, 1, 2]]}, {"triangle": ["a", "b"]}, "2 names for 1 cells")):
            with self.assertRaisesRegex(anticrack.CaseError, said):
                anticrack.Msh(points, cells, groups).to_bytes()
