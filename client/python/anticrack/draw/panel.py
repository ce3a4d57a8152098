# SPDX-License-Identifier: GPL-3.0-or-later
"""What panels share: their axes, their load, colours, numbers and names."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import Error, package
from ..result import BONDED, CRACK, DELAMINATED, FREE, GLUE, Load, Result
from ..text import harmless

package("matplotlib.ticker")  # needed by the other modules of this folder, too
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter  # noqa: E402
from matplotlib.transforms import ScaledTranslation  # noqa: E402

# For each kind of edge of an interface: name, colour, width and dash, so that they differ in print without colour.
LINES: dict[int, tuple[str, str, float, Any]] = {
    GLUE: ("glue, u\u207a = u\u207b", "#0072B2", 1.0, (0, (5, 3))), BONDED: ("bonded inclusion", "#000000", 2.5, "-"),
    DELAMINATED: ("delaminated inclusion", "#E69F00", 2.5, "-"), FREE: ("free crack", "#8CD17D", 1.8, "-"),
    CRACK: ("crack, [u] \u2265 0", "#B04A8A", 1.8, "-")}
MARKED = (DELAMINATED, BONDED, CRACK, FREE)
# Okabe and Ito's colours for colour-blind readers; all curves of a panel differ in colour, and neighbours in dash.
CURVES: list[tuple[str, Any]] = [
    ("#0072B2", "-"), ("#D55E00", (0, (5, 2))), ("#009E73", (0, (1, 1.2))), ("#CC79A7", (0, (7, 1.5, 1.5, 1.5))),
    ("#222222", (0, (3, 2))), ("#E69F00", "-"), ("#56B4E9", (0, (5, 2))), ("#8C6D31", (0, (1, 1.2)))]
CONTACT = "#C9E4F4"
MINUS = "\u2212"
BOX: dict[str, Any] = {"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.7, "linewidth": 0}  # under a name
_RAISED = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")


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


def unit_of(result: Result, dimension: str = "L") -> str:
    """The unit on an axis; empty if there is none."""
    return result.units.behind(dimension).strip()


def named(text: object, most: int = 60) -> str:
    """Makes a name of others show as it is, as matplotlib takes text between two $ for a formula."""
    shown = harmless(text)
    return (shown if len(shown) <= most else shown[:most - 1] + "\u2026").replace("$", r"\$")


def widened(low: float, high: float) -> tuple[float, float]:
    """Widens the range of an axis or of colours if it is a single value."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return 0.0, 1.0
    half = 0.0 if high > low else abs(low) / 2 or 1.0
    return low - half, high + half


def stretch_of(sides: Array) -> Array:
    """Factors by which a sheet is stretched: one longer than eight times its width is drawn wider."""
    return np.asarray(np.maximum(sides, sides.max() / 8) / sides)


def signed(text: str) -> str:
    return text.replace("-", MINUS)


def power_of_ten(exponent: int) -> str:
    return "10" + str(exponent).translate(_RAISED)


def number_text(value: float, digits: int = 4) -> str:
    """Writes a number for people: \u22121.5\u00d710\u207b\u00b9\u00b2."""
    leading, e, exponent = f"{float(f'{value:.{digits}g}'):.{max(digits, 6)}g}".partition("e")
    if not e:
        return signed(leading)
    return ("" if leading == "1" else f"{signed(leading)}\u00d7") + power_of_ten(int(exponent))


def offset_of(low: float, high: float, extent: float = 0) -> float:
    """The offset that the labels of an axis leave out: a round number if all values are far from 0 against their range,
    or against the longer `extent` of all that is drawn to the same scale; else 0."""
    size = max(high - low, extent)
    if not size > 0 or not max(abs(low), abs(high)) > 1e3 * size:
        return 0.0
    rounded = 10.0 ** (math.floor(math.log10(size)) + 2)
    return float(round((low + high) / 2 / rounded) * rounded)


def named_without(name: str, offset: float) -> str:
    """The name of a value that is drawn without an offset."""
    return f"{name} {MINUS if offset > 0 else '+'} {abs(offset):.15g}" if offset else name


def rounded(most: int, **options: Any) -> MaxNLocator:
    """Makes a locator of about so many round numbers on an axis."""
    return MaxNLocator(most, steps=[1, 2, 5, 10], **options)


class Scale:
    """How numbers from low to high are written: without an offset and a power of ten, which the label states. factor:
    by how much they are drawn larger."""

    def __init__(self, low: float, high: float, extent: float = 0, factor: float = 1) -> None:
        self.offset, self.factor = offset_of(low, high, extent), factor
        self._largest = max(abs(low - self.offset), abs(high - self.offset))
        plain = self._largest == 0 or 2e-3 <= self._largest < 1e5 or not math.isfinite(self._largest)
        self._exponent = 0 if plain else 3 * math.floor(math.log10(self._largest) / 3)

    def text(self, value: float, _: Any = None) -> str:
        value /= self.factor
        rounding = 1e-9 * self._largest + 2 * math.ulp(self.offset)
        shown = 0.0 if abs(value - self.offset) < rounding else value - self.offset
        return signed(f"{shown / 10.0 ** self._exponent:.6g}")

    def label(self, name: str, unit: str) -> str:
        """Writes the label; unit: "mm", or empty if there is none."""
        name = named_without(name, self.offset) + (f" {unit}" if self.offset and unit and self._exponent else "")
        inside = " ".join(part for part in (power_of_ten(self._exponent) if self._exponent else "", unit) if part)
        return name + (f" [{inside}]" if inside else "")


def label_axis(axis: Any, name: str, unit: str, scale: Scale, stretched: float = 1) -> None:
    """Labels an axis. stretched: by how much it is drawn longer than the others, which the label states too."""
    axis.set_major_formatter(FuncFormatter(scale.text))
    axis.set_label_text(scale.label(name, unit) + (
        f", stretched \u00d7{number_text(stretched, 6)}" if stretched != 1 else ""))


def fit_axis(axis: Any, name: str, unit: str) -> None:
    """Labels an axis by the range of what has been drawn."""
    label_axis(axis, name, unit, Scale(*sorted(axis.get_view_interval())))


def log_axis(axis: Any) -> None:
    """Puts labels at powers of ten, over few decades at 2 and 5 as well, and marks between them if there is room."""
    low, high = axis.get_view_interval()
    decades = abs(math.log10(high / low)) if low > 0 else 0
    axis.set_major_locator(rounded(5) if decades < 0.7 else
                           LogLocator(subs=(1, 2, 5) if decades < 2 else (1,), numticks=7))
    axis.set_minor_locator(LogLocator(subs=range(1, 10) if decades <= 4 else (1,), numticks=50))
    axis.set_major_formatter(FuncFormatter(lambda value, _: number_text(value, 5) if decades <= 2 or value == 0 else
                                           power_of_ten(round(math.log10(value)))))
    axis.set_minor_formatter(NullFormatter())


def point_text(x: float, y: float, size: float, digits: int = 4) -> str:
    """Writes a point with the digits that tell it from other points of a line of this size."""
    def text(value: float) -> str:
        more = math.ceil(math.log10(abs(value) / size)) if value and size > 0 else 0
        return number_text(value, min(max(digits + more, digits), 15))
    return f"({text(x)}, {text(y)})"


def legend_below(ax: Any, columns: int = 2, down: float = 0.5, middle: float = 0.5, **options: Any) -> Any:
    """Puts a legend `down` inches below the axes, clear of their labels, however flat they are drawn."""
    moved = ax.transAxes + ScaledTranslation(0, -down, ax.figure.dpi_scale_trans)
    return ax.legend(loc="upper center", bbox_to_anchor=(middle, 0), bbox_transform=moved, ncol=columns,
                     fontsize="small", frameon=False, **options)


def colour_bar(ax: Any, shades: Any, name: str, unit: str, colorbar: Any, **options: Any) -> None:
    """Draws a colour bar, by default beside `ax`. colorbar: False for none, or axes to draw it in. A second call for
    the same axes changes the bar and adds no other."""
    if colorbar is False:
        return
    scale, made = Scale(*shades.get_clim()), getattr(ax, "anticrack_colour_bar", None)
    if made is not None and made.ax.figure is ax.figure:
        made.update_normal(shades)
    elif colorbar is True:
        made = ax.figure.colorbar(shades, ax=ax, **options)
    else:
        box = colorbar.get_window_extent()
        made = ax.figure.colorbar(shades, cax=colorbar, extend=options.get("extend", "neither"),
                                  orientation="horizontal" if box.width > box.height else "vertical")
    ax.anticrack_colour_bar = made
    made.locator, made.formatter = rounded(4), FuncFormatter(scale.text)
    made.update_ticks()
    made.outline.set_linewidth(0.4)
    made.set_label(scale.label(name, unit))


def cut(values: Array, weights: Array, part: float, room: float) -> tuple[float, float]:
    """The end of an axis for values that are singular at tips, and the highest value. The end is `room` times the value
    below which `part` of the weight lies, or the highest value if that is little more; (0, 0) without values."""
    if not len(values):
        return 0.0, 0.0
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    highest = float(values[order[-1]])
    shown = room * float(values[order[np.searchsorted(below, part * below[-1])]])
    return (highest if highest <= 1.25 * shown else shown), highest
