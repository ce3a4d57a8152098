# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures: what they show, and what they ask for where it is missing."""
import copy
import os
import pathlib
import unittest
import warnings

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

import anticrack  # noqa: E402
from anticrack import draw  # noqa: E402
from anticrack.draw.along import edge_pressure  # noqa: E402
from anticrack.draw.plane import flux_peaks  # noqa: E402
from processes import ANTICRACKD  # noqa: E402

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
SAME = pathlib.Path(os.environ["SAME"])


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with anticrack.local(program=ANTICRACKD) as client:
            cls.several = client.run(EXAMPLES / "several-inclusions.toml", progress=False)
            cls.skew = client.run(EXAMPLES / "paper-2.toml", progress=False)
            cls.sweep = client.run(EXAMPLES / "load-ratio.toml", numpy.eye(2), bounds=True, progress=False)
            case = anticrack.Case.read(EXAMPLES / "load-ratio.toml")
            case.tables["accuracy"] = {"energy": 0.05}
            cls.accurate = client.run(case, progress=False)

    def setUp(self):
        warnings.simplefilter("error")
        self.addCleanup(warnings.resetwarnings)
        self.addCleanup(pyplot.close, "all")

    def test_membrane_is_a_surface_with_open_cracks(self):
        ax = draw.membrane(self.several, "opening")
        self.assertEqual({text.get_text() for text in ax.texts}, {"long", "short"})
        self.assertRegex(ax.get_title(), r"^opening: u amplified \u00d7[\d.]+$")
        factor = float(ax.get_title().rpartition("\u00d7")[2])
        fields = self.several["opening"].fields
        heights = numpy.concatenate([part.u for part in fields])
        self.assertAlmostEqual(numpy.ptp(ax.collections[0]._vec[2]), factor * numpy.ptp(heights))
        self.assertEqual(len(ax.collections[0]._facecolors), sum(len(part.triangles) for part in fields))
        self.assertLess(0.15, factor * numpy.ptp(heights) / 2)
        self.assertLessEqual(factor * numpy.ptp(heights) / 2, 0.3)
        ax.figure.canvas.draw()
        side_by_side = pyplot.subplots(subplot_kw={"projection": "3d"})[1]
        self.assertIs(draw.membrane(self.skew, ax=side_by_side), side_by_side)
        with self.assertRaisesRegex(anticrack.Error, "draw.displacement"):
            draw.membrane(self.skew, ax=pyplot.subplots()[1])
        flat = copy.deepcopy(self.skew)
        for part in flat["example-2"].fields:
            part.u[:] = 0
        self.assertEqual(draw.membrane(flat).get_title(), "example-2: u to scale")

    def test_names_of_many_inclusions_are_left_out(self):
        many = copy.deepcopy(self.several)
        many.mesh.inclusions += [f"i{i}" for i in range(30)]
        self.assertEqual([*draw.interfaces(many).texts, *draw.membrane(many, "opening").texts], [])

    def test_displacement(self):
        ax = draw.displacement(self.several, "opening")
        self.assertEqual({text.get_text() for text in ax.texts}, {"long", "short"})
        ax.figure.canvas.draw()
        for figure in (draw.membrane, draw.displacement, draw.plan):
            with self.assertRaisesRegex(anticrack.Error, "fields = true"):
                figure(self.several, self.without_fields()["a"])

    def without_fields(self):
        return {"a": anticrack.result.Load("a", "converged")}

    def test_traces_choose_the_most_eventful_interface(self):
        ax = draw.traces(self.several, "pulled")
        jumps = [numpy.abs(trace.jump).max() for trace in self.several["pulled"].traces]
        name = self.several.interfaces[int(numpy.argmax(jumps))].name
        self.assertTrue(ax.get_xlabel().startswith(f"arc length of {name} from ("), ax.get_xlabel())
        other = draw.traces(self.several, "pulled", "upper")
        upper = self.several.interfaces["upper"]
        self.assertEqual(other.get_xlabel(), f"arc length of upper from ({upper.x[0]:.4g}, {upper.y[0]:.4g})")
        with self.assertRaisesRegex(anticrack.Error, "no interface 'lower'; known are middle, upper"):
            draw.traces(self.several, "pulled", "lower")
        with self.assertRaisesRegex(anticrack.Error, "no load 'pushed'; did you mean pulled"):
            draw.traces(self.several, "pushed")
        ax.figure.canvas.draw()

    def test_traces_of_loads_on_one_panel_are_told_apart(self):
        ax = draw.traces(self.several, "pulled", "middle")
        names = [text.get_text() for text in ax.texts]
        bars = [patch.get_label() for patch in ax.patches if patch.get_alpha() is None]
        self.assertEqual(bars[:2], ["delaminated inclusion", "bonded inclusion"])
        draw.traces(self.several, "opening", "middle", ax)
        self.assertEqual((ax.get_title(), [text.get_text() for text in ax.texts]), ("", names))
        said = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertEqual(len(said), len(set(said)))
        for load in ("pulled", "opening"):
            self.assertLessEqual({f"{load}: $u^-$", f"{load}: $u^+$", f"{load}: $[u]$"}, set(said))
        shades = {patch.get_label(): patch.get_facecolor() for patch in ax.patches if "contact" in patch.get_label()}
        self.assertEqual(len(shades), len(set(shades.values())))
        self.assertIn("pulled: contact", shades)

    def test_shaded_contact_adds_up_to_its_length(self):
        skew, total = self.skew["example-2"], 0
        for line in self.skew.interfaces:
            for band in draw.traces(self.skew, skew, line.name).patches:
                if band.get_alpha() == 0.2:
                    total += numpy.ptp(band.get_path().vertices[:, 0])
        self.assertGreater(total, 0.1)
        self.assertAlmostEqual(total, skew.contact_length, delta=1e-9)

    def test_plan_cuts_off_the_peaks_of_the_flux(self):
        ax = draw.plan(self.several, "pulled")
        ax.figure.canvas.draw()
        self.assertLessEqual({"long", "short"}, {text.get_text() for text in ax.texts})
        bar = ax.figure.axes[1]
        self.assertIn("peaks cut off, up to", bar.get_ylabel())
        self.assertLess(bar.get_ylim()[1], max(size.max() for size in draw.flux(self.several, "pulled")) / 10)

    def test_peaks_of_the_flux_are_those_of_the_command(self):
        lines = [line.split() for line in (SAME / "flux.txt").read_text().splitlines() if not line.startswith("#")]
        nodes, triangles, drawn = (numpy.array([line[1:] for line in lines if line[0] == what], dtype=float)
                                   for what in ("node", "triangle", "drawn"))
        result = copy.copy(self.skew)
        result.mesh = copy.copy(result.mesh)
        result.mesh.nodes, result.mesh.tension, result.mesh.tension_law = nodes[:, :2], numpy.array([2.0]), []
        load = anticrack.result.Load("a", "converged")
        load.fields = [anticrack.result.Field("", numpy.arange(len(nodes)), triangles.astype(int), nodes[:, 2])]
        numpy.testing.assert_allclose(flux_peaks(result, load, draw.flux(result, load)), drawn[0], rtol=1e-9)

    def test_flux_has_the_tension_of_its_subdomain(self):
        result = copy.deepcopy(self.several)
        for part in result["pulled"].fields:
            part.u = result.mesh.nodes[part.nodes] @ (3.0, -4.0)
        for tension, size in zip(result.mesh.tension, draw.flux(result, "pulled")):
            numpy.testing.assert_allclose(size, 5 * tension, rtol=1e-3)  # the smallest triangles have edges of 1e-13
        self.assertGreater(len(set(result.mesh.tension)), 1)
        result.mesh.tension_law = ["", "1 + x^2"] + [""] * (len(result.mesh.tension) - 2)
        for size in draw.flux(result, "pulled"):  # |grad u|: T is not known
            numpy.testing.assert_allclose(size, 5, rtol=1e-3)
        self.assertTrue(draw.plan(result, "pulled").figure.axes[1].get_ylabel().startswith(r"$|\nabla u|$"))

    def test_the_side_that_came_off_is_the_minus_side(self):
        inclusion, *dots = draw.interfaces(self.skew, "example-2").lines
        self.assertEqual(inclusion.get_color(), "#E69F00")  # as in the command's figures
        self.assertEqual(len(dots), 1)
        self.assertLess(dots[0].get_ydata().max(), 0)  # its interface runs along y = 0, the plus side above

    def test_pressure_is_on_cracks_and_its_spikes_are_cut_off(self):
        ax = draw.pressure(self.several, "pulled")
        self.assertRegex(ax.get_ylabel(), r"cut off at the tips, up to \d")
        (line,) = ax.lines
        self.assertLess(ax.get_ylim()[1], numpy.nanmax(line.get_ydata()) / 1000)
        self.assertNotIn("cut off", draw.pressure(self.skew).get_ylabel())

    def test_pressure_is_what_the_command_draws(self):
        table = [line.split() for line in (SAME / "pressure.txt").read_text().splitlines() if not line.startswith("#")]
        s, kind, values, contact = numpy.array([line[1:] for line in table if line[0] == "node"], dtype=float).T
        drawn = numpy.array([line[1:] for line in table if line[0] == "drawn"], dtype=float).T
        self.assertGreater(drawn.shape[1], 5)
        line = anticrack.result.Interface("line", s, s, 0 * s, kind.astype(int), kind[:-1].astype(int), 0 * kind[:-1])
        trace = anticrack.result.Trace(0 * s, 0 * s, 0 * s, values, contact.astype(int))
        numpy.testing.assert_array_equal(edge_pressure(line, trace)[:3], drawn)

    def test_pressure_keeps_the_force(self):
        for load in self.several.loads.values():
            for line, trace in zip(self.several.interfaces, load.traces):
                edges = numpy.diff(line.s, prepend=line.s[0], append=line.s[-1])
                cracked = numpy.isin(line.kind, (anticrack.result.CRACK, anticrack.result.DELAMINATED))
                force = ((edges[:-1] + edges[1:]) / 2 * trace.pressure)[cracked].sum()
                _, means, lengths, _ = edge_pressure(line, trace)
                self.assertAlmostEqual(numpy.nansum(means * lengths), force, delta=1e-12 * max(1, abs(force)))

    def test_where_nothing_is_open_the_longest_contact_counts(self):
        closed = copy.deepcopy(self.several)
        load = closed["pulled"]
        for trace in load.traces:
            trace.jump[:] = 0
            trace.contact[:] = 0
        load.traces[1].contact[5] = 1
        self.assertIn(closed.interfaces[1].name, draw.traces(closed, "pulled").get_xlabel())

    def test_pressure_is_of_the_interface_in_contact(self):
        result = copy.deepcopy(self.several)
        load = result["pulled"]
        self.assertIn("of middle from", draw.traces(result, load).get_xlabel())
        for trace in load.traces:
            trace.contact[:] = 0
        self.assertEqual(draw.pressure(result, load).get_title(), "pulled: no contact")
        load.traces["upper"].contact[5:9] = load.traces["upper"].pressure[5:9] = 1
        self.assertIn("of upper from", draw.pressure(result, load).get_xlabel())
        self.assertIn("of middle from", draw.traces(result, load).get_xlabel())
        self.assertIn("of middle from", draw.pressure(result, load, interface="middle").get_xlabel())

    def test_lines_have_a_legend_and_axes_units(self):
        result = copy.deepcopy(self.several)
        result.units.length, result.units.force = "mm", "N"
        for ax in (draw.plan(result, "pulled"), draw.displacement(result, "pulled")):
            said = [text.get_text() for text in ax.get_legend().get_texts()]
            self.assertEqual(said, ["u given", "delaminated inclusion", "the side that came off", "bonded inclusion",
                                    "crack, [u] \u2265 0"])
            self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("x [mm]", "y [mm]"))
        self.assertEqual(draw.plan(result, "pulled").get_title(), "pulled: lines of u [mm]")
        ax = draw.membrane(result, "pulled")
        self.assertEqual((ax.get_xlabel(), ax.get_ylabel(), ax.figure.axes[1].get_ylabel()),
                         ("x [mm]", "y [mm]", "u [mm]"))

    def test_a_free_edge_has_no_traction(self):
        result = copy.deepcopy(self.several)
        self.assertIs(result.traction, False)
        result.mesh.boundary = result.mesh.boundary[:-3]
        for traction, name in ((False, "free"), (True, "free or traction"), (None, "free or traction")):
            result.traction = traction
            self.assertEqual(draw.interfaces(result).get_legend().get_texts()[1].get_text(), name)
        edges = draw.interfaces(result).collections[1].get_segments()
        self.assertEqual(len(edges), 3)

    def test_convergence_lies_over_others(self):
        ax = draw.convergence(self.skew)
        self.assertIs(draw.convergence(self.several, "opening", ax), ax)
        self.assertEqual(len(ax.lines), 4)
        self.assertTrue(ax.get_ylabel())
        few = draw.convergence(self.several, "pulled")  # one step
        self.assertTrue(all(tick == int(tick) for tick in few.get_xticks()))
        self.assertIn("example-2: relative change per iteration", ax.get_legend_handles_labels()[1])

    def test_error_band(self):
        ax = draw.error_band(self.accurate, "opening")
        band = ax.collections[0].get_paths()[0].vertices
        self.assertLess(band[:, 1].min(), self.accurate["opening"].energy)
        result = copy.deepcopy(self.accurate)
        stages = result["opening"].stages
        for first, last in ((2000, 60000), (5870, 7870), (6100, 6800), (9, 7e6)):
            stages["triangles"] = numpy.geomspace(first, last, len(stages["triangles"]))
            ax = draw.error_band(result, "opening")
            ax.figure.canvas.draw()
            low, high = ax.get_xlim()
            seen = [text.get_text() for text in ax.get_xticklabels() if low <= text.get_position()[0] <= high]
            self.assertGreaterEqual(len(list(filter(None, seen))), 2, (first, last))
        with self.assertRaisesRegex(anticrack.Error, "accuracy"):
            draw.error_band(self.skew)

    def test_sweep(self):
        (line,) = draw.sweep(self.sweep, "opening").lines
        self.assertEqual(line.get_xdata().tolist(), [0, 1])
        (line,) = draw.sweep(self.sweep, numpy.array([2.0, 1.0]), "gamma_c").lines
        self.assertEqual(line.get_ydata().tolist(), self.sweep.sweep.displacement[::-1, 0].tolist())
        (band,) = draw.sweep(self.sweep, "opening", ax=matplotlib.figure.Figure().subplots()).collections
        ends = band.get_paths()[0].vertices[:, 1]
        self.assertEqual((ends.min(), ends.max()), (self.sweep.sweep.displacement_lower.min(),
                                                    self.sweep.sweep.displacement_upper.max()))
        with self.assertRaisesRegex(anticrack.Error, "no load 'openin'; did you mean opening"):
            draw.sweep(self.sweep, "openin")
        with self.assertRaisesRegex(anticrack.Error, "not the result of a sweep"):
            draw.sweep(self.skew)

    def test_sweep_is_over_what_varies(self):
        result = copy.deepcopy(self.sweep)
        columns = result.sweep
        self.assertEqual(draw.sweep(result).get_xlabel(), "angle from skew to opening [\u00b0]")
        columns.coefficients = numpy.array([[1.0, 0], [1, 3]])
        columns.inclusions = [f"i{i}" for i in range(8)]
        for name in ("displacement", "displacement_lower", "displacement_upper"):
            setattr(columns, name, numpy.tile(getattr(columns, name), 8))
        ax = draw.sweep(result)
        self.assertEqual((ax.get_xlabel(), ax.lines[0].get_xdata().tolist()), ("coefficient of opening", [0, 3]))
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], [f"A of i{i}" for i in range(6)])
        self.assertEqual(ax.get_legend().get_title().get_text(), "and 2 more")
        self.assertEqual(len(draw.sweep(result, inclusion="i7").lines), 1)
        columns.coefficients = None
        ax = draw.sweep(result)
        self.assertEqual((ax.get_xlabel(), ax.lines[0].get_linestyle()), ("row", "None"))
        self.assertTrue((ax.get_xticks() % 1 == 0).all(), ax.get_xticks())
