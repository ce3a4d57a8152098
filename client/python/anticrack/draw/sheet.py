# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures for print: panels with their places in millimetres, and the files made of them."""
from __future__ import annotations

import contextlib
import io
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import matplotlib
from matplotlib import font_manager
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from ..errors import Error
from ..text import suggestion
from .panel import legend_below, named

INCH = 25.4
_LINE = 4.2  # height of a line of the title [mm]
LEFT, RIGHT = 16.0, 3.5  # room beside axes for numbers and a name [mm]
ABOVE, BELOW = 6.5, 10.5  # room above for a heading, below for numbers and a name [mm]
KEY = 3.7  # height of a row of a legend [mm]
_GAP = 3.0  # gap between panels over one axis [mm]
_ROOM = 400.0  # more than the height of any picture, which is set in the end [mm]

_LOOKS: dict[str, Any] = {
    "font.size": 8, "axes.titlesize": 8, "axes.labelsize": 8, "figure.titlesize": 9, "legend.fontsize": 7,
    "xtick.labelsize": 7, "ytick.labelsize": 7, "axes.linewidth": 0.6, "lines.linewidth": 1.2, "axes.titlepad": 4,
    "axes.labelpad": 2, "xtick.major.width": 0.5, "ytick.major.width": 0.5, "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4, "xtick.major.size": 2.5, "ytick.major.size": 2.5, "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5, "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#555555",
    "xtick.color": "#333333", "ytick.color": "#333333", "axes.grid": True, "grid.color": "#e4e4e4",
    "grid.linewidth": 0.5, "axes.axisbelow": True, "legend.frameon": False, "legend.borderaxespad": 0.3,
    "legend.handlelength": 2.2, "legend.labelspacing": 0.25, "svg.fonttype": "none", "svg.hashsalt": "anticrack",
    "pdf.fonttype": 42, "patch.linewidth": 0, "axes.xmargin": 0, "axes.titlecolor": "#222222"}


@dataclass
class Look:
    """How pictures look. width: of a panel [mm]; an overview has two side by side; titles: show titles of case and load
    and headings of panels; font: a family, empty for matplotlib's own; limits, heights and amplify:
    as for draw.membrane."""
    formats: list[str] = field(default_factory=lambda: ["png", "svg"])
    dpi: int = 300
    titles: bool = True
    width: float = 85.0
    font: str = ""
    amplify: float | None = None
    limits: tuple[float, float] | None = None
    heights: tuple[float, float] | None = None

    @contextlib.contextmanager
    def applied(self) -> Iterator[None]:
        """Applies the look inside the context, while figures are made. Raises Error if the font does not exist."""
        looks = dict(_LOOKS)
        if self.font:
            known = sorted({font.name for font in font_manager.fontManager.ttflist})
            if self.font not in known:
                raise Error(f"there is no font {self.font}; {suggestion(self.font, known)}")
            looks["font.family"] = [self.font, "DejaVu Sans"]
        with matplotlib.rc_context({**matplotlib.rcParamsDefault, "backend": matplotlib.rcParams["backend"]}):
            matplotlib.rcParams.update(looks)
            yield


class Sheet:
    """A picture of `columns` panels side by side. Heights are given from below the title."""

    def __init__(self, look: Look, title: str, columns: int = 1) -> None:
        self.look, self.width = look, columns * look.width
        self._figure = Figure(figsize=(self.width / INCH, _ROOM / INCH), dpi=100)
        FigureCanvasAgg(self._figure)
        # A character is about 1.75 mm wide.
        lines = textwrap.wrap(named(title, 200), max(10, int(self.width / 1.75)), max_lines=3,
                              placeholder=" \u2026") if look.titles else []
        self._head = 1 + _LINE * len(lines) if lines else 0.0
        for i, line in enumerate(lines):
            self._figure.text(0.5, 1 - (1 + _LINE * (i + 0.5)) / _ROOM, line, ha="center", va="center", fontsize=9,
                              color="#222222")

    def height(self, down: float) -> float:
        """The height of a place so many mm below the title, as a fraction of the figure."""
        return 1 - (self._head + down) / _ROOM

    @property
    def panels(self) -> list[Any]:
        return list(self._figure.axes)

    def panel(self, left: float, top: float, width: float, height: float, **options: Any) -> Any:
        """Makes axes at a place in mm from the left and from below the title."""
        return self._figure.add_axes((left / self.width, self.height(top + height), width / self.width,
                                      height / _ROOM), **options)

    def centre(self, ax: Any) -> None:
        """Centres axes of three dimensions in their place, and shrinks them if their names would leave it."""
        room, smaller = ax.get_position(original=True), 1.0
        for _ in range(3):  # repeated, as letters do not shrink with the axes
            if smaller:
                self._figure.draw_without_rendering()  # this places the names
                renderer, now = self._figure.canvas.get_renderer(), ax.get_position(original=True)
                names = Bbox.union([axis.get_tightbbox(renderer) for axis in (ax.xaxis, ax.yaxis, ax.zaxis)])
                names = names.transformed(self._figure.transFigure.inverted())
                smaller = max(0.0, (names.width + 3 / self.width) / room.width - 1)
                ax.set_position(now.shrunk(1 - smaller, 1 - smaller).anchored("C", now).translated(
                    (room.x0 + room.x1 - names.x0 - names.x1) / 2, 0))
        ax.apply_aspect()
        ax.title.set_x(((room.x0 + room.x1) / 2 - ax.get_position().x0) / ax.get_position().width)

    def axes(self, left: float, top: float, height: float, **options: Any) -> Any:
        """Makes the axes of a column, leaving room for their numbers and names."""
        return self.panel(left + LEFT, top, self.look.width - LEFT - RIGHT, height, **options)

    def stack(self, left: float, heights: list[float]) -> tuple[list[Any], float]:
        """Makes the axes of a column below each other over one axis; returns them and where the axis's name ends."""
        panels, top = list[Any](), ABOVE
        for height in heights:
            panels.append(self.axes(left, top, height, sharex=panels[0] if panels else None))
            top += height + _GAP
        return panels, top - _GAP + BELOW

    def legend(self, ax: Any, columns: int, handles: list[Any]) -> float:
        """Puts a legend below the axis in the middle of the column, in place of the axes' own; returns its height
        [mm]."""
        if not handles:
            return 0.0
        box, column = ax.get_position(), self.look.width / self.width
        middle = ((box.x0 + box.x1) / 2 // column + 0.5) * column
        legend_below(ax, columns, (BELOW - 1) / INCH, (middle - box.x0) / box.width, handles=handles)
        return 1 + KEY * -(-len(handles) // columns)

    def files(self, height: float) -> dict[str, bytes]:
        """Returns the files by format; the picture ends at this height."""
        for ax in self._figure.axes:
            room = (ax.get_position().width * self.width + 2 * RIGHT) / 1.6  # in characters
            ax.title.set_fontsize(8 * min(1, max(0.8, room / max(len(ax.get_title()), 1))))
            if not self.look.titles:
                ax.set_title("")
        shown = Bbox.from_bounds(0, _ROOM * self.height(height) / INCH, self.width / INCH, (self._head + height) / INCH)
        made = {}
        for kind in self.look.formats:
            buffer = io.BytesIO()
            # Without a date, so that the same result gives the same bytes.
            metadata: dict[str, Any] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None},
                                        "pdf": {"CreationDate": None, "Creator": None, "Producer": None}}[kind]
            self._figure.savefig(buffer, format=kind, dpi=self.look.dpi, metadata=metadata, facecolor="white",
                                 bbox_inches=shown)
            made[kind] = buffer.getvalue()
        return made
