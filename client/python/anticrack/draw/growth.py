# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of cracks and delaminations that grow: the load against the displacement, and G against the front."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import Error
from ..result import Arrays, Load, Result
from ..text import harmless
from .panel import CURVES, axes, load_of, named


def _begin(result: Result, load: str | Load | None, ax: Any) -> tuple[Any, Load]:
    ax, load = axes(ax), load_of(result, load)
    if not load.growth:
        raise Error(f"nothing grows under {harmless(load.name)}: write [growth] in the case")
    return ax, load


def place_of(rows: Arrays) -> Array:
    """(rows) the horizontal place of each row of growth: the displacement, or without inclusion the position."""
    return rows["position"] if np.isnan(rows["displacement"]).all() else rows["displacement"]


def growth(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Draws the load at which fronts go on against the displacement of the inclusion, or without one against the
    position of the front that goes on. Thick where what is increased goes up, thin where it would have to go back:
    there fronts run."""
    ax, load = _begin(result, load, ax)
    rows = load.growth
    by_position = bool(np.isnan(rows["displacement"]).all())
    at = place_of(rows)
    label = f"{named(load.name)}: " if len(result.loads) > 1 else ""
    color = CURVES[sum(not line.get_label().startswith("_") for line in ax.lines) // 2 % len(CURVES)][0]
    ax.plot(at, rows["load"], color=color, linewidth=0.6, label=f"{label}fronts run")
    ax.plot(at, np.where(rows["stable"] != 0, rows["load"], np.nan), color=color, linewidth=2, marker=".",
            markersize=4, label=f"{label}stable")
    ax.set_xlabel(("position of the front" if by_position else "displacement") + result.units.label("L"))
    ax.set_ylabel("load, times the load case")
    ax.set_title(f"{named(load.name)}: load of growth")
    ax.legend(fontsize="small")
    return ax


def release(result: Result, load: str | Load | None = None, ax: Any = None) -> Any:
    """Draws G1, the rate under the load case itself, and Gc against the position of each front; as dots G1 of its
    final positions, and as boxes the bounds of the means between them where no other front moves."""
    ax, load = _begin(result, load, ax)
    rows = load.growth
    fronts = sorted({int(front) for front in rows["front"] if front >= 0})
    for front, (color, _) in zip(fronts, CURVES * len(fronts)):
        own = rows["front"] == front
        order = np.argsort(rows["position"][own])
        of = f", front {front} on {named(str(rows['interface'][own][0]))}" if len(fronts) > 1 else ""
        ax.plot(rows["position"][own][order], rows["G1"][own][order], color=color, label=f"G1{of}")
        ax.plot(rows["position"][own][order], rows["Gc"][own][order], color=color, linestyle=":",
                label=f"Gc{of}")
        final = np.flatnonzero(np.isfinite(rows.get("energy_lower", np.full(len(own), np.nan))))
        at = final[own[final]]
        if len(at):
            ax.plot(rows["position"][at], rows["G1_final"][at], color=color, linestyle="", marker=".",
                    label=f"G1 on meshes of their own{of}")
        for here, after in zip(final, final[1:]):
            if own[here:after + 1].all() and np.isfinite(rows["G1_lower"][here]):
                ax.fill_between(rows["position"][[here, after]], rows["G1_lower"][here], rows["G1_upper"][here],
                                color=color, alpha=0.25, linewidth=0)
    ax.set_yscale("log")
    ax.set_xlabel("position of the front" + result.units.label("L"))
    ax.set_ylabel("G1 and Gc" + result.units.label("F"))
    ax.set_title(f"{named(load.name)}: energy release")
    ax.legend(fontsize="small")
    return ax
