# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels over the rows of a sweep."""
from __future__ import annotations

from numbers import Integral
from typing import Any

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.ticker import MultipleLocator

from ..arrays import Array, array_of
from ..errors import Error
from ..names import place
from ..result import Result, Sweep
from .along import Profile, middles
from .panel import CURVES, axes, fit_axis, legend_below, named, rounded, unit_of

_NAMED = 6  # curves with names; further ones are drawn alike and counted
_STRIPS = 400  # most strips of rows in a map, as more would not be seen
_OPEN, _CLOSED = "#e4e4e4", "#0072B2"


class Rows:
    """The horizontal axis: the one coefficient that varies, the angle of two coefficients on a circle around 0, or else
    the rows, whose points are not joined. at (rows): places of the rows."""

    def __init__(self, columns: Sweep) -> None:
        rows = np.arange(len(columns.status))
        self.label, self.at, self.joined, self.turn = "row", rows.astype(float), False, False
        given = columns.coefficients if columns.coefficients is not None else np.empty((len(rows), 0))
        varying = np.flatnonzero((given != given[:1]).any(axis=0))
        if len(varying) == 1:
            self.label, self.at = f"coefficient of {named(columns.loads[varying[0]], 20)}", given[:, varying[0]]
            self.joined = True
        elif len(varying) == 2:
            x, y = given[:, varying].T
            radius = np.hypot(x, y)
            if np.allclose(radius, radius[0], rtol=1e-6, atol=0):
                plain = np.arctan2(y, x)
                angle = np.unwrap(plain)
                one_turn = np.ptp(angle) <= 2 * np.pi * (1 + 1e-6)
                first, second = (named(columns.loads[i], 10) for i in varying)
                self.label = f"angle from {first} to {second} [\u00b0]"
                self.at, self.joined, self.turn = np.degrees(angle if one_turn else plain), True, True

    def axis(self, axis: Any) -> None:
        size = float(np.ptp(self.at)) if len(self.at) else 0.0
        quarters = [step for step in (5, 15, 30, 45, 90, 180) if size <= 6 * step or step == 180]  # divide a turn
        axis.set_major_locator(MultipleLocator(quarters[0]) if self.turn and size > 5 else
                               rounded(6, integer=self.label == "row"))
        fit_axis(axis, self.label, "")


def columns_of(result: Result) -> Sweep:
    if result.sweep is None:
        raise Error("this is not the result of a sweep")
    return result.sweep


def curves(ax: Any, result: Result, over: Rows, names: list[str], values: Array, label: str, unit: str,
           bounds: tuple[Array, Array] | None = None) -> None:
    """Draws curves of values (rows, names) over the rows that converged, with bands."""
    rows = np.flatnonzero(columns_of(result).converged)
    rows = rows[np.argsort(over.at[rows], kind="stable")]
    options: dict[str, Any] = {"marker": "o", "markersize": 2.2 if len(rows) <= 60 else 1.2} if (
        len(rows) <= 60 or not over.joined) else {}
    for i in range(len(names)):  # draws the first above the others
        color, dash = CURVES[i] if i < _NAMED else ("#bbbbbb", "-")
        more = "_" if i > _NAMED else f"{len(names) - _NAMED} more" if i == _NAMED else named(names[i], 18)
        ax.plot(over.at[rows], values[rows, i], color=color, linestyle=dash if over.joined else "none", label=more,
                zorder=3 - i / len(names), **options)
        if over.joined and bounds is not None:
            ax.fill_between(over.at[rows], bounds[0][rows, i], bounds[1][rows, i], color=color, alpha=0.25, linewidth=0)
    over.axis(ax.xaxis)
    ax.yaxis.set_major_locator(rounded(6))
    fit_axis(ax.yaxis, label, unit)
    if len(names) > 1:
        ax.legend(loc="best", fontsize="small")


def sweep(result: Result, x: str | int | Array | None = None, inclusion: str | int | None = None,
          ax: Any = None) -> Any:
    """Draws A of the inclusions, the first six in colours of their own, or of one given by name or index; the contact
    length if there is no inclusion. x: the coefficient that varies by default, that of a load by name or index, or your
    own values (rows). Rows with bounds have bands; rows that did not converge are left out."""
    ax, columns = axes(ax), columns_of(result)
    over = Rows(columns)
    if isinstance(x, (str, Integral)):
        if columns.coefficients is None:
            raise Error("the coefficients are not known; give x, a value for every row")
        index = place("load", x, columns.loads) if isinstance(x, str) else int(x)
        over.label, over.joined = f"coefficient of {named(columns.loads[index])}", True
        over.at = columns.coefficients[:, index]
    elif x is not None:
        over.label, over.joined = "", True
        over.at = array_of(x, (len(columns.status),), lambda problem: Error(f"x: {problem}"))
    if not columns.inclusions:
        return contact_length(result, ax, over)
    chosen = list(range(len(columns.inclusions)))
    if inclusion is not None:
        chosen = [place("inclusion", inclusion, columns.inclusions) if isinstance(inclusion, str) else inclusion]
    lower, upper = columns.displacement_lower, columns.displacement_upper
    curves(ax, result, over, [columns.inclusions[i] for i in chosen], columns.displacement[:, chosen],
           f"A of {named(columns.inclusions[chosen[0]])}" if len(chosen) == 1 else "A",
           unit_of(result), None if lower is None or upper is None else (lower[:, chosen], upper[:, chosen]))
    return ax


def contact_length(result: Result, ax: Any = None, over: Rows | None = None) -> Any:
    """Draws the contact length of all cracks in every row, over the horizontal axis of `sweep`."""
    ax, columns = axes(ax), columns_of(result)
    curves(ax, result, over or Rows(columns), [""], columns.contact_length[:, None], "contact length", unit_of(result))
    if ax.get_ylim()[1] > 0 and not columns.contact_length[columns.converged].any():
        ax.set_ylim(0, 1)
    return ax


def slopes(result: Result, part: int, ax: Any = None) -> Any:
    """Draws Bx (part 0) or By (part 1) of every inclusion, over the horizontal axis of `sweep`."""
    ax, columns = axes(ax), columns_of(result)
    if columns.slope is None:
        raise Error("no inclusion of this sweep tilts")
    curves(ax, result, Rows(columns), columns.inclusions, columns.slope[:, :, part], ("Bx", "By")[part], "")
    return ax


def _ends(values: Array) -> Array:
    """Ends of the values' strips: half-way to the neighbours and as far beyond the ends; half a unit around a single
    value."""
    if len(values) == 1:
        return np.array((values[0] - 0.5, values[0] + 0.5))
    return middles(np.concatenate((2 * values[:1] - values[1:2], values, 2 * values[-1:] - values[-2:-1])))[1:-1]


def contact_map(result: Result, interface: int | str, ax: Any = None) -> Any:
    """Draws where the cracks of an interface are closed, row by row; with many rows, the fraction of rows that are
    closed. Raises Error if the interface has no cracks."""
    ax, columns = axes(ax), columns_of(result)
    index = result.interfaces.place(interface) if isinstance(interface, str) else interface
    over, profile = Rows(columns), Profile(result, result.interfaces[index])
    here = np.flatnonzero(columns.contact_nodes[:, 0] == index)
    if not len(here):
        raise Error(f"{named(profile.line.name)} has no crack")
    nodes = np.full(len(profile.at), -1)
    nodes[columns.contact_nodes[here, 1]] = here
    order = np.argsort(over.at, kind="stable")
    strips = [strip for strip in np.array_split(order, min(len(order), _STRIPS)) if len(strip)]
    shades = np.full((len(strips), len(nodes)), np.nan)
    for i, strip in enumerate(strips):
        rows = strip[columns.converged[strip]]
        if len(rows):
            shades[i, nodes >= 0] = columns.contact[np.ix_(rows, nodes[nodes >= 0])].mean(axis=0)
    many = len(strips) < len(order)
    at = over.at[order]
    borders = _ends(at)[[*np.cumsum([0, *map(len, strips)])]] if many else _ends(at)
    ax.pcolormesh(middles(profile.at), borders, shades, vmin=0, vmax=1, rasterized=True,
                  cmap=LinearSegmentedColormap.from_list("", [_OPEN, _CLOSED]))
    profile.axis(ax)
    seen = profile.at[nodes >= 0]
    if np.ptp(seen) > 0:
        ax.set_xlim(seen.min(), seen.max())
    over.axis(ax.yaxis)
    ax.grid(False)
    ax.set_title(f"where {named(profile.line.name, 30) if len(result.interfaces) > 1 else 'the crack'} is closed")
    for color, label in ((_OPEN, "open"), (_CLOSED, "closed (pale: in some rows)" if many else "closed")):
        ax.fill([], [], color=color, label=label)
    legend_below(ax)
    return ax
