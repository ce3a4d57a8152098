# SPDX-License-Identifier: GPL-3.0-or-later
"""From above: the parts of a membrane, u, and its flux."""
from __future__ import annotations

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
                    stretch_of, widened)
from .perspective import not_converged
from .surface import Smooth, Surface

_NAMED = 16  # inclusions: more names would cover the lines
Limits = tuple[float, float]


def outer_edges(triangles: Array) -> Array:
    """Edges (n, 2), the lower node first, of only one triangle."""
    ends = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1).astype(np.int64)
    count = int(triangles.max(initial=0)) + 1
    keys = np.sort(ends[:, 0] * count + ends[:, 1])
    different = np.r_[True, keys[1:] != keys[:-1], True]
    outer = keys[different[1:] & different[:-1]]
    return np.stack((outer // count, outer % count), axis=1)


def boundary(nodes: Array, triangles: Array, given: Array, traction: bool | None) -> dict[str, Array]:
    """Edges (n, 2) of a mesh's boundary by what is given on them; given (b, 2): those where u is."""
    outer, count = outer_edges(triangles), len(nodes)
    keys, given = (edges.min(axis=1).astype(np.int64) * count + edges.max(axis=1) for edges in (outer, given))
    held = np.isin(keys, given)
    return {"u given": outer[held], "free" if traction is False else "free or traction": outer[~held]}


def frame(ax: Any, low: Array, high: Array, unit: str, margin: float = 0.03) -> Array:
    """The limits of a map of these corners, both axes to one scale; by how much either is drawn longer."""
    stretched = stretch_of(high - low)
    shown = stretched * (high - low)
    margins = margin * shown.max() / stretched
    ax.set(aspect=stretched[1] / stretched[0], xlim=(low[0] - margins[0], high[0] + margins[0]),
           ylim=(low[1] - margins[1], high[1] + margins[1]))
    for i, axis in enumerate((ax.xaxis, ax.yaxis)):
        label_axis(axis, "xy"[i], unit, Scale(low[i], high[i], shown.max() / stretched[i]), stretched[i])
        narrow = shown.max() / shown[i]
        axis.set_major_locator(rounded(6 if narrow < 3 else 3 if narrow < 6 else 1))
        if narrow >= 3:  # little room, above all for numbers side by side
            axis.set_tick_params(labelsize="x-small")
    return stretched


def _chains(edges: Array) -> list[list[int]]:
    """Nodes in the order of the lines that the edges (n, 2) make up: dashes go on from one to the next."""
    beside: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    chains = []
    for start in sorted(beside, key=lambda node: len(beside[node]) == 2):  # from ends first, then what is closed
        while beside[start]:
            chain = [start]
            while beside[chain[-1]]:
                following = beside[chain[-1]].pop()
                beside[following].remove(chain[-1])
                chain.append(following)
            chains.append(chain)
    return chains


def draw_boundary(ax: Any, nodes: Array, edges: dict[str, Array], drawn: dict[str, Any]) -> None:
    for (what, those), (color, width, dash) in zip(edges.items(), (("#444444", 1.4, "-"),
                                                                   ("#009E73", 1.6, (0, (1.2, 1.2))))):
        if len(those):
            lines = LineCollection([nodes[chain] for chain in _chains(those)], linewidth=width, color=color,
                                   linestyle=dash, capstyle="butt", joinstyle="round")
            drawn[what] = ax.add_collection(lines, autolim=False)


def draw_lines(ax: Any, lines: list[tuple[Array, Array]], away: Array, drawn: dict[str, Any]) -> None:
    """lines: points (k, 2) and kinds (k-1) of the edges of each interface, plus side on its left; away (2): from a
    delaminated inclusion to the dots on its other side."""
    thin = float(np.clip((16 / max(len(lines), 1)) ** 0.5, 0.35, 1))
    for kind, (what, color, width, dash) in LINES.items():
        for points, kinds in lines:
            for first, last in runs(kinds):
                if kinds[first] != kind:
                    continue
                x, y = points[first:last + 1].T
                edged = kind != GLUE and thin == 1
                if edged:  # against dark triangles
                    ax.plot(x, y, color="white", linewidth=width + 1.2, solid_capstyle="butt", label="_")
                (drawn[what],) = ax.plot(x, y, color=color, linewidth=thin * width, linestyle=dash,
                                         solid_capstyle="butt")
                if kind == DELAMINATED:
                    along = np.gradient(np.stack((x, y)), axis=1) / away[:, None]
                    with np.errstate(invalid="ignore"):
                        across = np.stack((-along[1], along[0])) / np.hypot(*along)
                    (drawn["the side that came off"],) = ax.plot(
                        x - away[0] * across[0], y - away[1] * across[1], color="#D00000", linewidth=1.1 * thin,
                        linestyle=(0, (1, 1)))


def beside(points: Array, edges: Array, away: Array, wheres: tuple[float, ...], sides: tuple[int, ...]) -> list[
        tuple[float, float, float, float]]:
    """Places on both sides (1: plus) at these parts of the length of some edges (indices) of a line."""
    found = []
    lengths = np.cumsum(np.hypot(*(np.diff(points, axis=0) / away)[edges].T))
    for where in wheres if len(edges) else ():
        edge = edges[min(int(np.searchsorted(lengths, where * lengths[-1])), len(edges) - 1)]
        (x, y), (right, up) = points[edge:edge + 2].mean(axis=0), (points[edge + 1] - points[edge]) / away
        size = np.hypot(right, up) or 1.0
        found += [(float(x), float(y), float(-side * up / size), float(side * right / size)) for side in sides]
    return found


def interfaces(result: Result, load: str | Load | None = None, ax: Any = None, labels: bool = True) -> Any:
    """The boundary, the inclusions, with dots on the side that came off, cracks, glue, and where the arc length of an
    interface begins, the same for every load; labels: names of inclusions, unless they are many, and a legend."""
    ax = axes(ax)
    if load is not None:
        load_of(result, load)
    _parts(result, ax, labels, {})
    return ax


def _parts(result: Result, ax: Any, labels: bool, drawn: dict[str, Any]) -> Names:
    nodes = result.mesh.nodes
    edges = boundary(nodes, result.mesh.triangles, result.mesh.boundary, result.traction)
    draw_boundary(ax, nodes, edges, drawn)
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    stretched = frame(ax, low, high, result.units.behind("L").strip())
    away = 0.012 * (stretched * (high - low)).max() / stretched
    lines = [(np.stack((line.x, line.y), axis=1), line.edge_kind) for line in result.interfaces]
    draw_lines(ax, lines, away, drawn)
    if len(lines) <= _NAMED and lines:
        begins = np.array([points[0] for points, _ in lines])
        (drawn["s = 0"],) = ax.plot(*begins.T, "s", markersize=3, markerfacecolor="none", markeredgewidth=0.8,
                                    color="#0072B2")
    every = [points for points, _ in lines] + [nodes[ends].mean(axis=1) for ends in edges.values()]
    names = Names(ax, np.concatenate(every) if every else np.empty((0, 2)))
    if labels and len(result.mesh.inclusions) <= _NAMED:
        for inclusion, name in enumerate(result.mesh.inclusions):
            for (points, _), line in zip(lines, result.interfaces):
                of_it = np.flatnonzero(line.edge_inclusion == inclusion)
                if len(of_it):
                    names.beside(name, beside(points, of_it, away, (0.5, 0.25, 0.75, 0.1, 0.9), (-1, 1)))
                    break
    if labels and drawn:
        legend_below(ax, handles=list(drawn.values()), labels=list(drawn))
    return names


def _beside(result: Result) -> dict[str, Any]:
    """Where there is room for a colour bar: along the longer sides."""
    width, height = np.ptp(result.mesh.nodes, axis=0)
    return {"location": "top", "aspect": 40} if width > 2 * height else {"location": "right"}


def _smooth(ax: Any, surface: Surface, values: Array, shades: Any) -> None:
    ax.add_collection(Smooth(surface.nodes, surface.triangles, shades.to_rgba(values)), autolim=False)


def _lines_of_u(ax: Any, surface: Surface, levels: int, drawn: dict[str, Any]) -> Any:
    """At round numbers, about so many; None where u is one number."""
    low, high = float(surface.known.min()), float(surface.known.max())
    steps = np.asarray(rounded(levels).tick_values(*widened(low, high)))
    steps = steps[(steps > low) & (steps < high)]
    if not len(steps):
        return None
    lines = ax.tricontour(Triangulation(*surface.nodes.T, surface.triangles), np.nan_to_num(surface.u), steps,
                          colors="#333333", linewidths=0.5, linestyles="solid")
    (drawn["u = const"],) = ax.plot([], [], color="#333333", linewidth=0.5)
    return lines


def displacement(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 12, lines: bool = True,
                 cmap: Any = None, limits: Limits | None = None, colorbar: Any = True) -> Any:
    """u from above, in colours and contour lines, with cracks and inclusions; takes a case with fields. limits:
    (lowest, highest) u of the colours. colorbar: False, or axes to draw it in."""
    load = load_of(result, load)
    surface, ax = Surface(result, load), axes(ax)
    shades = surface.shades(limits, cmap)
    _smooth(ax, surface, surface.u, shades)
    drawn: dict[str, Any] = {}
    if lines:
        _lines_of_u(ax, surface, levels, drawn)
    _parts(result, ax, True, drawn)
    scale = Scale(*shades.get_clim())
    colour_bar(ax, shades, scale.label("u", result.units.behind("L").strip()), scale, colorbar, **_beside(result))
    ax.set_title(named(load.name) + not_converged(load))
    return ax


def flux(result: Result, load: str | Load | None = None) -> list[Array]:
    """|T grad u| in the triangles of each subdomain, as its field lists them; takes a case with fields. Where some T is
    a law, of which a result has the mean alone, |grad u|."""
    load = load_of(result, load)
    ends = np.cumsum([len(part.triangles) for part in load.fields])[:-1]
    return np.split(Surface(result, load).flux, ends)


def plan(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 10, cmap: Any = "Blues",
         limits: Limits | None = None, colorbar: Any = True) -> Any:
    """From above: labelled lines of u over the flux (see `flux`) in colours, with cracks and inclusions; takes a case
    with fields. The flux grows without bound at tips: the colours end below its peaks. limits: (lowest, highest) flux
    of the colours. colorbar: False, or axes to draw it in."""
    ax, load = axes(ax), load_of(result, load)
    surface = Surface(result, load)
    shown, highest = cut(surface.flux, surface.areas, 0.98, 1.5)
    low, high = limits or (0, shown if shown > 0 else 1)
    shades = ScalarMappable(Normalize(low, high), cmap)
    _smooth(ax, surface, surface.flux_of_nodes, shades)
    drawn: dict[str, Any] = {}
    lines = _lines_of_u(ax, surface, levels, drawn)
    names = _parts(result, ax, True, drawn)
    if lines is not None:
        of_u = Scale(*widened(surface.known.min(), surface.known.max()))
        for level, segments in zip(lines.levels, lines.allsegs):
            if len(segments):
                names.on(of_u.text(level), np.concatenate(segments), 8)
    scale = Scale(low, high)
    law = result.mesh.tension_law
    label = scale.label("|\u2207u|" if law else "|T \u2207u|", "" if law else result.units.behind("F/L").strip())
    colour_bar(ax, shades, label, scale, colorbar, extend="max" if high < highest else "neither", **_beside(result))
    ax.set_title(f"{named(load.name)}: lines of u{_left_out(lines, surface)}{not_converged(load)}")
    return ax


def _left_out(lines: Any, surface: Surface) -> str:
    """What the numbers at lines leave out."""
    if lines is None:
        return ""
    label = Scale(*widened(surface.known.min(), surface.known.max())).label("u", "")
    return label[1:]
