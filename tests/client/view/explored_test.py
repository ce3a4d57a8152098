# SPDX-License-Identifier: GPL-3.0-or-later
"""What one does on the page of `anticrack view`: stages, sweeps, growth, studies, jobs, files to take along."""
import io
import json
import os
import pathlib
import time

import h5py
import numpy as np
from PIL import Image
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import anticrack
from anticrack import vtk
from anticrack.view import scene
from anticrack.draw import files, studies
from anticrack.draw.sheet import Look
from browser import InChromium, viewing
from cases import GROWTH
from processes import ANTICRACK, ANTICRACKD, DEBIAN_12, Daemon, FolderTest, run

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
SLOW = """
[geometry]
boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
interface = [[-1, 0], [1, 0]]
[[geometry.inclusion]]
name = "c"
from = [-0.5, 0]
to = [0.5, 0]
delaminated = true
[solver]
method = "uzawa"
epsilon = 1e-300
theta = 1e-6
max_iterations = 1000000
[[load]]
name = "up"
f = "y > 0 ? -1 : 1"
"""
SLIT = """
[geometry]
boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
[[geometry.crack]]
name = "slit"
points = [[-0.5, 0], [0.5, 0]]
[mesh]
preset = "uniform"
size = 0.2
[output]
fields = true
bounds = false
[[load]]
name = "up"
f = "y > 0 ? 1 : -1"
"""
PICTURE = "return document.getElementById('scene').dataset.frames > 0 && !document.getElementById('stage').hidden"
ROW = "return new URLSearchParams(location.hash.slice(1)).get('row')"


def blurred(picture):
    """The means of squares of some 20 pixels, in which times of day, names of jobs and edges of letters vanish."""
    with Image.open(picture) as image:
        image = image.convert("RGB")
        return np.asarray(image.resize((image.width // 20, image.height // 20), Image.Resampling.BOX), float)


def in_file(path):
    """All that a result file says but what only one who ran the case knows, and the meanings that the command adds."""
    found = {}

    def look(name, item):
        found.update({f"{name}@{key}": repr(value) for key, value in item.attrs.items()
                      if (name, key) not in (("", "case"), ("", "total_seconds")) and key != "meaning"})
        if hasattr(item, "shape"):
            found[name] = item.dtype, repr(item[()].tolist())
            return
        for key in item:  # visititems leaves out the second name of an empty list
            look(f"{name}/{key}", item[key])
    with h5py.File(path) as file:
        look("", file)
    return found


class Explored(InChromium):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = FolderTest("__init__")
        folder.setUp()
        cls.addClassCleanup(folder.doCleanups)
        cls.server = Daemon(folder.folder)
        cls.enterClassContext(cls.server)
        cls.client = cls.enterClassContext(anticrack.connect(f"127.0.0.1:{cls.server.port}"))
        _, address = cls.enterClassContext(viewing("--server", f"127.0.0.1:{cls.server.port}"))
        cls.browser.get(address)

    def tearDown(self):
        self.require_clean()

    def solved(self, case):
        return self.client.run(case, progress=False)

    def pixel(self, x, y):
        """The offset from the middle of the chart of a place in its coordinates."""
        return self.script("const {scales: {x, y}, width, height} = Chart.getChart(document.querySelector('#panel "
                           "canvas')); return [x.getPixelForValue(arguments[0]) - width / 2, "
                           "y.getPixelForValue(arguments[1]) - height / 2]", x, y)

    def click_chart(self, x, y):
        for left in reversed(range(5)):
            canvas = self.browser.find_element(By.CSS_SELECTOR, "#panel canvas")
            try:
                self.script("arguments[0].scrollIntoView({block: 'center'})", canvas)
                at = map(round, self.pixel(x, y))
                ActionChains(self.browser).move_to_element_with_offset(canvas, *at).click().perform()
                return
            except StaleElementReferenceException:  # it was drawn anew
                self.assertTrue(left)

    def test_stages_are_stepped_through(self):
        job = self.client.submit(EXAMPLES / "opening.toml")
        job.wait(False)
        stages = job.message.status.stages
        self.assertGreater(len(stages), 1)
        self.go(f"of={job.name}", PICTURE)
        self.until("return document.querySelector('[aria-label=\"stage before\"]')")
        self.click("[aria-label='stage before']")
        told = self.until("return document.getElementById('stage-numbers')?.textContent")
        before = stages[-2]
        self.assertIn(f"{len(stages) - 1} of {len(stages)}, {before.triangles} triangles", told)
        own = self.later(f"fetch('/api/array?mesh={before.mesh}&what=triangles').then(a => a.arrayBuffer())"
                         ".then(b => b.byteLength)")
        self.assertEqual(own, 3 * 4 * before.triangles)
        self.click("[aria-label='next stage']")
        self.until("return !document.getElementById('stage-numbers')")

    def test_a_sweep_is_started_from_the_page_with_numbers_as_germans_write_them(self):
        case = anticrack.Case.read(EXAMPLES / "load-ratio.toml")
        rows = np.array([[1, -0.5], [1, 0.5], [0.25, 1]])
        self.go("tab=case", "return document.querySelector('[aria-label=case]')")
        lines = ["; ".join(f"{value:g}".replace(".", ",") for value in row) for row in rows]
        self.script("document.querySelector('[aria-label=case]').value = arguments[0];"
                    "document.querySelector('.sweep').open = true;"
                    "document.querySelector('[aria-label=\"rows of the sweep\"]').value = arguments[1]",
                    case.text, "\n".join(["skew; opening", *lines]))
        self.button("Run sweep")
        self.until("return document.getElementById('tab-sweep')?.ariaSelected === 'true' && "
                   "document.querySelector('#panel canvas') && document.querySelector('table.row')")
        sweep = self.client.run(case, coefficients=rows, progress=False).sweep
        self.script("location.hash += '&up=A+of+gamma_c&across=opening'")
        time.sleep(0.3)
        for row in (2, 0):
            self.click_chart(rows[row, 1], sweep.displacement[row, 0])
            self.until(f"{ROW} === '{row}'")
            shown = self.until("return [...document.querySelectorAll('table.row tr')].map(row => "
                               "row.children[0].textContent + '=' + row.children[1].textContent)")
            told = dict(line.replace("\u2212", "-").split("=") for line in shown)
            self.assertAlmostEqual(float(told["A of gamma_c"]), sweep.displacement[row, 0], delta=1e-6)
            self.assertEqual(float(told["opening"]), rows[row, 1])
        self.button("Show row 0 on the interfaces")
        self.until("return document.getElementById('tab-interfaces').ariaSelected === 'true' && "
                   "document.getElementById('numbers').innerText.startsWith('row-0')")

    def test_a_job_that_is_taken_along_is_what_the_command_fetches(self):
        jobs = [self.client.submit(EXAMPLES / "opening.toml"), self.client.submit(anticrack.Case.parse(GROWTH)),
                self.client.submit(EXAMPLES / "load-ratio.toml", coefficients=[[1, -0.5], [1, 0.5]], traces=[1])]
        for job in jobs:
            job.wait(False)
            got = bytes(self.later(f"fetch('/api/export?kind=h5&of={job.name}').then(a => a.arrayBuffer())"
                                   ".then(b => [...new Uint8Array(b)])"))
            path = self.folder / f"{job.name[5:]}.h5"
            ended = run(ANTICRACK, "job", "fetch", job.name, "-o", path, "--server", f"127.0.0.1:{self.server.port}")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertEqual(*map(in_file, (io.BytesIO(got), path)))

    def test_growth_steps_through_fronts(self):
        result = self.solved(anticrack.Case.parse(GROWTH))
        growth = next(iter(result.loads.values())).growth
        self.go(f"of={result.job}&tab=growth&plan=1&up=G1", PICTURE)
        self.until("return document.querySelector('#panel canvas') && document.querySelector('table.row')")
        row = len(growth["x"]) // 2
        self.click_chart(growth["position"][row], growth["G1"][row])
        self.until(f"{ROW} === '{row}'")
        where = self.script("return document.querySelector('[aria-label=step]').value")
        self.assertEqual(int(where), row)
        scene = self.browser.find_element(By.ID, "scene")  # the middle, where the path ends
        ActionChains(self.browser).click(scene).perform()
        last = int(np.argmin(np.hypot(growth["x"], growth["y"])))
        self.until(f"{ROW} === '{last}'")

    def test_a_click_on_the_membrane_tells_what_is_there(self):
        result = self.solved(EXAMPLES / "opening.toml")
        part = next(iter(result.loads.values())).fields[0]
        self.go(f"of={result.job}&plan=1", PICTURE)
        self.until("return document.querySelector('#bar i')")
        scene = self.browser.find_element(By.ID, "scene")
        ActionChains(self.browser).move_to_element_with_offset(scene, 7, -90).click().perform()
        told = self.until("return document.getElementById('hit')?.innerText.includes('nodes') && "
                          "document.getElementById('hit').innerText").replace("\u2212", "-")
        words = told.replace("\n", " ").split()
        x, y, u = (float(words[words.index(name) + 1]) for name in ("x", "y", "u"))
        corners = [int(word.strip(",")) for word in words[words.index("nodes") + 1:words.index("nodes") + 4]]
        at = np.column_stack((result.mesh.nodes[corners], np.ones(3)))
        weights = np.linalg.solve(at.T, (x, y, 1))
        self.assertTrue((weights > -1e-5).all(), "the place lies in its triangle")
        values = dict(zip(part.nodes.tolist(), part.u.tolist()))
        self.assertAlmostEqual(u, weights @ [values[node] for node in corners], delta=1e-5)

    def test_a_job_is_cancelled_submitted_again_and_deleted(self):
        job = self.client.submit(anticrack.Case.parse(SLOW))
        self.go(f"of={job.name}&tab=convergence", "return document.querySelector('.timeline li')")
        self.until("return document.querySelector('#panel canvas')?.clientHeight > 0")  # residuals, as they come
        self.button("Cancel", "#jobs .here")
        self.until("return document.querySelector('.here .state.cancelled')")
        self.assertEqual(self.client.job(job.name).state, "cancelled")
        self.button("Submit again", "#jobs .here")
        self.until(f"return new URLSearchParams(location.hash.slice(1)).get('of') !== '{job.name}'")
        again = self.fragment()["of"]
        self.button("Cancel", "#jobs .here")
        self.until("return document.querySelector('.here .state.cancelled')")
        for answer, left in (("dismiss", True), ("accept", False)):
            self.click(f"[data-key='{again}Delete\u2026']")
            asked = self.browser.switch_to.alert
            self.assertIn(again, asked.text)
            getattr(asked, answer)()
            time.sleep(0.5)
            self.assertEqual(again in [each.name for each in self.client.jobs()], left)
        self.until("return document.getElementById('notices').textContent.includes('has been deleted')")

    def test_everything_is_reached_by_the_keyboard(self):
        result = self.solved(EXAMPLES / "opening.toml")
        self.go(f"of={result.job}&tab=membrane", PICTURE)
        self.until("return document.querySelector('#bar i')")
        before = self.script("return document.getElementById('scene').dataset.frames")
        self.script("document.getElementById('scene').focus()")
        ActionChains(self.browser).send_keys(Keys.ARROW_LEFT, "+", Keys.ENTER).perform()
        self.until("return document.getElementById('hit') && "
                   "new URLSearchParams(location.hash.slice(1)).get('view')")
        self.assertNotEqual(before, self.script("return document.getElementById('scene').dataset.frames"))
        self.script("document.getElementById('tab-membrane').focus()")
        ActionChains(self.browser).send_keys(Keys.ARROW_RIGHT).perform()
        self.until("return document.activeElement.id === 'tab-interfaces' && document.querySelector('#panel canvas')")
        names = self.script(
            "return [...document.querySelectorAll('button, input, select, textarea, canvas, a, summary')]"
            ".filter(each => each.checkVisibility()).filter(each => each.tabIndex < 0 && each.role !== 'tab' || "
            "!(each.textContent.trim() || each.ariaLabel || each.labels?.length)).map(each => each.outerHTML)")
        self.assertEqual(names, [], "each is reached by Tab and has a name")

    def test_numbers_are_pasted_as_germans_and_english_write_them(self):
        wanted = {"0,5": 0.5, "0.5": 0.5, "1.234,5": 1234.5, "1,234.5": 1234.5, "1'234.5": 1234.5, "1 234,5": 1234.5,
                  "1.234.567": 1234567, "1,234,567": 1234567, "\u22120,25": -0.25, "2,5e-3": 2.5e-3}
        found = self.later(f"import('/dom.js').then(m => {json.dumps(list(wanted))}.map(m.parse))")
        self.assertEqual(found, list(wanted.values()))

    def test_many_samples_keep_their_extremes(self):
        columns, count = 800, 100_000
        y = np.exp(np.random.default_rng(1).normal(size=count) - np.linspace(0, 20, count))
        y[[777, 55_555]] = 1e-30, 1e6
        self.script("window.sample = arguments[0]", y.tolist())
        found = np.array(self.later("import('/chart.js').then(m => m.thinned(Float64Array.from(sample, (_, i) => i), "
                                    f"sample, {columns}).map(p => [p.x, p.y]))"))
        self.assertLessEqual(len(found), 4 * columns)
        np.testing.assert_array_equal(found[:, 1], y[found[:, 0].astype(int)])
        self.assertTrue((np.diff(found[:, 0]) > 0).all())
        for part in range(columns):
            own = (np.arange(count) * columns // (count - 1)).clip(max=columns - 1) == part
            kept = found[(found[:, 0] * columns // (count - 1)).clip(max=columns - 1) == part, 1]
            self.assertEqual((kept.min(), kept.max()), (y[own].min(), y[own].max()))


class OfAFile(InChromium):
    def test_many_triangles_are_thinned_first_and_while_they_move(self):
        with anticrack.local(program=ANTICRACKD) as client:
            result = client.run(anticrack.Case.parse(SLIT.replace("0.2", "0.0065")), progress=False)
        result.save(self.folder / "many.h5")
        (load,) = result.loads.values()
        surface, count = scene.Values(result, load), len(result.mesh.triangles)
        self.assertGreater(count, 200_000)
        edges, own = np.unique(np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0,
                               return_counts=True)
        np.testing.assert_array_equal(surface.array("outline", False), edges[own == 1])
        kept, few = surface.thinned
        for what in surface.known:
            np.testing.assert_array_equal(surface.array(what, True), surface.array(what, False)[kept])
        at = surface.points[kept][few]
        (x, y), areas = np.moveaxis(at[:, 1:] - at[:, :1], 1, 0), surface.areas.sum()
        self.assertAlmostEqual(abs(np.linalg.det(np.stack((x, y), 1))).sum() / 2, areas, delta=0.03 * areas)
        with self.page(self.folder / "many.h5"):
            self.until(PICTURE)
            self.until("return document.querySelector('#bar i') && document.getElementById('moving').hidden && "
                       "document.getElementById('moving').textContent")
            self.script("const line = document.getElementById('moving'); window.told = []; new MutationObserver(() => "
                        "line.hidden || told.push(line.textContent)).observe(line, {attributes: true});"
                        "document.getElementById('scene').focus()")
            ActionChains(self.browser).send_keys(Keys.ARROW_LEFT).perform()
            self.until("return told.length && document.getElementById('moving').hidden")
            self.assertEqual(self.script("return told[0]"), f"{len(few)} of {count} triangles while it moves")
            self.go("of=file&plan=1&colour=flux", "return document.getElementById('bar').textContent.includes('grad')")
            values = surface.array("flux", False)
            told = self.script("return document.querySelector('#bar span:nth-child(2)').textContent")
            self.assertAlmostEqual(float(told.replace("\u2212", "-")), values.min(), delta=1e-3 * abs(values).max())
            self.require_clean()

    def test_what_is_taken_along_is_what_the_package_writes(self):
        with anticrack.local(program=ANTICRACKD) as client:
            client.run(EXAMPLES / "opening.toml", progress=False).save(self.folder / "r.h5")
        result = anticrack.read(self.folder / "r.h5")
        load = next(iter(result.loads.values()))
        with self.page(self.folder / "r.h5"):
            self.until(PICTURE)
            links = self.until("return [...document.querySelectorAll('#export-links a')].map(a => a.href)")
            got = {}
            for kind in ("png", "svg", "vtu", "h5", "toml"):
                (where,) = [link for link in links if f"kind={kind}" in link]
                got[kind] = bytes(self.later(f"fetch('{where}').then(a => a.arrayBuffer())"
                                             ".then(b => [...new Uint8Array(b)])"))
            self.require_clean()
        for kind in ("png", "svg"):
            made = files.draw_figures(result, self.folder, files.Wanted(["membrane"], "", [load.name]), Look([kind]))
            self.assertEqual(got[kind], pathlib.Path(made.files[0]).read_bytes(), kind)
        self.assertEqual(got["vtu"], vtk.membrane(result, load))
        self.assertEqual(got["h5"], (self.folder / "r.h5").read_bytes())
        self.assertEqual(got["toml"].decode(), result.case)

    def test_looks_as_the_guide_shows_it(self):
        kept = EXAMPLES.parent / "view.png"
        with self.page("--local", EXAMPLES / "opening.toml"):
            self.until(PICTURE)
            self.until("return document.querySelector('#bar i') && document.querySelector('.here .succeeded')")
            self.go("of=" + self.fragment()["of"] + "&tab=interfaces&theme=light",
                    "return document.querySelectorAll('#panel canvas').length === 3")
            time.sleep(1)
            shown = self.browser.get_screenshot_as_png()
            self.require_clean()
        if "ANTICRACK_RENEW_PICTURES" in os.environ:
            kept.write_bytes(shown)
        if DEBIAN_12:  # another gmsh makes another mesh
            far = np.abs(blurred(io.BytesIO(shown)) - blurred(kept))
            self.assertLess(far.max(), 40, "of 255, in squares of 20 pixels")
            self.assertLess(far.mean(), 1.5)

    def test_a_study_of_two_keys_has_a_line_for_each_value_of_one_and_contours_over_both(self):
        grid = {"load.up.f": [1, 2, 3], "mesh.size": [0.3, 0.2]}
        with anticrack.local(program=ANTICRACKD) as client:
            study = client.study(anticrack.Case.parse(SLIT), grid, path=self.folder / "s.h5", progress=False)
        with self.page(self.folder / "s.h5"):
            src = self.until("return document.querySelector('#panel .drawing img')?.naturalWidth && "
                             "document.querySelector('#panel .drawing img').src")
            lines = self.script("return Chart.getChart(document.querySelector('#panel canvas')).data.datasets.map(line "
                                "=> [line.label, line.data.map(point => [point.x, point.y])])")
            size, load, energy = (study[name] for name in ("mesh.size", "load.up.f", "energy"))
            for (label, points), value in zip(lines, grid["mesh.size"], strict=True):
                self.assertEqual(label, f"mesh.size = {value:g}")
                self.assertEqual(points, [list(point) for point in zip(load[size == value], energy[size == value])])
            got = bytes(self.later(f"fetch('{src}').then(a => a.arrayBuffer()).then(b => [...new Uint8Array(b)])"))
            made = studies.draw_study(study, self.folder / "figures", Look(["svg"]))
            self.assertIn(got, [pathlib.Path(path).read_bytes() for path in made.files if "energy" in path])
            self.script("document.querySelector('[aria-label=row]').focus()")
            for row in (1, 2):  # the slider keeps the focus
                ActionChains(self.browser).send_keys(Keys.ARROW_RIGHT).perform()
                self.until(f"{ROW} === '{row}' && document.activeElement.ariaLabel === 'row'")
            self.assertIn(study.rows[2].job, self.script("return document.querySelector('table.row').textContent"))
            self.go("of=file&tab=tables", "return document.querySelector('#panel tbody td')")
            links = self.script("return [...document.querySelectorAll('#export-links a')].map(a => a.href)")
            sizes = [len(self.later(f"fetch('{link}').then(a => a.ok ? a.text() : '')")) for link in links]
            self.assertEqual(len(sizes), 4)  # PNG, SVG, HDF5, TOML
            self.assertTrue(all(sizes), links)
            self.require_clean()

    def test_a_study_is_stepped_through(self):
        case = anticrack.Case.read(EXAMPLES / "several-inclusions.toml")
        with Daemon(self.folder) as server, anticrack.connect(f"127.0.0.1:{server.port}") as client:
            study = client.study(case, {"mesh.size": [0.2, 0.1]}, path=self.folder / "s.h5", progress=False)
            with self.page("--server", f"127.0.0.1:{server.port}", self.folder / "s.h5"):
                self.until("return document.querySelector('#panel canvas')")
                self.assertEqual(self.tabs(), ["tables", "sweep", "case"])
                self.go("of=file&tab=tables", "return document.querySelector('#panel tbody td')")
                head = self.script("return [...document.querySelectorAll('#panel th button')].map(b => "
                                   "b.firstChild.textContent)")
                lines = [dict(zip(head, row)) for row in self.numbers_of_table()]
                self.assertEqual([line["energy"] for line in lines],
                                 [of["energy"] for row in study.rows for of in row.answers.values()])
                self.go("of=file&tab=sweep&row=1", "return document.querySelector('table.row')")
                self.button(f"Show the job of row {lines[1]['row']:g}")
                job = study.rows[int(lines[1]["row"])].job
                self.until(f"return new URLSearchParams(location.hash.slice(1)).get('of') === '{job}'")
                self.until(PICTURE)
                self.require_clean()
