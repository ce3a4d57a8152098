# SPDX-License-Identifier: GPL-3.0-or-later
"""What figures share: where they are drawn, of what, and in which colours."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import Error, package
from ..result import BONDED, CRACK, DELAMINATED, FREE, Load, Result
from ..text import harmless

# Of kinds of edges: name and colour, as in the command's figures.
LINES = {BONDED: ("bonded inclusion", "#000000"), DELAMINATED: ("delaminated inclusion", "#E69F00"),
         CRACK: ("crack, [u] \u2265 0", "#B04A8A"), FREE: ("free crack", "#8CD17D")}
_MINUS = "\u2212"
BOX = {"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.6, "linewidth": 0}  # under a name


def axes(ax: Any, projection: str = "rectilinear") -> Any:
    if ax is not None:
        return ax
    return package("matplotlib.pyplot").subplots(layout="constrained", subplot_kw={"projection": projection})[1]


def load_of(result: Result, load: str | Load | None) -> Load:
    if isinstance(load, Load):
        return load
    if load is None and not result.loads:
        raise Error("there is no load to draw" + ("; keep rows, as in client.run(case, coefficients, traces=[0])"
                                                  if result.sweep is not None else ""))
    return result.loads[next(iter(result.loads), "") if load is None else load]


def fields(load: Load) -> list[Any]:
    if not load.fields:
        raise Error(f"{harmless(load.name)} has no fields; solve with Case(fields=True), in TOML [output] "
                    "fields = true")
    return load.fields


def traces_of(result: Result, load: Load) -> None:
    """Raises Error where there is none to draw."""
    if not result.interfaces:
        raise Error("the sheet has no interface, so there is nothing to draw along one")
    if not load.traces:
        raise Error(f"{harmless(load.name)} has no traces: it is {load.status.replace('_', ' ')}")


def widened(low: float, high: float) -> tuple[float, float]:
    """The range of an axis or of colours: around a single value, as the command's."""
    half = 0.0 if high > low else abs(low) / 2 or 1.0
    return low - half, high + half


def stretch_of(sides: Array) -> Array:
    """Of a sheet: longer ones than eight times their width are drawn wider."""
    return np.asarray(np.maximum(sides, sides.max() / 8) / sides)


def number_text(value: float, digits: int) -> str:
    """Without an "e"."""
    leading, e, exponent = f"{float(f'{value:.{digits}g}'):.{max(digits, 6)}g}".partition("e")
    return f"${leading} \\cdot 10^{{{int(exponent)}}}$" if e else leading


def factor_text(factor: float) -> str:
    """×2000, behind what is multiplied."""
    return "×" + number_text(factor, 6)


def offset_of(low: float, high: float, extent: float = 0) -> float:
    """What the labels of an axis leave out, as the command's: a round number where all is far from 0 against its range,
    or against the longer `extent` of all that is drawn to one scale; else 0."""
    size = max(high - low, extent)
    if not size > 0 or not max(abs(low), abs(high)) > 1e3 * size:
        return 0.0
    rounded = 10.0 ** (math.floor(math.log10(size)) + 2)
    return float(round((low + high) / 2 / rounded) * rounded)


def named_without(name: str, offset: float) -> str:
    """Of what is drawn without an offset."""
    return f"{name} {_MINUS if offset > 0 else '+'} {abs(offset):.15g}" if offset else name


class Scale:
    """Of numbers from low to high: their texts leave an offset and a power of ten out, which the label says."""

    def __init__(self, low: float, high: float, extent: float = 0) -> None:
        self.offset = offset_of(low, high, extent)
        self._largest = max(abs(low - self.offset), abs(high - self.offset))
        plain = self._largest == 0 or 1e-3 <= self._largest < 1e5
        self._exponent = 0 if plain else 3 * math.floor(math.log10(self._largest) / 3)

    def text(self, value: float, _: Any = None) -> str:
        shown = 0.0 if abs(value - self.offset) < 1e-9 * self._largest else value - self.offset
        return f"{shown / 10.0 ** self._exponent:.6g}".replace("-", _MINUS)

    def label(self, name: str, unit: str) -> str:
        """unit: "mm", empty where there is none."""
        name = named_without(name, self.offset) + (f" {unit}" if self.offset and unit and self._exponent else "")
        inside = " ".join(part for part in (f"$10^{{{self._exponent}}}$" if self._exponent else "", unit) if part)
        return name + (f" [{inside}]" if inside else "")


def label_axis(axis: Any, name: str, unit: str, scale: Scale, stretched: float = 1) -> None:
    """stretched: by how much it is drawn longer than others to one scale, which the label says too."""
    from matplotlib.ticker import FuncFormatter
    axis.set_major_formatter(FuncFormatter(scale.text))
    axis.set_label_text(scale.label(name, unit) + (f", stretched {factor_text(stretched)}" if stretched != 1 else ""))


def point_text(x: float, y: float, size: float) -> str:
    """A point, with the digits that tell it from others of a line of this size."""
    def text(value: float) -> str:
        more = math.ceil(math.log10(abs(value) / size)) if value and size > 0 else 0
        return number_text(value, min(max(4 + more, 4), 15))
    return f"({text(x)}, {text(y)})"


def legend_below(ax: Any, *entries: Any) -> None:
    """At a distance of the labels of the axis, however flat it is drawn."""
    from matplotlib.transforms import ScaledTranslation
    down = ScaledTranslation(0, -0.5, ax.figure.dpi_scale_trans)
    ax.legend(*entries, loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=ax.transAxes + down, ncol=2,
              fontsize="small", frameon=False)


def cut(values: Array, weights: Array, part: float, room: float) -> tuple[float, float]:
    """The end of an axis for values that are singular at tips, and the highest of them: `room` times what `part` of the
    weight stays below, or the highest if that is little more."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    highest = float(values[order[-1]])
    shown = room * float(values[order[np.searchsorted(below, part * below[-1])]])
    return (highest if highest <= 1.25 * shown else shown), highest
