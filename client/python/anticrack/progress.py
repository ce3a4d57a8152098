# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows what a job is doing: a bar on a terminal and in a notebook, plain lines elsewhere."""
from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence
from typing import Any, TextIO

import numpy as np

from . import entries
from .notebook import Curves
from .text import harmless
from .v1 import job_pb2, solve_pb2

WIDTH = 20
PAUSE = 0.1  # between two updates of a bar [s]


class State:
    """Follows the events of a job and says which are worth a line. stages: a line for each stage of an accuracy."""

    def __init__(self, job: solve_pb2.Job) -> None:
        spec, sweeps = job.spec, job.spec.HasField("sweep")
        self.total = job.status.sweep_answer.rows if sweeps else job.status.load_case_count or len(spec.load_cases)
        self.loads = [load.name for load in spec.load_cases]
        self.unit = "rows" if sweeps else "load cases"
        self.step = "iteration" if spec.solver.HasField("uzawa") else "step"
        self.accuracy = spec.accuracy if spec.HasField("accuracy") else None
        self.stages: dict[str, str] = {}
        self.ended, self.now = 0, "submitted"

    def take(self, message: solve_pb2.WatchJobResponse) -> list[str]:
        event = message.WhichOneof("event")
        lines = []
        for load in message.load_cases_ended:
            self.ended += 1
            lines += self._load_ended(load.answer)
        if event == "snapshot":
            status = message.snapshot.job.status
            self.total = status.sweep_answer.rows or self.total
            lines += [line for stage in status.stages for line in self._stage_ended(stage)]
        elif event == "phase":
            state = _word(solve_pb2.JobStatus.State.Name(message.phase.state))
            self.now = f"{state} ({message.phase.detail})" if message.phase.detail else state
            lines.append(self.now)
        elif event == "samples" and message.samples.iteration:
            samples = message.samples
            name = self.loads[samples.load_case[-1]] if samples.load_case[-1] < len(self.loads) else ""
            criterion = f", criterion {samples.criterion[-1]:.2g}" if self.step == "iteration" else ""
            self.now = f"{name}: {self.step} {samples.iteration[-1]}{criterion}"
        elif event == "sweep_rows":
            self.ended += len(message.sweep_rows.status)
            self.now = "solving"
        elif event == "growth_step":
            row = message.growth_step.row
            self.now = f"front on {row.interface} at {row.position:.4g}, load {row.load:.4g}"
            if row.HasField("g1_upper"):
                upper = f"{row.load_upper:.4g}" if row.HasField("load_upper") else "any"
                self.now += f", to the next {row.load_lower:.4g} to {upper}"
        elif event == "stage_ended":
            self.ended = 0  # the next stage solves the load cases again
            lines += self._stage_ended(message.stage_ended)
        elif event == "ended":
            self.now = _word(solve_pb2.JobStatus.State.Name(message.ended.status.state))
            self.ended = message.ended.status.load_cases_ended or self.ended
            lines.append(self.now)
        return lines

    def _load_ended(self, answer: solve_pb2.LoadCaseAnswer) -> list[str]:
        if self.accuracy is not None and answer.status == answer.STATUS_CONVERGED:
            return []  # it is solved in every stage; the stage's line tells of success
        count = answer.iterations
        return [f"{answer.name}: {_word(solve_pb2.LoadCaseAnswer.Status.Name(answer.status))} after {count} {self.step}"
                f"{'' if count == 1 else 's'}"]

    def _stage_ended(self, stage: solve_pb2.Stage) -> list[str]:
        """The line of a stage; none if it was told already, as a watch may tell of a stage twice."""
        if not stage.answers or stage.mesh in self.stages or self.accuracy is None:
            return []
        self.stages[stage.mesh] = (f"stage {len(self.stages) + 1}: {stage.triangles} triangles, "
                                   + _errors(stage, self.accuracy))
        return [self.stages[stage.mesh]]

    def bar(self) -> str:
        part = min(self.ended / self.total, 1) if self.total else 0
        done = int(part * WIDTH)
        return f"[{'#' * done}{'.' * (WIDTH - done)}] {self.ended}/{self.total} {self.unit}, {self.now}"


def _word(name: str) -> str:
    """The word for a state that the command uses."""
    word = name.removeprefix("STATE_").removeprefix("STATUS_").lower().replace("_", " ")
    return {"waiting for mesh": "waiting for the mesh", "succeeded": "done"}.get(word, word)


def _errors(stage: solve_pb2.Stage, asked: job_pb2.Accuracy) -> str:
    """The largest errors over all load cases, as the command prints them: "energy 0.21 % (asked 0.1 %)", with "-" for
    an unknown one."""
    def text(error: float, most: float) -> str:
        percent = f"{100 * error:.{2 if error < 1 and not most else 3}g} %" if np.isfinite(error) else "- %"
        return percent + (f" (asked {100 * most:.6g} %)" if most else "")
    columns = {name: np.array([entries.values_of(answer)[name] for answer in stage.answers])
               for name in ("energy", "energy_lower", "energy_upper", "displacement_error",
                            "displacement_error_probable")}
    widths = np.maximum(columns["energy_upper"] - columns["energy_lower"], 0)
    sizes = np.where(widths == 0, 1, np.abs(columns["energy"]))
    energy, moved = (widths / sizes).max(), columns["displacement_error"].max()
    told = "energy " + text(energy, asked.energy)
    if asked.HasField("displacement") or np.isfinite(moved):
        told += ", A " + text(moved, asked.displacement)
    probable = columns["displacement_error_probable"].max()
    if asked.HasField("displacement_estimated") or (asked.HasField("displacement") and np.isfinite(probable)):
        told += ", probably " + text(probable, asked.displacement_estimated)
    return told + (f"; {harmless(stage.forecast)}" if stage.forecast else "")


class Place:
    """Where progress is shown: a text that is replaced, on a terminal or in the notebook that it finds itself in, or
    else lines. Nothing is shown once `out` is closed or full, no reason to lose the work."""

    def __init__(self, out: TextIO | None = None, shown: bool = True) -> None:
        self._out = (out or sys.stderr) if shown else None  # sys.stderr may be None without a terminal
        self._handle = _notebook_handle() if shown and out is None else None
        self._width = 0
        self.open = self._out is not None
        self.replaces = self._handle is not None or _is_terminal(self._out)

    def show(self, text: str, last: bool = False, above: Sequence[str] = (),
             page: dict[str, str] | None = None) -> None:
        """above: lines that stay above a text that is replaced; page: what a notebook shows in place of it."""
        if self._out is None:
            return
        text = harmless(text)
        try:
            if self._handle is not None:
                self._handle.update(page or {"text/plain": text}, raw=True)
                return
            if self.replaces:
                text = text[:_columns(self._out)]
                self._out.write("".join("\r" + line.ljust(self._width) + "\n" for line in above)
                                + "\r" + text.ljust(self._width) + "\n" * last)
                self._width = 0 if last else len(text)
            else:
                self._out.write(text + "\n")
            self._out.flush()
        except (OSError, ValueError):
            self._out, self.open = None, False


class Progress:
    """Shows the progress of a job on `out`, or in the notebook that it finds itself in."""

    def __init__(self, job: solve_pb2.Job, out: TextIO | None = None, shown: bool = True) -> None:
        self._state, self._name, self._place = State(job), job.name, Place(out, shown)
        self._curves, self._next = Curves(job.spec), 0.0

    def take(self, message: solve_pb2.WatchJobResponse) -> None:
        if not self._place.open:
            return
        before = len(self._state.stages)
        lines = self._state.take(message)
        self._curves.take(message)
        stages, ended = list(self._state.stages.values()), message.HasField("ended")
        if not self._place.replaces:
            for line in lines:
                self._place.show(f"{self._name}: {line}")
        elif len(stages) > before or ended or time.monotonic() >= self._next:
            text = f"{self._name} {self._state.bar()}"
            told = "\n".join([*stages, harmless(text)])
            self._place.show(text, ended, stages[before:], {"text/plain": told, "text/html": self._curves.html(told)})
            self._next = time.monotonic() + (0 if len(stages) > before or ended else PAUSE)


def _columns(out: TextIO) -> int:
    """Width of the terminal: a longer text would wrap into a second line, which would not be overwritten."""
    try:
        return os.get_terminal_size(out.fileno()).columns - 1
    except OSError:
        return 100


def _is_terminal(out: TextIO | None) -> bool:
    try:
        return out is not None and out.isatty()
    except ValueError:  # closed
        return False


def _notebook_handle() -> Any:
    """The handle of a text in a notebook that can be replaced; None outside notebooks."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is None or not hasattr(shell, "kernel"):
        return None
    return ipython.display.display({"text/plain": ""}, raw=True, display_id=True)  # type: ignore[union-attr]
