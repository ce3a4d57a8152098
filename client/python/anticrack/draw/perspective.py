# SPDX-License-Identifier: GPL-3.0-or-later
"""The deformed membrane in perspective."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import Error
from ..result import Load, Result, runs
from ..text import harmless
from .panel import BOX, LINES, Scale, axes, factor_text, fields, label_axis, load_of, stretch_of, widened

_NAMES = 6  # of inclusions: more would cover each other


def _amplification(extent: float, size: float) -> float:
    """A round factor by which u is up to 0.3 of the size; as in the command's figure."""
    if not extent > 0:
        return 1.0
    wanted = 0.3 * size / extent
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(step for step in (1, 1.5, 2, 3, 4, 5, 6, 8) if step * power <= wanted))


def _azimuth(result: Result) -> float:
    """Over the minus side of the first interface: its cracks open upwards on the far side."""
    along = [(line.x[-1] - line.x[0], line.y[-1] - line.y[0]) for line in result.interfaces[:1]]
    return -62 + float(np.degrees(np.arctan2(*reversed(along[0])))) if along else -62


def _mark(result: Result, load: Load, factor: float, ax: Any) -> None:
    """Inclusions and cracks on their plus faces, which inclusions hold, and the names of a few inclusions."""
    named: set[int] = set()
    for interface, trace in zip(result.interfaces, load.traces):
        for first, last in runs(interface.edge_kind * 100_000 + interface.edge_inclusion):
            kind, inclusion = int(interface.edge_kind[first]), int(interface.edge_inclusion[first])
            if kind not in LINES:
                continue
            line = np.stack((interface.x, interface.y, factor * trace.u_plus))[:, first:last + 1]
            ax.plot(*line, color=LINES[kind][1], linewidth=1.5, zorder=100)
            if inclusion >= 0 and inclusion not in named and len(result.mesh.inclusions) <= _NAMES:
                named.add(inclusion)
                ax.text(*line[:, line.shape[1] // 2], harmless(result.mesh.inclusions[inclusion]), ha="center",
                        va="bottom", fontsize="small", bbox=BOX, zorder=101)


def _corners(result: Result, load: Load) -> tuple[Array, Array, Array]:
    """Nodes (n, 2), u (n) and triangles (m, 3) of all subdomains: both faces of an open crack have their own nodes."""
    parts = fields(load)
    firsts = np.cumsum([0, *(len(part.nodes) for part in parts)])
    return (result.mesh.nodes[np.concatenate([part.nodes for part in parts])],
            np.concatenate([part.u for part in parts]),
            np.concatenate([part.triangles + first for part, first in zip(parts, firsts)]))


def membrane(result: Result, load: str | Load | None = None, ax: Any = None, cmap: str = "viridis") -> Any:
    """The deformed membrane in perspective, its cracks open, u amplified as the title says and in colours, with cracks
    and inclusions; takes a case with fields. `ax` has three dimensions: subplots(subplot_kw={"projection": "3d"});
    `displacement` draws u on an `ax` of two."""
    load = load_of(result, load)
    nodes, u, triangles = _corners(result, load)
    ax = axes(ax, "3d")
    if ax.name != "3d":
        raise Error('the membrane is drawn in perspective; give ax of subplots(subplot_kw={"projection": "3d"}), or '
                    "draw.displacement, which is from above")
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    sides = np.ptp(nodes, axis=0)
    # Of a long sheet neither its length, or it would stand like a curtain, nor its width.
    stretched = stretch_of(sides)
    shown = stretched * sides
    factor = _amplification(np.ptp(u), np.sqrt(shown.prod()))
    colours = Normalize(*widened(u.min(), u.max()))
    shades = ScalarMappable(colours, cmap)
    faces = ax.plot_trisurf(*nodes.T, factor * u, triangles=triangles, linewidth=0.2, antialiased=False)
    of_faces = shades.to_rgba(u[triangles].mean(axis=1))
    faces.set(facecolors=of_faces, edgecolors=of_faces)
    place = {"location": "bottom", "pad": 0.05} if (stretched != 1).any() else {"pad": 0.1}  # beside the names of axes
    ax.figure.colorbar(shades, ax=ax, label="u" + result.units.label("L"), shrink=0.6, **place)
    _mark(result, load, factor, ax)
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    scale = "to scale" if factor == 1 else f"amplified {factor_text(factor)}"
    ax.set(zticks=[], title=f"{harmless(load.name)}: u {scale}", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    for i, axis in enumerate((ax.xaxis, ax.yaxis)):
        axis.get_major_locator().set_params(nbins=5 if shown[i] > shown.max() / 3 else 2)
        label_axis(axis, "xy"[i], result.units.behind("L").strip(),
                   Scale(low[i], high[i], shown.max() / stretched[i]), stretched[i])
    ax.set_box_aspect([*(np.ptp((ax.get_xlim(), ax.get_ylim()), axis=1) * stretched), np.ptp(ax.get_zlim())])
    ax.view_init(38, _azimuth(result))
    return ax
