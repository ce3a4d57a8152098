# SPDX-License-Identifier: GPL-3.0-or-later
"""From above: the parts of a membrane, u, and its flux."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..result import DELAMINATED, Load, Result, runs
from ..text import harmless
from .panel import (BOX, LINES, Scale, axes, cut, fields, label_axis, legend_below, load_of, number_text, stretch_of,
                    widened)

_NAMES = 20  # of inclusions: more would cover each other
_LABELLED = 60  # lines of u, likewise


def _levels(load: Load, levels: int) -> Array:
    """Of u: round numbers, about so many, from its lowest to its highest."""
    from matplotlib.ticker import MaxNLocator
    low, high = min(f.u.min() for f in fields(load)), max(f.u.max() for f in load.fields)
    return np.asarray(MaxNLocator(levels).tick_values(*widened(low, high)))


def _lines(levels: Array, triangulation: Any, u: Array, width: float, ax: Any) -> Any:
    """Lines of those levels that are there; None: none is."""
    inner = levels[(levels > u.min()) & (levels < u.max())]
    return ax.tricontour(triangulation, u, inner, colors="black", linewidths=width,
                         linestyles="solid") if inner.size else None


def _boundary(result: Result) -> dict[str, Array]:
    """Edges (n, 2) of the boundary, by what is given on them."""
    mesh = result.mesh

    def keys(edges: Array) -> Array:
        return np.asarray(edges.min(axis=1).astype(np.int64) * len(mesh.nodes) + edges.max(axis=1))
    edges = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    _, first, count = np.unique(keys(edges), return_index=True, return_counts=True)
    outer = edges[first[count == 1]]
    held = np.isin(keys(outer), keys(mesh.boundary))
    return {"u given": outer[held], "free" if result.traction is False else "free or traction": outer[~held]}


def interfaces(result: Result, load: str | Load | None = None, ax: Any = None, labels: bool = True) -> Any:
    """The boundary, the inclusions, with dots on the side that came off, and the cracks, the same for every load;
    labels: names of inclusions, unless they are many, and a legend of the lines."""
    ax = axes(ax)
    if load is not None:
        load_of(result, load)
    from matplotlib.collections import LineCollection
    drawn: dict[str, Any] = {}
    for (what, edges), color, width in zip(_boundary(result).items(), ("#444444", "#009E73"), (2.5, 1.2)):
        if len(edges):
            segments = LineCollection(list(result.mesh.nodes[edges]), linewidth=width, color=color, capstyle="round")
            drawn[what] = ax.add_collection(segments)
    named: set[int] = set()
    low, high = result.mesh.nodes.min(axis=0), result.mesh.nodes.max(axis=0)
    stretched = stretch_of(high - low)
    shown = stretched * (high - low)
    away = 0.012 * shown.max() / stretched
    for interface in result.interfaces:
        for first, last in runs(interface.edge_kind * 100_000 + interface.edge_inclusion):
            kind, inclusion = int(interface.edge_kind[first]), int(interface.edge_inclusion[first])
            if kind not in LINES:
                continue
            x, y = interface.x[first:last + 1], interface.y[first:last + 1]
            what, color = LINES[kind]
            (drawn[what],) = ax.plot(x, y, color=color, linewidth=2)
            along = np.gradient(np.stack((x, y)), axis=1) * stretched[:, None]
            across = np.stack((-along[1], along[0])) / np.hypot(*along)
            if kind == DELAMINATED:
                (drawn["the side that came off"],) = ax.plot(x - away[0] * across[0], y - away[1] * across[1], ":",
                                                             color="#D00000")
            if labels and inclusion >= 0 and inclusion not in named and len(result.mesh.inclusions) <= _NAMES:
                named.add(inclusion)
                middle = len(x) // 2
                up, right = across[1, middle], across[0, middle]
                ax.annotate(harmless(result.mesh.inclusions[inclusion]), (x[middle], y[middle]),
                            xytext=(6 * right, 6 * up), textcoords="offset points",
                            va="bottom" if up > 0.5 else "top" if up < -0.5 else "center",
                            ha="center" if abs(up) > 0.9 else "left" if right > 0 else "right",
                            rotation=90 if abs(up) < 0.1 else 0, bbox=BOX)
    if labels and drawn:
        legend_below(ax, list(drawn.values()), list(drawn))
    margin = 0.03 * shown.max() / stretched
    ax.set(aspect=stretched[1] / stretched[0], xlim=(low[0] - margin[0], high[0] + margin[0]),
           ylim=(low[1] - margin[1], high[1] + margin[1]))
    for i, axis in enumerate((ax.xaxis, ax.yaxis)):
        label_axis(axis, "xy"[i], result.units.behind("L").strip(),
                   Scale(low[i], high[i], shown.max() / stretched[i]), stretched[i])
        narrow = shown.max() / shown[i]
        axis.get_major_locator().set_params(nbins=6 if narrow < 3 else 3 if narrow < 6 else 1)
        if narrow >= 3:  # little room, above all for numbers side by side
            axis.set_tick_params(labelsize="x-small")
    return ax


def _beside(result: Result) -> dict[str, Any]:
    """Where there is room for a colour bar: along the longer sides."""
    width, height = np.ptp(result.mesh.nodes, axis=0)
    return {"location": "top", "aspect": 40} if width > 2 * height else {}


def _triangulation(result: Result, part: Any) -> Any:
    from matplotlib.tri import Triangulation
    x, y = result.mesh.nodes[part.nodes].T
    return Triangulation(x, y, part.triangles)


def displacement(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 12, lines: bool = True,
                 cmap: str = "viridis") -> Any:
    """u from above, in colours and contour lines, with cracks and inclusions; takes a case with fields."""
    load = load_of(result, load)
    steps, ax = _levels(load, levels), axes(ax)
    for part in load.fields:
        triangulation = _triangulation(result, part)
        shades = ax.tricontourf(triangulation, part.u, steps, cmap=cmap)
        if lines:
            _lines(steps, triangulation, part.u, 0.3, ax)
    ax.figure.colorbar(shades, ax=ax, label="u" + result.units.label("L"), **_beside(result))
    interfaces(result, load, ax)
    ax.set_title(harmless(load.name))
    return ax


def flux(result: Result, load: str | Load | None = None) -> list[Array]:
    """|T grad u| in the triangles of each subdomain, as its field lists them; takes a case with fields. Where some T is
    a law, of which a result has the mean alone, |grad u|."""
    sizes = []
    tensions = np.ones(len(result.mesh.tension)) if result.mesh.tension_law else result.mesh.tension
    for tension, part in zip(tensions, fields(load_of(result, load))):
        a, b, c = np.moveaxis(result.mesh.nodes[part.nodes][part.triangles], 1, 0)
        u = part.u[part.triangles]
        (bx, by), (cx, cy) = (b - a).T, (c - a).T
        ub, uc = u[:, 1] - u[:, 0], u[:, 2] - u[:, 0]
        sizes.append(tension * np.hypot(ub * cy - uc * by, uc * bx - ub * cx) / (bx * cy - cx * by))
    return sizes


def flux_peaks(result: Result, load: Load, sizes: list[Array]) -> tuple[float, float]:
    """Of what `flux` gives: the end of the axis, and the highest."""
    corners = [result.mesh.nodes[part.nodes][part.triangles] for part in load.fields]
    areas = [np.abs(np.linalg.det(np.diff(each, axis=1))) for each in corners]
    return cut(np.concatenate(sizes), np.concatenate(areas), 0.98, 1.5)


def plan(result: Result, load: str | Load | None = None, ax: Any = None, levels: int = 10, cmap: str = "Blues") -> Any:
    """From above: labelled lines of u over the flux (see `flux`) in colours, with cracks and inclusions; takes a case
    with fields. The flux grows without bound at tips: its peaks are cut off, and the colour bar says so."""
    ax, load = axes(ax), load_of(result, load)
    sizes = flux(result, load)
    parts = [_triangulation(result, part) for part in load.fields]
    shown, highest = flux_peaks(result, load, sizes)
    steps = _levels(load, levels)
    scale = Scale(steps.min(), steps.max())
    for part, field, size in zip(parts, load.fields, sizes):
        shades = ax.tripcolor(part, size, vmin=0, vmax=shown if shown > 0 else 1, cmap=cmap, rasterized=True)
        lines = _lines(steps, part, field.u, 0.6, ax)
        if lines is not None and sum(map(len, lines.allsegs)) <= _LABELLED:
            ax.clabel(lines, lines.levels[::2], fmt=scale.text, fontsize="x-small")
    said = f", peaks cut off, up to {number_text(highest, 2)}" if shown < highest else ""
    name = r"$|\nabla u|$" if result.mesh.tension_law else r"$|T \nabla u|$" + result.units.label("F/L")
    ax.figure.colorbar(shades, ax=ax, label=name + said,
                       extend="max" if said else "neither", **_beside(result))
    interfaces(result, load, ax)
    ax.set_title(f"{harmless(load.name)}: lines of {scale.label('u', result.units.behind('L').strip())}")
    return ax
