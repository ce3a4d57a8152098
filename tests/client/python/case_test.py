# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases from TOML and from objects: sent as they are, and refused by name where they are wrong."""
import os
import pathlib
import unittest

import numpy

import anticrack
from anticrack import Case, Crack, Geometry, Hole, Inclusion, Interface, Load, Mesh, Region, Side
from anticrack.errors import ServerError
from anticrack.reading import in_terms_of, places_of
from anticrack.v1 import case_pb2, job_pb2
from cases import read
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
SQUARE = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
ONE = [Load("one", 1)]


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
                self.assertEqual(ours.message.spec, theirs.message.spec, case)

    def test_mistakes_have_lines_while_the_tables_are_those_of_the_text(self):
        mesh = "[geometry]\nboundary = [[0, 0], [1, 0], [0, 1]]\n"
        text = mesh + "[solver]\ntheat = 1\n[[load]]\nname = 'a'\nf = nan"
        case = Case.parse(text, "own.toml")
        with self.assertRaisesRegex(anticrack.CaseError, r"^own.toml:4: solver.theat: unknown key; did you mean "):
            read(case)
        del case.tables["solver"]["theat"]
        with self.assertRaisesRegex(anticrack.CaseError, "^own.toml: load.a.f: nan is not a finite number; write "):
            read(case)
        case.tables["load"][0]["f"] = "1 +"
        with anticrack.local(program=ANTICRACKD) as client:
            with self.assertRaisesRegex(anticrack.ServerError, "^own.toml: load.a.f: "):
                client.submit(case)
        with self.assertRaisesRegex(anticrack.CaseError, r"^own.toml:7: load.a.f: nan is not a finite number"):
            read(Case.parse(text.replace("theat = 1", ""), "own.toml"))
        said = r"^own.toml: its 5 MB are more than the server takes, 4\.19 MB; write fewer points, or "
        with self.assertRaisesRegex(anticrack.CaseError, said):
            read(Case.parse("# " + 5_000_000 * "a" + "\n", "own.toml"))
        with self.assertRaisesRegex(anticrack.CaseError, "^case: load: missing; write "):
            read(Case.parse(mesh))
        self.assertEqual(len(read(Case.parse(mesh), loads_optional=True).mesh.geometry.boundary), 3)

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
        ours, theirs = read(case).mesh, read(Case.parse(text)).mesh
        self.assertEqual(ours, theirs)
        self.assertEqual(list(ours.geometry.neumann_sides), ["base", "window"])
        self.assertEqual(ours.geometry.inclusions[0].delaminated_parts.stretches[0].to, 0.5)
        everywhere = read(Case.parse(text.replace('["base", [[1, 0], [0, 1]], "window"]', '"all"'))).mesh.geometry
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
        ours, theirs = read(case), read(Case.parse(text))
        self.assertEqual(ours.mesh, theirs.mesh)
        self.assertEqual(ours.spec, theirs.spec)
        again = read(Case.parse(ours.text))
        self.assertEqual((again.mesh, again.spec), (ours.mesh, ours.spec))

    def test_what_is_wrong_is_named(self):
        def bump(x, y):
            return x * y
        square = Geometry(SQUARE)
        for case, said in (
                (lambda: Case(square, [Load("a", numpy.ones(3))]), "load.a.f.per: missing"),
                (lambda: Case(square, [Load("a", [1, 2], per="side")]), "load.a.f.per: .*known are node, triangle"),
                (lambda: Case(square, [Load("a", numpy.ones((3, 2)), per="node")]), r"load.a.f.values: .*\(3, 2\)"),
                (lambda: Case(square, [Load("a", numpy.array([numpy.nan]), per="node")]), "load.a.f.values: "),
                (lambda: Case(square, [Load("a", 1, per="node")]), r"load.a.f.values: .* shape \(\) is not \(nodes"),
                (lambda: Case(square, [Load("a", {"values": [1], "pre": "node"})]), "load.a.f.pre: unknown key; "),
                (lambda: Case(square, [Load("a", True)]), "load.a.f: true is not a finite number"),
                (lambda: Case(square, ONE, title=1), "title: 1 is not text"),
                (lambda: Case(square, ONE, Mesh(size=True)), "mesh.size: true is not a finite number; write "),
                (lambda: Case(square, ONE, Mesh(size=1j)), "mesh.size: 1j .complex. is not possible; give a "),
                (lambda: Case(square, ONE, Mesh(size=[0.1, None])), "mesh.size.1: None .NoneType. is not possible"),
                (lambda: Case(square, ONE, Mesh(size=10**400)), r"mesh.size: 10*\.\.\. is not a finite number"),
                (lambda: Case(Geometry([(0, 0), (1, -numpy.inf)]), ONE), "geometry.boundary.1.1: -inf is not a finite"),
                (lambda: Case(Geometry(SQUARE, holes=[Hole(spline={1})]), ONE), "geometry.hole.0.spline: .*.set. is "),
                (lambda: Case(mesh=Mesh(file="x.msh", preset=b"paper")), "mesh.preset: b.paper. .bytes. is not pos"),
                (lambda: Case(square, [Load("a", [[1], [1, 2]], per="node")]), "load.a.f.values: "),
                (lambda: Case(square, [Load("a", bump)]), "f: the Python function bump .*expression .*per=.node"),
                (lambda: Case(square, [Load("a", 1, boundary_value=bump)]), "load.a.boundary_value: .*bump .*express"),
                (lambda: Case(Geometry(SQUARE, regions=[Region("r", (0, 0), tension=bump)]), ONE),
                 "geometry.region.r.tension: the Python function bump .*expression"),
                (lambda: Case(square, [Load("a", point_forces=[(0, 0, 1)])]), r"point_forces: .*\[\(\(x, y\), force\)"),
                (lambda: Case(square, Load("a", 1)), "load: .* is not a list of tables; write "),
                (lambda: Case(square, ["a"]), "load.0: 'a' is not a table; write "),
                (lambda: Case("case.toml", ONE), "geometry: 'case.toml' is not a table"),
                (lambda: Case(square, ONE, accuracy=0.01), r"accuracy: 0.01 is not a table"),
                (lambda: Case(Geometry(SQUARE, inclusions=Inclusion("b", (0, 0), (1, 0)))), "geometry.inclusion: "),
                (lambda: Case(Geometry(SQUARE, cracks=["c"])), "geometry.crack.0: 'c' is not a table"),
                (lambda: Case(mesh=Mesh(file="x.msh", curves=["crack"])), "mesh.groups.curve: .* is not a table"),
                (lambda: 3, "case: 3 is no case; give a Case"),
                (lambda: Case(square, ONE, Mesh(curves={0: "crack"})), "mesh.groups.curve.0: .0. is not a tag")):
            with self.assertRaisesRegex(anticrack.CaseError, said):
                read(case())
        with self.assertRaises(TypeError):
            anticrack.Accuracy(0.01)  # of what?

    def test_only_its_tables_can_be_changed(self):
        case = Case(Geometry(SQUARE), [Load("a", 1)], accuracy=anticrack.Accuracy(A=0.1))
        for name in ("accuracy", "acuracy"):
            with self.assertRaisesRegex(AttributeError, f"case.{name} .* case.tables, which has geometry, acc"):
                setattr(case, name, None)
        case.tables = {**case.tables, "title": "other", "load": [Load("b", 1)]}
        spec = read(case).spec
        self.assertEqual((spec.title, spec.load_cases[0].name), ("other", "b"))

    def test_are_told_by_what_is_given(self):
        self.assertEqual(repr(Inclusion("fibre", (0, 0), (1, 0), fixed=0.5)),
                         "Inclusion(name='fibre', start=(0, 0), end=(1, 0), fixed=0.5)")
        half = numpy.float64(0.5)
        self.assertEqual(repr(Inclusion("fibre", (half, 0), [half, half], fixed=half)),
                         "Inclusion(name='fibre', start=(0.5, 0), end=[0.5, 0.5], fixed=0.5)")
        case = Case(Geometry(SQUARE, inclusions=[Inclusion("b", points=numpy.zeros((1000, 2)))] * 9), [Load("a", 1)])
        self.assertEqual(repr(case), "<Case '' with geometry, load>")
        self.assertLess(len(repr(Inclusion("b", points=numpy.zeros((1000, 2))))), 120)


class Answers(unittest.TestCase):
    def test_keep_what_is_in_memory_here(self):
        loads = [Load("one", 1), Load("two", numpy.array([2.0, 3]), per="triangle"), Load("three", [4, 5], per="node")]
        case = read(Case(Geometry(SQUARE), loads))
        self.assertEqual([(index, values.tolist()) for index, values in case.arrays()], [(1, [2, 3]), (2, [4, 5])])
        self.assertEqual([load.force.array.per_triangle for load in case.spec.load_cases], [False, True, False])
        loads[1].f[0] = 1
        self.assertNotEqual(read(Case(Geometry(SQUARE), loads)).text, case.text)  # else one result replaces the other
        msh = anticrack.Msh([[0, 0], [1, 0], [0, 1]], {"triangle": [[0, 1, 2]]})
        self.assertEqual(read(Case(loads=ONE, mesh=Mesh(file=msh))).msh(), msh.to_bytes())
        self.assertIsNone(case.msh())

    def test_say_where_fields_were_written(self):
        places = {field: case_pb2.CasePlace(where=where, key=key) for field, where, key in (
            ("load_cases[0]", "a.toml:3", "load.up"), ("load_cases[0].force", "a.toml:5", "load.up.f"),
            ("options.tension[top]", "--set mesh.tension.top=1", "mesh.tension.top"), ("options.tension.top", "", ""),
            ("solver", "", "solver"), ("solver.theta", "", "solver.theta"))}
        for fields, said in (
                ((("spec.load_cases[0].force.expression", "no"),), "a.toml:5: load.up.f: no"),
                ((("load_cases[0].point_forces[2].at", "no"),), "a.toml:3: load.up: no"),
                ((("mesh.options.tension[top]", "no"),), "--set mesh.tension.top=1: mesh.tension.top: no"),
                ((("sweep.traces[0]", "no"),), "sweep.traces[0]: no"),
                ((("solver.theta", "no"), ("solver", "no")), "solver.theta: no"),
                ((("solver", "no"), ("solver.theta", "no")), "solver: no\nsolver.theta: no"),
                ((("solver.theta", "no"), ("solver", "nor this")), "solver.theta: no\nsolver: nor this")):
            self.assertEqual(str(in_terms_of(places, ServerError("INVALID_ARGUMENT", "all", fields=fields))), said)
        spec = job_pb2.JobSpec(load_cases=[{"name": "up"}])
        error = ServerError("INVALID_ARGUMENT", "all", fields=(("spec.load_cases[0].force.constant", "no"),))
        self.assertEqual(str(in_terms_of(places_of(spec), error)), "load.up.f: no")


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
