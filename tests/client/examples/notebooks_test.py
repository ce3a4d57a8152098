# SPDX-License-Identifier: GPL-3.0-or-later
"""The notebooks of the gallery run, and come to the numbers that they show."""
import html.parser
import math
import os
import pathlib
import re
import unittest

import nbclient
import nbformat

from anticrack.notebook import Curves, job_html
from anticrack.v1 import job_pb2, solve_pb2
from processes import ANTICRACKD, DEBIAN_12

NOTEBOOKS = sorted((pathlib.Path(os.environ["EXAMPLES"]) / "notebooks").glob("*.ipynb"))
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?(?!\w)")


def outputs(notebook):
    """Of each cell: the words, with # for numbers, the numbers, and the kinds of what is shown."""
    for cell in notebook.cells:
        shown = [output.get("data", {"text/plain": output.get("text", "")}) for output in cell.get("outputs", [])]
        text = re.sub("jobs/[0-9a-f]+", "jobs/ID", "\n".join(data.get("text/plain", "") for data in shown))
        yield re.sub(r"\s+", " ", NUMBER.sub("#", text)), [float(number) for number in NUMBER.findall(text)], [
            sorted(data) for data in shown]


class Notebooks(unittest.TestCase):
    def try_notebook(self, path):
        kept = nbformat.read(path, 4)
        ran = nbformat.read(path, 4)
        os.environ["PATH"] = f"{pathlib.Path(ANTICRACKD).parent}:{os.environ['PATH']}"
        nbclient.NotebookClient(ran, timeout=500, kernel_name="python3", record_timing=False).execute()
        if os.environ.get("ANTICRACK_RENEW_GOLDEN"):
            return nbformat.write(ran, path)
        self.assertTrue(any(cell.get("outputs") for cell in kept.cells))
        for (words, numbers, kinds), (theirs, others, more) in zip(outputs(ran), outputs(kept), strict=True):
            self.assertEqual(kinds, more)
            if not DEBIAN_12:
                continue  # another gmsh makes other meshes
            self.assertEqual(words, theirs)
            for one, other in zip(numbers, others, strict=True):
                self.assertTrue(math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-9), f"{one} should be {other}")

    def test_first_steps_draws_while_it_waits(self):
        (path,) = [path for path in NOTEBOOKS if path.stem == "first-steps"]
        (live,) = [output for cell in nbformat.read(path, 4).cells for output in cell.get("outputs", [])
                   if "<svg" in output.get("data", {}).get("text/html", "")]
        self.assertEqual(live["data"]["text/html"].count("<polyline"), 3)


for each in NOTEBOOKS:
    setattr(Notebooks, f"test_{each.stem.replace('-', '_')}", lambda self, path=each: self.try_notebook(path))


class Tags(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.texts = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)

    def handle_data(self, data):
        self.texts.append(data)


class Shown(unittest.TestCase):
    HOSTILE = '<script>x</script>"\u202e&'

    def test_names_of_others_are_text(self):
        answer = solve_pb2.LoadCaseAnswer(name=self.HOSTILE, status=3, inclusions=[{"name": self.HOSTILE}])
        job = solve_pb2.Job(name="jobs/1", status={"answers": [answer]})
        curves = Curves(job_pb2.JobSpec(load_cases=[{"name": self.HOSTILE}]))
        samples = {"load_case": [0, 0], "iteration": [1, 2], "criterion": [1, 0.1]}
        curves.take(solve_pb2.WatchJobResponse(samples=samples))
        for text in (job_html(job, self.HOSTILE, self.HOSTILE), curves.html(self.HOSTILE)):
            found = Tags(text)
            self.assertNotIn("script", found.tags)
            self.assertGreater(sum('<script>x</script>"?&' in part for part in found.texts), 1)

    def test_the_live_figure_is_logarithmic(self):
        spec = job_pb2.JobSpec(load_cases=[{"name": "up"}])
        criteria = [1.0, 1e-2, 1e-3, 0.0, math.nan, 1e-6]
        curves = Curves(spec)
        for i, criterion in enumerate(criteria, 1):
            samples = {"load_case": [0], "iteration": [i], "criterion": [criterion]}
            curves.take(solve_pb2.WatchJobResponse(samples=samples))
        (points,) = re.findall('points="([^"]*)"', curves.html(""))
        places = [tuple(map(float, point.split(","))) for point in points.split()]
        (x0, y0), (x1, y1) = places[0], places[-1]
        for (x, y), (i, criterion) in zip(places, ((1, 1), (2, 1e-2), (3, 1e-3), (6, 1e-6)), strict=True):
            self.assertAlmostEqual((x - x0) / (x1 - x0), (i - 1) / 5, delta=1e-3)
            self.assertAlmostEqual((y - y0) / (y1 - y0), math.log10(criterion) / -6, delta=1e-3)
