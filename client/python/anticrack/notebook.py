# SPDX-License-Identifier: GPL-3.0-or-later
"""What a notebook shows of a job: a table, and while it runs how the iterations or the stages converge. The figure is
SVG of a few lines, so that it needs no other package and no event loop."""
from __future__ import annotations

import html
import math
from typing import Any

from .entries import values_of
from .text import between, harmless, html_table
from .v1 import job_pb2, solve_pb2

_WIDTH, _HEIGHT, _LEFT, _BELOW = 420, 190, 60, 34  # of the figure and of the room beside it [pixels]
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#222222", "#E69F00", "#56B4E9", "#8C6D31")
_MOST = 400  # points of a curve; of more every second one is left out


def job_html(job: solve_pb2.Job, title: str, error: str) -> str:
    """A table of a job's load cases. title: the job in a line."""
    rows = []
    names = list(dict.fromkeys(part.name for answer in job.status.answers for part in answer.inclusions))[:8]
    for answer in job.status.answers:
        numbers, parts = values_of(answer), {part.name: values_of(part) for part in answer.inclusions}
        solved = answer.status in (answer.STATUS_CONVERGED, answer.STATUS_NOT_CONVERGED)
        told = [(numbers, "energy"), *((parts.get(part), "A") for part in names)]
        rows.append([answer.name, numbers["status"], str(answer.iterations),
                     *(between(of[name], of[f"{name}_lower"], of[f"{name}_upper"]) if solved and of else "-"
                       for of, name in told)])
    head = ["load", "status", "iterations", "energy", *(f"A of {name}" for name in names)]
    return html_table(": ".join(part for part in (title, error) if part), head, rows)


class Curves:
    """The curves of a job that runs: the criterion of each load case over its iterations, or the errors of all load
    cases over the triangles of the stages."""

    def __init__(self, spec: job_pb2.JobSpec) -> None:
        self._loads = [load.name for load in spec.load_cases]
        self._stages = spec.HasField("accuracy")
        self._curves: dict[str, dict[float, float]] = {}

    def take(self, message: solve_pb2.WatchJobResponse) -> None:
        event = message.WhichOneof("event")
        if event == "snapshot":
            for stage in message.snapshot.job.status.stages:
                self._stage(stage)
        elif event == "stage_ended":
            self._stage(message.stage_ended)
        elif event == "samples" and not self._stages:
            samples = message.samples
            for load, x, y in zip(samples.load_case, samples.iteration, samples.criterion):
                if load < len(self._loads):
                    self._point(f"criterion of {self._loads[load]}", x, y)

    def _stage(self, stage: solve_pb2.Stage) -> None:
        answers = list(map(values_of, stage.answers))
        energy = [(of["energy_upper"] - of["energy_lower"]) / (abs(of["energy"]) or math.nan) for of in answers]
        for name, values in (("energy", energy), ("A", [of["displacement_error"] for of in answers]),
                             ("A, probably", [of["displacement_error_probable"] for of in answers])):
            self._point(f"error of {name}", stage.triangles, max(values, default=math.nan))

    def _point(self, name: str, x: float, y: float) -> None:
        if 0 < y < math.inf and (len(self._curves) < len(_COLOURS) or name in self._curves):
            curve = self._curves.setdefault(name, {})
            curve[x] = y
            if len(curve) > _MOST:
                self._curves[name] = dict(list(curve.items())[::2])

    def html(self, text: str) -> str:
        """The figure, with a text above it."""
        return f"<pre>{html.escape(harmless(text, chr(10)))}</pre>{self._svg()}"

    def _svg(self) -> str:
        curves = {name: sorted(points.items()) for name, points in self._curves.items() if len(points) > 1}
        if not curves:
            return ""
        every = [point for points in curves.values() for point in points]
        (x0, x1), (y0, y1) = ((min(values), max(values)) for values in zip(*every))
        low = math.floor(math.log10(y0))
        high = max(math.ceil(math.log10(y1)), low + 1)
        along: Any = math.log10 if self._stages else float

        def at(x: float, y: float) -> str:
            right = (along(x) - along(x0)) / ((along(x1) - along(x0)) or 1) * (_WIDTH - _LEFT - 10)
            up = (math.log10(y) - low) / (high - low) * (_HEIGHT - _BELOW - 10)
            return f"{_LEFT + right:.1f},{_HEIGHT - _BELOW - up:.1f}"
        parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" height="{_HEIGHT + 15 * len(curves)}" '
                 'font-family="sans-serif" font-size="11">']

        def text(x: float, y: float, words: str, colour: str = "#333", anchor: str = "middle") -> None:
            parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">'
                         f"{html.escape(harmless(words))}</text>")
        for power in range(low, high + 1, max(1, (high - low) // 4)):
            left, up = at(x0, 10.0 ** power).split(",")
            parts.append(f'<path d="M{left} {up}H{_WIDTH - 10}" stroke="#e4e4e4"/>')
            text(_LEFT - 5, float(up) + 4, f"1e{power}", anchor="end")
        for x, anchor in ((x0, "start"), (x1, "end")):
            text(float(at(x, y0).split(",")[0]), _HEIGHT - _BELOW + 14, f"{x:.6g}", anchor=anchor)
        text((_WIDTH + _LEFT) / 2, _HEIGHT - 6, "triangles" if self._stages else "iteration")
        for index, (name, points) in enumerate(curves.items()):
            parts.append(f'<polyline points="{" ".join(at(*point) for point in points)}" fill="none" '
                         f'stroke="{_COLOURS[index]}" stroke-width="1.5"/>')
            text(_LEFT, _HEIGHT + 10 + 15 * index, name, _COLOURS[index], "start")
        return "".join([*parts, "</svg>"])
