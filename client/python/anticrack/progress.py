# SPDX-License-Identifier: GPL-3.0-or-later
"""What a job is doing: a bar on a terminal and in a notebook, plain lines elsewhere."""
from __future__ import annotations

import sys
import time
from typing import Any, TextIO

from .v1 import solve_pb2

WIDTH = 30
PAUSE = 0.1  # between two looks of a bar [s]


class State:
    """Follows the events of a job; the text of what is worth a line, or None."""

    def __init__(self, job: solve_pb2.Job) -> None:
        self.total = job.sweep_answer.rows if job.HasField("sweep") else job.load_case_count or len(job.load_cases)
        self.loads = [load.name for load in job.load_cases]
        self.unit = "rows" if job.HasField("sweep") else "load cases"
        self.step = "iteration" if job.solver.HasField("uzawa") else "step"
        self.ended, self.now = 0, "submitted"

    def take(self, message: solve_pb2.WatchJobResponse) -> str | None:
        event = message.WhichOneof("event")
        line = None
        if event == "snapshot":
            self.total = message.snapshot.job.sweep_answer.rows or self.total
        elif event == "phase":
            state = solve_pb2.Job.State.Name(message.phase.state).removeprefix("STATE_").replace("_", " ").lower()
            line = self.now = f"{state} ({message.phase.detail})" if message.phase.detail else state
        elif event == "samples" and message.samples.iteration:
            samples = message.samples
            name = self.loads[samples.load_case[-1]] if samples.load_case[-1] < len(self.loads) else ""
            self.now = f"{name}: iteration {samples.iteration[-1]}, criterion {samples.criterion[-1]:.2g}"
        elif event == "sweep_rows":
            self.ended += len(message.sweep_rows.status)
            self.now = "solving"
        elif event == "stage_ended":
            self.ended = 0
            line = f"stage of {message.stage_ended.triangles} triangles ended after {message.stage_ended.seconds:.2g} s"
        elif event == "ended":
            line = self.now = solve_pb2.Job.State.Name(message.ended.state).removeprefix("STATE_").lower().replace(
                "_", " ")
        for load in message.load_cases_ended:
            self.ended += 1
            status = solve_pb2.LoadCaseAnswer.Status.Name(load.answer.status).removeprefix("STATUS_").lower()
            count = load.answer.iterations
            said = (f"{load.answer.name}: {status.replace('_', ' ')} after {count} {self.step}"
                    f"{'' if count == 1 else 's'}")
            line = f"{line}\n{said}" if line else said
        return line

    def bar(self) -> str:
        part = min(self.ended / self.total, 1) if self.total else 0
        done = int(part * WIDTH)
        return f"[{'#' * done}{'.' * (WIDTH - done)}] {self.ended}/{self.total} {self.unit}, {self.now}"


class Progress:
    """out: where it is shown; a notebook is noticed."""

    def __init__(self, job: solve_pb2.Job, out: TextIO | None = None) -> None:
        self._state, self._name = State(job), job.name
        self._out = out or sys.stderr
        self._handle = _notebook_handle() if out is None else None
        self._bar = self._handle is None and self._out.isatty()
        self._shown, self._next = 0, 0.0

    def take(self, message: solve_pb2.WatchJobResponse) -> None:
        line = self._state.take(message)
        drawn = self._handle is not None or self._bar
        if drawn and not message.HasField("ended"):
            if time.monotonic() < self._next:
                return
            self._next = time.monotonic() + PAUSE
        if self._handle is not None:
            self._handle.update({"text/plain": self._text()}, raw=True)
        elif self._bar:
            text = self._text()[:100]
            self._out.write("\r" + text.ljust(self._shown))
            self._shown = len(text)
            if message.HasField("ended"):
                self._out.write("\n")
            self._out.flush()
        elif line:
            self._out.write("".join(f"{self._name}: {part}\n" for part in line.split("\n")))
            self._out.flush()

    def _text(self) -> str:
        return f"{self._name} {self._state.bar()}"


def _notebook_handle() -> Any:
    """Of a text that can be replaced; None outside notebooks."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is None or not hasattr(shell, "kernel"):
        return None
    return ipython.display.display({"text/plain": ""}, raw=True, display_id=True)  # type: ignore[union-attr]
