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
from processes import ANTICRACKD  # noqa: E402

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])


def width(patch):
    """Of a band, which is a polygon or, from matplotlib 3.9 on, a rectangle."""
    return numpy.ptp(patch.get_path().transformed(patch.get_patch_transform()).vertices[:, 0])


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
        (surface,) = [each for each in ax.collections if hasattr(each, "triangles")]
        self.assertAlmostEqual(numpy.ptp(surface.points[:, 2]), factor * numpy.ptp(heights))
        self.assertEqual(len(surface.triangles), sum(len(part.triangles) for part in fields))
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

    def test_membrane_is_seen_from_the_front(self):
        for turned in (1, -1):
            result = copy.deepcopy(self.skew)
            for line in result.interfaces:
                line.x = turned * line.x
            ax = draw.membrane(result)
            self.assertTrue(-180 < ax.azim < 0, "x to the right, as from above")
        self.assertGreater(ax.elev, draw.membrane(self.skew).elev, "over the near side into the crack")

    def test_a_plane_that_is_most_of_u_is_left_out(self):
        tilted = copy.deepcopy(self.skew)
        (a, b), lift = (30.0, -20.0), numpy.ptp(tilted["example-2"].fields[0].u)
        for part in tilted["example-2"].fields:
            part.u += tilted.mesh.nodes[part.nodes] @ (a, b)
        ax = draw.membrane(tilted)
        self.assertRegex(ax.get_title(), "u less a plane, amplified")
        (surface,) = [each for each in ax.collections if hasattr(each, "triangles")]
        self.assertGreater(numpy.ptp(surface.points[:, 2]), lift)
        self.assertLess(numpy.ptp(surface.points[:, 2]), 0.3)

    def test_colours_are_the_same_where_that_is_asked_for(self):
        for figure in (draw.membrane, draw.displacement):
            bar = figure(self.several, "opening", limits=(-3, 5)).figure.axes[1]
            low, high = (bar.get_xlim if bar.get_xlim() != (0, 1) else bar.get_ylim)()
            self.assertEqual((low, high), (-3, 5))
        self.assertEqual(draw.membrane(self.several, "opening", amplify=7).get_title(), "opening: u amplified \u00d77")

    def test_drawn_twice_there_is_one_colour_bar(self):
        for figure in (draw.membrane, draw.displacement, draw.plan):
            ax = figure(self.several, "opening")
            before = ax.figure.axes[1].get_xlim(), ax.figure.axes[1].get_ylim()
            ax.clear()
            figure(self.several, "pulled", ax=ax)
            self.assertEqual(len(ax.figure.axes), 2)
            self.assertNotEqual((ax.figure.axes[1].get_xlim(), ax.figure.axes[1].get_ylim()), before)
            self.assertEqual(len(figure(self.several, "pulled", colorbar=False).figure.axes), 1)

    def test_names_of_many_inclusions_are_left_out(self):
        many = copy.deepcopy(self.several)
        many.mesh.info.inclusions.extend(f"i{i}" for i in range(30))
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
        self.assertTrue(ax.get_title().startswith(f"pulled: {name}, A = "), ax.get_title())
        other = draw.traces(self.several, "pulled", "upper")
        upper = self.several.interfaces["upper"]
        self.assertEqual(other.get_xlabel(), f"arc length s from ({upper.x[0]:.4g}, {upper.y[0]:.4g})")
        self.assertEqual(draw.traces(self.several, "pulled", "middle").get_xlabel(), "x")
        with self.assertRaisesRegex(anticrack.Error, "no interface 'lower'; known are middle, upper"):
            draw.traces(self.several, "pulled", "lower")
        with self.assertRaisesRegex(anticrack.Error, "no load 'pushed'; did you mean pulled"):
            draw.traces(self.several, "pushed")
        ax.figure.canvas.draw()

    def test_traces_of_loads_on_one_panel_are_told_apart(self):
        ax = draw.traces(self.several, "pulled", "middle")
        names = [text.get_text() for text in ax.texts]
        said = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertEqual(said[-2:], ["delaminated inclusion", "bonded inclusion"])
        draw.traces(self.several, "opening", "middle", ax)
        self.assertEqual((ax.get_title(), [text.get_text() for text in ax.texts]), ("", names))
        said = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertEqual(len(said), len(set(said)))
        for load in ("pulled", "opening"):
            self.assertLessEqual({f"{load}: u\u207b", f"{load}: u\u207a", f"{load}: [u]"}, set(said))
        shades = {patch.get_label(): patch.get_facecolor() for patch in ax.patches if "contact" in patch.get_label()}
        self.assertEqual(len(shades), len(set(shades.values())))
        self.assertIn("pulled: contact", shades)

    def test_shaded_contact_adds_up_to_its_length(self):
        skew, total = self.skew["example-2"], 0
        for line in self.skew.interfaces:
            for band in draw.traces(self.skew, skew, line.name).patches:
                if band.get_alpha() == 0.2:
                    total += width(band)
        edge = max(numpy.diff(line.s).max() for line in self.skew.interfaces)
        self.assertGreater(total, 0.1)
        self.assertAlmostEqual(total, skew.contact_length, delta=2 * edge)  # bands end in the middles of edges

    def test_plan_cuts_off_the_peaks_of_the_flux(self):
        ax = draw.plan(self.several, "pulled")
        ax.figure.canvas.draw()
        self.assertLessEqual({"long", "short"}, {text.get_text() for text in ax.texts})
        bar = ax.figure.axes[1]
        self.assertEqual(bar.get_ylabel(), "|T \u2207u|")
        self.assertLess(bar.get_ylim()[1], max(size.max() for size in draw.flux(self.several, "pulled")) / 10)
        self.assertEqual(draw.plan(self.several, "pulled", limits=(0, 9)).figure.axes[1].get_ylim(), (0, 9))

    def test_flux_has_the_tension_of_its_subdomain(self):
        result = copy.deepcopy(self.several)
        for part in result["pulled"].fields:
            part.u = result.mesh.nodes[part.nodes] @ (3.0, -4.0)
        for tension, size in zip(result.mesh.tension, draw.flux(result, "pulled")):
            numpy.testing.assert_allclose(size, 5 * tension, rtol=1e-2)  # the smallest triangles have edges of 1e-13
        self.assertGreater(len(set(result.mesh.tension)), 1)
        for part in result["pulled"].fields:
            part.tension[:] = (2, 1, 3)
        for size in draw.flux(result, "pulled"):
            numpy.testing.assert_allclose(size, numpy.hypot(2 * 3 - 4, 3 - 3 * 4), rtol=1e-2)

    def test_the_side_that_came_off_is_the_minus_side(self):
        lines = {line.get_color(): line for line in draw.interfaces(self.skew, "example-2").lines}
        self.assertLess(lines["#D00000"].get_ydata().max(), 0)  # its interface runs along y = 0, the plus side above
        self.assertEqual(numpy.abs(lines["#E69F00"].get_ydata()).max(), 0)

    def test_pressure_is_on_cracks_and_its_spikes_are_cut_off(self):
        ax = draw.pressure(self.several, "pulled")
        self.assertEqual([text.get_text() for text in ax.texts], ["peaks at the tips are cut off"])
        (line,) = ax.lines
        self.assertLess(ax.get_ylim()[1], numpy.nanmax(line.get_ydata()) / 1000)
        self.assertEqual(list(draw.pressure(self.skew).texts), [])

    def test_pressure_is_drawn_in_contact_and_nowhere_else(self):
        ax = draw.pressure(self.skew)
        bands = [width(patch) for patch in ax.patches]
        drawn = ax.lines[0].get_xdata()[numpy.isfinite(ax.lines[0].get_ydata())]
        self.assertAlmostEqual(sum(bands), numpy.ptp(drawn), delta=0.05)
        self.assertLess(numpy.ptp(ax.get_xlim()), 2 * sum(bands), "the axis is of the contact")
        whole = draw.pressure(self.skew, whole=True)
        self.assertEqual(whole.get_xlim(), (-1, 1))

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
        self.assertIn(closed.interfaces[1].name, draw.traces(closed, "pulled").get_title())

    def test_pressure_is_of_the_interface_in_contact(self):
        result = copy.deepcopy(self.several)
        load = result["pulled"]
        self.assertIn(": middle", draw.traces(result, load).get_title())
        for trace in load.traces:
            trace.contact[:] = 0
        self.assertEqual(draw.pressure(result, load).get_title(), "pulled: no contact")
        cracked = numpy.flatnonzero(result.interfaces["upper"].kind == anticrack.result.CRACK)[:4]
        load.traces["upper"].contact[cracked] = load.traces["upper"].pressure[cracked] = 1
        self.assertIn("on upper", draw.pressure(result, load).get_title())
        self.assertIn(": middle", draw.traces(result, load).get_title())
        self.assertEqual(draw.pressure(result, load, interface="middle").get_title(), "pulled: no contact")

    def test_lines_have_a_legend_and_axes_units(self):
        result = copy.deepcopy(self.several)
        result.units.length, result.units.force = "mm", "N"
        for ax in (draw.plan(result, "pulled"), draw.displacement(result, "pulled")):
            said = [text.get_text() for text in ax.get_legend().get_texts()]
            self.assertEqual(said, ["u = const", "u given", "glue, u\u207a = u\u207b", "bonded inclusion",
                                    "delaminated inclusion", "the side that came off", "crack, [u] \u2265 0", "s = 0"])
            self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("x [mm]", "y [mm]"))
        self.assertEqual(draw.plan(result, "pulled").get_title(), "pulled: lines of u")
        ax = draw.membrane(result, "pulled")
        self.assertEqual((ax.get_xlabel(), ax.get_ylabel(), ax.figure.axes[1].get_xlabel()),
                         ("x [mm]", "y [mm]", "u [mm]"))

    def test_a_free_edge_has_no_traction(self):
        result = copy.deepcopy(self.several)
        self.assertIs(result.traction, False)
        result.mesh.boundary = result.mesh.boundary[:-3]
        for traction, name in ((False, "free"), (True, "free or traction"), (None, "free or traction")):
            result.traction = traction
            self.assertEqual(draw.interfaces(result).get_legend().get_texts()[1].get_text(), name)
        chains = draw.interfaces(result).collections[1].get_segments()
        self.assertEqual(sum(len(chain) - 1 for chain in chains), 3)

    def test_convergence_of_either_method(self):
        ax = draw.convergence(self.skew)  # Algorithm 2
        self.assertEqual(len(ax.lines), 2)
        self.assertEqual(ax.lines[1].get_ydata()[0], self.skew["example-2"].solver.uzawa.epsilon)
        few = draw.convergence(self.several, "pulled")  # one step of the active set
        self.assertTrue(all(tick == int(tick) for tick in few.get_xticks()))
        self.assertEqual([label.partition(":")[0] for label in few.get_legend_handles_labels()[1]],
                         ["gap", "sign", "complementarity"])
        self.assertIs(draw.convergence(self.skew, ax=few), few)
        self.assertIn("example-2: of u in the energy norm, squared", few.get_legend_handles_labels()[1])

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
        for figure in (draw.error_band, draw.errors):
            with self.assertRaisesRegex(anticrack.Error, "accuracy"):
                figure(self.skew)
        widths = draw.errors(self.accurate, "opening").lines[1].get_ydata()
        stages = self.accurate["opening"].stages
        numpy.testing.assert_allclose(widths, (stages["energy_upper"] - stages["energy_lower"]) / -stages["energy"])

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
        for values, said in (([1.0], r"x: an array of shape \(1,\) is not \(2,\)"), ([1, numpy.nan], "x: nan at"),
                             (numpy.ma.masked_array([1, 2], [True, False]), "x: 1 of 2 entries are masked")):
            with self.assertRaisesRegex(anticrack.Error, said):
                draw.sweep(self.sweep, values)
        (line,) = draw.sweep(self.sweep, numpy.int64(1)).lines
        self.assertEqual(line.get_xdata().tolist(), [0, 1])
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
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()],
                         [f"i{i}" for i in range(6)] + ["2 more"])
        self.assertEqual(len(draw.sweep(result, inclusion="i7").lines), 1)
        columns.coefficients = None
        ax = draw.sweep(result)
        self.assertEqual((ax.get_xlabel(), ax.lines[0].get_linestyle()), ("row", "None"))
        self.assertTrue((ax.get_xticks() % 1 == 0).all(), ax.get_xticks())

    def test_map_of_contact_is_that_of_the_rows(self):
        columns = self.sweep.sweep
        ax = draw.contact_map(self.sweep, 0)
        values = ax.collections[0].get_array().reshape(2, -1)
        order = numpy.argsort(draw.sweeps.Rows(columns).at)
        for row, shades in zip(columns.contact[order], values):
            self.assertEqual(numpy.nansum(shades), row.sum())


FIBRE = "points = [[-0.5, 0], [0.5, 0]]"


def odd_case(width=2.0, height=2.0, x=0.0, y=0.0, load="y > 0 ? 1 : -1", size=0.4, inclusion=FIBRE, more=""):
    """A fibre on a sheet with this middle; the load is that of coordinates from the middle, in halves of the sheet."""
    half, high = width / 2, height / 2
    place = f"(x - ({x})) / {half}", f"(y - ({y})) / {high}"
    for name, text in zip("xy", place):
        load = load.replace(name, f"({text})") if name == "x" else load.replace("y", f"({text})", 1)
    corners = [[x - half, y - high], [x + half, y - high], [x + half, y + high], [x - half, y + high]]
    tables = {"geometry": {"boundary": corners}, "output": {"fields": True},
              "mesh": {"preset": "uniform", "size": size * min(half, 16 * high)}, "load": [{"name": "a", "f": load}]}
    case = anticrack.Case.parse(more)
    case.tables.update(tables)
    if inclusion:
        points = [[x - half / 2, y], [x + half / 2, y]] if width >= height else [[x, y - high / 2], [x, y + high / 2]]
        case.tables["geometry"]["inclusion"] = [{"name": "fibre", "points": points}]
    return case


class OddResults(unittest.TestCase):
    """Each is drawn without a warning and with labels that can be told apart."""
    SHEETS = {
        "plain": {}, "long": {"width": 100, "height": 10}, "longer": {"width": 1000, "height": 1},
        "tall": {"width": 1, "height": 50}, "small": {"width": 1e-9, "height": 1e-9},
        "large": {"width": 1e9, "height": 1e9}, "of a map": {"width": 100, "height": 100, "x": 6000050, "y": 50},
        "far below": {"width": 10, "height": 5, "x": -2e5, "y": -3e5}, "without anything": {"inclusion": ""},
        "without a load": {"load": "0 * x"}, "of few triangles": {"size": 2.0}, "hardly loaded": {"load": "1e-30 * x"},
        "loaded beyond all": {"load": "1e30 * x"}, "pressed": {"load": "y > 0 ? -1 : 1"},
    }

    @classmethod
    def setUpClass(cls):
        cls.results = {}
        with anticrack.local(program=ANTICRACKD) as client:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of u that is not small
                for name, sheet in cls.SHEETS.items():
                    cls.results[name] = client.run(odd_case(**sheet), progress=False)
                lifted = odd_case()
                lifted.tables["load"][0]["boundary_value"] = 1e6
                cls.results["lifted"] = client.run(lifted, progress=False)

    def setUp(self):
        warnings.simplefilter("error")
        self.addCleanup(warnings.resetwarnings)
        self.addCleanup(pyplot.close, "all")

    def labels_are_apart(self, ax):
        ax.figure.canvas.draw()
        for axis, side in ((ax.xaxis, 0), (ax.yaxis, 1)):
            low, high = sorted(axis.get_view_interval())
            boxes = [label.get_window_extent() for label in axis.get_ticklabels()
                     if low <= label.get_position()[side] <= high and label.get_text()]
            self.assertGreater(len(boxes), 0)
            ends = sorted((box.x0, box.x1) if side == 0 else (box.y0, box.y1) for box in boxes)
            for (_, end), (begin, _) in zip(ends, ends[1:]):
                self.assertLess(end, begin)

    def test_are_drawn(self):
        for name, result in self.results.items():
            for figure in (draw.membrane, draw.displacement, draw.plan, draw.interfaces, draw.traces, draw.pressure,
                           draw.convergence):
                if name == "without anything" and figure in (draw.traces, draw.pressure):
                    continue
                with self.subTest(sheet=name, figure=figure.__name__):
                    ax = figure(result)
                    if ax.name == "3d":
                        ax.figure.canvas.draw()
                    else:
                        self.labels_are_apart(ax)
                    said = [text.get_text() for text in ax.figure.findobj(matplotlib.text.Text)]
                    self.assertFalse([text for text in said if "nan" in text or "e+" in text or text == "-0"], said)
                    pyplot.close(ax.figure)

    def test_places_far_away_leave_an_offset_out(self):
        for figure in (draw.membrane, draw.displacement, draw.plan, draw.interfaces):
            ax = figure(self.results["of a map"])
            self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("x \u2212 6000000", "y"))
            self.assertEqual(ax.xaxis.get_major_formatter()(6000040, 0), "40")
            ax = figure(self.results["far below"])
            self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("x + 200000", "y + 300000"))
        self.assertEqual(draw.traces(self.results["of a map"]).get_xlabel(), "x \u2212 6000000")
        result = copy.copy(self.results["small"])
        result.units = anticrack.result.Units("m", "N")
        ax = draw.interfaces(result)
        self.assertEqual(ax.get_xlabel(), "x [10\u207b\u00b9\u00b2 m]")
        self.assertEqual(ax.xaxis.get_major_formatter()(-2e-10, 0), "\u2212200")
        self.assertEqual(ax.xaxis.get_major_formatter()(-1e-26, 0), "0")

    def test_long_sheets_are_drawn_wider(self):
        for name, axis in (("long", "y"), ("longer", "y"), ("tall", "x")):
            ax = draw.plan(self.results[name])
            ax.figure.canvas.draw()
            box = ax.get_window_extent()
            self.assertLess(max(box.width / box.height, box.height / box.width), 8.5, name)
            self.assertRegex(getattr(ax, f"get_{axis}label")(), axis + r", stretched \u00d7[\d.]+")
        for name in ("plain", "of a map"):
            self.assertNotIn("stretched", draw.plan(self.results[name]).get_ylabel())

    def test_factors_are_for_people(self):
        for name, said in (("small", "\u00d7"), ("hardly loaded", "\u00d710"), ("loaded beyond all", "\u00d710"),
                           ("without a load", "to scale")):
            self.assertIn(said, draw.membrane(self.results[name]).get_title())

    def test_curves_of_a_lifted_sheet_are_told_apart(self):
        ax = draw.traces(self.results["lifted"])
        said = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertEqual(said[:3], ["a: u\u207b \u2212 1000000", "a: u\u207a \u2212 1000000", "a: [u]"])
        low, high = ax.get_ylim()
        self.assertLess(high - low, 2)

    def test_what_is_not_there_is_said(self):
        for figure in (draw.traces, draw.pressure):
            with self.assertRaisesRegex(anticrack.Error, "the sheet has no interface"):
                figure(self.results["without anything"])
            with self.assertRaisesRegex(anticrack.Error, "a has no traces: it is failed"):
                figure(self.results["plain"], anticrack.result.Load("a", "failed"))
        with self.assertRaisesRegex(anticrack.Error, "a has no history"):
            draw.convergence(self.results["plain"], anticrack.result.Load("a", "converged"))
        empty = copy.copy(self.results["plain"])
        empty.loads = anticrack.names.Named("load")
        with self.assertRaisesRegex(anticrack.Error, "there is no load to draw"):
            draw.traces(empty)

    def test_residuals_of_0_have_a_place(self):
        result = copy.deepcopy(self.results["plain"])
        result["a"].history.update(iteration=numpy.arange(1, 4), criterion=numpy.array([1.0, 1e-8, 0]), **{
            f"kkt_{name}": numpy.array([1e-3, 0, 0]) for name in anticrack.result.KKT})
        ax = draw.convergence(result)
        ax.figure.canvas.draw()
        self.assertEqual([text.get_text() for text in ax.get_yticklabels()][0], "0")
        self.assertLess(ax.get_ylim()[0], 0)

    def test_numbers_of_numpy_choose_interfaces(self):
        result = self.results["plain"]
        self.assertEqual(draw.traces(result, "a", numpy.int64(0)).get_title(),
                         draw.traces(result, "a", "fibre").get_title())
        with self.assertRaisesRegex(anticrack.Error, "there is no interface 1; there is 1 interface"):
            draw.traces(result, "a", 1)

    def test_no_zero_has_a_sign(self):
        self.assertEqual(anticrack.text.interval(0, -1e-3, 1e-3, -1e-17), "0.0000 +- 0.0010 (0.0000 on the mesh)")
        self.assertNotIn("-0.0000 ", repr(self.results["pressed"]))
