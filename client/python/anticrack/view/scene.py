# SPDX-License-Identifier: GPL-3.0-or-later
"""A result as the page draws it: what there is, as JSON, and arrays as little-endian buffers."""
from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
from aiohttp import web

from ..arrays import Array
from ..notes import notes_on
from ..result import CRACK, DELAMINATED, FREE, KKT, Load, Result, fields_cure
from ..text import with_bounds
from ..vtk import of_triangles
from .opened import Opened, load_of
from .reply import reply

TRACES = ("u_minus", "u_plus", "jump", "pressure", "flux", "force", "contact")
HISTORY = ("iteration", "criterion", "energy", "contact_count", *(f"kkt_{name}" for name in KKT))
_MOVING = 60_000  # triangles of the thinned mesh, about
_OPENS = (CRACK, DELAMINATED, FREE)


class Surface:
    """All subdomains together; the faces of an open crack have nodes of their own. nodes (n): of the mesh; part (n):
    the subdomain; triangles (m, 3): indices into nodes. Without fields it is the mesh, and u is not known."""

    def __init__(self, result: Result, load: Load) -> None:
        self.result, self.load, parts = result, load, load.fields
        if parts:
            first = np.cumsum([0, *(len(part.nodes) for part in parts)])
            self.nodes = np.concatenate([part.nodes for part in parts])
            self.part = np.repeat(np.arange(len(parts)), np.diff(first))
            self.triangles = np.concatenate([part.triangles + start for part, start in zip(parts, first)])
        else:
            self.nodes, self.triangles = np.arange(len(result.mesh.nodes)), result.mesh.triangles
            self.part = np.zeros(len(self.nodes), int)

    @property
    def points(self) -> Array:
        return self.result.mesh.nodes[self.nodes]  # type: ignore[no-any-return]

    def of_triangles(self, what: str) -> Array:
        """(m) |T grad u|, the density of energy, or the error indicator over the area"""
        parts = list(self.load.fields)
        if what == "flux":
            return np.hypot(*np.concatenate([part.flux for part in parts]).T)  # type: ignore[no-any-return]
        if what == "energy_density":
            return np.concatenate([part.energy_density for part in parts])
        assert self.load.indicator is not None
        areas = np.concatenate([part.areas for part in parts])
        values = of_triangles(self.result.mesh, self.load.indicator, self.nodes[self.triangles])
        return np.divide(values, areas, out=np.zeros_like(areas), where=areas > 0)

    def of_nodes(self, what: str) -> Array:
        """(n) u, or the means of the triangles at a node, weighted by area"""
        if what == "u":
            return np.concatenate([part.u for part in self.load.fields])
        areas = np.concatenate([part.areas for part in self.load.fields])

        def summed(values: Array) -> Array:
            return np.bincount(self.triangles.ravel(), np.repeat(values, 3), len(self.nodes))
        around = summed(areas)
        return np.divide(summed(areas * self.of_triangles(what)), around, out=np.zeros_like(around), where=around > 0)

    def outline(self) -> Array:
        """(e, 2) edges of one triangle only: the boundary, and both faces of interfaces"""
        edges = np.sort(self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
        found, counts = np.unique(edges[:, 0] * len(self.nodes) + edges[:, 1], return_counts=True)
        once = found[counts == 1]
        return np.column_stack((once // len(self.nodes), once % len(self.nodes)))

    def thinned(self) -> Array:
        """(k, 3) some 60,000 triangles: nodes of a cell of a grid become one, except those of slits, whose faces would
        close; triangles with two corners in a cell vanish."""
        low, size = self.points.min(axis=0), np.ptp(self.points, axis=0).max()
        cells = int((_MOVING / 2) ** 0.5)
        column, row = (np.minimum((self.points - low) / size * cells, cells - 1)).astype(np.int64).T
        cluster = (self.part * cells + row) * cells + column
        _, copy, count = np.unique(self.nodes * (self.part.max() + 1) + self.part, return_inverse=True,
                                   return_counts=True)
        slit = np.flatnonzero(count[copy] > 1)
        cluster[slit] = -1 - slit
        _, first, cluster = np.unique(cluster, return_index=True, return_inverse=True)
        found = first[cluster][self.triangles]
        a, b, c = found.T
        return found[(a != b) & (b != c) & (c != a)]  # type: ignore[no-any-return]


def _colours(load: Load) -> list[str]:
    if not load.fields:
        return []
    return ["u", "flux", "energy_density", *["indicator"] * (load.indicator is not None)]


def _told(result: Result, load: Load) -> dict[str, Any]:
    units = result.units
    return {"name": load.name, "status": load.status, "reason": load.reason, "error": load.error,
            "warnings": load.warnings[:50], "no_bracket": load.no_bracket, "colours": _colours(load),
            "steps": len(load.history.get("iteration", ())), "traces": len(load.traces),
            "energy": with_bounds(load, "energy", units.behind("F L")), "growth_notes": load.growth_notes,
            "growth": [[float(x), float(y)] for x, y in zip(load.growth["x"], load.growth["y"])] if load.growth else [],
            "contact_length": load.contact_length, "iterations": load.iterations, "kkt": load.kkt,
            "inclusions": [{"name": part.name, "A": with_bounds(part, "A", units.behind("L")),
                            "resultant": part.resultant} for part in load.inclusions.values()],
            "stages": {name: load.stages[name].tolist() for name in ("triangles", "energy", "energy_lower",
                                                                     "energy_upper", "displacement_error")
                       if name in load.stages}}


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
    units = {dimension: result.units.of(dimension) for dimension in ("L", "F", "F/L", "F L", "F/L^2")}
    low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    return {"title": result.title, "job": result.job, "units": units, "case": case or result.case,
            "triangles": len(mesh.triangles), "nodes": len(mesh.nodes), "low": low.tolist(), "high": high.tolist(),
            "not_reached": result.not_reached, "notes": notes_on(result), "moving": _MOVING,
            "cure": fields_cure(result) if any(not load.fields for load in loads) else "",
            "warnings": list(mesh.info.warnings), "server": result.server_version,
            "loads": [_told(result, load) for load in loads], "marks": _marks(result),
            "tips": [[tip.at.x, tip.at.y] for tip in mesh.info.tips],
            "interfaces": [{"name": line.name, "nodes": len(line.s),
                            "opens": bool(np.isin(line.edge_kind, _OPENS).any())} for line in result.interfaces],
            "sweep": None if sweep is None else {"loads": sweep.loads, "rows": len(sweep.status), "kept": sweep.kept,
                                                 "converged": int(sweep.converged.sum())}}


def array(result: Result, load: Load, what: str, interface: int) -> Array:
    """The values of a name that the page may ask for. Raises KeyError."""
    if what == "line":
        line = result.interfaces[interface]
        return np.stack((line.s, line.x, line.y, np.append(line.edge_kind, 0)))
    if what == "trace":
        return np.stack([getattr(load.traces[interface], name) for name in TRACES])
    if what == "history":
        return np.stack([load.history[name] for name in HISTORY])
    surface = Surface(result, load)
    if what in ("points", "triangles", "thinned", "outline", "nodes"):
        found = getattr(surface, what)
        return np.asarray(found() if callable(found) else found)
    if what in _colours(load):
        return surface.of_nodes(what)
    raise KeyError(what)


def triangle(result: Result, load: Load, index: int) -> dict[str, Any]:
    """What is known in a triangle of the surface."""
    surface = Surface(result, load)
    if not 0 <= index < len(surface.triangles):
        raise IndexError(f"there is no triangle {index}")
    corners = surface.nodes[surface.triangles[index]]
    return {"nodes": corners.tolist(), "subdomain": result.mesh.subdomain_names[int(surface.part[
        surface.triangles[index][0]])] if load.fields else "",
            **{what: float(surface.of_triangles(what)[index]) for what in _colours(load) if what != "u"}}


def add_routes(app: web.Application, opened: Opened) -> None:
    async def describe(request: web.Request) -> web.Response:
        name = request.query["of"]
        result = await opened.result(name)
        return reply(await asyncio.to_thread(described, result, opened.cases.get(name, "")))

    async def send(request: web.Request) -> web.Response:
        what, index = request.query["what"], int(request.query.get("interface", 0))
        values = await asyncio.to_thread(array, *await load_of(opened, request.query), what, index)
        kind = "i4" if values.dtype.kind in "iu" else "f8"
        return web.Response(body=np.ascontiguousarray(values, "<" + kind).tobytes(), headers={"X-Array": kind},
                            content_type="application/octet-stream")

    async def pick(request: web.Request) -> web.Response:
        load = await load_of(opened, request.query)
        return reply(await asyncio.to_thread(triangle, *load, int(request.query["index"])))
    app.router.add_get("/api/result", describe)
    app.router.add_get("/api/array", send)
    app.router.add_get("/api/triangle", pick)
