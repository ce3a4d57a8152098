# SPDX-License-Identifier: GPL-3.0-or-later
"""What figures share: where they are drawn, of what, and in which colours."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import Error, package
from ..result import BONDED, CRACK, DELAMINATED, FREE, Load, Result
from ..text import harmless

# Of kinds of edges: name and colour, as in the command's figures.
LINES = {BONDED: ("bonded inclusion", "#000000"), DELAMINATED: ("delaminated inclusion", "#E69F00"),
         CRACK: ("crack, [u] \u2265 0", "#B04A8A"), FREE: ("free crack", "#8CD17D")}
BOX = {"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.6, "linewidth": 0}  # under a name


def axes(ax: Any, projection: str = "rectilinear") -> Any:
    if ax is not None:
        return ax
    return package("matplotlib.pyplot").subplots(layout="constrained", subplot_kw={"projection": projection})[1]


def load_of(result: Result, load: str | Load | None) -> Load:
    if isinstance(load, Load):
        return load
    return result.loads[next(iter(result.loads), "") if load is None else load]


def fields(load: Load) -> list[Any]:
    if not load.fields:
        raise Error(f"{harmless(load.name)} has no fields; solve with Case(fields=True), in TOML [output] "
                    "fields = true")
    return load.fields


def cut(values: Array, weights: Array, part: float, room: float) -> tuple[float, float]:
    """The end of an axis for values that are singular at tips, and the highest of them: `room` times what `part` of the
    weight stays below, or the highest if that is little more."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    highest = float(values[order[-1]])
    shown = room * float(values[order[np.searchsorted(below, part * below[-1])]])
    return (highest if highest <= 1.25 * shown else shown), highest
