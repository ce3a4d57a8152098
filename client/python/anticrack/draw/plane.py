# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels from above: the parts of a membrane, u, and its flux."""
from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.tri import Triangulation

from ..arrays import Array
from ..result import DELAMINATED, GLUE, Load, Result, runs
from .names import Names
from .panel import (LINES, Scale, axes, colour_bar, cut, label_axis, legend_below, load_of, named, rounded,
                    stretch_of, unit_of, widened)
from .perspective import not_converged
from .surface import Surface

NAMED = 16  # most inclusions that are named, as more names would cover the lines
Limits = tuple[float, float]


class Plane:
    """The parts of a mesh that a map shows. held (b, 2): edges where u is given; traction: whether a traction acts on
    other outer edges, None if not known; lines: for each interface its points (k, 2) and the kinds and inclusions (k-1)
    of its edges, with the plus side on its left."""

    def __init__(self, nodes: Array, triangles: Array, held: Array, traction: bool | None,
                 lines: list[tuple[Array, Array, Array]], inclusions: list[str], unit: str) -> None:
        self.nodes, self.triangles, self.lines, self.inclusions, self.unit = nodes, triangles, lines, inclusions, unit
        code = np.array((1 << 32, 1))  # makes one number of an edge's nodes, the lower one first
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        keys, counts = np.unique(edges @ code, return_counts=True)
        outer = keys[counts == 1]
        given = np.isin(outer, np.sort(held, axis=1) @ code)
        free = "free" if traction is False else "free or traction"
        self.boundary = {what: np.stack(np.divmod(those, code[0]), axis=1)
                         for what, those in (("u given", outer[given]), (free, outer[~given]))}
        self.low, self.high = nodes.min(axis=0), nodes.max(axis=0)

    def draw(self, ax: Any, low: Array, high: Array, margin: float = 0.03) -> Names:
        """Draws the map between two corners, with labels for a legend; returns the Names that find room for names."""
        stretched = frame(ax, low, high, self.unit, margin)
        self._away = 0.012 * (stretched * (high - low)).max() / stretched
        for (what, edges), (color, width, dash) in zip(self.boundary.items(), (("#444444", 1.4, "-"),
                                                                               ("#009E73", 1.6, (0, (1.2, 1.2))))):
            if len(edges):
                ax.add_collection(LineCollection(
                    [self.nodes[chain] for chain in _chains(edges)], linewidth=width, color=color, linestyle=dash,
                    capstyle="butt", joinstyle="round", label=what), autolim=False)
        draw_lines(ax, [(points, kinds) for points, kinds, _ in self.lines if (
            (points.max(axis=0) >= low) & (points.min(axis=0) <= high)).all()], self._away)
        if 0 < len(self.lines) <= NAMED:
            ax.plot(*np.array([points[0] for points, *_ in self.lines]).T, "s", markersize=3.5, markerfacecolor="none",
                    markeredgewidth=0.8, color="#0072B2", zorder=4, label="s = 0")
        self._low, self._high = low, high
        every = np.concatenate([points for points, *_ in self.lines]
                               + [self.nodes[edges].mean(axis=1) for edges in self.boundary.values()])
        return Names(ax, every[self._inside(every)])

    def _inside(self, points: Array) -> Array:
        return np.asarray(((points >= self._low) & (points <= self._high)).all(axis=1))

    def beside(self, points: Array, chosen: Array, wheres: tuple[float, ...], sides: tuple[int, ...]) -> list[
            tuple[float, float, float, float]]:
        """Places beside those edges of a line that are chosen and visible: at the fractions `wheres` of their length,
        on the given sides (1: plus)."""
        inside = self._inside(points)
        edges = np.flatnonzero(chosen & inside[1:] & inside[:-1])
        lengths = np.cumsum(np.hypot(*(np.diff(points, axis=0) / self._away)[edges].T))
        found = []
        for where in wheres if len(edges) else ():
            edge = edges[min(int(np.searchsorted(lengths, where * lengths[-1])), len(edges) - 1)]
            (x, y), (right, up) = points[edge:edge + 2].mean(axis=0), (points[edge + 1] - points[edge]) / self._away
            size = np.hypot(right, up) or 1.0
            found += [(float(x), float(y), float(-side * up / size), float(side * right / size)) for side in sides]
        return found

    def name_inclusions(self, names: Names, told: Collection[str] = ()) -> None:
        """Names the inclusions, except those of interfaces whose names are in `told`."""
        for index, name in enumerate(self.inclusions):
            for points, kinds, inclusions in self.lines:
                places = self.beside(points, (inclusions == index) & (kinds != GLUE), (0.5, 0.25, 0.75, 0.1, 0.9),
                                     (-1, 1))
                if places and name not in told:
                    names.beside(name, places)
                    break


def frame(ax: Any, low: Array, high: Array, unit: str, margin: float = 0.03) -> Array:
    """Sets the limits of a map with these corners, both axes to one scale; returns by how much each is stretched."""
    stretched = stretch_of(high - low)
    shown = stretched * (high - low)
    margins = margin * shown.max() / stretched
    ax.set(aspect=stretched[1] / stretched[0], xlim=(low[0] - margins[0], high[0] + margins[0]),
           ylim=(low[1] - margins[1], high[1] + margins[1]))
    for i, axis in enumerate((ax.xaxis, ax.yaxis)):
        label_axis(axis, "xy"[i], unit, Scale(low[i], high[i], shown.max() / stretched[i]), stretched[i])
        narrow = shown.max() / shown[i]
        axis.set_major_locator(rounded(6 if narrow < 3 else 3 if narrow < 6 else 1))
        if narrow >= 3:  # there is little room, above all for numbers side by side
            axis.set_tick_params(labelsize="x-small")
    return stretched


def _chains(edges: Array) -> list[list[int]]:
    """Joins edges (n, 2) to lines and returns the nodes of each in order, so that dashes go on from edge to edge."""
    beside: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    chains = []
    for start in sorted(beside, key=lambda node: len(beside[node]) == 2):  # from ends of open lines, then closed ones
        while beside[start]:
            chain = [start]
            while beside[chain[-1]]:
                following = beside[chain[-1]].pop()
                beside[following].remove(chain[-1])
                chain.append(following)
            chains.append(chain)
    return chains


def draw_lines(ax: Any, lines: list[tuple[Array, Array]], away: Array) -> None:
    """Draws interfaces. lines: points (k, 2) and kinds (k-1) of the edges of each, with the plus side on the left; away
    (2): offset from a delaminated inclusion to the dots on the side that came off."""
    thin = float(np.clip((16 / max(len(lines), 1)) ** 0.5, 0.35, 1))
    for kind, (what, color, width, dash) in LINES.items():
        labels = {"line": what, "side": "the side that came off"}
        for (first, last), points in [(run, points) for points, kinds in lines for run in runs(kinds)
                                      if kinds[run[0]] == kind]:
            x, y = points[first:last + 1].T
            if kind != GLUE and thin == 1:  # a white rim makes it stand out on dark triangles
                ax.plot(x, y, color="white", linewidth=width + 1.2, solid_capstyle="butt", label="_")
            ax.plot(x, y, color=color, linewidth=thin * width, linestyle=dash, solid_capstyle="butt",
                    label=labels.pop("line", "_"))
            if kind == DELAMINATED:
                along = np.gradient(np.stack((x, y)), axis=1) / away[:, None]
                with np.errstate(invalid="ignore"):
                    across = np.stack((-along[1], along[0])) / np.hypot(*along)
                ax.plot(x - away[0] * across[0], y - away[1] * across[1], color="#D00000", linewidth=1.1 * thin,
                        linestyle=(0, (1, 1)), label=labels.pop("side", "_"))


def interfaces(result: Result, load: str | Load | None = None, ax: Any = None, labels: bool = True) -> Any:
    """Draws the boundary, inclusions with dots on the side that came off, cracks, glue, and where the arc length of
    each interface begins; all are the same for every load. labels: add a legend and, unless they are many,
    inclusions' names."""
    ax = axes(ax)
    if load is not None:
        load_of(result, load)
    _parts(result, ax, labels)
    return ax


def _parts(result: Result, ax: Any, labels: bool = True) -> Names:
    mesh = result.mesh
    plane = Plane(mesh.nodes, mesh.triangles, mesh.boundary, result.traction,
                  [(np.c_[line.x, line.y], line.edge_kind, line.edge_inclusion) for line in result.interfaces],
                  mesh.inclusions, unit_of(result))
    names = plane.draw(ax, plane.low, plane.high)
    if labels and len(plane.inclusions) <= NAMED:
        plane.name_inclusions(names)
    if labels:
        legend_below(ax)
    return names


def _beside(result: Result) -> dict[str, Any]:
    """Options that place a colour bar where there is room, along the sheet's longer sides."""
    width, height = np.ptp(result.mesh.nodes, axis=0)
    return {"location": "top", "aspect": 40} if width > 2 * height else {"location": "right"}


def _smooth(ax: Any, surface: Surface, values: Array, shades: Any) -> None:
    if len(surface.triangles):
        ax.tripcolor(*surface.nodes.T, surface.triangles, values, shading="gouraud", norm=shades.norm,
                     cmap=shades.cmap, rasterized=True, zorder=0)


def _lines_of_u(ax: Any, surface: Surface, levels: int) -> Any:
    """Draws about so many contour lines of u at round numbers; returns None if u is constant."""
    low, high = float(surface.known.min()), float(surface.known.max())
    steps = np.asarray(rounded(levels).tick_values(*widened(low, high)))
    steps = steps[(steps > low) & (steps < high)]
    if not len(steps):
        return None
    lines = ax.tricontour(Triangulation(*surface.nodes.T, surface.triangles), np.nan_to_num(surface.u), steps,
                          colors="#333333", linewidths=0.5, linestyles="solid")
    ax.plot([], [], color="#333333", linewidth=0.5, label="u = const")
    return lines


def displacement(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 12, lines: bool = True,
                 cmap: Any = None, limits: Limits | None = None, colorbar: Any = True) -> Any:
    """Draws u from above, in colours and contour lines, with cracks and inclusions; needs a case with fields. limits:
    (lowest, highest) u of the colours. colorbar: False, or axes to draw it in."""
    load = load_of(result, load)
    surface, ax = Surface(result, load), axes(ax)
    shades = surface.shades(limits, cmap)
    _smooth(ax, surface, surface.u, shades)
    if lines:
        _lines_of_u(ax, surface, levels)
    _parts(result, ax)
    colour_bar(ax, shades, "u", unit_of(result), colorbar, **_beside(result))
    ax.set_title(named(load.name) + not_converged(load))
    return ax


def flux(result: Result, load: str | Load | None = None) -> list[Array]:
    """|T grad u| in the triangles of each subdomain, in the order of its field; needs a case with fields."""
    load = load_of(result, load)
    ends = np.cumsum([len(part.triangles) for part in load.fields])[:-1]
    return np.split(Surface(result, load).flux, ends)


def plan(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 10, cmap: Any = "Blues",
         limits: Limits | None = None, colorbar: Any = True) -> Any:
    """Draws labelled contour lines of u over the flux (see `flux`) in colours, from above, with cracks and inclusions;
    needs a case with fields. The flux grows without bound at tips: the colours end below its peaks. limits: (lowest,
    highest) flux of the colours. colorbar: False, or axes to draw it in."""
    ax, load = axes(ax), load_of(result, load)
    surface = Surface(result, load)
    shown, highest = cut(surface.flux, surface.areas, 0.98, 1.5)
    low, high = limits or (0, shown if shown > 0 else 1)
    shades = ScalarMappable(Normalize(low, high), cmap)
    _smooth(ax, surface, surface.flux_of_nodes, shades)
    lines, names, left_out = _lines_of_u(ax, surface, levels), _parts(result, ax), ""
    if lines is not None:
        of_u = Scale(*widened(surface.known.min(), surface.known.max()))
        left_out = of_u.label("u", "")[1:]
        for level, segments in zip(lines.levels, lines.allsegs):
            if len(segments):
                names.on(of_u.text(level), np.concatenate(segments), 8)
    colour_bar(ax, shades, "|T \u2207u|", unit_of(result, "F/L"), colorbar,
               extend="max" if high < highest else "neither", **_beside(result))
    ax.set_title(f"{named(load.name)}: lines of u{left_out}{not_converged(load)}")
    return ax
