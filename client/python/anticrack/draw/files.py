# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses the figures of a result that are drawn, and writes their files."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import output
from ..errors import Error
from ..output import Made
from ..result import Load, Result, chosen, fields_cure
from ..text import harmless, suggestion
from . import pictures
from .along import can_open, eventful
from .history import bounded
from .meshes import Plan
from .sheet import Look
from .sweeps import Rows

_MANY = 12  # more loads, rows and interfaces are drawn only on request
_TOGETHER = 8  # most loads that are drawn over each other


@dataclass
class Wanted:
    """What to draw. only: some of commands.FIGURES; empty: all that have something to show. interface: that of the
    traces, the overview and together; empty: the most eventful, and traces of all that can open. loads: names; empty:
    the first twelve. all: draw all loads and interfaces, however many."""
    only: list[str] = field(default_factory=list)
    interface: str = ""
    loads: list[str] = field(default_factory=list)
    all: bool = False

    def has(self, figure: str) -> bool:
        return not self.only or figure in self.only


def _traces_suffix(index: int) -> str:
    return "-traces" if index == 0 else f"-traces-{index + 1}"


def _steps(load: Load) -> int:
    return len(load.history["iteration"]) if load.history else 0


class _Drawing:
    """Draws what is wanted of a result. Raises Error if a name does not exist."""

    def __init__(self, result: Result, folder: str, wanted: Wanted, look: Look) -> None:
        self.result, self.wanted, self.look = result, wanted, look
        names = [line.name for line in result.interfaces]
        if wanted.interface and wanted.interface not in names:
            raise Error(f"there is no interface {harmless(wanted.interface)}; {suggestion(wanted.interface, names)}")
        self.asked = names.index(wanted.interface) if wanted.interface else None
        self.opening = [i for i, line in enumerate(result.interfaces) if can_open(line)]
        self.loads = chosen(result, wanted.loads)
        # Only the most eventful of the interfaces that can open is drawn.
        self.chooses = (not wanted.all and self.asked is None and "traces" not in wanted.only
                        and len(self.opening) > _MANY)
        self.fewest = 2 if "convergence" in wanted.only else 3  # steps that a convergence must have
        self.drawn = Made(folder)

    def note(self, text: str) -> None:
        self.drawn.notes.append(text)

    def eventful(self, loads: list[Load]) -> tuple[int, int]:
        return (self.asked, self.asked) if self.asked is not None else eventful(self.result, loads)

    def first(self, every: list[Any], what: str) -> list[Any]:
        if self.wanted.all or len(every) <= _MANY:
            return every
        self.note(f"the first {_MANY} of {len(every)} {what}, --all draws all")
        return every[:_MANY]

    def shown(self, what: str, other: str) -> list[Load]:
        if self.wanted.loads:
            return self.loads
        return self.first(self.loads, f"{what} drawn; --load {other} chooses others")

    def draw_loads(self) -> None:
        suffixes = ["-membrane", "-plan", "-convergence", "-accuracy", "-growth",
                    *(_traces_suffix(i) for i in range(len(self.result.interfaces)))]
        # Stems of all loads, so that a load's file has the same name however many are drawn.
        for load, stem in zip(self.shown("loads", "NAME"), output.stems((load.name for load in self.loads), suffixes)):
            self.draw_load(load, stem)
        self.note_interfaces()
        few = sum(1 for load in self.loads if load.traces and _steps(load) < self.fewest)
        if few and self.wanted.has("convergence"):
            how = ("a single step: no convergence is drawn" if self.fewest == 2 else
                   "one or two steps: no convergence is drawn; --only convergence draws that of two")
            self.note(f"{few} load{' was' if few == 1 else 's were'} solved in {how}")

    def draw_load(self, load: Load, stem: str) -> None:
        result, look, has, told = self.result, self.look, self.wanted.has, f'load "{harmless(load.name)}"'
        if not load.traces and (result.interfaces or not load.fields):
            self.note(f"{told} has no traces ({load.status.replace('_', ' ')}): nothing to draw")
            return
        if load.fields:
            if has("overview") and result.interfaces:
                self.drawn.add(stem, pictures.overview_picture(look, result, load, *self.eventful([load])))
            for figure, draw in (("membrane", pictures.draw_membrane), ("plan", pictures.draw_plan)):
                if has(figure):
                    self.drawn.add(f"{stem}-{figure}", pictures.picture(draw, look, result, load))
        elif any(map(has, ("overview", "membrane", "plan"))):
            self.note(f"{told}: no membrane and no plan drawn, it has no fields; {fields_cure(result)}")
        self.draw_traces(load, stem)
        if has("convergence") and _steps(load) >= self.fewest:
            self.drawn.add(f"{stem}-convergence", pictures.picture(pictures.draw_convergence, look, result, load))
        if has("growth") and load.growth:
            self.drawn.add(f"{stem}-growth", pictures.growth_picture(look, result, load))
            if load.membrane_rows is not None:
                for row in load.membrane_rows:
                    self.drawn.add(f"{stem}-growth-{row}",
                                   pictures.picture(pictures.draw_membrane, look, result, load.grown(int(row))))
        if has("accuracy") and len(bounded(load)["triangles"]) > 1:
            self.drawn.add(f"{stem}-accuracy", pictures.picture(pictures.draw_accuracy, look, result, load))
        elif has("accuracy") and (load.stages or self.wanted.only):
            self.note(f"{told}: no accuracy drawn, fewer than two stages have bounds")

    def draw_traces(self, load: Load, stem: str) -> None:
        if not self.wanted.has("traces") or not load.traces:
            return
        chosen = [self.asked] if self.asked is not None else sorted(set(self.eventful([load]))) if self.chooses else (
            self.opening)
        for index in chosen:
            self.drawn.add(stem + _traces_suffix(index), pictures.traces_picture(self.look, self.result, load, index))

    def note_interfaces(self) -> None:
        """Notes which interfaces are left out."""
        if not self.wanted.has("traces"):
            return
        if self.chooses:
            self.note(f"of {len(self.opening)} interfaces that can open the most eventful is drawn; --all draws the "
                      "traces of each, --interface NAME those of one")
        closed = [line.name for i, line in enumerate(self.result.interfaces) if i not in self.opening]
        if closed and self.asked is None:
            count = ("an interface is glued or bonded all along and has" if len(closed) == 1 else
                     f"{len(closed)} interfaces are glued or bonded all along and have")
            self.note(f"{count} no traces drawn; --interface {harmless(closed[0])} draws them")

    def draw_sweep(self) -> None:
        if not self.wanted.only:
            self.draw_rows()
        for load in self.shown("rows with traces", "row-K"):
            self.draw_traces(load, load.name)
        if self.loads:
            self.note_interfaces()

    def draw_rows(self) -> None:
        result, sweep = self.result, self.result.sweep
        assert sweep is not None
        if not sweep.converged.any():
            self.note("no row of the sweep converged: nothing to draw of it")
            return
        if sweep.displacement_lower is not None and not Rows(sweep).joined:
            self.note("the sweep is drawn row by row, without bounds: its coefficients are not of one parameter; --csv "
                      "has the bounds")
        self.drawn.add("sweep", pictures.sweep_picture(self.look, result))
        if sweep.slope is not None and np.any(sweep.slope[sweep.converged]):
            self.drawn.add("sweep-slope", pictures.slope_picture(self.look, result))
        told = "interfaces that can open drawn with their contact; --interface NAME chooses another"
        for index in self.first(self.opening, told) if self.asked is None else [self.asked]:
            if (sweep.contact_nodes[:, 0] == index).any():
                self.drawn.add("sweep-contact" + (f"-{index + 1}" if index else ""),
                               pictures.contact_picture(self.look, result, index))


def draw_figures(result: Result, folder: str, wanted: Wanted, look: Look) -> Made:
    """Draws LOAD-membrane, LOAD-plan, LOAD-traces (-2 and so on for further interfaces), LOAD-convergence,
    LOAD-accuracy, LOAD-growth, LOAD-growth-ROW of membranes that are kept and the overview LOAD for every load with
    traces; for a sweep, sweep, sweep-slope, sweep-contact and the traces of kept rows. Makes the folder. Raises Error
    if it cannot be written or a name does not exist."""
    drawing = _Drawing(result, folder, wanted, look)
    output.make_folder(folder)
    with look.applied():
        if result.sweep is None:
            drawing.draw_loads()
        elif not wanted.loads:
            drawing.draw_sweep()
        else:
            for load in drawing.loads:
                drawing.draw_traces(load, load.name)
    return drawing.drawn


def draw_together(result: Result, folder: str, wanted: Wanted, look: Look) -> Made:
    """Draws "together": [u], u-, u+ and the contact pressure of the first eight loads with traces on one interface."""
    drawing = _Drawing(result, folder, wanted, look)
    loads = [load for load in drawing.loads if load.traces]
    if not loads or not result.interfaces:
        raise Error("no load has traces of an interface: nothing to draw together")
    output.make_folder(folder)
    if len(loads) > _TOGETHER:
        drawing.note(f"the first {_TOGETHER} of {len(loads)} loads drawn together; choose others with --load")
        loads = loads[:_TOGETHER]
    with look.applied():
        drawing.drawn.add("together", pictures.together_picture(look, result, loads, drawing.eventful(loads)[1]))
    return drawing.drawn


def draw_mesh(plan: Plan, folder: str, look: Look) -> Made:
    """Draws the picture "mesh-ID" of a mesh."""
    drawn = Made(folder)
    output.make_folder(folder)
    with look.applied():
        files, notes = pictures.mesh_picture(look, plan)
    drawn.add(output.stems(["mesh-" + plan.message.name.removeprefix("meshes/")], [])[0], files)
    drawn.notes += notes
    return drawn
