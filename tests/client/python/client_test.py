# SPDX-License-Identifier: GPL-3.0-or-later
"""The package against the real server: jobs, sweeps, arrays, stages, certificates, tokens, a server that crashes."""
import asyncio
import hashlib
import io
import os
import pathlib
import tempfile
import unittest
import unittest.mock
import warnings
import xml.etree.ElementTree

import numpy

import anticrack
from anticrack import Accuracy, Case, Geometry, Inclusion, Interface, Load, Mesh, Msh
from anticrack.progress import Progress, State
from anticrack.v1 import solve_pb2
from processes import ANTICRACK, ANTICRACKD, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
DEPLOY = pathlib.Path(os.environ["DEPLOY"])
LIMIT = 0.1038245  # A of Example 3, see tests/accuracy/paper_limits.hpp
GEOMETRY = Geometry([(-1, -1), (1, -1), (1, 1), (-1, 1)], [Interface([(-1, 0), (1, 0)])],
                    [Inclusion("fibre", (-0.5, 0), (0.5, 0), delaminated=True)])
OPENING = Load("opening", "y > 0 ? 1 : -1")
COARSE = Mesh(size=0.2)
LONG = anticrack.Uzawa(theta=1e-3, max_iterations=20_000)


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Jobs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = cls.enterClassContext(anticrack.local(program=ANTICRACKD))

    def test_are_solved(self):
        result = self.client.run(Case(GEOMETRY, [OPENING], title="a fibre", fields=True), progress=False)
        load = result["opening"]
        self.assertTrue(result.converged and load.converged)
        fibre = load.inclusions["fibre"]
        self.assertAlmostEqual(fibre.A / LIMIT, 1, delta=0.01)
        self.assertLess(fibre.A_lower, LIMIT)
        self.assertLess(LIMIT, fibre.A_upper)
        self.assertLess(max(load.kkt.values()), 1e-9)
        self.assertEqual((result.title, result.mesh.inclusions), ("a fibre", ["fibre"]))
        self.assertEqual(len(load.traces[0].jump), len(result.interfaces[0].s))
        self.assertEqual(sum(len(field.triangles) for field in load.fields), len(result.mesh.triangles))
        self.assertEqual(len(load.indicator), len(result.mesh.triangles))
        again = self.client.run(Case.parse(result.case), progress=False)
        self.assertEqual((again.case, again["opening"].energy), (result.case, load.energy))

    def test_warn_of_u_that_is_not_small(self):
        loads = [Load("opening", "y > 0 ? 1 : -1"), Load("strong", "y > 0 ? 1000 : -1000")]
        units = anticrack.Units("mm", "N")
        with self.assertWarnsRegex(UserWarning, r"^u reaches \d+ mm in load \"strong\", and the smaller side of the "
                                                r"sheet is 2 mm: .*small slopes") as caught:
            result = self.client.run(Case(GEOMETRY, loads, COARSE, units=units), progress=False)
        self.assertEqual(caught.filename, __file__)
        path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / "result.h5"
        result.save(path)
        self.assertIn(f"note: {caught.warning}\n", run(ANTICRACK, "show", path).stdout)
        with self.assertWarnsRegex(UserWarning, "gives no force"):
            self.client.run(Case(GEOMETRY, [OPENING], COARSE, units=anticrack.Units("km")), progress=False)
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # without units u may have another one than x
            self.client.run(Case(GEOMETRY, loads, COARSE), progress=False)

    def test_are_found_again_listed_and_deleted(self):
        job = self.client.submit(Case(GEOMETRY, [OPENING], COARSE))
        self.assertEqual(self.client.job(job.name).result()["opening"].status, "converged")
        self.assertIn(job.name, [listed.name for listed in self.client.jobs(1000)])
        job.refresh()
        self.assertEqual((job.state, job.ended, job.error), ("succeeded", True, None))
        job.delete()
        with self.assertRaises(anticrack.ServerError) as caught:
            job.refresh()
        self.assertEqual((caught.exception.code, caught.exception.reason), ("NOT_FOUND", "NOT_FOUND"))

    def test_are_cancelled(self):
        job = self.client.submit(Case(GEOMETRY, [OPENING], COARSE, LONG))
        for message in job.events():
            if message.HasField("samples"):
                break
        self.assertEqual(job.cancel().wait(progress=False).state, "cancelled")

    def test_one_that_does_not_converge_has_its_answers(self):
        case = Case(GEOMETRY, [OPENING], COARSE, anticrack.Uzawa(theta=0.1, max_iterations=3))
        result = self.client.run(case, progress=False)
        self.assertFalse(result.converged)
        self.assertEqual(result["opening"].status, "not_converged")
        self.assertEqual(result["opening"].history["iteration"].tolist(), [1, 2, 3])
        self.assertIn("3", result["opening"].reason)

    def test_refusals_name_the_field(self):
        with self.assertRaises(anticrack.ServerError) as caught:
            self.client.submit(Case(GEOMETRY, [Load("a", "sin(z)")], COARSE))
        self.assertEqual(caught.exception.code, "INVALID_ARGUMENT")
        self.assertTrue(str(caught.exception).startswith("load.a.f: "), caught.exception)
        with self.assertRaisesRegex(anticrack.ServerError, "^load.a.traction: nothing has a traction"):
            self.client.submit(Case(GEOMETRY, [Load("a", 1.0, traction="5")], COARSE))
        for text, said in (("[solver]\nmethod = 'uzawa'\ntheta = -1", "case:6: solver.theta: "),
                           ("[mesh]\nsize = 1e-9", "case:5: mesh.size: "),
                           ("[[geometry.region]]\nname = 'a b'\nat = [0, 0.5]", "case:5: geometry.region.a b.name: "),
                           ("[[geometry.inclusion]]\nname = 'i'\nfrom = [0, 3]\nto = [0, 4]",
                            "case:6: geometry.inclusion.i.from: ")):
            case = "[geometry]\nboundary = [[-1,-1], [1,-1], [1,1], [-1,1]]\ninterface = [[-1,0], [1,0]]\n" + text
            with self.assertRaises(anticrack.ServerError, msg=text) as caught:
                self.client.submit(Case.parse(case + "\n[[load]]\nname = 'a'\nf = 1"))
            self.assertTrue(str(caught.exception).startswith(said), caught.exception)

    def test_a_region_that_is_not_there_is_named(self):
        geometry = Geometry(GEOMETRY.boundary, regions=[anticrack.Region("sheet", (0, 0.5))])
        with self.assertRaisesRegex(anticrack.ServerError, "^load.a.f.shet: .*sheet"):
            self.client.run(Case(geometry, [Load("a", {"shet": 1})]), progress=False)
        case = Case(loads=[Load("a", {"shet": 1})], mesh=Mesh(file=EXAMPLES / "plate.msh"))
        job = self.client.submit(case)  # only the mesher knows the subdomains of a file
        for found in (job, self.client.job(job.name)):
            with self.assertRaisesRegex(anticrack.ServerError, "^load.a.f.*shet"):
                found.wait(progress=False).result()

    def test_regions_that_forget_their_tension_are_told(self):
        geometry = Geometry(GEOMETRY.boundary, GEOMETRY.interfaces, regions=[
            anticrack.Region("top", (0, 0.5), tension=2), anticrack.Region("below", (0, -0.5))])
        with self.assertWarnsRegex(UserWarning, "^geometry.region.below: it gives no tension, .* its tension is 1;"):
            self.client.mesh(Case(geometry))
        given = "[units]\nlength = 'mm'\nforce = 'N'\n[geometry]\nboundary = [[0, 0], [1, 0], [0, 1]]"
        with self.assertWarnsRegex(UserWarning, "units: nothing gives a tension, so T is 1 N/mm; write tension in "):
            self.client.mesh(Case.parse(given))

    def test_a_mesh_that_fails_says_why(self):
        far = Geometry(GEOMETRY.boundary, [Interface([(3, 0), (4, 0)])], [Inclusion("fibre", (3, 0), (4, 0))])
        with self.assertRaises(anticrack.ServerError) as caught:
            self.client.mesh(Case(far))
        self.assertEqual(caught.exception.reason, "GEOMETRY_INVALID")
        with self.assertRaisesRegex(anticrack.ServerError, r"^mesh.groups.curve.77: the file has no curve group 77"):
            self.client.mesh(Case(mesh=Mesh(file=EXAMPLES / "plate.msh", curves={77: "crack"})))
        with self.assertRaisesRegex(anticrack.CaseError, r"^mesh.file: none.msh: No such file"):
            self.client.mesh(Case(mesh=Mesh(file="none.msh")))

    def test_loads_are_arrays_on_the_mesh(self):
        case = Case(GEOMETRY, [Load("one", 1)], COARSE)
        arrays = self.client.mesh_arrays(self.client.mesh(case))
        for per, count in (("node", len(arrays["nodes"])), ("triangle", len(arrays["triangles"]))):
            loads = [Load("one", 1), Load("array", numpy.ones(count, dtype=numpy.float32), per=per)]
            result = self.client.run(Case(GEOMETRY, loads, COARSE), progress=False)
            self.assertAlmostEqual(result["array"].energy, result["one"].energy, places=12)

    def test_sweeps_are_columns(self):
        case = EXAMPLES / "load-ratio.toml"
        coefficients = numpy.array([[1.0, 0], [0, 1], [1, 1]])
        result = self.client.run(case, coefficients, traces=[1], progress=False)
        sweep = result.sweep
        self.assertTrue(sweep.converged.all() and result.converged)
        self.assertTrue((sweep.coefficients == coefficients).all())
        self.assertEqual(sweep.displacement.shape, (3, 1))
        self.assertAlmostEqual(sweep.displacement[1, 0] / LIMIT, 1, delta=0.01)
        self.assertEqual(sweep.contact.shape, (3, len(sweep.contact_nodes)))
        self.assertGreater(result["row-1"].traces[0].jump.max(), 0.2)
        frame = sweep.frame()
        self.assertEqual(frame["status"].tolist(), ["converged"] * 3)
        self.assertEqual(frame["A of gamma_c"].tolist(), sweep.displacement[:, 0].tolist())
        again = self.client.run(case, frame[["opening", "skew"]], progress=False).sweep
        self.assertEqual(again.energy.tolist(), sweep.energy.tolist())

    def test_sweeps_of_nodal_forces(self):
        case = Case(GEOMETRY, [Load("one", 1)], COARSE)
        nodes = self.client.mesh_arrays(self.client.mesh(case))["nodes"]
        forces = numpy.vstack([numpy.ones(len(nodes)), nodes[:, 1]])
        sweep = self.client.run(case, nodal_forces=forces, progress=False).sweep
        self.assertAlmostEqual(sweep.energy[0], self.client.run(case, progress=False)["one"].energy_mesh, places=12)
        self.assertIsNone(sweep.coefficients)

    def test_sweeps_have_bounds_on_request(self):
        case = EXAMPLES / "load-ratio.toml"
        coefficients = numpy.array([[1.0, 0], [0, 1], [1, 1]])
        result = self.client.run(case, coefficients, traces=[1], bounds=True, progress=False)
        alone, sweep = self.client.run(case, progress=False), result.sweep
        for row, name in enumerate(("skew", "opening")):
            fibre = alone[name].inclusions["gamma_c"]
            numpy.testing.assert_allclose(
                [sweep.energy_lower[row], sweep.energy_upper[row], sweep.displacement_lower[row, 0],
                 sweep.displacement_upper[row, 0]],
                [alone[name].energy_lower, alone[name].energy_upper, fibre.A_lower, fibre.A_upper], rtol=1e-6)
        kept = result["row-1"]
        self.assertEqual((kept.energy_upper, kept.energy_mesh, kept.inclusions["gamma_c"].A_lower,
                          kept.inclusions["gamma_c"].A_mesh),
                         (sweep.energy_upper[1], sweep.energy_mesh[1], sweep.displacement_lower[1, 0],
                          sweep.displacement_mesh[1, 0]))
        numpy.testing.assert_array_equal(sweep.displacement, sweep.displacement_lower + 0.5 * (
            sweep.displacement_upper - sweep.displacement_lower))
        frame = sweep.frame()
        self.assertEqual(frame["energy_lower"].tolist(), sweep.energy_lower.tolist())
        self.assertTrue((frame["A_lower of gamma_c"] < frame["A of gamma_c"]).all())
        self.assertIsNone(self.client.run(case, coefficients, progress=False).sweep.energy_lower)

    def test_sweeps_have_tips_on_request(self):
        case = EXAMPLES / "load-ratio.toml"
        sweep = self.client.run(case, numpy.eye(2), tips=True, progress=False).sweep
        alone = self.client.run(case, progress=False)
        for row, name in enumerate(("skew", "opening")):
            for i, tip in enumerate(alone[name].tips):
                numpy.testing.assert_allclose(sweep.intensity[row, i], tip.intensity, rtol=1e-6)
                numpy.testing.assert_allclose(sweep.energy_release_rate[row, i], tip.G, rtol=1e-6)
        self.assertEqual(sweep.frame()["intensity of tip 1"].tolist(), sweep.intensity[:, 1].tolist())
        self.assertIsNone(self.client.run(case, numpy.eye(2), progress=False).sweep.intensity)
        with self.assertRaisesRegex(anticrack.CaseError, "tips are of a sweep"):
            self.client.run(case, tips=True)

    def test_sweeps_leave_out_the_accuracy(self):
        case = Case(GEOMETRY, [OPENING])
        plain = self.client.run(case, [[1.0]], progress=False)
        case.tables["accuracy"] = {"energy": 1e-6}
        with self.assertWarnsRegex(UserWarning, r"^\[accuracy\] is not used: .* bounds=True.* smaller mesh\.size"):
            result = self.client.run(case, [[1.0]], progress=False)
        self.assertEqual(result.mesh_name, plain.mesh_name)  # graded, not the coarse one of an accuracy
        self.assertIn("accuracy", case.tables)

    def test_wrong_sweeps_are_refused(self):
        case = EXAMPLES / "load-ratio.toml"
        for arguments, said in (({"coefficients": [[1.0]]}, r"\(1, 1\) is not \(rows, 2\)"),
                                ({"traces": [0]}, "traces"), ({"bounds": True}, "have bounds anyway"),
                                ({"coefficients": [[numpy.inf, 1]]}, "finite"),
                                ({"coefficients": [[1, 1], [1]]}, "not all of one length"),
                                ({"coefficients": "ratio.csv"}, "'ratio.csv' is no array; .*loads.*DataFrame.*csv"),
                                ({"coefficients": [[1, 1]], "traces": ["a"]}, "traces: .*write rows, as .0, 2."),
                                ({"coefficients": [[1, 1]], "nodal_forces": [[1]]}, "not both")):
            with self.assertRaisesRegex(anticrack.CaseError, said):
                self.client.submit(case, **arguments)

    def test_meshes_are_arrays_or_files(self):
        n = 8  # squares along a side; the middle of the line y = 0 is a crack
        x, y = (axis.ravel() for axis in numpy.meshgrid(*[numpy.linspace(-1, 1, n + 1)] * 2))
        corner = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
        triangles = numpy.vstack([numpy.column_stack([corner, corner + 1, corner + n + 2]),
                                  numpy.column_stack([corner, corner + n + 2, corner + n + 1])])
        first = n // 2 * (n + 1)
        lines = numpy.column_stack([first + numpy.arange(n), first + 1 + numpy.arange(n)])
        left, along = numpy.arange(n) * (n + 1), numpy.arange(n)
        rim = [(left, n + 1), (left + n, n + 1), (along, 1), (along + n * (n + 1), 1)]
        lines = numpy.vstack([lines, *(numpy.column_stack([first, first + step]) for first, step in rim)])
        names = ["glue", "glue", *["delaminated:fibre"] * (n - 4), "glue", "glue", *["dirichlet:left"] * n,
                 *["dirichlet"] * (3 * n)]
        where = ["top" if row >= n // 2 else "below" for row in numpy.tile(corner // (n + 1), 2)]
        msh = Msh(numpy.column_stack([x, y]), {"triangle": triangles, "line": lines},
                  {"triangle": where, "line": names})
        result = self.client.run(Case(loads=[Load("opening", {"top": 1, "below": -1})], mesh=Mesh(file=msh)),
                                 progress=False)
        self.assertEqual(sorted(result.mesh.subdomain_names), ["below", "top"])
        self.assertAlmostEqual(result["opening"].inclusions["fibre"].A / LIMIT, 1, delta=0.03)
        self.assertEqual([(part.name, part.free) for part in result["opening"].boundary],
                         [("left", 0), ("boundary", 0)])
        file = self.client.mesh(Case(mesh=Mesh(file=EXAMPLES / "plate.msh")))
        self.assertEqual(file.name, self.client.mesh(EXAMPLES / "plate.toml").name)

    def test_accuracy_in_stages(self):
        case = Case(GEOMETRY, [OPENING], accuracy=Accuracy(energy=0.02, A=0.05))
        job, out = self.client.submit(case), io.StringIO()
        result = job.wait(out=out).result()
        load = result["opening"]
        self.assertTrue(result.converged, result.not_reached)
        self.assertGreater(len(load.stages["triangles"]), 1)
        self.assertLessEqual(load.energy_upper - load.energy_lower, 0.02 * abs(load.energy))
        self.assertEqual(load.stages["triangles"][-1], len(result.mesh.triangles))
        self.assertEqual(load.stages["energy"][-1], load.energy)
        width = (load.energy_upper - load.energy_lower) / abs(load.energy)
        said = (f"stage {len(job.message.status.stages)}: {len(result.mesh.triangles)} triangles, "
                f"energy {100 * width:.3g} % (asked 2 %), "
                f"A {100 * load.stages['displacement_error'][-1]:.3g} % (asked 5 %)")
        self.assertIn(f"{job.name}: {said}, probably ", out.getvalue())
        self.assertEqual(out.getvalue().count("stage 1: "), 1)
        bar = Terminal()
        shown = Progress(job.message, bar)
        for message in job.events():
            shown.take(message)
        self.assertIn(said, bar.getvalue().split("\n")[-3])
        self.assertIn(f"\r{job.name} [####################] 1/1 load cases, done", bar.getvalue())
        unreached = self.client.run(Case(GEOMETRY, [OPENING], accuracy=Accuracy(A=1e-6, max_triangles=2000)),
                                    progress=False)
        self.assertFalse(unreached.converged)
        self.assertIn("max_triangles", unreached.not_reached)

    def test_progress_is_lines_or_a_bar(self):
        plain, bar = io.StringIO(), Terminal()
        job = self.client.submit(Case(GEOMETRY, [OPENING], COARSE)).wait(out=plain)
        self.assertRegex(plain.getvalue(), rf"(?m)^{job.name}: opening: converged after \d+ steps?$")
        self.assertTrue(plain.getvalue().endswith(f"{job.name}: done\n"))
        shown = Progress(job.message, bar)
        for message in job.events():
            shown.take(message)
        self.assertIn(f"\r{job.name} [####################] 1/1 load cases, done", bar.getvalue())
        self.assertEqual(bar.getvalue().count("\n"), 1)
        waits = solve_pb2.WatchJobResponse(phase={"state": solve_pb2.JobStatus.STATE_WAITING_FOR_MESH})
        self.assertEqual(State(job.message).take(waits), ["waiting for the mesh"])

    def test_progress_in_a_notebook_is_one_text_that_changes(self):
        ipython = unittest.mock.MagicMock()
        handle = ipython.display.display.return_value
        job = self.client.submit(Case(GEOMETRY, [OPENING], COARSE))
        with unittest.mock.patch.dict("sys.modules", IPython=ipython):
            job.wait()
        ((shown,), options) = handle.update.call_args
        self.assertRegex(shown["text/plain"], rf"^{job.name} \[#+\] 1/1 load cases, done$")
        self.assertTrue(options["raw"])

    def test_a_notebook_shows_a_curve_while_it_waits_where_an_event_loop_runs_and_tables_then(self):
        ipython = unittest.mock.MagicMock()
        title = "<script>alert(1)</script>"

        async def run_in_a_cell():
            job = self.client.submit(Case(GEOMETRY, [OPENING], COARSE, LONG, title=title))
            return job.wait()
        with unittest.mock.patch.dict("sys.modules", IPython=ipython):
            job = asyncio.run(run_in_a_cell())
        pages = [shown[0]["text/html"] for shown, _ in ipython.display.display.return_value.update.call_args_list]
        root = xml.etree.ElementTree.fromstring(pages[-1].partition("</pre>")[2])
        (line,) = root.iter("{http://www.w3.org/2000/svg}polyline")
        points = numpy.array([pair.split(",") for pair in line.get("points").split()], float)
        self.assertTrue((numpy.diff(points[:, 0]) >= 0).all() and len(points) > 10)
        self.assertGreater(points[-1, 1], points[0, 1], "the criterion falls")
        self.assertIn("criterion of opening", pages[-1])
        load = job.result()["opening"]
        for shown in (job, job.result(), load):
            page = shown._repr_html_()
            self.assertIn(f"{load.energy:.4g}"[:6], page)
            self.assertNotIn("<script", page)


class Connections(FolderTest):
    def test_certificates_and_tokens(self):
        made = self.folder / "made"
        self.assertEqual(run(DEPLOY / "make-certificates", made).returncode, 0)
        tokens = self.folder / "tokens"
        tokens.write_text(f"ann user {hashlib.sha256(b'secret').hexdigest()}\n", encoding="utf-8")
        (self.folder / "token").write_text("secret\n", encoding="utf-8")
        flags = ["--tls-certificate", made / "server.crt", "--tls-key", made / "server.key"]
        with Daemon(self.folder, *flags, "--tokens", tokens) as daemon:
            address = f"localhost:{daemon.port}"
            for credential in ({"token": "secret"}, {"token_file": self.folder / "token"}):
                with anticrack.connect(address, ca=made / "ca.crt", **credential) as client:
                    self.assertTrue(client.run(Case(GEOMETRY, [OPENING], COARSE), progress=False).converged)
            for arguments, code in (({"token": "wrong"}, "UNAUTHENTICATED"), ({}, "UNAUTHENTICATED")):
                with anticrack.connect(address, ca=made / "ca.crt", **arguments) as client:
                    with self.assertRaises(anticrack.ServerError) as caught:
                        client.info()
                    self.assertEqual(caught.exception.code, code)
            with anticrack.connect(address, first_contact=0.2) as client:
                with self.assertRaisesRegex(anticrack.ServerError, "cannot reach the server at .*TLS"):
                    client.info()

    def test_certificates_of_clients(self):
        made = self.folder / "made"
        self.assertEqual(run(DEPLOY / "make-certificates", made).returncode, 0)
        with Daemon(self.folder, "--tls-certificate", made / "server.crt", "--tls-key", made / "server.key",
                    "--tls-client-roots", made / "ca.crt") as daemon:
            own = {"cert": made / "client-trial.crt", "key": made / "client-trial.key"}
            with anticrack.connect(f"localhost:{daemon.port}", ca=made / "ca.crt", **own) as client:
                self.assertIn("uzawa", client.info().features)
            with anticrack.connect(f"localhost:{daemon.port}", ca=made / "ca.crt", first_contact=0.2) as client:
                with self.assertRaises(anticrack.ServerError):
                    client.info()

    def test_bad_credentials_go_nowhere(self):
        for arguments, said in (({"token": "a b"}, "token: "), ({"token": "a"}, "unencrypted"), ({"cert": "x"}, "key"),
                                ({"ca": self.folder / "none"}, "ca: .* cannot be read"),
                                ({"ca": EXAMPLES / "plate.msh"}, "ca: .* should contain -----BEGIN CERTIFICATE-----")):
            with self.assertRaisesRegex(anticrack.CaseError, said):
                anticrack.connect("solver.example.org:7433", **arguments)

    def test_nobody_there(self):
        with anticrack.connect(f"unix:{self.folder}/nobody", first_contact=0.2) as client:
            with self.assertRaisesRegex(anticrack.ServerError, "cannot reach the server at unix:.*nobody"):
                client.info()
        for call in (client.info, lambda: client.run(EXAMPLES / "slit.toml"), lambda: client.mesh_arrays("meshes/a")):
            with self.assertRaisesRegex(anticrack.Error, "this client is closed, .* connect another"):
                call()
        with self.assertRaisesRegex(anticrack.LocalServerError, "no anticrackd"):
            with anticrack.local(program="no-such-program"):
                pass
        with self.assertRaisesRegex(anticrack.LocalServerError, "(?s)before it was ready.*--no-such-flag"):
            with anticrack.local("--no-such-flag", program=ANTICRACKD):
                pass

    def test_a_watch_goes_on_after_a_crash(self):
        with Daemon(self.folder) as first, anticrack.connect(f"127.0.0.1:{first.port}") as client:
            job = client.submit(Case(GEOMETRY, [OPENING], COARSE, LONG))
            events, numbers = job.events(), []
            for message in events:
                numbers.append(message.sequence)
                if message.HasField("samples"):
                    break
            first.kill()
            with Daemon(self.folder, port=first.port), self.assertLogs("anticrack", "WARNING") as logged:
                for message in events:
                    if message.WhichOneof("event") not in ("snapshot", "heartbeat"):
                        numbers.append(message.sequence)
                    if message.HasField("samples") and job.refresh().message.status.attempt == 2 and not job.ended:
                        job.cancel()
                self.assertEqual((job.state, job.message.status.attempt), ("cancelled", 2))
        self.assertRegex(logged.output[0], rf"server 127.0.0.1:{first.port}: .*trying again for up to 300 s")
        self.assertEqual(numbers, sorted(numbers))
        self.assertEqual(len(numbers[1:]), len(set(numbers[1:])))
