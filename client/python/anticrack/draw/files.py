# SPDX-License-Identifier: GPL-3.0-or-later
"""Which figures of a result are drawn, and their files."""
from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from .. import output
from ..errors import Error
from ..result import Load, Result
from ..text import harmless, suggestion
from . import pictures
from .along import can_open, eventful
from .history import bounded
from .meshes import Plan
from .sheet import Look
from .sweeps import Rows

FIGURES = ("overview", "membrane", "plan", "traces", "convergence", "accuracy")
_MANY = 12  # more loads, rows and interfaces are drawn where they are asked for
_TOGETHER = 8  # loads over each other


@dataclass
class Wanted:
    """only: of FIGURES, none: all that have something to show; interface: the one of the traces, the overview and
    together, empty: the most eventful, and traces of all that can open; loads: names, none: the first twelve; all: of
    loads and interfaces, however many."""
    only: list[str] = field(default_factory=list)
    interface: str = ""
    loads: list[str] = field(default_factory=list)
    all: bool = False

    def has(self, figure: str) -> bool:
        return not self.only or figure in self.only


@dataclass
class Drawn:
    """files: in the order of the loads; notes: what was left out and why."""
    files: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


class _Folder:
    """Each file is written whole or not at all."""

    def __init__(self, path: str) -> None:
        output.make_folder(path)
        self.path, self.drawn = path, Drawn()

    def add(self, stem: str, files: dict[str, bytes]) -> None:
        for kind, content in files.items():
            file = os.path.join(self.path, f"{stem}.{kind}")
            output.write(file, content)
            self.drawn.files.append(file)

    def note(self, text: str) -> None:
        self.drawn.notes.append(text)


def stems(names: Iterable[str], suffixes: list[str]) -> list[str]:
    """A name of a file for each: [A-Za-z0-9][A-Za-z0-9_.-]*. No two of them, with any of the suffixes or none, are
    equal, in upper or lower case."""
    taken: set[str] = set()
    found = []
    for name in names:
        base = re.sub("[^A-Za-z0-9.-]", "_", name)
        base = base if re.match("[A-Za-z0-9]", base) else f"load{base}"
        stem, copy = base, 2
        while taken & (files := {(stem + suffix).lower() for suffix in ("", *suffixes)}):
            stem, copy = f"{base}-{copy}", copy + 1
        taken |= files
        found.append(stem)
    return found


def _traces_suffix(index: int) -> str:
    return "-traces" if index == 0 else f"-traces-{index + 1}"


class _Choice:
    """Of the loads and interfaces of a result."""

    def __init__(self, result: Result, wanted: Wanted) -> None:
        self.result, self.wanted = result, wanted
        names = [line.name for line in result.interfaces]
        if wanted.interface and wanted.interface not in names:
            raise Error(f"there is no interface {harmless(wanted.interface)}; {suggestion(wanted.interface, names)}")
        self.asked = names.index(wanted.interface) if wanted.interface else None
        self.opening = [i for i, line in enumerate(result.interfaces) if can_open(line)]
        for name in wanted.loads:
            if name not in result.loads:
                cure = suggestion(name, result.loads) if result.loads else (
                    "it keeps traces of no row; run the sweep with --traces")
                raise Error(f"there is no load {harmless(name)}; {cure}")
        self.loads = [result.loads[name] for name in wanted.loads] or list(result.loads.values())

    @property
    def chooses(self) -> bool:
        """Whether of the interfaces that can open only the most eventful is drawn."""
        return (not self.wanted.all and self.asked is None and "traces" not in self.wanted.only
                and len(self.opening) > _MANY)

    def eventful(self, loads: list[Load]) -> tuple[int, int]:
        return (self.asked, self.asked) if self.asked is not None else eventful(self.result, loads)

    def traces(self, load: Load) -> list[int]:
        if self.asked is not None:
            return [self.asked]
        return sorted(set(self.eventful([load]))) if self.chooses else self.opening

    def first(self, what: str, other: str, folder: _Folder) -> list[Load]:
        if self.wanted.all or self.wanted.loads or len(self.loads) <= _MANY:
            return self.loads
        folder.note(f"the first {_MANY} of {len(self.loads)} {what} drawn; --load {other} chooses others, --all draws "
                    "all")
        return self.loads[:_MANY]


def draw_figures(result: Result, folder: str, wanted: Wanted, look: Look) -> Drawn:
    """Of every load with traces LOAD-membrane, LOAD-plan, LOAD-traces (-2 and so on of further interfaces),
    LOAD-convergence, LOAD-accuracy and LOAD, an overview; of a sweep sweep, sweep-slope, sweep-contact and the traces
    of rows that were kept. The folder is made. Raises Error where it cannot be written or a name is not there."""
    choice = _Choice(result, wanted)
    into = _Folder(folder)
    with look.applied():
        if result.sweep is not None and not wanted.loads:
            _draw_sweep(choice, into, look)
        elif result.sweep is not None:
            for load in choice.loads:
                _draw_traces(choice, load, load.name, into, look)
        else:
            _draw_loads(choice, into, look)
    return into.drawn


def _draw_loads(choice: _Choice, into: _Folder, look: Look) -> None:
    suffixes = ["-membrane", "-plan", "-convergence", "-accuracy",
                *(_traces_suffix(i) for i in range(len(choice.result.interfaces)))]
    names = dict(zip((load.name for load in choice.loads), stems((load.name for load in choice.loads), suffixes)))
    for load in choice.first("loads", "NAME", into):
        _draw_load(choice, load, names[load.name], into, look)
    _note_interfaces(choice, into)
    fewest = 2 if "convergence" in choice.wanted.only else 3
    few = sum(1 for load in choice.loads if load.traces and _steps(load) < fewest)
    if few and choice.wanted.has("convergence"):
        how = ("a single step: no convergence is drawn" if fewest == 2 else
               "one or two steps: no convergence is drawn; --only convergence draws that of two")
        into.note(f"{few} load{' was' if few == 1 else 's were'} solved in {how}")


def _steps(load: Load) -> int:
    return len(load.history["iteration"]) if load.history else 0


def _draw_load(choice: _Choice, load: Load, stem: str, into: _Folder, look: Look) -> None:
    result, wanted = choice.result, choice.wanted
    if not load.traces and (result.interfaces or not load.fields):
        into.note(f'load "{harmless(load.name)}" has no traces ({load.status.replace("_", " ")}): nothing to draw')
        return
    if any(map(wanted.has, ("overview", "membrane", "plan"))):
        if not load.fields:
            into.note(f'load "{harmless(load.name)}": no membrane and no plan drawn, it has no fields; to have them: '
                      f"{_fields_cure(result)}")
        else:
            if wanted.has("overview") and result.interfaces:
                into.add(stem, pictures.overview_picture(look, result, load, *choice.eventful([load])))
            for figure in filter(wanted.has, ("membrane", "plan")):
                into.add(f"{stem}-{figure}", pictures.picture(figure, look, result, load))
    _draw_traces(choice, load, stem, into, look)
    if wanted.has("convergence") and _steps(load) >= (2 if "convergence" in wanted.only else 3):
        into.add(f"{stem}-convergence", pictures.picture("convergence", look, result, load))
    if not wanted.has("accuracy"):
        return
    if len(bounded(load)["triangles"]) > 1:
        into.add(f"{stem}-accuracy", pictures.accuracy_picture(look, result, load))
    elif load.stages or "accuracy" in wanted.only:
        into.note(f'load "{harmless(load.name)}": no accuracy drawn, fewer than two stages have bounds')


def _draw_traces(choice: _Choice, load: Load, stem: str, into: _Folder, look: Look) -> None:
    if not choice.wanted.has("traces") or not load.traces:
        return
    for index in choice.traces(load):
        into.add(stem + _traces_suffix(index), pictures.traces_picture(look, choice.result, load, index))


def _fields_cure(result: Result) -> str:
    return (f"anticrack job fetch {harmless(result.job)} --fields -o fields.h5, while the server keeps the job; else "
            "run the case again with [output] fields = true")


def _note_interfaces(choice: _Choice, into: _Folder) -> None:
    """What is left out of them."""
    if not choice.wanted.has("traces"):
        return
    if choice.chooses:
        into.note(f"of {len(choice.opening)} interfaces that can open the most eventful is drawn; --all draws the "
                  "traces of each, --interface NAME those of one")
    closed = [line.name for i, line in enumerate(choice.result.interfaces) if i not in choice.opening]
    if closed and choice.asked is None:
        count = ("an interface is glued or bonded all along and has" if len(closed) == 1 else
                 f"{len(closed)} interfaces are glued or bonded all along and have")
        into.note(f"{count} no traces drawn; --interface {harmless(closed[0])} draws them")


def _draw_sweep(choice: _Choice, into: _Folder, look: Look) -> None:
    result, sweep = choice.result, choice.result.sweep
    assert sweep is not None
    if not choice.wanted.only and not sweep.converged.any():
        into.note("no row of the sweep converged: nothing to draw of it")
    elif not choice.wanted.only:
        if sweep.displacement_lower is not None and not Rows(sweep).joined:
            into.note("the sweep is drawn row by row, without bounds: its coefficients are not of one parameter; --csv "
                      "has the bounds")
        into.add("sweep", pictures.sweep_picture(look, result))
        if sweep.slope is not None and np.any(sweep.slope[sweep.converged]):
            into.add("sweep-slope", pictures.slope_picture(look, result))
        for index in _maps(choice, into):
            if (sweep.contact_nodes[:, 0] == index).any():
                into.add("sweep-contact" + (f"-{index + 1}" if index else ""),
                         pictures.contact_picture(look, result, index))
    for load in choice.first("rows with traces", "row-K", into):
        _draw_traces(choice, load, load.name, into, look)
    if choice.loads:
        _note_interfaces(choice, into)


def _maps(choice: _Choice, into: _Folder) -> list[int]:
    """The interfaces of a sweep on which it is drawn where they are closed."""
    if choice.asked is not None:
        return [choice.asked]
    if choice.wanted.all or len(choice.opening) <= _MANY:
        return choice.opening
    into.note(f"contact is drawn on the first {_MANY} of {len(choice.opening)} interfaces that can open; --interface "
              "NAME chooses another, --all draws all")
    return choice.opening[:_MANY]


def draw_together(result: Result, folder: str, wanted: Wanted, look: Look) -> Drawn:
    """"together": [u], u-, u+ and the contact pressure of the loads with traces, the first eight, on one interface."""
    choice = _Choice(result, wanted)
    loads = [load for load in choice.loads if load.traces]
    if not loads or not result.interfaces:
        raise Error("no load has traces of an interface: nothing to draw together")
    into = _Folder(folder)
    if len(loads) > _TOGETHER:
        into.note(f"the first {_TOGETHER} of {len(loads)} loads drawn together; choose others with --load")
        loads = loads[:_TOGETHER]
    with look.applied():
        into.add("together", pictures.together_picture(look, result, loads, choice.eventful(loads)[1]))
    return into.drawn


def draw_mesh(plan: Plan, folder: str, look: Look) -> Drawn:
    """"mesh-ID" of a mesh."""
    into = _Folder(folder)
    with look.applied():
        files, notes = pictures.mesh_picture(look, plan)
    into.add(stems(["mesh-" + plan.message.name.removeprefix("meshes/")], [])[0], files)
    into.drawn.notes += notes
    return into.drawn
