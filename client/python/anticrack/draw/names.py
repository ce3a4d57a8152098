# SPDX-License-Identifier: GPL-3.0-or-later
"""Places names on a map so that none covers another."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from .panel import BOX, named

_SIZE = 7.0  # size of the letters [points]
_LONGEST = 24


class Names:
    """The names on axes whose limits are set, on which `lines` (n, 2) are drawn."""

    def __init__(self, ax: Any, lines: Array) -> None:
        ax.apply_aspect()
        self._ax, self._points_a_dot = ax, 72 / ax.figure.dpi
        self._room = np.array(ax.bbox.size) * self._points_a_dot
        self._lines = self._points(lines[::max(1, len(lines) // 2000)])
        self._taken = np.empty((0, 4))

    def _points(self, spots: Array) -> Array:
        """The spots in points on paper."""
        return np.asarray((self._ax.transData.transform(np.reshape(spots, (-1, 2))) - self._ax.bbox.p0)
                          * self._points_a_dot)

    def _box(self, text: str, at: Array, towards: Any = (0, 0)) -> Array:
        """Left, low, right and high end of a text that lies in a direction from a point."""
        half = np.array((0.31 * _SIZE * (min(len(text), _LONGEST) + 0.5), 0.65 * _SIZE))
        middle = at + half * towards
        return np.concatenate((middle - half, middle + half))

    def _free(self, box: Array) -> bool:
        inside = (box[:2] >= 0).all() and (box[2:] <= self._room).all()
        apart = (self._taken[:, :2] > box[2:]) | (self._taken[:, 2:] < box[:2])
        return bool(inside and apart.any(axis=1).all())

    def beside(self, text: str, choices: list[tuple[float, float, float, float]], arrow: bool = False) -> bool:
        """Writes a text at the place of `choices` (x, y, and a direction of length 1) where it covers no name and the
        least of the lines. arrow: draw an arrow to the place. Returns False if there is no room."""
        free: list[Any] = []
        for x, y, right, up in choices:
            direction = np.array((right, up))
            side = np.sign(direction) * (np.abs(direction) > 0.38)
            at = self._points(np.array((x, y)))[0]
            end = at + direction * (11 if arrow else 4)
            box = self._box(text, end, side)
            if self._free(box):
                covered = int(((self._lines > box[:2]) & (self._lines < box[2:])).all(axis=1).sum())
                free.append((covered, box, (x, y), tuple(end - at), side))
        if not free:
            return False
        _, box, spot, offset, side = min(free, key=lambda found: int(found[0]))
        self._taken = np.vstack((self._taken, box))
        if arrow:
            self._ax.annotate("", spot, offset, textcoords="offset points", zorder=6, arrowprops={
                "arrowstyle": "<|-", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 6, "color": "k"})
        self._ax.annotate(named(text, _LONGEST), spot, offset, textcoords="offset points", fontsize=_SIZE, bbox=BOX,
                          zorder=7, ha=("center", "left", "right")[int(side[0])],
                          va=("center", "bottom", "top")[int(side[1])])
        return True

    def on(self, text: str, spots: Array, least: float) -> bool:
        """Writes a text on the one of the spots (n, 2) with the most room around it: `least` points to lines, and more
        to other names. Returns False if there is no room."""
        spots = spots[::max(1, len(spots) // 200)]
        points = self._points(spots)
        if not len(points):
            return False
        room = np.full(len(points), np.inf)
        for others, part in ((self._lines, 1), ((self._taken[:, :2] + self._taken[:, 2:]) / 2, 3)):
            if len(others):
                room = np.minimum(room, np.hypot(*(points[:, None] - others).transpose(2, 0, 1)).min(axis=1) / part)
        for best in np.argsort(-room)[:20]:
            box = self._box(text, points[best])
            if room[best] >= least and self._free(box):
                self._taken = np.vstack((self._taken, box))
                self._ax.text(*spots[best], named(text, _LONGEST), fontsize=_SIZE, color="#444444", bbox=BOX,
                              ha="center", va="center", zorder=5)
                return True
        return False
