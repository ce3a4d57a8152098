# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of `anticrack plot`: which are made, of what size, what is said of the others, and how they look."""
import copy
import os
import pathlib
import re
import struct
import sys
import unittest
import warnings

import matplotlib
import numpy
from matplotlib.image import imread
from matplotlib.testing.compare import compare_images

matplotlib.use("Agg")

import anticrack  # noqa: E402
from anticrack.draw import pictures  # noqa: E402
from anticrack.draw.files import Wanted, draw_figures, draw_together  # noqa: E402
from anticrack.draw.meshes import Plan  # noqa: E402
from anticrack.draw.sheet import Look, Sheet  # noqa: E402
from processes import ANTICRACKD, FolderTest, run  # noqa: E402

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
KEPT = pathlib.Path(__file__).parent / "kept"
FEW = Look(["png"], 50)


class Plots(FolderTest):
    @classmethod
    def setUpClass(cls):
        with anticrack.local(program=ANTICRACKD) as client:
            cls.several = client.run(EXAMPLES / "several-inclusions.toml", progress=False)
            cls.uzawa = client.run(EXAMPLES / "paper-2.toml", progress=False)
            case = anticrack.Case.read(EXAMPLES / "load-ratio.toml")
            cls.sweep = client.run(case, numpy.array([[1, x / 10] for x in range(-9, 10)]), bounds=True, traces=[3],
                                   progress=False)
            case.tables["accuracy"] = {"energy": 0.05}
            case.tables["output"] = {"fields": True}
            cls.accurate = client.run(case, progress=False)
            mesh = client.mesh(EXAMPLES / "several-inclusions.toml")
            cls.mesh = Plan(mesh, client.mesh_arrays(mesh), anticrack.result.Units("mm"), True)

    def setUp(self):
        super().setUp()
        warnings.simplefilter("error")
        self.addCleanup(warnings.resetwarnings)

    def names(self, result, look=FEW, **wanted):
        """The files without their ends, and what was said."""
        self.count = getattr(self, "count", 0) + 1
        drawn = draw_figures(result, str(self.folder / str(self.count)), Wanted(**wanted), look)
        self.assertEqual(sorted(drawn.files), sorted(map(str, (self.folder / str(self.count)).iterdir())))
        return [pathlib.Path(file).stem for file in drawn.files], drawn.notes

    def test_every_figure_of_every_load(self):
        result = copy.deepcopy(self.several)
        history = result["pulled"].history
        for name in history:
            history[name] = numpy.resize(history[name], 3)
        result["pulled"].stages = self.accurate["opening"].stages
        self.assertEqual(self.names(result)[0], [
            "opening", "opening-membrane", "opening-plan", "opening-traces", "opening-traces-2",
            "pulled", "pulled-membrane", "pulled-plan", "pulled-traces", "pulled-traces-2", "pulled-convergence",
            "pulled-accuracy"])
        self.assertEqual(self.names(result, only=["plan", "traces"], interface="upper", loads=["pulled"]),
                         (["pulled-plan", "pulled-traces-2"], []))

    def test_have_the_size_of_a_column_in_every_format(self):
        for look, width in ((Look(["pdf", "svg", "png"], 127), 85), (Look(["png", "svg", "pdf"], 254, width=60), 60)):
            folder = self.folder / str(width)
            drawn = draw_figures(self.accurate, str(folder), Wanted(only=["overview", "traces"]), look)
            self.assertEqual([pathlib.Path(file).suffix[1:] for file in drawn.files[:3]], look.formats)
            for name, columns in (("opening", 2), ("opening-traces", 1)):
                png = (folder / f"{name}.png").read_bytes()
                self.assertEqual(struct.unpack(">I", png[16:20])[0], columns * width * look.dpi // 25.4)
                head = (folder / f"{name}.svg").read_text(encoding="utf-8")[:1000]
                wide = re.search(r'<svg[^>]* width="([\d.]+)pt"', head)[1]
                self.assertAlmostEqual(float(wide), columns * width * 72 / 25.4, places=3)
                box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ", (folder / f"{name}.pdf").read_bytes())
                self.assertAlmostEqual(float(box[1]), columns * width * 72 / 25.4, places=3)

    def test_are_the_same_bytes_again(self):
        look = Look(["png", "svg", "pdf"], 50)
        with look.applied():
            first, again = (pictures.traces_picture(look, self.uzawa, self.uzawa["example-2"], 0) for _ in range(2))
        self.assertEqual(first, again)

    def test_without_titles_there_is_none(self):
        load = self.several["pulled"]
        for draw in (lambda look: pictures.overview_picture(look, self.several, load, 0, 0),
                     lambda look: pictures.traces_picture(look, self.several, load, 0),
                     lambda look: pictures.picture(pictures.draw_plan, look, self.several, load)):
            texts = {}
            for titles in (True, False):
                look = Look(["svg"], 50, titles)
                with look.applied():
                    svg = draw(look)["svg"].decode()
                texts[titles] = set(re.findall("<text[^>]*>([^<]*)</text>", svg))
            self.assertTrue(any("pulled" in text for text in texts[True]), texts)
            told = [text for text in texts[False] if re.search("pulled|fibres|amplified|lines of|A =", text)]
            self.assertEqual(told, [])

    def test_letters_are_of_the_font_that_is_asked_for(self):
        look = Look(["svg"], 50, font="DejaVu Serif")
        drawn = draw_figures(self.several, str(self.folder), Wanted(only=["plan"], loads=["opening"]), look)
        self.assertIn("DejaVu Serif", pathlib.Path(drawn.files[0]).read_text(encoding="utf-8"))
        with self.assertRaisesRegex(anticrack.Error, "there is no font DejaVu Serf; did you mean DejaVu Serif?"):
            draw_figures(self.several, str(self.folder), Wanted(), Look(font="DejaVu Serf"))

    def test_what_is_left_out_is_said(self):
        result = copy.deepcopy(self.several)
        del result["opening"].fields[:]
        pulled = result["pulled"]
        del pulled.traces[:], pulled.fields[:]
        pulled.status = "failed"
        result["opening"].stages = {name: values[:1] for name, values in self.accurate["opening"].stages.items()}
        made, notes = self.names(result)
        self.assertEqual(made, ["opening-traces", "opening-traces-2"])
        self.assertEqual(len(notes), 4)
        for note, said in zip(notes, ("no fields; to have them: anticrack job fetch jobs/", "fewer than two stages",
                                      r"no traces \(failed\): nothing to draw",
                                      "1 load was solved in one or two steps")):
            self.assertRegex(note, said)

    def test_glue_is_drawn_where_it_is_asked_for(self):
        result = copy.deepcopy(self.several)
        result.interfaces["upper"].edge_kind[:] = anticrack.result.GLUE
        made, notes = self.names(result, loads=["opening"], only=["traces"])
        self.assertEqual(made, ["opening-traces"])
        self.assertRegex(notes[0], "no traces drawn; --interface upper draws them")
        self.assertEqual(self.names(result, loads=["opening"], only=["traces"], interface="upper"),
                         (["opening-traces-2"], []))

    def test_of_many_the_first_or_the_most_eventful(self):
        result = copy.deepcopy(self.several)
        load = result["opening"]
        for i in range(2, 14):
            result.interfaces.append(copy.copy(result.interfaces[1]))
            result.interfaces[i].name = f"line-{i}"
            load.traces.append(copy.copy(load.traces[1]))
        load.traces[4].jump = 10 * load.traces[0].jump.max() + load.traces[4].jump
        load.traces[4].contact = 0 * load.traces[4].contact
        result.loads = anticrack.names.Named("load", [("opening", load)])
        made, notes = self.names(result, only=["overview", "traces"])
        self.assertEqual(len(made), 15)
        made, notes = self.names(result)
        self.assertIn("opening-traces-5", made)
        self.assertLessEqual(len(made), 5)
        self.assertRegex(notes[0], "of 14 interfaces that can open the most eventful is drawn; --all")
        result.loads = anticrack.names.Named("load", [(f"load-{i}", copy.copy(load)) for i in range(13)])
        for name, each in result.loads.items():
            each.name = name
        made, notes = self.names(result, only=["plan"])
        self.assertEqual((len(made), notes[0][:28]), (12, "the first 12 of 13 loads dra"))
        self.assertEqual([len(each) for each in self.names(result, only=["plan"], all=True)], [13, 0])
        drawn = draw_together(result, str(self.folder / "t"), Wanted(interface="line-3"), FEW)
        self.assertEqual([pathlib.Path(file).name for file in drawn.files], ["together.png"])
        self.assertEqual(drawn.notes, ["the first 8 of 13 loads drawn together; choose others with --load"])

    def test_what_is_not_there_is_refused_before_a_folder_is_made(self):
        for wanted, said in ((Wanted(interface="midle"), "no interface midle; did you mean middle?"),
                             (Wanted(loads=["openin"]), "no load openin; did you mean opening?")):
            for draw in (draw_figures, draw_together):
                with self.assertRaisesRegex(anticrack.Error, re.escape(said)):
                    draw(self.several, str(self.folder / "new"), wanted, FEW)
        with self.assertRaisesRegex(anticrack.Error, "it keeps traces of no row; run the sweep with --traces"):
            bare = copy.copy(self.sweep)
            bare.loads = anticrack.names.Named("load")
            draw_figures(bare, str(self.folder / "new"), Wanted(loads=["row-1"]), FEW)
        with self.assertRaisesRegex(anticrack.Error, "nothing to draw together"):
            draw_together(bare, str(self.folder / "new"), Wanted(), FEW)
        self.assertFalse((self.folder / "new").exists())

    def test_a_sweep(self):
        self.assertEqual(self.names(self.sweep), (["sweep", "sweep-contact", "row-3-traces"], []))
        self.assertEqual(self.names(self.sweep, loads=["row-3"]), (["row-3-traces"], []))
        result = copy.deepcopy(self.sweep)
        columns = result.sweep
        columns.slope = numpy.ones((len(columns.status), 1, 2))
        columns.coefficients = numpy.random.default_rng(1).random(columns.coefficients.shape)
        made, notes = self.names(result)
        self.assertEqual(made, ["sweep", "sweep-slope", "sweep-contact", "row-3-traces"])
        self.assertRegex(notes[0], "row by row, without bounds")
        columns.status[:] = 5
        self.assertEqual(self.names(result),
                         (["row-3-traces"], ["no row of the sweep converged: nothing to draw of it"]))

    def test_names_of_others_are_no_formulas_commands_or_paths(self):
        result = copy.deepcopy(self.several)
        bad = ["$\\frac{$", "../../<script>&\n!touch pwned\u202e", "`touch pwned`"]
        result.title = bad[1]
        for i, name in enumerate(bad[:2]):
            result.interfaces[i].name = result.mesh.info.interfaces[i].name = name
        result.mesh.info.inclusions[:] = bad[:2]
        load = result["opening"]
        load.inclusions = anticrack.names.Named("inclusion", zip(bad, load.inclusions.values()))
        result.loads = anticrack.names.Named("load", [(bad[0], load), (bad[1], copy.copy(load))])
        load.name, result.loads[bad[1]].name = bad[:2]
        made, _ = self.names(result, Look(["svg"], 50))
        self.assertIn("load__frac__", made)
        self.assertTrue(all(re.fullmatch("[A-Za-z0-9][A-Za-z0-9_.-]*", name) for name in made), made)
        svg = (self.folder / "1" / "load__frac__-traces.svg").read_text(encoding="utf-8")
        self.assertIn("$\\frac{$", svg)
        self.assertNotRegex(svg, "<script>|\u202e")

    def test_degenerate_answers(self):
        for value in (0.0, numpy.nan):
            result = copy.deepcopy(self.several)
            for load in result.loads.values():
                for part in load.fields:
                    part.u[:] = value
                for trace in load.traces:
                    trace.u_plus[:] = trace.u_minus[:] = trace.jump[:] = trace.pressure[:] = value
                for name in load.history:
                    load.history[name] = numpy.full(3, value)
                load.history["iteration"] = numpy.arange(3)
            self.assertEqual(len(self.names(result)[0]), 12)
            draw_together(result, str(self.folder / "t"), Wanted(), FEW)
        one = copy.deepcopy(self.several)
        one["pulled"].traces[1].contact[:] = 0
        one["pulled"].traces[1].contact[5] = 1
        self.assertIn("pulled-traces-2", self.names(one, loads=["pulled"])[0])
        triangle = copy.deepcopy(self.several)
        mesh, load = triangle.mesh, triangle["opening"]
        mesh.triangles, mesh.subdomain = numpy.array([(0, 1, 2)]), mesh.subdomain[:1]
        mesh.nodes = numpy.array([(0.0, 0), (1, 0), (0, 1)])
        mesh.boundary = numpy.array([(0, 1)])
        del load.fields[1:]
        load.fields[0].nodes, load.fields[0].triangles = numpy.arange(3), numpy.array([(0, 1, 2)])
        load.fields[0].u, load.fields[0].tension = numpy.array([0.0, 1, 2]), numpy.array([(1.0, 0, 1)])
        self.assertIn("opening-membrane", self.names(triangle, loads=["opening"])[0])

    def test_sheets_of_any_shape_size_and_place(self):
        for width, height, x, y in ((60, 10, 30, 5), (1e4, 1, 0, 0), (1, 50, 0.5, 25), (1, 1e4, 0, 0),
                                    (1e-9, 1e-9, 0, 0), (1e9, 1e-3, 5e8, 1e5), (1, 1, 5e5, -6e6),
                                    (1e-3, 1e-3, -1e6, 0)):
            result = copy.deepcopy(self.uzawa)
            result.units = anticrack.result.Units("mm", "N")
            size = numpy.array((width, height)) / 2
            result.mesh.nodes = result.mesh.nodes * size + (x, y)
            for line in result.interfaces:
                line.x, line.y, line.s = line.x * size[0] + x, line.y * size[1] + y, line.s * size[0]
            with self.subTest(width=width, height=height, x=x, y=y):
                self.assertEqual(len(self.names(result)[0]), 5)
                for file in (self.folder / str(self.count)).iterdir():
                    self.assertEqual(imread(file)[:, [0, -1]].min(), 1, f"{file.name}: a name is cut off at the edge")
                draw_together(result, str(self.folder / "t"), Wanted(), FEW)

    def test_together_a_load_has_one_colour_and_dash(self):
        seen, save = [], Sheet.files
        try:
            Sheet.files = lambda *given: seen.extend(given[0]._figure.axes) or save(*given)
            draw_together(self.several, str(self.folder), Wanted(interface="middle"), FEW)
        finally:
            Sheet.files = save
        self.assertEqual(len(seen), 4)
        looks = [[(line.get_color(), line.get_linestyle()) for line in ax.lines[:2]] for ax in seen]
        self.assertEqual(looks, looks[:1] * 4)
        self.assertNotEqual(*looks[0])
        for ax, trace_name in zip(seen, ("jump", "u_minus", "u_plus")):
            for line, load in zip(ax.lines, self.several.loads.values()):
                numpy.testing.assert_array_equal(line.get_ydata(), getattr(load.traces["middle"], trace_name))

    def test_look_as_they_did(self):
        """Against pictures that are kept, with room for other releases of matplotlib and its fonts. PICTURES=FOLDER
        keeps those of today there."""
        look = Look(["png"], 80)
        with look.applied():
            made = {"overview": pictures.overview_picture(look, self.several, self.several["pulled"], 0, 0),
                    "accuracy": pictures.picture(pictures.draw_accuracy, look, self.accurate, self.accurate["opening"]),
                    "convergence": pictures.picture(pictures.draw_convergence, look, self.uzawa,
                                                    self.uzawa["example-2"]),
                    "together": pictures.together_picture(look, self.several, list(self.several.loads.values()), 0),
                    "sweep": pictures.sweep_picture(look, self.sweep),
                    "contact": pictures.contact_picture(look, self.sweep, 0),
                    "mesh": pictures.mesh_picture(look, self.mesh)[0]}
        for name, content in made.items():
            file = pathlib.Path(os.environ.get("PICTURES", self.folder)) / f"{name}.png"
            file.write_bytes(content["png"])
            with self.subTest(picture=name):
                tolerance = 9 if name == "overview" else 3
                self.assertIsNone(compare_images(KEPT / f"{name}.png", file, tolerance))


class Command(FolderTest):
    def plot(self, *words, **options):
        return run(sys.executable, "-P", "-m", "anticrack", *words, cwd=self.folder, **options)

    def test_has_the_options_of_the_command(self):
        said = self.plot("plot", "--help").stdout
        of_python = set(re.findall("(?<![a-z])--[a-z-]+", said)) - {"--json", "--quiet", "--help"}
        told = run(os.environ["ANTICRACK"], "plot", "--help").stdout
        self.assertEqual(of_python, set(re.findall("  (?:-o,)?(--[a-z-]+)", told)) - {"--help"})

    def test_says_what_is_wrong_in_one_line(self):
        (self.folder / "no.h5").write_bytes(b"no")
        for words, said in ((("plot", "missing.h5"), "there is no file missing.h5; name a result file"),
                            (("plot", "no.h5"), "no.h5: cannot be read as a result file"),
                            (("plot", "no.h5", "--format", "gif"), '"gif" is none of png, svg and pdf; see'),
                            (("plot", "no.h5", "--dpi", "20"), "--dpi: 20 is no number from 50 to 1200; see"),
                            (("plot", "no.h5", "--limits", "2,1"), "--limits: 2,1 is not LOW,HIGH"),
                            (("plot", "no.h5", "--together", "--only", "plan"), "exclude each other")):
            ended = self.plot(*words)
            self.assertEqual((ended.returncode, ended.stdout), (2, ""), words)
            self.assertRegex(ended.stderr, f"^anticrack: .*{re.escape(said)}.*\n$")


if __name__ == "__main__":
    unittest.main()
