# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a result as tables, with their units and meanings."""
from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from aiohttp import web

from .. import entries
from ..result import Result, Sweep
from ..study.record import Study
from ..v1 import solve_pb2
from .opened import FILE, Opened
from .gate import reply

Column = tuple[str, str, str, list[Any]]  # name, unit, meaning, values


def _known(value: Any) -> bool:
    return value != "" and not (isinstance(value, float) and math.isnan(value))


def _columns(result: Result, message: Any, names: list[str], values: dict[str, list[Any]]) -> Iterator[Column]:
    """The columns that have a value, with unit and meaning of the message's fields."""
    known = entries.entries_of(message.DESCRIPTOR)
    for name in names:
        if any(map(_known, values[name])):
            meaning, unit = entries.meaning_of(known[name][1]) if name in known else ("", "")
            yield name, result.units.of(unit), meaning, values[name]


def _of_parts(result: Result, message: Any, parts: str) -> list[Column]:
    """A row for each part of each load; "" for the loads themselves."""
    rows = [(load.name, part) for load in result.loads.values() for part in (
        (load,) if not parts else getattr(getattr(load, parts), "values", getattr(load, parts).__iter__)())]
    names = [name for name in entries.defaults_of(message) if not rows or hasattr(rows[0][1], name)]
    values = {name: [getattr(part, name) for _, part in rows] for name in names}
    first = [("load case", "-", "", [name for name, _ in rows])] if parts else []
    return [*first, *_columns(result, message, names, values)]


def _of_arrays(result: Result, messages: Sequence[Any], what: str) -> list[Column]:
    """A row for each entry of a load's arrays, such as those of stages."""
    loads = [(load.name, getattr(load, what)) for load in result.loads.values() if getattr(load, what)]
    names = list(loads[0][1]) if loads else []
    counts = [len(arrays[names[0]]) for _, arrays in loads]
    told = [name for (name, _), count in zip(loads, counts) for _ in range(count)]
    columns: list[Column] = [("load case", "-", "", told)]
    for message in messages:
        own = [name for name in names if name in entries.entries_of(message.DESCRIPTOR)]
        columns += _columns(result, message, own, {
            name: [value for _, arrays in loads for value in arrays[name].tolist()] for name in own})
    return columns


def _of_sweep(result: Result, sweep: Sweep) -> list[Column]:
    """A row for each row, as Sweep.frame has it."""
    found = {"row": np.arange(len(sweep.status)), **sweep.columns()}
    return [(name, "-" if name in sweep.loads else result.units.of_column(name), "", np.asarray(values).tolist())
            for name, values in found.items()]


def tables_of_study(study: Study) -> dict[str, list[Column]]:
    """A row for each row and load, as Study.frame has it."""
    lines = study.lines()
    return {"sweep": [(name, study.units.of_column(name) if name in study.columns else "-", "",
                       [line.get(name) for line in lines]) for name in lines[0]]}


def tables_of(result: Result) -> dict[str, list[Column]]:
    """The tables that have rows, by their names."""
    answer = solve_pb2.LoadCaseAnswer
    found = {"loads": _of_parts(result, answer(), "")}
    for what, name, message in (("inclusions", "inclusions", solve_pb2.InclusionAnswer()),
                                ("tips", "tips", solve_pb2.Tip()),
                                ("boundary", "boundary", solve_pb2.BoundaryAnswer()),
                                ("probes", "probe_points", solve_pb2.ProbeAnswer())):
        found[what] = _of_parts(result, message, name)
    found["stages"] = _of_arrays(result, (solve_pb2.Stage(), solve_pb2.StageAnswer()), "stages")
    found["growth"] = _of_arrays(result, (solve_pb2.GrowthRow(),), "growth")
    if result.sweep is not None:
        found = {"sweep": _of_sweep(result, result.sweep)} | found
    return {name: columns for name, columns in found.items() if columns and columns[0][3]}


def csv_of(columns: list[Column]) -> str:
    """The rows with a head; a unit stands behind its column's name. A text that a spreadsheet would take for a formula
    has a ' before it."""
    def cell(value: Any) -> Any:
        if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t", "\r"):
            return "'" + value
        return repr(value) if isinstance(value, float) else value
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([cell(name if unit == "-" else f"{name} [{unit}]") for name, unit, _, _ in columns])
    writer.writerows([cell(value) for value in row] for row in zip(*(values for *_, values in columns)))
    return out.getvalue()


def add_routes(app: web.Application, opened: Opened) -> None:
    async def of(name: str) -> dict[str, list[Column]]:
        study = opened.study if name == FILE else None
        return tables_of(await opened.result(name)) if study is None else tables_of_study(study)

    async def tables(request: web.Request) -> web.Response:
        found = await of(request.query["of"])
        return reply([{"name": name, "columns": [{"name": head, "unit": unit, "meaning": meaning, "values": values}
                                                 for head, unit, meaning, values in columns]}
                      for name, columns in found.items()])

    async def as_csv(request: web.Request) -> web.Response:
        name = request.query["table"]
        columns = (await of(request.query["of"]))[name]
        return web.Response(text=csv_of(columns), content_type="text/csv", headers={
            "Content-Disposition": f'attachment; filename="{name}.csv"'})
    app.add_routes([web.get("/api/tables", tables), web.get("/api/csv", as_csv)])
