# SPDX-License-Identifier: GPL-3.0-or-later
"""A result as the page draws it: what there is, as JSON, and arrays as little-endian buffers."""
from __future__ import annotations

import asyncio
import functools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from aiohttp import web

from ..arrays import Array
from ..notes import notes_on
from ..result import CRACK, DELAMINATED, FREE, KKT, Load, Result, Units, fields_cure, joined
from ..study.record import Study
from ..text import with_bounds
from ..vtk import of_triangles
from .opened import FILE, Opened, load_of
from .gate import reply

TRACES = ("u_minus", "u_plus", "jump", "pressure", "flux", "force", "contact")
HISTORY = ("iteration", "criterion", "energy", "contact_count", *(f"kkt_{name}" for name in KKT))
_STAGES = ("triangles", "energy", "energy_lower", "energy_upper", "displacement_error")
_MOVING = 60_000  # triangles of the thinned mesh, about
_KEPT = 3  # surfaces in memory
_OPENS = (CRACK, DELAMINATED, FREE)


class Surface:
    """A surface of triangles. nodes (n): of the mesh; part (n): the subdomain; points (n, 2); triangles (m, 3): indices
    into nodes."""
    known, range = list[str](), ""

    def __init__(self, points: Array, triangles: Array, nodes: Array | None = None, part: Array | None = None) -> None:
        self.nodes = np.arange(len(points)) if nodes is None else nodes
        self.part = np.zeros(len(points), np.int32) if part is None else part
        self.points, self.triangles = points[self.nodes], triangles

    @functools.cached_property
    def thinned(self) -> tuple[Array, Array]:
        """(k) points that are kept, (t, 3) some 60,000 triangles of them: nodes of a cell of a grid become one, except
        those of slits, whose faces would close; triangles with two corners in a cell vanish."""
        low, size = self.points.min(axis=0), np.ptp(self.points, axis=0).max()
        cells = int((_MOVING / 2) ** 0.5)
        column, row = (np.minimum((self.points - low) / size * cells, cells - 1)).astype(np.int64).T
        cluster = (self.part.astype(np.int64) * cells + row) * cells + column
        copy = self.nodes.astype(np.int64) * (int(self.part.max()) + 1) + self.part
        slit = np.flatnonzero(np.bincount(copy)[copy] > 1)
        cluster[slit] = -1 - slit
        _, first, cluster = np.unique(cluster, return_index=True, return_inverse=True)
        found = first[cluster][self.triangles]
        a, b, c = found.T
        kept, corners = np.unique(found[(a != b) & (b != c) & (c != a)], return_inverse=True)
        return kept, corners.reshape(-1, 3)

    def of_nodes(self, what: str) -> Array:
        raise KeyError(what)

    def array(self, what: str, thin: bool) -> Array:
        """The points or triangles, their outline, or values at the points; thin: of fewer triangles."""
        if what in ("triangles", "outline"):
            triangles = self.thinned[1] if thin else self.triangles
            return triangles if what == "triangles" else outline_of(triangles)
        values = self.points if what == "points" else self.of_nodes(what)
        return values[self.thinned[0]] if thin else values  # type: ignore[no-any-return]


def outline_of(triangles: Array) -> Array:
    """(e, 2) edges of one triangle only: the boundary, and both faces of interfaces."""
    low, high = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64), axis=1).T
    edges, counts = np.unique(low << 32 | high, return_counts=True)  # as one number: rows take 8 times as long
    found = edges[counts == 1]
    return np.stack((found >> 32, found & 0xFFFFFFFF), axis=1)


class Values(Surface):
    """The membrane of a load. Without fields it is the mesh, and nothing is known on it."""

    def __init__(self, result: Result, load: Load) -> None:
        self.result, self.load, mesh, parts = result, load, result.mesh, list(load.fields)
        nodes, part, triangles = joined(parts) if parts else (None, None, mesh.triangles)
        super().__init__(mesh.nodes, triangles, nodes, part)
        self.known, self._lately = colours_of(load), ("", np.empty(0))

    def _joined(self, what: str) -> Array:
        return np.concatenate([getattr(part, what) for part in self.load.fields])

    @functools.cached_property
    def areas(self) -> Array:
        return self._joined("areas")

    def of_triangles(self, what: str) -> Array:
        """(m) |T grad u|, the density of energy, or the error indicator over the area"""
        if what != "indicator":
            values = self._joined(what)
            return np.hypot(*values.T) if what == "flux" else values  # type: ignore[no-any-return]
        assert self.load.indicator is not None
        values = of_triangles(self.result.mesh, self.load.indicator, self.nodes[self.triangles])
        return np.divide(values, self.areas, out=np.zeros_like(values), where=self.areas > 0)

    def of_nodes(self, what: str) -> Array:
        """(n) u, or the means of the triangles at a node, weighted by area. `range` then has least, largest, and
        the value above which there are 2 % of the area, around tips, whose colours would hide all else."""
        if self._lately[0] != what:
            if what not in self.known:
                raise KeyError(what)
            values, cut = (self._joined("u"), math.inf) if what == "u" else self._means(what)
            ends = values[np.isfinite(values)]
            self.range = f"{ends.min()} {ends.max()} {min(cut, ends.max())}" if ends.size else ""
            self._lately = what, values
        return self._lately[1]

    def _means(self, what: str) -> tuple[Array, float]:
        values, areas = self.of_triangles(what), self.areas
        order = np.argsort(values)
        cut = values[order[np.searchsorted(np.cumsum(areas[order]), 0.98 * areas.sum())]]

        def summed(of: Array) -> Array:
            return np.bincount(self.triangles.ravel(), np.repeat(of, 3), len(self.nodes))
        around = summed(areas)
        return np.divide(summed(areas * values), around, out=np.zeros_like(around), where=around > 0), float(cut)


def colours_of(load: Load) -> list[str]:
    return ["u", "flux", "energy_density", *["indicator"] * (load.indicator is not None)] if load.fields else []


def _told(result: Result, load: Load) -> dict[str, Any]:
    units = result.units
    return {"name": load.name, "status": load.status, "reason": load.reason, "error": load.error,
            "warnings": load.warnings[:50], "no_bracket": load.no_bracket, "colours": colours_of(load),
            "steps": len(load.history.get("iteration", ())), "traces": len(load.traces),
            "energy": with_bounds(load, "energy", units.behind("F L")), "growth_notes": load.growth_notes,
            "growth": [[float(x), float(y)] for x, y in zip(load.growth["x"], load.growth["y"])] if load.growth else [],
            "contacts": load.contact_intervals, "contact_length": load.contact_length, "iterations": load.iterations,
            "inclusions": [{"name": part.name, "A": with_bounds(part, "A", units.behind("L"))}
                           for part in load.inclusions.values()],
            "stages": {name: load.stages[name].tolist() for name in _STAGES if name in load.stages}}


def _marks(result: Result) -> list[dict[str, Any]]:
    """The names of inclusions and cracks, each in the middle of its edges."""
    found: dict[str, list[tuple[float, float]]] = {}
    for line in result.interfaces:
        x, y = (line.x[1:] + line.x[:-1]) / 2, (line.y[1:] + line.y[:-1]) / 2
        for index in np.unique(line.edge_inclusion):
            own = (line.edge_inclusion == index) & ((index >= 0) | np.isin(line.edge_kind, (CRACK, FREE)))
            if own.any():
                name = result.mesh.inclusions[index] if index >= 0 else line.name
                found.setdefault(name, []).extend(zip(x[own].tolist(), y[own].tolist()))
    return [{"name": name, "at": places[len(places) // 2]} for name, places in found.items()]


def described(result: Result, case: str) -> dict[str, Any]:
    mesh, loads, sweep = result.mesh, list(result.loads.values()), result.sweep
    return {"title": result.title, "job": result.job, "units": _units(result.units), "case": case or result.case,
            "triangles": len(mesh.triangles), "nodes": len(mesh.nodes), "not_reached": result.not_reached,
            "notes": notes_on(result), "warnings": list(mesh.info.warnings), "marks": _marks(result),
            "cure": fields_cure(result) if any(not load.fields for load in loads) else "",
            "loads": [_told(result, load) for load in loads], "tips": [[tip.at.x, tip.at.y] for tip in mesh.info.tips],
            "interfaces": [{"name": line.name, "nodes": len(line.s),
                            "opens": bool(np.isin(line.edge_kind, _OPENS).any())} for line in result.interfaces],
            "sweep": None if sweep is None else {"loads": sweep.loads, "rows": len(sweep.status), "kept": sweep.kept,
                                                 "converged": int(sweep.converged.sum())}}


def described_study(study: Study) -> dict[str, Any]:
    """A study, as a sweep without loads: its rows have jobs, one for each line of its table."""
    empty: dict[str, list[Any]] = {name: [] for name in ("notes", "warnings", "marks", "loads", "tips", "interfaces")}
    return empty | {"title": study.title, "units": _units(study.units), "case": study.case, "sweep": {
        "loads": study.varying() or study.keys, "rows": len(study.rows), "converged": int(study.converged.sum()),
        "jobs": [line["job"] for line in study.lines()]}}


def _units(units: Units) -> dict[str, str]:
    return {dimension: units.of(dimension) for dimension in ("L", "F", "F/L", "F L")}


def _of_lines(result: Result, load: Load, what: str, interface: int) -> Array:
    """The shape of an interface, its traces, or the history of the load."""
    if what == "line":
        line = result.interfaces[interface]
        return np.stack((line.s, line.x, line.y, np.append(line.edge_kind, 0)))
    if what == "trace":
        return np.stack([getattr(load.traces[interface], name) for name in TRACES])
    return np.stack([load.history[name] for name in HISTORY])


def triangle(result: Result, load: Load, index: int) -> dict[str, Any]:
    """What is known in a triangle of the surface."""
    if not 0 <= index < len(result.mesh.triangles):
        raise IndexError(f"there is no triangle {index}")
    for part in load.fields:
        if index < len(part.triangles):
            own = replace(part, triangles=part.triangles[[index]], tension=part.tension[[index]])
            own.mesh = result.mesh
            alone = Values(result, replace(load, fields=[own]))
            return {"nodes": part.nodes[own.triangles[0]].tolist(), "subdomain": part.name, **{
                what: float(alone.of_triangles(what)[0]) for what in alone.known[1:]}}
        index -= len(part.triangles)
    return {"nodes": result.mesh.triangles[index].tolist(), "subdomain": ""}


def add_routes(app: web.Application, opened: Opened) -> None:
    async def describe(request: web.Request) -> web.Response:
        name = request.query["of"]
        if name == FILE and opened.study is not None:
            return reply(described_study(opened.study))
        result = await opened.result(name)
        return reply(await asyncio.to_thread(described, result, opened.cases.get(name, "")))

    kept: list[tuple[Any, Surface]] = []  # of the loads and meshes that were asked for lately
    one = asyncio.Lock()  # many large arrays at once would take much memory

    def surface_of(of: Any, make: Callable[..., Surface], *words: Any) -> Surface:
        found = next((each for each in kept if each[0] is of), None) or (of, make(*words))
        kept[:] = [found, *(each for each in kept if each is not found)][:_KEPT]
        return found[1]

    async def send(request: web.Request) -> web.Response:
        query, what, headers = request.query, request.query["what"], dict[str, str]()
        if "mesh" in query:
            mesh = await opened.mesh(query["mesh"])
            given: tuple[Any, ...] = mesh, Surface, mesh["nodes"], mesh["triangles"]
        else:
            result, load = await load_of(opened, query)
            given = load, Values, result, load
        if what in ("line", "trace", "history") and "mesh" not in query:
            values = _of_lines(result, load, what, int(query.get("interface", 0)))
        else:
            async with one:
                surface = await asyncio.to_thread(surface_of, *given)
                values = await asyncio.to_thread(surface.array, what, "thin" in query)
                headers["X-Range"] = surface.range if what in surface.known else ""
        headers["X-Array"] = kind = "i4" if values.dtype.kind in "iu" else "f8"
        return web.Response(body=np.ascontiguousarray(values, "<" + kind).tobytes(), headers=headers,
                            content_type="application/octet-stream")

    async def pick(request: web.Request) -> web.Response:
        load = await load_of(opened, request.query)
        return reply(await asyncio.to_thread(triangle, *load, int(request.query["index"])))
    app.add_routes([web.get("/api/result", describe), web.get("/api/array", send), web.get("/api/triangle", pick)])
