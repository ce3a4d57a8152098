# SPDX-License-Identifier: GPL-3.0-or-later
"""The deformed membrane in perspective."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import Error
from ..result import Load, Result, runs
from .panel import (BOX, LINES, MARKED, Scale, axes, colour_bar, label_axis, load_of, named, number_text, rounded,
                    stretch_of, unit_of, widened)
from .surface import Heights, Surface

_NAMES = 6  # most inclusions that are named, as more names would cover each other
_ELEVATION = 38


def _amplification(extent: float, size: float) -> float:
    """A round factor that makes u at most 0.3 of the size."""
    if not extent > 0:
        return 1.0
    wanted = 0.3 * size / extent
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(step for step in (1, 1.5, 2, 3, 4, 5, 6, 8) if step * power <= wanted))


def view(result: Result) -> tuple[float, float]:
    """The viewer's direction, in degrees up and around. It is from the front, with x to the right, and over the minus
    side of the first interface if possible, so that its cracks open upwards on the far side; else from higher up."""
    across = np.array((0.0, 1.0))
    for line in result.interfaces[:1]:
        across = np.array((line.y[0] - line.y[-1], line.x[-1] - line.x[0]))
    across = across / (np.hypot(*across) or 1)
    towards, around = min(((float(across @ (np.cos(np.radians(angle)), np.sin(np.radians(angle)))), angle)
                           for angle in (-62, -118)), key=lambda found: found[0])
    return (_ELEVATION if towards < 0.3 else 55), around


def _plane(surface: Surface) -> Array:
    """(n) heights of the plane through u on the nodes if the plane makes up most of u, as for a sheet whose edges are
    held at different heights; else 0."""
    if len(surface.known) != len(surface.u) or not np.ptp(surface.u) > 0:
        return np.zeros(len(surface.u))
    middle, size = surface.nodes.mean(axis=0), np.ptp(surface.nodes, axis=0).max()
    columns = np.c_[(surface.nodes - middle) / size, np.ones(len(surface.u))]
    weighted = (columns * surface.around[:, None]).T
    plane = columns @ np.linalg.lstsq(weighted @ columns, weighted @ surface.u, None)[0]
    return np.asarray(plane * (np.ptp(surface.u - plane) < 0.3 * np.ptp(surface.u)))


def _lit(surface: Surface, slopes: Array, around: float) -> Array:
    """(n) brightness of the nodes; the light comes from the viewer's upper left."""
    angle = np.radians(around + 90)
    right, away = np.array((np.cos(angle), np.sin(angle))), np.array((-np.sin(angle), np.cos(angle)))
    with np.errstate(over="ignore", invalid="ignore"):
        lit = (slopes @ (0.5 * right + 0.3 * away) + 0.81) / np.sqrt((slopes ** 2).sum(axis=1) + 1)
    return np.where(np.isfinite(lit), 0.65 + 0.35 * np.clip(lit, 0, 1), 1)


def _mark(result: Result, load: Load, height: Any, above: float, ax: Any) -> None:
    """Draws inclusions and cracks on their plus faces, to which inclusions are bonded, and the names of a few
    inclusions above them."""
    known: set[int] = set()
    thin = min(1.0, (12 / max(len(result.interfaces), 1)) ** 0.5)
    for interface, trace in zip(result.interfaces, load.traces):
        for first, last in runs(interface.edge_kind * 100_000 + interface.edge_inclusion):
            kind, inclusion = int(interface.edge_kind[first]), int(interface.edge_inclusion[first])
            if kind not in MARKED:
                continue
            x, y, u, low = (values[first:last + 1] for values in (interface.x, interface.y, trace.u_plus,
                                                                  trace.u_minus))
            up = height(x, y, u)
            ax.plot(x, y, up, color=LINES[kind][1], linewidth=1.5 * thin, zorder=100)
            if inclusion >= 0 and inclusion not in known and len(result.mesh.inclusions) <= _NAMES:
                known.add(inclusion)
                middle = len(x) // 2
                if np.isfinite(up[middle]):
                    ax.text(x[middle], y[middle], max(up[middle], height(x, y, low)[middle]) + above,
                            named(result.mesh.inclusions[inclusion], 18), ha="center", va="bottom", fontsize="small",
                            bbox=BOX, zorder=101)


def heights_of(result: Result, load: str | Load | None = None) -> tuple[float, float]:
    """The lowest and the highest u that `membrane` draws, less the plane that it leaves out."""
    surface = Surface(result, load_of(result, load))
    rest = np.where(np.isfinite(surface.u), surface.u - _plane(surface), 0)
    return float(rest.min()), float(rest.max())


def membrane(result: Result, load: str | Load | None = None, ax: Any = None, cmap: Any = None,
             amplify: float | None = None, limits: tuple[float, float] | None = None, colorbar: Any = True,
             heights: tuple[float, float] | None = None) -> Any:
    """Draws the deformed membrane in perspective with its cracks open; u is in colours and amplified as the title says
    (or by `amplify`). Needs a case with fields. If the sheet's edges are held at different heights, the plane through
    u is left out. limits: (lowest, highest) u of the colours, to share by several figures; heights: likewise of
    the vertical axis, see heights_of. colorbar: False, or axes to
    draw it in. `ax` has three dimensions: subplots(subplot_kw={"projection": "3d"}); `displacement` draws u on an `ax`
    of two."""
    load = load_of(result, load)
    surface = Surface(result, load)
    ax = axes(ax, "3d")
    if ax.name != "3d":
        raise Error('the membrane is drawn in perspective; give ax of subplots(subplot_kw={"projection": "3d"}), or '
                    "draw.displacement, which is from above")
    up, around = view(result)
    plane = _plane(surface)
    level = plane.any()
    low, high = surface.nodes.min(axis=0), surface.nodes.max(axis=0)
    # The mean of length and width: by its length alone a long sheet would stand like a curtain.
    stretched = stretch_of(high - low)
    shown = stretched * (high - low)
    size = float(np.sqrt(shown.prod()))
    rest = np.where(np.isfinite(surface.u), surface.u - plane, 0)
    ends = heights if heights is not None else (float(rest.min()), float(rest.max()))
    factor = amplify or _amplification(np.ptp(ends), 0.4 * size if level else size)
    shades = surface.shades(limits, cmap)
    middle = surface.nodes.mean(axis=0)
    tilt = np.linalg.lstsq(surface.nodes - middle, plane - plane.mean(), None)[0]
    colours = shades.to_rgba(surface.u)
    colours[:, :3] *= _lit(surface, factor * (surface.slopes - tilt), around)[:, None]
    points = np.c_[surface.nodes, factor * rest]
    ax.add_collection(Heights(points, surface.triangles, colours, bool(load.stages)), autolim=False)

    def height(x: Array, y: Array, u: Array) -> Array:
        return np.asarray(factor * (u - (np.c_[x, y] - middle) @ tilt - plane.mean()))
    _mark(result, load, height, 0.06 * size, ax)
    room = factor * np.mean(ends) + np.array((-0.5, 0.5)) * max(factor * np.ptp(ends), 0.15 * size)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=room)
    for i, axis in enumerate((ax.xaxis, ax.yaxis)):
        axis.set_major_locator(rounded(5 if shown[i] > shown.max() / 3 else 2))
        label_axis(axis, "xy"[i], unit_of(result), Scale(low[i], high[i], shown.max() / stretched[i]))
    tall = Scale(ends[0], ends[1], factor=factor)
    steps = rounded(2).tick_values(*widened(*ends))
    ticks = [factor * step for step in steps if room[0] <= factor * step <= room[1]]
    ax.set_zticks(ticks if np.ptp(room) > 0.25 * size else sorted({*ticks[:1], *ticks[-1:]}))
    label_axis(ax.zaxis, "" if level else "u", unit_of(result), tall)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_pane_color((1, 1, 1, 0))
        axis.set_rotate_label(False)
        axis.labelpad = -4 if axis is not ax.zaxis else -7 if around > -90 else -2
    ax.tick_params(pad=-2)
    ax.grid(False)
    ax.set_box_aspect([*shown, np.ptp(room)], zoom=1.05)
    ax.view_init(up, around)
    text = "u to scale" if factor == 1 else f"u {'amplified ' if factor > 1 else ''}\u00d7{number_text(factor, 6)}"
    wider = [f", {name} stretched \u00d7{number_text(by, 6)}" for name, by in zip("xy", stretched) if by != 1]
    ax.set_title(f"{named(load.name)}: {text.replace('u', 'u less a plane,', 1) if level else text}"
                 + "".join(wider) + not_converged(load))
    colour_bar(ax, shades, "u", unit_of(result), colorbar, pad=0.02, shrink=0.6, aspect=30, orientation="horizontal")
    return ax


def not_converged(load: Load) -> str:
    return ", not converged" if load.status == "not_converged" else ""
